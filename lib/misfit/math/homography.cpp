#include "misfit/math/homography.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "misfit/math/decompositions.h"
#include "misfit/math/least_squares.h"
#include "misfit/math/statistics.h"

namespace misfit {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int shape = 8;                     // of H, in normalised coordinates with H(2, 2) = 1
constexpr std::size_t points_for_lens = 12;  // 24 numbers for nine unknowns

/// Centre to 0 and the mean distance from it to √2.
struct Normalisation {
  Vector2d centre{0.0, 0.0};
  double scale = 1.0;

  [[nodiscard]] Vector2d operator()(const Vector2d& p) const { return scale * (p - centre); }
  [[nodiscard]] Matrix3d matrix() const {
    Matrix3d m;
    m << scale, 0.0, -scale * centre.x(), 0.0, scale, -scale * centre.y(), 0.0, 0.0, 1.0;
    return m;
  }
};

Normalisation normalisation_of(const std::vector<PlanePoint>& points, Vector2d PlanePoint::*which) {
  Normalisation out;
  for (const PlanePoint& p : points) out.centre += p.*which / static_cast<double>(points.size());
  double distance = 0.0;
  for (const PlanePoint& p : points) distance += (p.*which - out.centre).norm() / static_cast<double>(points.size());
  out.scale = distance > 0.0 ? std::sqrt(2.0) / distance : 1.0;
  return out;
}

/// Smallest extent of the points over their largest.
double flatness(const std::vector<Vector2d>& points) {
  Vector2d centre{0.0, 0.0};
  for (const Vector2d& p : points) centre += p / static_cast<double>(points.size());
  Matrix2d spread = Matrix2d::Zero();
  for (const Vector2d& p : points) spread += (p - centre) * (p - centre).transpose();
  const Vector2d squares = symmetric_eigen(spread).values;
  return squares(1) > 0.0 ? std::sqrt(std::max(squares(0), 0.0) / squares(1)) : 0.0;
}

bool on_one_line(const std::vector<PlanePoint>& points, Vector2d PlanePoint::*which) {
  constexpr double least = 0.01;
  constexpr std::size_t few = 50;
  std::vector<Vector2d> all;
  for (const PlanePoint& p : points) all.push_back(p.*which);
  if (flatness(all) < least) return true;
  if (points.size() > few) return false;
  for (std::size_t without = 0; without < all.size(); ++without) {
    std::vector<Vector2d> rest = all;
    rest.erase(rest.begin() + without);
    if (flatness(rest) < least) return true;
  }
  return false;
}

/// What is estimated, in coordinates in which it is well conditioned.
struct Task {
  const std::vector<PlanePoint>& points;
  Normalisation place, pixel;
  Vector2d middle;
  double radius;
};

/// The linear solution; H(2, 2) = 1.
std::optional<Matrix3d> linear(const Task& task) {
  const auto n = std::ssize(task.points);
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(2 * n, 9);
  for (Eigen::Index i = 0; i < n; ++i) {
    const PlanePoint& p = task.points[i];
    const Vector3d u = task.place(p.place).homogeneous();
    const Vector2d q = task.pixel(p.pixel);
    rows.row(2 * i).head<3>() = u;
    rows.row(2 * i).tail<3>() = -q.x() * u;
    rows.row(2 * i + 1).segment<3>(3) = u;
    rows.row(2 * i + 1).tail<3>() = -q.y() * u;
  }
  const Eigen::VectorXd h = right_singular(rows).vectors.col(8);
  if (std::abs(h(8)) < 1e-9) return std::nullopt;
  Matrix3d out;
  out << h(0), h(1), h(2), h(3), h(4), h(5), h(6), h(7), h(8);
  return Matrix3d(out / h(8));
}

/// Where the model has a point, and the derivative by the eight of H and k1.
struct Projected {
  Vector2d pixel;
  Eigen::Matrix<double, 2, 9> slope;
};

std::optional<Projected> projected(const Task& task, const double* h, double k1, const Vector2d& place) {
  const Vector2d u = task.place(place);
  const double w = h[6] * u.x() + h[7] * u.y() + 1.0;
  if (!(w > 1e-9)) return std::nullopt;
  const Vector2d q{(h[0] * u.x() + h[1] * u.y() + h[2]) / w, (h[3] * u.x() + h[4] * u.y() + h[5]) / w};
  Eigen::Matrix<double, 2, shape> by_h;
  by_h.row(0) << u.x(), u.y(), 1.0, 0.0, 0.0, 0.0, -q.x() * u.x(), -q.x() * u.y();
  by_h.row(1) << 0.0, 0.0, 0.0, u.x(), u.y(), 1.0, -q.y() * u.x(), -q.y() * u.y();
  by_h /= w * task.pixel.scale;
  const Vector2d d = (q / task.pixel.scale + task.pixel.centre - task.middle) / task.radius;
  const double square = d.squaredNorm();
  Projected out;
  out.pixel = task.middle + task.radius * (1.0 + k1 * square) * d;
  out.slope.leftCols<shape>() = ((1.0 + k1 * square) * Matrix2d::Identity() + 2.0 * k1 * d * d.transpose()) * by_h;
  out.slope.col(shape) = task.radius * square * d;
  return out;
}

struct Solution {
  std::vector<double> h;  ///< eight
  double k1 = 0.0, rss = 0.0;
};

std::optional<Solution> refined(const Task& task, const Solution& start, bool lens) {
  LeastSquares problem;
  const int h = problem.add_block(start.h), k = problem.add_block({start.k1}, {-1.0}, {1.0});
  if (!lens) problem.fix_block(k);
  for (const PlanePoint& p : task.points) {
    problem.add_residuals({h, k}, 2, [&task, &p](const double* const* blocks, double* r, double** J) {
      const auto found = projected(task, blocks[0], blocks[1][0], p.place);
      if (!found) return false;
      for (int i = 0; i < 2; ++i) {
        r[i] = found->pixel(i) - p.pixel(i);
        if (J != nullptr && J[0] != nullptr)
          for (int j = 0; j < shape; ++j) J[0][shape * i + j] = found->slope(i, j);
        if (J != nullptr && J[1] != nullptr) J[1][i] = found->slope(i, shape);
      }
      return true;
    });
  }
  LeastSquares::Options options;
  options.max_iterations = 100;
  options.function_tolerance = 1e-12;
  const auto summary = problem.solve(options);
  if (!summary.usable) return std::nullopt;
  return Solution{problem.block(h), problem.block(k).front(), 2.0 * summary.cost};
}

bool explains_better(const Solution& with, const Solution& without, std::size_t points) {
  constexpr double threshold = 1e-3, rounding = 1e-6;  // [px]
  const double numbers = 2.0 * static_cast<double>(points), left = numbers - shape - 1.0;
  if (without.rss < numbers * rounding * rounding) return false;
  const double tiny = 1e-12 * without.rss;
  return f_tail((without.rss - with.rss) / (std::max(with.rss, tiny) / left), 1.0, left) < threshold;
}

PlaneMap map_of(const Task& task, const Solution& s) {
  Matrix3d h;
  h << s.h[0], s.h[1], s.h[2], s.h[3], s.h[4], s.h[5], s.h[6], s.h[7], 1.0;
  return {task.pixel.matrix().inverse() * h * task.place.matrix(), s.k1, task.middle, task.radius};
}

/// Of the eight of H and of k1 where it is free, by the degrees of freedom that are left.
Eigen::MatrixXd covariance_of(const Task& task, const Solution& s, Eigen::Index unknowns, double sigma) {
  const auto n = std::ssize(task.points);
  Eigen::MatrixXd rows(2 * n, unknowns);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto found = projected(task, s.h.data(), s.k1, task.points[i].place);
    rows.middleRows(2 * i, 2) = found->slope.leftCols(unknowns);
  }
  return sigma * sigma * symmetric_inverse(rows.transpose() * rows);
}

