#include "misfit/fit/filter/other_weights.h"

#include <algorithm>
#include <cmath>

#include "misfit/core/watch.h"
#include "misfit/fit/filter/first_noise.h"
#include "misfit/inference/output_weights.h"

namespace misfit {
namespace {

struct End {
  LikelihoodAscent::Point point;
  double height;
  std::vector<double> sigma;
  bool settled = true;
};

double level(const ChannelNoise& noise) { return std::hypot(noise.white, noise.coloured); }

End end_of(const LikelihoodAscent& at) {
  End out{at.here(), height_of(at), {}};
  for (const ChannelNoise& channel : at.out.noise.channels) out.sigma.push_back(level(channel));
  return out;
}

/// By more than five sigmas of the present covariance.
bool moved(const LikelihoodAscent& at, const Eigen::VectorXd& from) {
  constexpr double far = 5.0;
  const Eigen::MatrixXd& covariance = at.out.covariance;
  if (covariance.rows() != from.size()) return false;
  return ((at.theta - from).cwiseAbs().array() > far * covariance.diagonal().cwiseMax(0.0).cwiseSqrt().array()).any();
}

/// A step of the parameters with the noise as it is: do they move, and is the noise about them another one?
bool leads_away(LikelihoodAscent& at, const End& from, int threads) {
  constexpr double another = 0.2;  // relative change of a noise
  at.gauss_newton_step();
  if (!moved(at, from.point.theta)) return false;
  const NoiseFit now = fit_noise(at.runs(), from.point.noise, {at.out.reference, threads, kRefinements});
  if (!std::isfinite(now.minus_log_density)) return false;
  return !std::equal(from.sigma.begin(), from.sigma.end(), now.noise.channels.begin(),
                     [](double before, const ChannelNoise& channel) { return std::abs(level(channel) / before - 1.0) < another; });
}

}  // namespace

void weigh_outputs_otherwise(LikelihoodAscent& at, const AscentRounds& rounds) {
  if (at.theta.size() == 0) return;
  End best = end_of(at);
  WeighedSearch<End> search;
  search.return_to = [&](const End& end) {
    best = end;
    at.return_to(end.point);
  };
  search.end_from = [&](const Weighing& weighing, const End& from) -> std::optional<End> {
    FilterNoise noise = from.point.noise;
    noise.channels[weighing.output].white *= weighing.factor;
    noise.channels[weighing.output].coloured *= weighing.factor;
    if (!at.begin_with(noise) || !leads_away(at, from, rounds.threads)) return std::nullopt;
    at.iterate(rounds.most, rounds.tolerance);
    return end_of(at);
  };
  try {
    const std::vector<std::string> words = weigh_outputs_otherwise(at.out.model, best, search);
    at.out.notes.insert(at.out.notes.end(), words.begin(), words.end());
  } catch (const TimeLimitReached&) {
    const SuspendedTimeLimit back;
    at.return_to(best.point);
    throw;
  }
}

}  // namespace misfit
