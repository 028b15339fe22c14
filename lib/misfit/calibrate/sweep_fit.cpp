#include "misfit/calibrate/sweep_fit.h"

#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

#include "misfit/core/lists.h"
#include "misfit/math/decompositions.h"
#include "misfit/math/scalar.h"

namespace misfit {
namespace {

constexpr int parameters = int_size(camera_parameter_names);
using CameraJet = Jet<parameters>;
using Row = Eigen::Matrix<double, 1, parameters>;

// Wide physical bounds in the order of camera_parameter_names; an estimate that ends at one is not believed.
struct Bounds {
  double lower, upper;
};
constexpr std::array<Bounds, parameters> bounds = {{
    {-5.0, 5.0},      // h_c [m]
    {1e-3, 1e6},      // K [px/m]
    {-0.35, 0.35},    // camera_roll [rad]: 20 deg
    {-300.0, 300.0},  // centre_y [px]
    {-300.0, 300.0},  // centre_z [px]
    {-0.3, 0.3},      // pixel_aspect [-]
    {-1.0, 1.0},      // lens_k1 [-]
    {-1.0, 1.0},      // camera_distance [m]
}};

// Residuals of one point, 0 to 2 of them, and their rows of derivatives to all camera parameters.
struct PointResiduals {
  int count = 0;
  std::array<double, 2> r{};
  std::array<Row, 2> rows;
};

PointResiduals point_residuals(const SweepPoint& point, double l_b, const CameraParameters<double>& camera) {
  CameraParameters<CameraJet> jets;
  const auto to = camera_entries(jets);
  const auto values = camera_values(camera);
  for (int i = 0; i < parameters; ++i) *to[i] = CameraJet(values[i], i);
  const auto p = project_point<CameraJet>(jets, l_b, {CameraJet(point.x), CameraJet(0.0), CameraJet(point.z)});
  const std::array<double, 2> measured = {point.P_y, point.P_z};
  PointResiduals out;
  for (std::size_t i = 0; i < 2; ++i) {
    if (!std::isfinite(measured[i])) continue;
    out.r[out.count] = p[i].a - measured[i];
    out.rows[out.count] = p[i].v.transpose();
    ++out.count;
  }
  return out;
}

int coordinates(const SweepPoint& p) { return (std::isfinite(p.P_y) ? 1 : 0) + (std::isfinite(p.P_z) ? 1 : 0); }

CameraParameters<double> with_free(CameraParameters<double> camera, const std::vector<std::size_t>& free, const double* values) {
  for (std::size_t j = 0; j < free.size(); ++j) camera_entry(camera, free[j]) = values[j];
  return camera;
}

LeastSquares::Evaluate point_cost(const SweepPoint& point, double l_b, const SweepModel& model) {
  return [&point, l_b, &model](const double* const* blocks, double* r, double** J) {
    const PointResiduals at = point_residuals(point, l_b, with_free(model.start, model.free, blocks[0]));
    std::copy_n(at.r.begin(), at.count, r);
    if (J == nullptr || J[0] == nullptr) return true;
    for (int i = 0; i < at.count; ++i) {
      for (std::size_t j = 0; j < model.free.size(); ++j) J[0][i * model.free.size() + j] = at.rows[i][model.free[j]];
    }
    return true;
  };
}

// Covariance and rank from the Jacobian at the solution. Columns are brought to length 1 first, since px, m and rad have no common size.
void add_covariance(SweepFit& fit, const Eigen::MatrixXd& J) {
  constexpr double min_singular_value = 1e-7;
  const Eigen::VectorXd length = J.colwise().norm();
  if (J.rows() <= J.cols() || !(length.minCoeff() > 1e-12 * length.maxCoeff())) return;
  const Eigen::MatrixXd scaled = J * length.cwiseInverse().asDiagonal();
  const RightSingular svd = right_singular(scaled);
  if (!(svd.values.minCoeff() > min_singular_value)) return;
  const Eigen::MatrixXd half = length.cwiseInverse().asDiagonal() * svd.vectors * svd.values.cwiseInverse().asDiagonal();
  fit.covariance = fit.sigma_px * fit.sigma_px * half * half.transpose();
  fit.determined = true;
}

void add_statistics(SweepFit& fit, const SweepData& data) {
  const auto& [points, keep, l_b] = data;
  Eigen::MatrixXd J(2 * points.size(), fit.free.size());
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!keep[i]) continue;
    const PointResiduals at = point_residuals(points[i], l_b, fit.camera);
    for (int k = 0; k < at.count; ++k, ++row) {
      fit.rss += at.r[k] * at.r[k];
      for (std::size_t j = 0; j < fit.free.size(); ++j) J(row, j) = at.rows[k][fit.free[j]];
    }
  }
  fit.data = row;
  if (fit.data <= fit.free.size()) return;
  fit.sigma_px = std::sqrt(fit.rss / static_cast<double>(fit.data - fit.free.size()));
  add_covariance(fit, J.topRows(row));
}

