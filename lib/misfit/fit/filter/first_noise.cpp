#include "misfit/fit/filter/first_noise.h"

#include <algorithm>
#include <limits>

#include "misfit/inference/roughness.h"

namespace misfit {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// Of three searches from the present noise; with an infinite density where none has one.
NoiseFit best_noise(const LikelihoodAscent& at, int threads) {
  constexpr int iterations = 6;
  NoiseFit best;
  best.minus_log_density = infinite;
  for (const double share : {0.4, 1.0, 2.0}) {
    FilterNoise start = at.out.noise;
    for (std::size_t o = 0; o < start.channels.size(); ++o)
      start.channels[o].coloured_frequency = share * at.out.reference.channels[o].coloured_frequency;
    const NoiseFit fit = fit_noise(at.runs(), start, {at.out.reference, threads, iterations});
    if (fit.minus_log_density < best.minus_log_density) best = fit;
  }
  return best;
}

struct NoiseAtStart {
  NoiseFit fit;
  double height;  ///< with it; −infinity: the model cannot be run with it
};

/// The search stays where it is.
NoiseAtStart noise_at_start(LikelihoodAscent& at, int threads) {
  const FilterNoise before = at.out.noise;
  const NoiseFit fit_before = at.out.noise_fit;
  NoiseAtStart found{best_noise(at, threads), -infinite};
  if (at.try_noise(found.fit)) found.height = height_of(at);
  at.out.noise = before;
  at.out.noise_fit = fit_before;
  at.out.forced.set_force_time(before.force_time);
  at.linearise();
  return found;
}

}  // namespace

double height_of(const LikelihoodAscent& at) {
  return any_chosen(at.out.penalties) ? marginal_loglik(at.normal_equations(), at.out.penalties, at.objective) : at.objective;
}

void search_noise(LikelihoodAscent& at, int threads) {
  constexpr double clearly = 0.5;  // of the log-likelihood
  const Eigen::VectorXd start = at.theta;
  const NoiseAtStart at_start = noise_at_start(at, threads);
  at.gauss_newton_step();
  if (at.try_noise(best_noise(at, threads)) && height_of(at) > at_start.height - clearly) return;
  at.theta = start;
  at.linearise();
  at.try_noise(at_start.fit);
}

}  // namespace misfit
