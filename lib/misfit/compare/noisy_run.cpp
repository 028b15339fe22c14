#include "misfit/compare/noisy_run.h"

#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>

#include "misfit/sim/random_run.h"

namespace misfit {
namespace {

/// (j, j'/ω), exactly sampled: with the stationary covariance σ² I the noise of a step is σ² (I − φ φᵀ).
class ColouredNoise {
 public:
  ColouredNoise(const MeasurementNoise& noise, std::mt19937_64& random)
      : noise_(noise), state_{noise.coloured * normal_(random), noise.coloured * normal_(random)} {}

  [[nodiscard]] double value() const { return state_[0]; }

  void step(double h, std::mt19937_64& random) {
    if (!(noise_.coloured > 0.0)) return;
    if (h != h_) discretise(h);
    const double u = normal_(random), v = normal_(random);
    const std::array<double, 2> next{phi_[0] * state_[0] + phi_[1] * state_[1] + noise_.coloured * root_[0] * u,
                                     phi_[2] * state_[0] + phi_[3] * state_[1] + noise_.coloured * (root_[1] * u + root_[2] * v)};
    state_ = next;
  }

 private:
  /// φ = e^(−ζωh) (cosh(μh) I + sinh(μh)/μ (A + ζω I)), A = ω [0 1; −1 −2ζ], μ = ω sqrt(ζ² − 1), which may be imaginary.
  void discretise(double h) {
    h_ = h;
    const double omega = 2.0 * std::numbers::pi * noise_.coloured_frequency, zeta = noise_.coloured_damping;
    const std::complex<double> mu = omega * std::sqrt(std::complex<double>(zeta * zeta - 1.0, 0.0));
    const double even = std::real(std::exp(-zeta * omega * h) * std::cosh(mu * h));
    const double odd =
        std::abs(mu * h) < 1e-6 ? h * std::exp(-zeta * omega * h) : std::real(std::exp(-zeta * omega * h) * std::sinh(mu * h) / mu);
    phi_ = {even + odd * zeta * omega, odd * omega, -odd * omega, even - odd * zeta * omega};
    const double q00 = 1.0 - phi_[0] * phi_[0] - phi_[1] * phi_[1], q11 = 1.0 - phi_[2] * phi_[2] - phi_[3] * phi_[3];
    const double q01 = -phi_[0] * phi_[2] - phi_[1] * phi_[3];
    const double a = std::sqrt(std::max(q00, 0.0)), b = a > 0.0 ? q01 / a : 0.0;
    root_ = {a, b, std::sqrt(std::max(q11 - b * b, 0.0))};
  }

  MeasurementNoise noise_;
  std::normal_distribution<double> normal_;
  std::array<double, 2> state_;
  double h_ = -1.0;
  std::array<double, 4> phi_{};
  std::array<double, 3> root_{};  ///< lower Cholesky factor of the step's noise over σ²
};

double as_rounded(const MeasurementNoise& noise, double value) {
  return noise.step > 0.0 ? noise.level + noise.step * std::round((value - noise.level) / noise.step) : value;
}

}  // namespace

std::optional<Signals> noisy_run(const StochasticModel& model, const Signals& like, const std::vector<double>& x0, std::uint64_t seed) {
  std::seed_seq sequence{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32U)};
  std::mt19937_64 random(sequence);
  std::normal_distribution<double> normal;
  std::vector<double> start = x0;
  const std::size_t own = model.model->system_states();
  for (std::size_t i = 0; i < model.start_sigma.size(); ++i) start[own + i] += model.start_sigma[i] * normal(random);
  Stepper stepper(*model.model);
  Segment run;
  run_randomly({stepper, like, input_table(like, *model.model)}, start.data(), random, run, model.intensity);
  if (!run.finite) return std::nullopt;
  Signals out = like;
  for (std::size_t c = 0; c < out.measured.size(); ++c) {
    ColouredNoise coloured(model.noise[c], random);
    std::vector<double>& values = out.measured[c].values;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (i > 0) coloured.step(like.t[i] - like.t[i - 1], random);
      const double measured =
          run.y(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(c)) + coloured.value() + model.noise[c].white * normal(random);
      if (std::isfinite(values[i])) values[i] = as_rounded(model.noise[c], measured);
    }
  }
  return out;
}

}  // namespace misfit