PlaneFit fit_of(const Task& task, const Solution& s, bool lens, double pixel_sigma) {
  PlaneFit fit{map_of(task, s), {}, 0.0, 0.0, {}};
  for (const PlanePoint& p : task.points) fit.distances.push_back((projected(task, s.h.data(), s.k1, p.place)->pixel - p.pixel).norm());
  const auto n = std::ssize(task.points);
  const Eigen::Index unknowns = shape + (lens ? 1 : 0), left = 2 * n - unknowns;
  fit.rms = std::sqrt(s.rss / static_cast<double>(n));
  fit.sigma = left > 0 ? std::sqrt(s.rss / static_cast<double>(left)) : pixel_sigma;
  fit.sigma_at = [=, map = fit.map, covariance = covariance_of(task, s, unknowns, fit.sigma), place = task.place, pixel = task.pixel,
                  middle = task.middle, radius = task.radius](const Vector2d& at) {
    const std::vector<PlanePoint> none;
    const auto found = projected({none, place, pixel, middle, radius}, s.h.data(), s.k1, at);
    if (!found) return 0.0;
    const Eigen::MatrixXd by_unknowns = map.slope(at).inverse() * found->slope.leftCols(unknowns);
    return std::sqrt(std::max(0.5 * (by_unknowns * covariance * by_unknowns.transpose()).trace(), 0.0));
  };
  return fit;
}

}  // namespace

