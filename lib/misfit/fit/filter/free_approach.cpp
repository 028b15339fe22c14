#include "misfit/fit/filter/free_approach.h"

#include <cmath>
#include <limits>

#include "misfit/core/error.h"
#include "misfit/math/statistics.h"

namespace misfit {
namespace {

struct MeanSquare {
  double sum = 0.0, count = 0.0;
  [[nodiscard]] double value() const { return count > 0.0 ? sum / count : 1.0; }
};

/// Adds the whitened innovations of an output that count.
void add_whitened(const FilterEstimate& estimate, std::size_t experiment, std::size_t output, MeanSquare& out) {
  const FilterData& data = estimate.data[experiment];
  const FilterTrace& trace = estimate.traces[experiment];
  for (std::size_t k = data.first; k < trace.samples; ++k) {
    const std::size_t at = trace.place(k, output);
    if (data.use[at] != SampleRole::counted) continue;
    out.sum += trace.e[at] * trace.e[at] / trace.S[at];
    out.count += 1.0;
  }
}

bool begin(LikelihoodAscent& at) {
  at.out.noise = hardly_forced(at.out.noise, at.out.reference);
  return at.linearise();
}

/// White noise as large as the residuals. Mean over the outputs of its logarithm.
double rescale_noise(FilterEstimate& estimate) {
  double out = 0.0;
  for (std::size_t o = 0; o < estimate.noise.channels.size(); ++o) {
    MeanSquare whitened;
    for (std::size_t e = 0; e < estimate.data.size(); ++e) add_whitened(estimate, e, o, whitened);
    ChannelNoise& channel = estimate.noise.channels[o];
    if (!channel.given) channel.white *= std::sqrt(whitened.value());
    out += std::log(channel.white) / static_cast<double>(estimate.noise.channels.size());
  }
  return out;
}

}  // namespace

bool follows_freely(LikelihoodAscent& at) {
  constexpr double most = 0.5;  // of the variance
  if (!begin(at)) return false;
  for (std::size_t e = 0; e < at.out.data.size(); ++e) {
    for (std::size_t o = 0; o < at.out.noise.channels.size(); ++o) {
      MeanSquare whitened;
      add_whitened(at.out, e, o, whitened);
      if (whitened.count == 0.0) continue;
      const double white = at.out.noise.channels[o].white;
      if (!(white * white * whitened.value() < most * std::pow(standard_deviation(at.out.data[e].signals->measured[o].values), 2)))
        return false;
    }
  }
  return true;
}

void settle_freely(LikelihoodAscent& at) {
  constexpr int most_rounds = 15;
  constexpr double settled = 0.01;  // of the residuals' RMS
  if (!begin(at)) throw RunError(at.failure());
  double before = std::numeric_limits<double>::infinity();
  for (int k = 0; k < most_rounds; ++k) {
    const double residuals = rescale_noise(at.out);
    if (!at.linearise()) throw RunError(at.failure());
    if (before - residuals < settled) return;
    before = residuals;
    at.gauss_newton_step();
  }
}

}  // namespace misfit
