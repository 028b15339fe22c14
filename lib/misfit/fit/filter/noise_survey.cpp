#include "misfit/fit/filter/noise_survey.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace misfit {
namespace {

/// Shares of the usual correlation time, in equal ratios.
constexpr std::array grid = {0.2, 0.5, 1.2, 3.0, 8.0, 20.0};
constexpr int first_iterations = 2;
constexpr std::size_t carried_on = 2;

FilterNoise with_time(FilterNoise noise, double force_time) {
  noise.force_time = force_time;
  return noise;
}

/// The usual coloured noise beside white noise as it is.
FilterNoise with_usual_coloured(FilterNoise noise, const FilterNoise& usual) {
  for (std::size_t o = 0; o < noise.channels.size(); ++o) {
    const double white = noise.channels[o].white;
    noise.channels[o] = usual.channels[o];
    noise.channels[o].white = white;
  }
  return noise;
}

void sort_by_height(std::vector<NoiseFit>& fits) {
  std::erase_if(fits, [](const NoiseFit& fit) { return !std::isfinite(fit.minus_log_density); });
  std::stable_sort(fits.begin(), fits.end(),
                   [](const NoiseFit& a, const NoiseFit& b) { return a.minus_log_density < b.minus_log_density; });
}

bool same_time(const NoiseFit& a, const NoiseFit& b) {
  constexpr double near = 0.2;
  return std::abs(std::log(a.noise.force_time / b.noise.force_time)) < near;
}

}  // namespace

std::vector<NoiseFit> noise_maxima(const LinearisedRuns& runs, const FilterNoise& start, const NoiseSearch& search) {
  std::vector<NoiseFit> fits;
  for (const double share : grid) {
    const FilterNoise there = with_time(start, share * search.reference.force_time);
    fits.push_back(fit_noise(runs, there, {search.reference, search.threads, first_iterations}));
    fits.push_back(fit_noise(runs, with_usual_coloured(there, search.reference), {search.reference, search.threads, first_iterations}));
  }
  sort_by_height(fits);
  fits.resize(std::min(fits.size(), carried_on));
  for (NoiseFit& fit : fits) fit = fit_noise(runs, fit.noise, search);
  sort_by_height(fits);
  std::vector<NoiseFit> out;
  for (NoiseFit& fit : fits) {
    if (std::none_of(out.begin(), out.end(), [&](const NoiseFit& higher) { return same_time(higher, fit); })) out.push_back(std::move(fit));
  }
  return out;
}

}  // namespace misfit
