#include "misfit/track/locate.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "misfit/core/lists.h"
#include "misfit/math/statistics.h"

namespace misfit {
namespace {

constexpr int max_unknowns = 10;  // centre, three levels, slope of the ground in x and y, outer, inner, edge
using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, max_unknowns, 1>;
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, max_unknowns, max_unknowns>;

constexpr int sectors = 8;
constexpr double min_sigma = 0.01;                                      // [px] no edge is the formula of marker.h to better than that
constexpr int alike_columns = 4, alike_lines = 2;                       // how far residuals of texture and compression are alike
constexpr double least_outer = 2.0, most_outer = 30.0, min_edge = 0.6;  // [px]

/// Pixels taken into account: image columns and rows, ends included.
struct Window {
  int c0 = 0, c1 = -1, r0 = 0, r1 = -1;
  double reach_x = 0.0, reach_y = 0.0;
  bool round = true;
  [[nodiscard]] bool takes(double x, double y) const {
    return round ? x * x + y * y <= reach_x * reach_x : std::abs(x) <= reach_x && std::abs(y) <= reach_y;
  }
};

Window window_at(const Field& field, const Marker& marker, const PixelPoint& at) {
  Window w;
  w.round = marker.kind != MarkerKind::picture;
  const double margin = w.round ? std::max(2.5, 0.3 * marker.outer) + 0.5 * marker.edge : 0.0;
  w.reach_x = marker.reach_x() + margin;
  w.reach_y = marker.reach_y() + margin;
  w.c0 = std::max(0, static_cast<int>(std::ceil(at.column - w.reach_x)));
  w.c1 = std::min(field.image.width - 1, static_cast<int>(std::floor(at.column + w.reach_x)));
  w.r0 = std::max(0, static_cast<int>(std::ceil(field.image_row(at.row - w.reach_y))));
  w.r1 = std::min(field.image.height - 1, static_cast<int>(std::floor(field.image_row(at.row + w.reach_y))));
  return w;
}

struct Pixel {
  int column = 0, row = 0;  ///< of the image
  double x = 0.0, y = 0.0;  ///< from the centre when gathered
  double grey = 0.0, model = 0.0, residual = 0.0, weight = 1.0;
  Vector slope;
};

/// One fit: unknowns are centre, levels 0 … shapes and, where asked, the shape.
class Fitter {
 public:
  Fitter(const Field& field, const Marker& marker, const PixelPoint& start, bool fit_shape)
      : field_(field), marker_(marker), at_(start), shape_(fit_shape && marker.kind != MarkerKind::picture) {
    levels_ = 1 + marker.shapes();
    ground_ = marker.kind != MarkerKind::picture;
    first_shape_ = 2 + levels_ + (ground_ ? 2 : 0);
    unknowns_ = first_shape_ + (shape_ ? marker.shapes() + 1 : 0);
  }

  Location run() {
    Location out;
    for (int pass = 0; pass < (shape_ ? 3 : 2); ++pass) {
      gather();
      if (int_size(pixels_) < 3 * unknowns_ || !start_levels() || !iterate(pass)) return out;
    }
    out.converged = true;
    finish(out);
    return out;
  }

 private:
  void gather() {
    const Window w = window_at(field_, marker_, at_);
    pixels_.clear();
    for (int r = w.r0; r <= w.r1; ++r) {
      for (int c = w.c0; c <= w.c1; ++c) {
        const double x = c - at_.column, y = field_.row_of(r) - at_.row;
        if (!w.takes(x, y)) continue;
        Pixel p;
        p.column = c;
        p.row = r;
        p.grey = field_.image(c, r);
        pixels_.push_back(p);
      }
    }
  }

  /// The levels that fit best at the present centre and shape.
  bool start_levels() {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (const Pixel& p : pixels_) {
      const ShapeValue s = shape_at(marker_, p.column - at_.column, field_.row_of(p.row) - at_.row);
      const Eigen::Vector3d phi(1.0, s.value[0], levels_ > 2 ? s.value[1] : 0.0);
      normal += phi * phi.transpose();
      right += phi * p.grey;
    }
    if (levels_ < 3) normal(2, 2) = 1.0;
    const Eigen::LDLT<Eigen::Matrix3d> solver(normal);
    if (solver.info() != Eigen::Success || solver.rcond() < 1e-10) return false;
    const Eigen::Vector3d solution = solver.solve(right);
    for (int k = 0; k < 3; ++k) marker_.levels[k] = solution(k);
    return solution.allFinite();
  }

