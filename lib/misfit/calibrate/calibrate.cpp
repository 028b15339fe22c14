#include "misfit/calibrate/calibrate.h"

#include <algorithm>
#include <cmath>

#include "misfit/calibrate/groups.h"
#include "misfit/calibrate/outliers.h"
#include "misfit/calibrate/selection.h"
#include "misfit/calibrate/sweep_points.h"
#include "misfit/core/error.h"
#include "misfit/core/text.h"

namespace misfit {
namespace {

struct Plan {
  SweepModel base;
  std::vector<CameraGroup> candidates;
  std::vector<std::string> notes;
};

void free_group(SweepModel& model, const CameraGroup& group) {
  model.free.insert(model.free.end(), group.parameters.begin(), group.parameters.end());
  std::sort(model.free.begin(), model.free.end());
  model.free.erase(std::unique(model.free.begin(), model.free.end()), model.free.end());
}

Plan make_plan(const CalibrateOptions& options, bool with_y) {
  Plan plan;
  plan.base.free = {camera_parameter("h_c"), camera_parameter("K")};
  plan.base.start.K = 1.0;
  for (const auto& [name, value] : options.fixed) camera_entry(plan.base.start, camera_parameter(name)) = value;
  for (const std::string& name : options.force) {
    const CameraGroup group = camera_group(name, with_y);
    if (group.parameters.empty()) throw RunError("the sweep gives no P_y, so " + name + " cannot be freed");
    free_group(plan.base, group);
  }
  for (const std::string& name : options.candidates) {
    const CameraGroup group = camera_group(name, with_y);
    if (std::count(options.force.begin(), options.force.end(), name) > 0) continue;
    if (group.parameters.size() < camera_group(name, true).parameters.size()) {
      plan.notes.push_back("the sweep gives no P_y: " +
                           (group.parameters.empty() ? name + " was not tested" : "of " + name + " only centre_z was tested"));
    }
    if (!group.parameters.empty()) plan.candidates.push_back(group);
  }
  return plan;
}

std::size_t coordinates(const std::vector<SweepPoint>& points) {
  std::size_t count = 0;
  for (const SweepPoint& p : points) count += (std::isfinite(p.P_y) ? 1 : 0) + (std::isfinite(p.P_z) ? 1 : 0);
  return count;
}

// The first judgement of which points to keep: with all candidates free where the data allow it, else under the base model.
std::vector<bool> first_keep(const std::vector<SweepPoint>& points, double l_b, const Plan& plan, double limit) {
  SweepModel largest = plan.base;
  for (const CameraGroup& group : plan.candidates) free_group(largest, group);
  const SweepModel& model = coordinates(points) >= 3 * largest.free.size() ? largest : plan.base;
  return points_within(points, l_b, robust_fit(points, l_b, model), limit);
}

std::string names_of(const std::vector<std::size_t>& parameters) {
  std::string text;
  for (const std::size_t p : parameters) text += (text.empty() ? "" : ", ") + std::string(camera_parameter_names[p]);
  return text;
}

void check_enough(std::size_t data, const std::vector<std::size_t>& free) {
  if (data > free.size()) return;
  throw RunError("the sweep has " + std::to_string(data) + " usable coordinates for " + std::to_string(free.size()) + " unknowns (" +
                 names_of(free) + "); a calibration needs more coordinates than unknowns");
}

// Selection and the points kept depend on one another: repeated until the points stay (they do after one or two rounds).
Selection select_and_clean(const std::vector<SweepPoint>& points, std::vector<bool>& keep, double l_b, Plan& plan,
                           const CalibrateOptions& options) {
  for (int round = 0;; ++round) {
    plan.base.start = start_camera(points, l_b, plan.base.start);
    Selection selection = select_parameters({{points, keep, l_b}, plan.base, plan.candidates, options.threshold});
    check_enough(selection.fit.data, selection.fit.free);
    std::vector<bool> next = points_within(points, l_b, selection.fit, options.outlier_limit);
    if (next == keep) return selection;
    if (round == 10) {
      plan.notes.emplace_back("outlier rejection did not converge in 10 rounds; that of the last round is used");
      return selection;
    }
    keep = std::move(next);
  }
}

void add_residuals(Calibration& calibration, const std::vector<SweepPoint>& points, const std::vector<bool>& keep, double l_b) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const SweepPoint& p = points[i];
    const auto predicted = predict(p, l_b, calibration.camera);
    if (std::isfinite(p.P_y))
      calibration.residuals.push_back(
          {.point = p.point, .coordinate = 'y', .theta = p.theta, .measured = p.P_y, .predicted = predicted[0], .used = keep[i]});
    if (std::isfinite(p.P_z))
      calibration.residuals.push_back(
          {.point = p.point, .coordinate = 'z', .theta = p.theta, .measured = p.P_z, .predicted = predicted[1], .used = keep[i]});
  }
}

