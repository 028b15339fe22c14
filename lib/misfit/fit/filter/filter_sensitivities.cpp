#include "misfit/fit/filter/filter_sensitivities.h"

#include <algorithm>
#include <cmath>

namespace misfit {
namespace {

constexpr Eigen::Index block = 4;  // columns whose sums stay in registers
using Block = Eigen::Map<Eigen::Array<double, block, 1>>;
using ConstBlock = Eigen::Map<const Eigen::Array<double, block, 1>>;

/// `out` = Σ a_i · row i of `rows`; `out` is as long as a row.
void combine(const double* a, const RowMatrix& rows, double* out) {
  const Eigen::Index width = rows.cols();
  for (Eigen::Index c = 0; c < width; c += block) {
    const double* at = rows.data() + c;
    Eigen::Array<double, block, 1> sum = a[0] * ConstBlock(at);
    for (Eigen::Index i = 1; i < rows.rows(); ++i) sum += a[i] * ConstBlock(at += width);
    Block(out + c) = sum;
  }
}

}  // namespace

void FilterSensitivities::begin(FilterJacobian& jacobian, const FilterData& data, const Sizes& sizes) {
  jacobian_ = &jacobian;
  jacobian.J.resize(std::count(data.use.begin(), data.use.end(), SampleRole::counted), sizes.columns);
  jacobian.r.resize(jacobian.J.rows());
  jacobian.index.clear();
  const Eigen::Index width = (sizes.columns + block - 1) / block * block;
  model_ = RowMatrix::Zero(sizes.states, width);
  coloured_ = RowMatrix::Zero(2 * static_cast<Eigen::Index>(sizes.outputs), width);
  past_ = RowMatrix::Zero(sizes.past, width);
  work_.resize(sizes.states, width);
  row_.resize(width);
}

void FilterSensitivities::predict_output(const double* a, int o, const double* direct, const Slots& slots) {
  combine(a, model_, row_.data());
  row_ += coloured_.row(2 * static_cast<Eigen::Index>(o));
  for (int c = 0; c < slots.count(); ++c) row_[slots.column(c)] += direct[c];
}

void FilterSensitivities::keep(std::size_t place, const FilterTrace& trace) {
  const Eigen::Index r = jacobian_->index.size();
  const double whiten = 1.0 / std::sqrt(trace.S[place]);
  jacobian_->J.row(r) = whiten * row_.head(jacobian_->J.cols());
  jacobian_->r[r] = -whiten * trace.e[place];
  jacobian_->index.push_back(place);
}

void FilterSensitivities::update(const double* gain, const double* gain_coloured) {
  for (Eigen::Index i = 0; i < model_.rows(); ++i) model_.row(i) -= gain[i] * row_;
  for (Eigen::Index i = 0; i < coloured_.rows(); ++i) coloured_.row(i) -= gain_coloured[i] * row_;
}

void FilterSensitivities::update_past(const double* gain) {
  for (Eigen::Index i = 0; i < past_.rows(); ++i) past_.row(i) -= gain[i] * row_;
}

void FilterSensitivities::step(const double* D, const Slots& slots, const NoiseStep& noise) {
  const Eigen::Index n = model_.rows();
  for (Eigen::Index i = 0; i < n; ++i) {
    const double* phi = D + i * kRowStride;
    combine(phi, model_, work_.row(i).data());
    for (int c = 0; c < slots.count(); ++c) work_(i, slots.column(c)) += phi[n + c];
  }
  model_.swap(work_);
  for (std::size_t o = 0; o < noise.coloured.size(); ++o) {
    const auto& p = noise.coloured[o].phi;
    const Eigen::Index at = 2 * static_cast<Eigen::Index>(o);
    row_ = coloured_.row(at);
    coloured_.row(at) = p[0] * row_ + p[1] * coloured_.row(at + 1);
    coloured_.row(at + 1) = p[2] * row_ + p[3] * coloured_.row(at + 1);
  }
}

}  // namespace misfit