  void evaluate() {
    for (Pixel& p : pixels_) {
      p.x = p.column - at_.column;
      p.y = field_.row_of(p.row) - at_.row;
      const ShapeValue s = shape_at(marker_, p.x, p.y);
      p.model = marker_.levels[0];
      p.slope = Vector::Zero(unknowns_);
      p.slope(2) = 1.0;
      double by_edge = 0.0;
      for (int k = 0; k + 1 < levels_; ++k) {
        const std::size_t i = k;
        const double level = marker_.levels[i + 1];
        p.model += level * s.value[i];
        p.slope(0) -= level * s.by_x[i];
        p.slope(1) -= level * s.by_y[i];
        p.slope(3 + k) = s.value[i];
        if (shape_) p.slope(first_shape_ + k) = level * s.by_radius[i];
        by_edge += level * s.by_edge[i];
      }
      if (ground_) {
        const double outside = 1.0 - s.value[0];
        p.slope(2 + levels_) = outside * p.x;
        p.slope(3 + levels_) = outside * p.y;
        p.model += outside * (tilt_x_ * p.x + tilt_y_ * p.y);
      }
      if (shape_) p.slope(unknowns_ - 1) = by_edge;
      p.residual = p.grey - p.model;
    }
  }

  void weigh() {
    std::vector<double> sizes;
    sizes.reserve(pixels_.size());
    for (const Pixel& p : pixels_) sizes.push_back(std::abs(p.residual));
    const auto middle = sizes.begin() + sizes.size() / 2;
    std::nth_element(sizes.begin(), middle, sizes.end());
    const double limit = 2.0 * std::max(1.4826 * *middle, 1.0);
    for (Pixel& p : pixels_) p.weight = std::abs(p.residual) <= limit ? 1.0 : limit / std::abs(p.residual);
  }

  bool iterate(int pass) {
    const PixelPoint began = at_;
    for (int iteration = 0; iteration < 12; ++iteration) {
      evaluate();
      weigh();
      Matrix H = Matrix::Zero(unknowns_, unknowns_);
      Vector g = Vector::Zero(unknowns_);
      for (const Pixel& p : pixels_) {
        H.noalias() += p.weight * p.slope * p.slope.transpose();
        g.noalias() += p.weight * p.residual * p.slope;
      }
      for (int k = 0; k < unknowns_; ++k) H(k, k) *= shape_ ? 1.05 : 1.0 + 1e-9;
      const Eigen::LDLT<Matrix> solver(H);
      if (solver.info() != Eigen::Success) return false;
      Vector step = solver.solve(g);
      if (!step.allFinite()) return false;
      const double move = std::hypot(step(0), step(1)), longest = 0.15 * (marker_.reach_x() + marker_.reach_y());
      if (move > longest) step *= longest / move;
      apply(step);
      if (std::hypot(at_.column - began.column, at_.row - began.row) > 0.7 * (marker_.reach_x() + marker_.reach_y())) return false;
      if (move < (pass == 0 ? 0.05 : 0.003) && iteration > (shape_ ? 5 : 0)) break;
    }
    return true;
  }

  void apply(const Vector& step) {
    at_.column += step(0);
    at_.row += step(1);
    for (int k = 0; k < levels_; ++k) marker_.levels[k] += step(2 + k);
    if (ground_) {
      tilt_x_ += step(2 + levels_);
      tilt_y_ += step(3 + levels_);
    }
    if (!shape_) return;
    marker_.outer = std::clamp(marker_.outer + step(first_shape_), least_outer, most_outer);
    if (marker_.kind == MarkerKind::ring)
      marker_.inner = std::clamp(marker_.inner + step(first_shape_ + 1), 0.15 * marker_.outer, 0.9 * marker_.outer);
    marker_.edge = std::clamp(marker_.edge + step(unknowns_ - 1), min_edge, 0.8 * marker_.outer);
  }

  void finish(Location& out) {
    evaluate();
    weigh();
    out.at = at_;
    out.levels = marker_.levels;
    out.outer = marker_.outer;
    out.inner = marker_.inner;
    out.edge = marker_.edge;
    const double right = field_.image.width - 1.0 + 0.5, bottom = field_.frame_height() - 1.0 + 0.5;
    out.inside = at_.column - marker_.reach_x() > -0.5 && at_.column + marker_.reach_x() < right && at_.row - marker_.reach_y() > -0.5 &&
                 at_.row + marker_.reach_y() < bottom;
    quality(out);
    out.sigma = sigma_of();
    out.weakest_sector = weakest_sector(out.noise);
  }