void note_separability(Calibration& calibration) {
  const Eigen::MatrixXd& C = calibration.covariance;
  for (Eigen::Index i = 0; i < C.rows(); ++i) {
    for (Eigen::Index j = i + 1; j < C.rows(); ++j) {
      const double correlation = C(i, j) / std::sqrt(C(i, i) * C(j, j));
      if (std::abs(correlation) <= 0.98) continue;
      calibration.notes.push_back(calibration.names[i] + " and " + calibration.names[j] +
                                  " are nearly collinear in this sweep (correlation " + format_value(correlation) +
                                  "): only their combined effect is well determined");
    }
  }
}

void note_tests(Calibration& calibration) {
  for (const CameraTest& test : calibration.tests) {
    const bool seen = std::all_of(test.sigmas.begin(), test.sigmas.end(), [](double s) { return std::isfinite(s); });
    if (seen || test.selected) continue;
    calibration.notes.push_back("this sweep cannot distinguish " + test.name + " from the other free parameters");
  }
}

void note_outliers(Calibration& calibration, std::size_t points) {
  if (calibration.outliers == 0) return;
  calibration.notes.push_back(std::to_string(calibration.outliers) + " of " + std::to_string(points) +
                              (calibration.outliers == 1 ? " points was rejected as an outlier" : " points were rejected as outliers"));
  if (std::size_t{3} * calibration.outliers > points) {
    calibration.notes.emplace_back("that is more than a third: check that points, angles and geometry belong together");
  }
}

/// Points that do not follow the angles determine no scale.
void check_scale(const SweepFit& fit) {
  constexpr double min_sigmas = 3.0, min_scale = 0.1;  // px/m: the rig would be smaller than a pixel
  const std::size_t scale = camera_parameter("K");
  const double K = camera_entry(fit.camera, scale), sigma = fit.sigma(scale);
  if (std::isfinite(K) && std::isfinite(sigma) && std::isfinite(fit.rss) && K > std::max(min_scale, min_sigmas * sigma)) return;
  throw RunError("the points do not follow the angles: the scale K = " + format_value(K, sigma) +
                 " px/m does not differ significantly from zero; check that points, angles and geometry belong together");
}

Calibration calibrate_once(const Sweep& sweep, const RigGeometry& geometry, const CalibrateOptions& options) {
  const double l_b = geometry.l_b;
  const std::vector<SweepPoint> points = sweep_points(sweep, geometry);
  Plan plan = make_plan(options, has_y(points));
  check_enough(coordinates(points), plan.base.free);
  std::vector<bool> keep = first_keep(points, l_b, plan, options.outlier_limit);
  const Selection selection = select_and_clean(points, keep, l_b, plan, options);
  if (!selection.fit.determined) throw RunError("the sweep cannot distinguish these parameters: " + names_of(selection.fit.free));
  check_scale(selection.fit);

  Calibration calibration;
  calibration.model = options.model;
  calibration.camera = selection.fit.camera;
  for (const std::size_t p : selection.fit.free) calibration.names.emplace_back(camera_parameter_names[p]);
  calibration.covariance = selection.fit.covariance;
  calibration.sigma_px = selection.fit.sigma_px;
  calibration.rms_px = std::sqrt(selection.fit.rss / static_cast<double>(selection.fit.data));
  calibration.outliers = static_cast<int>(std::count(keep.begin(), keep.end(), false));
  calibration.message = selection.fit.message;
  calibration.converged = selection.fit.converged;
  calibration.tests = selection.tests;
  calibration.notes = plan.notes;
  add_residuals(calibration, points, keep, l_b);
  note_outliers(calibration, points.size());
  note_tests(calibration);
  note_separability(calibration);
  if (!selection.fit.inside) calibration.notes.emplace_back("a parameter ended at its physical bound: the calibration is not valid");
  return calibration;
}

/// Parameters that were no candidates but are significant in the sweep: in the tests, not in the camera.
void test_disabled_parameters(const Sweep& sweep, const RigGeometry& geometry, const CalibrateOptions& options, Calibration& calibration) {
  CalibrateOptions everything = options;
  everything.candidates = optional_camera_parameters();
  const auto enabled = [&](const std::string& name) {
    return std::count(options.candidates.begin(), options.candidates.end(), name) +
               std::count(options.force.begin(), options.force.end(), name) >
           0;
  };
  if (std::all_of(everything.candidates.begin(), everything.candidates.end(), enabled)) return;
  for (CameraTest test : calibrate_once(sweep, geometry, everything).tests) {
    if (!test.selected || enabled(test.name)) continue;
    test.selected = false;
    calibration.notes.push_back(test.name + " is significant in the sweep (drop " + format_value(test.drop) +
                                "), but this study does not estimate it: add it to [camera] free and calibrate again");
    calibration.tests.push_back(std::move(test));
  }
}

}  // namespace

Calibration calibrate(const Sweep& sweep, const RigGeometry& geometry, const CalibrateOptions& options) {
  try {
    Calibration calibration = calibrate_once(sweep, geometry, options);
    if (options.test_others) test_disabled_parameters(sweep, geometry, options, calibration);
    return calibration;
  } catch (const RunError& error) {
    if (sweep.source.empty()) throw;
    throw RunError(sweep.source + ": " + error.what());
  }
}

}  // namespace misfit