std::optional<Vector2d> PlaneMap::pixel(const Vector2d& place) const {
  const Vector3d q = homography * place.homogeneous();
  if (!(q.z() > 0.0)) return std::nullopt;
  const Vector2d d = q.hnormalized() - middle;
  return Vector2d(middle + d * (1.0 + k1 * d.squaredNorm() / (radius * radius)));
}

std::optional<Vector2d> PlaneMap::place(const Vector2d& pixel) const {
  const Vector2d d = (pixel - middle) / radius;
  const double seen = d.norm();
  double r = seen;
  for (int k = 0; k < 50 && seen > 0.0; ++k) {
    const double slope_of_r = 1.0 + 3.0 * k1 * r * r;
    if (!(slope_of_r > 0.05)) return std::nullopt;
    const double step = (r * (1.0 + k1 * r * r) - seen) / slope_of_r;
    r -= step;
    if (std::abs(step) < 1e-14) break;
  }
  const Vector2d q = middle + (seen > 0.0 ? radius * r / seen : 0.0) * d;
  const Vector3d u = homography.inverse() * q.homogeneous();
  if (std::abs(u.z()) < 1e-300) return std::nullopt;
  const Vector2d out = u.hnormalized();
  if (!((homography * out.homogeneous()).z() > 0.0)) return std::nullopt;
  return out;
}

Matrix2d PlaneMap::slope(const Vector2d& place) const {
  const Vector3d q = homography * place.homogeneous();
  const Vector2d at = q.hnormalized();
  const Matrix2d by_place = (homography.topLeftCorner<2, 2>() - at * homography.block<1, 2>(2, 0)) / q.z();
  const Vector2d d = (at - middle) / radius;
  return ((1.0 + k1 * d.squaredNorm()) * Matrix2d::Identity() + 2.0 * k1 * d * d.transpose()) * by_place;
}

Vector2d PlaneMap::sigmas_at(const Vector2d& place, double sigma) const { return sigma * slope(place).inverse().rowwise().norm(); }

Matrix3d homography_of_square(const std::array<Vector2d, 4>& corners) {
  const std::array<Vector2d, 4> square{Vector2d(0, 0), Vector2d(1, 0), Vector2d(1, 1), Vector2d(0, 1)};
  Eigen::Matrix<double, 8, 8> rows = Eigen::Matrix<double, 8, 8>::Zero();
  Eigen::Matrix<double, 8, 1> right;
  for (Eigen::Index k = 0; k < 4; ++k) {
    const Vector3d u = square[k].homogeneous();
    for (Eigen::Index i = 0; i < 2; ++i) {
      const double q = corners[k](i);
      rows.row(2 * k + i).segment<3>(3 * i) = u;
      rows.row(2 * k + i).tail<2>() = -q * u.head<2>();
      right(2 * k + i) = q;
    }
  }
  const Eigen::Matrix<double, 8, 1> h = rows.partialPivLu().solve(right);
  Matrix3d out;
  out << h(0), h(1), h(2), h(3), h(4), h(5), h(6), h(7), 1.0;
  return out;
}

bool on_one_line(const std::vector<PlanePoint>& points) {
  return on_one_line(points, &PlanePoint::place) || on_one_line(points, &PlanePoint::pixel);
}

std::optional<PlaneFit> fit_plane(const std::vector<PlanePoint>& points, const PictureSize& picture, std::string& why, double pixel_sigma) {
  constexpr std::size_t least = 4;
  if (points.size() < least) {
    why = "four points at least are needed";
    return std::nullopt;
  }
  if (on_one_line(points)) {
    why = "all of the points, or all but one, lie on one line, and no map of a plane is known by these";
    return std::nullopt;
  }
  const Task task{points, normalisation_of(points, &PlanePoint::place), normalisation_of(points, &PlanePoint::pixel),
                  Vector2d(0.5 * (picture.width - 1.0), 0.5 * (picture.height - 1.0)), 0.5 * std::hypot(picture.width, picture.height)};
  why = "no camera sees these places so: two of them are exchanged, or one is far off";
  const auto first = linear(task);
  if (!first) return std::nullopt;
  Solution start;
  for (int i = 0; i < shape; ++i) start.h.push_back((*first)(i / 3, i % 3));
  for (const PlanePoint& p : points)
    if (!projected(task, start.h.data(), 0.0, p.place)) return std::nullopt;
  auto best = refined(task, start, false);
  if (!best) return std::nullopt;
  bool lens = false;
  if (points.size() >= points_for_lens) {
    const auto with = refined(task, *best, true);
    lens = with && explains_better(*with, *best, points.size());
    if (lens) best = with;
  }
  why.clear();
  return fit_of(task, *best, lens, pixel_sigma);
}

}  // namespace misfit