  void quality(Location& out) const {
    double mean = 0.0, total = 0.0, left = 0.0;
    const auto n = static_cast<double>(pixels_.size());
    for (const Pixel& p : pixels_) mean += p.grey / n;
    for (const Pixel& p : pixels_) {
      total += (p.grey - mean) * (p.grey - mean);
      left += p.residual * p.residual;
    }
    out.noise = std::sqrt(left / (n - unknowns_));
    out.explained = total > 0.0 ? 1.0 - left / total : 0.0;
  }

  [[nodiscard]] double sigma_of() const {
    Matrix H = Matrix::Zero(unknowns_, unknowns_), M = H;
    for (const Pixel& p : pixels_) H.noalias() += p.weight * p.slope * p.slope.transpose();
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
      const Pixel& a = pixels_[i];
      const Vector score = a.weight * a.residual * a.slope;
      Vector others = 0.5 * score;
      for (std::size_t j = i + 1; j < pixels_.size() && pixels_[j].row <= a.row + alike_lines; ++j) {
        const Pixel& b = pixels_[j];
        const int apart = std::abs(b.column - a.column);
        if (apart > alike_columns) continue;
        const double weight = (1.0 - apart / (alike_columns + 1.0)) * (1.0 - (b.row - a.row) / (alike_lines + 1.0));
        others += (weight * b.weight * b.residual) * b.slope;
      }
      M.noalias() += score * others.transpose() + others * score.transpose();
    }
    const Eigen::LDLT<Matrix> solver(H);
    const auto n = static_cast<double>(pixels_.size());
    const Matrix covariance = solver.solve(solver.solve(M).transpose().eval()) * (n / (n - unknowns_));
    const double variance = 0.5 * (covariance(0, 0) + covariance(1, 1));
    const Matrix classical = solver.solve(Matrix::Identity(unknowns_, unknowns_));
    double left = 0.0;
    for (const Pixel& p : pixels_) left += p.weight * p.residual * p.residual;
    const double plain = 0.5 * (classical(0, 0) + classical(1, 1)) * left / (n - unknowns_);
    return std::sqrt(std::max(variance, plain) + min_sigma * min_sigma);
  }

  /// For each sector the least-squares factor of the model about its mean; a factor whose own uncertainty excuses it counts as so much
  /// better.
  [[nodiscard]] double weakest_sector(double noise) const {
    std::array<double, sectors> together{}, square{}, mean_grey{}, count{};
    std::array<double, sectors> mean_model{};
    const auto sector = [](const Pixel& p) {
      const double turn = std::atan2(p.y, p.x) / (2.0 * 3.14159265358979323846) + 0.5;
      return std::clamp(static_cast<int>(turn * sectors), 0, sectors - 1);
    };
    for (const Pixel& p : pixels_) {
      const std::size_t s = sector(p);
      count[s] += 1.0;
      mean_grey[s] += p.grey;
      mean_model[s] += p.model;
    }
    for (const Pixel& p : pixels_) {
      const std::size_t s = sector(p);
      const double g = p.grey - mean_grey[s] / count[s], m = p.model - mean_model[s] / count[s];
      together[s] += g * m;
      square[s] += m * m;
    }
    double weakest = 1.0;
    for (std::size_t s = 0; s < sectors; ++s) {
      if (!(square[s] > 0.0)) continue;
      const double factor = together[s] / square[s], sigma = noise / std::sqrt(square[s]);
      const double fault = std::max(0.0, std::abs(factor - 1.0) - 2.0 * std::min(sigma, 0.2));
      weakest = std::min(weakest, 1.0 - fault);
    }
    return weakest;
  }

  const Field& field_;
  Marker marker_;
  PixelPoint at_;
  bool shape_, ground_ = false;
  int levels_ = 2, first_shape_ = 4, unknowns_ = 4;
  double tilt_x_ = 0.0, tilt_y_ = 0.0;  ///< of the ground [grey levels per px]
  std::vector<Pixel> pixels_;
};

}  // namespace

Location locate(const Field& field, const Marker& marker, const PixelPoint& start, bool fit_shape) {
  return Fitter(field, marker, start, fit_shape).run();
}

}  // namespace misfit
