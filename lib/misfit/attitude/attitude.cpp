#include "misfit/attitude/attitude.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "misfit/attitude/angles.h"
#include "misfit/attitude/axis_sample.h"
#include "misfit/attitude/propagation.h"
#include "misfit/attitude/stencil.h"
#include "misfit/core/error.h"
#include "misfit/core/missing.h"
#include "misfit/core/text.h"

namespace misfit {
namespace {

void check_geometry(const RigGeometry& g) {
  for (const auto& [name, value] : {std::pair{"R", g.R}, std::pair{"V", g.V}, std::pair{"l_b", g.l_b}}) {
    if (!(value > 0.0)) throw InputError(std::string("geometry: ") + name + " is " + format_value(value) + ", it must be positive");
  }
  if (g.l_s > g.R) return;
  throw InputError("geometry: the camera must stand beyond the apex: l_s is " + format_value(g.l_s) + " m, R is " + format_value(g.R) +
                   " m");
}

std::string count_of(std::size_t count, std::size_t of, const std::string& is, const std::string& are) {
  return std::to_string(count) + " of " + std::to_string(of) + " samples " + (count == 1 ? is : are);
}

// What was lost on the way from pixels to angles.
void note_losses(Attitude& a, const AxisSamples& axes, const std::vector<bool>& even) {
  const std::size_t n = a.t.size();
  if (axes.lost > 0) a.notes.push_back(count_of(axes.lost, n, "is lost in the track", "are lost in the track"));
  if (axes.unexplained > 0)
    a.notes.push_back(
        count_of(axes.unexplained, n, "is lost because no angle explains its pixels", "are lost because no angle explains their pixels"));
  const auto gaps = std::count(even.begin(), even.end(), false);
  if (gaps > 0)
    a.notes.push_back(counted(static_cast<std::size_t>(gaps), "step differs from the usual one and counts as a gap",
                              "steps differ from the usual one and count as gaps"));
  const std::size_t without = std::count_if(a.alpha_T.begin(), a.alpha_T.end(), [](double v) { return std::isnan(v); });
  a.notes.push_back(count_of(without, n, "has no alpha_T, which is computed from seven successive samples",
                             "have no alpha_T, which is computed from seven successive samples"));
}

// Measurement noise per sample: the track's where it knows it, else the estimate.
std::vector<double> noise_per_sample(const Track& track, const std::vector<bool>& even, std::vector<std::string>& notes) {
  std::vector<double> sigma = track.sigma;
  sigma.resize(track.t.size(), kMissing);
  if (std::all_of(sigma.begin(), sigma.end(), [](double s) { return std::isfinite(s); })) return sigma;
  const std::size_t unknown = std::count_if(sigma.begin(), sigma.end(), [](double s) { return !std::isfinite(s); });
  const auto estimate = pixel_noise(track, even);
  notes.push_back(count_of(unknown, sigma.size(), "has no sigma in the track: ", "have no sigma in the track: ") +
                  (estimate ? "measurement noise there is " + format_value(*estimate) + " px, estimated from sixth differences"
                            : "too few samples in a row to estimate it, so sigmas are missing there"));
  for (double& s : sigma) {
    if (!std::isfinite(s)) s = estimate.value_or(kMissing);
  }
  return sigma;
}

Attitude from_axis_samples(const Track& track, const AxisSamples& axes, const std::vector<bool>& even, double lag) {
  const std::size_t n = track.t.size();
  Attitude a;
  a.t = track.t;
  for (auto* column : {&a.theta, &a.psi, &a.alpha, &a.beta, &a.alpha_T, &a.phi, &a.eta}) column->assign(n, kMissing);
  for (std::size_t i = 0; i < n; ++i) {
    const AxisSample& sample = axes.samples[i];
    if (!sample.ok) continue;
    a.theta[i] = sample.theta;
    a.psi[i] = sample.psi;
    a.eta[i] = std::atan(std::hypot(std::tan(sample.theta), std::tan(sample.psi)));  // atan2(sqrt(n_y² + n_z²), n_x)
  }
  a.theta_mean = three_point_average(a.theta, even);
  a.psi_mean = three_point_average(a.psi, even);
  a.theta_rate = five_point_derivative(a.theta_mean, a.t, even);
  a.psi_rate = five_point_derivative(a.psi_mean, a.t, even);
  for (std::size_t i = 0; i < n; ++i) {
    a.alpha[i] = wind_angle(a.theta_mean[i], a.theta_rate[i], lag);
    a.beta[i] = wind_angle(a.psi_mean[i], a.psi_rate[i], lag);
    a.alpha_T[i] = total_angle(a.alpha[i], a.beta[i]);
    a.phi[i] = clock_angle(a.theta_mean[i], a.psi_mean[i]);
  }
  return a;
}

Attitude without_sigmas(Attitude a) {
  for (auto* column : {&a.sigma_theta, &a.sigma_psi, &a.sigma_alpha_T, &a.sigma_phi}) column->assign(a.t.size(), kMissing);
  return a;
}

}  // namespace

Attitude attitude(const Track& track, const Calibration& calibration, const RigGeometry& geometry, const AttitudeOptions& options) {
  check_geometry(geometry);
  const double lag = geometry.R_cp / geometry.V;
  const std::vector<bool> even = even_steps(track.t, options.even);
  const AxisSamples axes = read_axes(track, calibration, geometry, options.sigmas);
  if (axes.lost + axes.unexplained == track.t.size()) {
    throw RunError("no sample of the track can be read as an angle: " +
                   count_of(axes.lost, track.t.size(), "is lost, of the other ", "are lost, of the other ") +
                   std::to_string(axes.unexplained) + " no angle explains the pixels (camera and geometry do not belong to this track?)");
  }
  Attitude result = from_axis_samples(track, axes, even, lag);
  note_losses(result, axes, even);
  if (!options.sigmas) return without_sigmas(std::move(result));
  const std::vector<double> sigma = noise_per_sample(track, even, result.notes);
  result.notes.push_back(add_sigmas(result, {axes.samples, sigma, calibration.covariance}, lag));
  return result;
}

}  // namespace misfit
