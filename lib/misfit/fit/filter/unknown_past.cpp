#include "misfit/fit/filter/unknown_past.h"

#include <algorithm>

#include "misfit/model/memory.h"

namespace misfit {

UnknownPast::UnknownPast(const FilterModel& model, const FilterData& data, int states, int channels) {
  const auto& effects = model.model.effects;
  const bool late = std::any_of(effects.begin(), effects.end(), [](const BoundEffect& e) { return reads_the_past(e.effect->spec()); });
  if (!late) return;
  for (std::size_t i = 0; i < data.input_departures.size(); ++i) {
    if (data.input_departures[i] > 0.0) inputs_.push_back({static_cast<int>(i), data.input_departures[i]});
  }
  const Eigen::Index count = std::ssize(inputs_);
  X_.setZero(states, count);
  J_.setZero(2 * static_cast<Eigen::Index>(channels), count);
  G_.setZero(states, count);
  V_.setZero(count, count);
  for (Eigen::Index c = 0; c < count; ++c) V_(c, c) = inputs_[c].sigma * inputs_[c].sigma;
  gain_.setZero(count);
  reached_ = count > 0;
}

bool UnknownPast::respond(Stepper& stepper, const double* x, Interval interval) {
  std::array<double, kMaxInputs> past = mean_;
  std::array<double, kMaxStates> from{}, other{};
  const auto n = static_cast<std::size_t>(X_.rows());
  interval.u0.before = past.data();
  std::copy_n(x, n, from.begin());
  if (!stepper.step(from.data(), interval)) return false;
  reached_ = false;
  for (Eigen::Index c = 0; c < G_.cols(); ++c) {
    past[inputs_[c].index] = mean_[inputs_[c].index] + inputs_[c].sigma;
    std::copy_n(x, n, other.begin());
    if (!stepper.step(other.data(), interval)) return false;
    past[inputs_[c].index] = mean_[inputs_[c].index];
    for (std::size_t i = 0; i < n; ++i) G_(i, c) = (other[i] - from[i]) / inputs_[c].sigma;
    reached_ = reached_ || !G_.col(c).isZero(0.0);
  }
  return true;
}

void UnknownPast::keep(FilterTrace& trace) const {
  if (!reached_) return;
  trace.past_response.insert(trace.past_response.end(), G_.data(), G_.data() + G_.size());
  for (const PastInput& input : inputs_) trace.past_mean.push_back(mean_[input.index]);
}

void UnknownPast::recall_into(const FilterTrace& trace, std::size_t step, double* shift) {
  const auto size = static_cast<std::size_t>(G_.size()), count = inputs_.size();
  reached_ = (step + 1) * size <= trace.past_response.size();
  if (!reached_) return;
  std::copy_n(trace.past_response.data() + step * size, size, G_.data());
  for (std::size_t c = 0; c < count; ++c) {
    const double change = mean_[inputs_[c].index] - trace.past_mean[step * count + c];
    for (Eigen::Index i = 0; i < G_.rows(); ++i) shift[i] += G_(i, c) * change;
  }
}

void UnknownPast::predict_jointly(const double* phi, Strides apart, const NoiseStep& noise, MatrixRef P, MatrixRef C) {
  using ByStrides = Eigen::Stride<Eigen::Dynamic, Eigen::Dynamic>;
  const Eigen::Map<const Eigen::MatrixXd, 0, ByStrides> turning(phi, X_.rows(), X_.rows(), ByStrides(apart.column, apart.row));
  const Across turned = turning.lazyProduct(X_), by_variance = G_.lazyProduct(V_);
  P += turned.lazyProduct(G_.transpose());
  P += G_.lazyProduct(turned.transpose());
  P += by_variance.lazyProduct(G_.transpose());
  for (std::size_t o = 0; o < noise.coloured.size(); ++o) {
    const auto& p = noise.coloured[o].phi;
    const Eigen::Index at = 2 * static_cast<Eigen::Index>(o);
    const PastVector first = J_.row(at).transpose(), second = J_.row(at + 1).transpose();
    J_.row(at) = (p[0] * first + p[1] * second).transpose();
    J_.row(at + 1) = (p[2] * first + p[3] * second).transpose();
  }
  C += G_.lazyProduct(J_.transpose());
  X_ = turned + by_variance;
}

void UnknownPast::update_jointly(const VectorRef& a, int o, const VectorRef& gain, const VectorRef& gain_coloured, double innovation,
                                 double S) {
  const PastVector shared = X_.transpose().lazyProduct(a) + J_.row(2 * static_cast<Eigen::Index>(o)).transpose();
  gain_ = shared / S;
  X_ -= gain.lazyProduct(shared.transpose());
  J_ -= gain_coloured.lazyProduct(shared.transpose());
  V_ -= gain_.lazyProduct(shared.transpose());
  for (Eigen::Index c = 0; c < gain_.size(); ++c) mean_[inputs_[c].index] += gain_[c] * innovation;
}

}  // namespace misfit