bool inside_bounds(const SweepFit& fit) {
  return std::all_of(fit.free.begin(), fit.free.end(), [&](std::size_t p) {
    const double margin = 1e-6 * (bounds[p].upper - bounds[p].lower);
    const double value = camera_entry(fit.camera, p);
    return value > bounds[p].lower && value < bounds[p].upper &&
           (p == 1 || std::min(value - bounds[p].lower, bounds[p].upper - value) > margin);
  });
}

}  // namespace

double SweepFit::sigma(std::size_t parameter) const {
  const auto found = std::find(free.begin(), free.end(), parameter);
  if (found == free.end()) return 0.0;
  if (!determined) return std::numeric_limits<double>::quiet_NaN();
  const Eigen::Index j = found - free.begin();
  return std::sqrt(covariance(j, j));
}

double& camera_entry(CameraParameters<double>& camera, std::size_t parameter) { return *camera_entries(camera)[parameter]; }

double camera_entry(const CameraParameters<double>& camera, std::size_t parameter) { return camera_values(camera)[parameter]; }

std::array<double, 2> predict(const SweepPoint& point, double l_b, const CameraParameters<double>& camera) {
  return project_point<double>(camera, l_b, {point.x, 0.0, point.z});
}

CameraParameters<double> start_camera(const std::vector<SweepPoint>& points, double l_b, CameraParameters<double> start) {
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (const SweepPoint& p : points) {
    if (!std::isfinite(p.P_z)) continue;
    const Eigen::Vector2d row(p.z, 1.0);
    normal += row * row.transpose();
    right += row * ((p.P_z - start.centre_z) * (l_b + start.camera_distance - p.x) / l_b);
  }
  const Eigen::Vector2d solution = normal.fullPivLu().solve(right);  // K, K h_c
  if (!(solution[0] > bounds[1].lower)) return start;
  start.K = solution[0];
  start.h_c = std::clamp(solution[1] / solution[0], 0.9 * bounds[0].lower, 0.9 * bounds[0].upper);
  return start;
}

SweepFit fit_sweep(const SweepData& data, const SweepModel& model, const LeastSquares::Robust& loss) {
  const auto& [points, keep, l_b] = data;
  std::vector<double> values, lower, upper;
  for (const std::size_t parameter : model.free) {
    values.push_back(camera_entry(model.start, parameter));
    lower.push_back(bounds[parameter].lower);
    upper.push_back(bounds[parameter].upper);
  }
  LeastSquares problem;
  const int block = problem.add_block(values, lower, upper);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!keep[i]) continue;
    problem.add_residuals({block}, coordinates(points[i]), point_cost(points[i], l_b, model), loss);
  }
  LeastSquares::Options options;
  options.max_iterations = 200;
  options.function_tolerance = 1e-14;
  const auto summary = problem.solve(options);
  SweepFit fit;
  fit.free = model.free;
  fit.camera = with_free(model.start, model.free, problem.block(block).data());
  fit.converged = summary.converged;
  fit.message = summary.message;
  add_statistics(fit, data);
  fit.inside = inside_bounds(fit);
  return fit;
}

}  // namespace misfit
