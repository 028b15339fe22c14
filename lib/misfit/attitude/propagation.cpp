#include "misfit/attitude/propagation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "misfit/attitude/stencil.h"
#include "misfit/core/missing.h"
#include "misfit/core/text.h"
#include "misfit/math/statistics.h"

namespace misfit {
namespace {

constexpr std::size_t reach = 3;  // alpha at sample i is made of samples i − reach … i + reach
constexpr std::size_t window = 2 * reach + 1;

// A quantity linearised in (theta, psi) of the samples around i: entry k belongs to sample i − reach + k.
using Linear = std::array<Eigen::RowVector2d, window>;

Linear zero() {
  Linear linear;
  linear.fill(Eigen::RowVector2d::Zero());
  return linear;
}

struct Variance {
  double measurement = 0.0, camera = 0.0;
  [[nodiscard]] double sigma() const { return std::sqrt(measurement + camera); }
};

Variance variance(const UncertaintySources& from, std::size_t i, const Linear& linear) {
  Variance v;
  Eigen::RowVectorXd by_camera = Eigen::RowVectorXd::Zero(from.camera.rows());
  for (std::size_t k = 0; k < window; ++k) {
    if (linear[k].isZero(0.0)) continue;
    const AxisSample& sample = from.samples[i + k - reach];
    const double sigma = from.sigma_px[i + k - reach];
    v.measurement += sigma * sigma * (linear[k] * sample.by_pixel).squaredNorm();
    by_camera += linear[k] * sample.by_camera;
  }
  v.camera = by_camera.dot(by_camera * from.camera);
  return v;
}

struct MeanAngle {
  double angle, rate;
};

/// ∂alpha/∂theta of each sample: average times (1 − lag sin·rate), rate times lag cos. The same for beta and psi.
std::array<double, window> wind_angle_weights(const std::vector<double>& t, std::size_t i, const MeanAngle& mean, double lag) {
  std::array<double, window> weights{};
  const std::array<double, 5> derivative = derivative_weights(t, i);
  for (std::size_t k = 0; k < 3; ++k) {
    weights[reach - 1 + k] += (1.0 - lag * std::sin(mean.angle) * mean.rate) / 3.0;
    for (std::size_t d = 0; d < 5; ++d) weights[d + k] += lag * std::cos(mean.angle) * derivative[d] / 3.0;
  }
  return weights;
}

Variance total_angle_variance(const Attitude& a, const UncertaintySources& from, std::size_t i, double lag) {
  const auto by_theta = wind_angle_weights(a.t, i, {a.theta_mean[i], a.theta_rate[i]}, lag);
  const auto by_psi = wind_angle_weights(a.t, i, {a.psi_mean[i], a.psi_rate[i]}, lag);
  Linear alpha = zero(), beta = zero(), total = zero();
  const double sine = std::sin(a.alpha_T[i]);
  const double along_alpha = sine > 0.0 ? std::sin(a.alpha[i]) * std::cos(a.beta[i]) / sine : 0.0;
  const double along_beta = sine > 0.0 ? std::cos(a.alpha[i]) * std::sin(a.beta[i]) / sine : 0.0;
  for (std::size_t k = 0; k < window; ++k) {
    alpha[k] << by_theta[k], 0.0;
    beta[k] << 0.0, by_psi[k];
    total[k] = along_alpha * alpha[k] + along_beta * beta[k];
  }
  if (sine > 0.0) return variance(from, i, total);
  const Variance one = variance(from, i, alpha);
  const Variance other = variance(from, i, beta);
  return {(one.measurement + other.measurement) / 2.0, (one.camera + other.camera) / 2.0};
}

// phi = atan2(tan psi, tan theta) of the averages.
double clock_angle_sigma(const Attitude& a, const UncertaintySources& from, std::size_t i) {
  const double nothing_known = std::numbers::pi / std::sqrt(3.0);
  const double y = std::tan(a.psi_mean[i]);
  const double z = std::tan(a.theta_mean[i]);
  const double square = y * y + z * z;
  if (square == 0.0) return nothing_known;
  Linear phi = zero();
  for (std::size_t k = reach - 1; k <= reach + 1; ++k) phi[k] << -y * (1.0 + z * z) / (3.0 * square), z * (1.0 + y * y) / (3.0 * square);
  const double sigma = variance(from, i, phi).sigma();
  return sigma > nothing_known ? nothing_known : sigma;
}

}  // namespace

std::string add_sigmas(Attitude& a, const UncertaintySources& from, double lag) {
  constexpr double deg = std::numbers::pi / 180.0;
  for (auto* column : {&a.sigma_theta, &a.sigma_psi, &a.sigma_alpha_T, &a.sigma_phi}) column->assign(a.t.size(), kMissing);
  std::vector<double> measurement, camera;
  for (std::size_t i = 0; i < a.t.size(); ++i) {
    if (!from.samples[i].ok) continue;
    Linear theta = zero(), psi = zero();
    theta[reach] << 1.0, 0.0;
    psi[reach] << 0.0, 1.0;
    a.sigma_theta[i] = variance(from, i, theta).sigma();
    a.sigma_psi[i] = variance(from, i, psi).sigma();
    if (std::isfinite(a.phi[i])) a.sigma_phi[i] = clock_angle_sigma(a, from, i);
    if (!std::isfinite(a.alpha_T[i])) continue;
    const Variance total = total_angle_variance(a, from, i, lag);
    a.sigma_alpha_T[i] = total.sigma();
    measurement.push_back(std::sqrt(total.measurement));
    camera.push_back(std::sqrt(total.camera));
  }
  return "sigma of alpha_T (median): " + format_value(median(measurement) / deg) + " deg from measurement noise, " +
         format_value(median(camera) / deg) + " deg from the calibration";
}

}  // namespace misfit
