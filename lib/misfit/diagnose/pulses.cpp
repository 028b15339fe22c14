#include "misfit/diagnose/pulses.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "misfit/core/display.h"
#include "misfit/core/duration.h"
#include "misfit/core/text.h"
#include "misfit/math/statistics.h"

namespace misfit {
namespace {

constexpr double far = 8.0;  // robust standard deviations

/// The smoothed force in units of what the model's own random force would give it: its variance is that of the force less the smoother's
/// own. Where a recording says little of the force (a gain that depends on the state) it is small, pulses or not; where it says next to
/// nothing, NaN. Empty where it says next to nothing anywhere.
std::vector<double> standardised(const std::vector<double>& force, const std::vector<double>& sigma) {
  constexpr double next_to_nothing = 0.05;
  double of_force = 0.0;
  for (std::size_t k = 0; k < force.size(); ++k)
    of_force += (force[k] * force[k] + sigma[k] * sigma[k]) / static_cast<double>(force.size());
  std::vector<double> known;
  for (const double s : sigma) known.push_back(of_force - s * s);
  const double best = *std::max_element(known.begin(), known.end());
  if (!(best > next_to_nothing * of_force)) return {};
  std::vector<double> out(force.size(), std::nan(""));
  for (std::size_t k = 0; k < force.size(); ++k) {
    if (known[k] > next_to_nothing * best) out[k] = force[k] / std::sqrt(known[k]);
  }
  return out;
}

std::vector<double> finite(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  return values;
}

/// Samples first … last that lie far from the median.
struct Stretch {
  std::size_t first = 0, last = 0;
};

std::vector<Stretch> far_stretches(const std::vector<double>& force, double usual, double sigma) {
  constexpr std::size_t apart = 3;
  std::vector<Stretch> out;
  for (std::size_t k = 0; k < force.size(); ++k) {
    if (!(std::abs(force[k] - usual) > far * sigma)) continue;
    if (out.empty() || k - out.back().last > apart) out.push_back({k, k});
    out.back().last = k;
  }
  return out;
}

/// They are pulses, and no force that is always there.
bool stand_out(const std::vector<Stretch>& stretches, const std::vector<double>& force, double usual) {
  constexpr std::size_t fewest = 3;
  constexpr double longest = 0.2, held = 0.75;  // shares of the time, of the sum of squares
  double samples = 0.0, inside = 0.0, all = 0.0;
  const std::vector<double> known = finite(force);
  for (const double f : known) all += (f - usual) * (f - usual);
  for (const Stretch& s : stretches) {
    for (std::size_t k = s.first; k <= s.last; ++k) {
      if (!std::isfinite(force[k])) continue;
      samples += 1.0;
      inside += (force[k] - usual) * (force[k] - usual);
    }
  }
  return stretches.size() >= fewest && samples < longest * static_cast<double>(known.size()) && inside > held * all;
}

/// Samples at which an input as recorded changes by more than a fifth of its range.
std::vector<std::size_t> jumps_of(const std::vector<double>& input) {
  constexpr double share = 0.2;
  const auto [least, largest] = std::minmax_element(input.begin(), input.end());
  std::vector<std::size_t> out;
  for (std::size_t k = 1; k < input.size(); ++k) {
    if (std::abs(input[k] - input[k - 1]) > share * (*largest - *least)) out.push_back(k);
  }
  return out;
}

/// The input at whose changes four fifths of the pulses begin, where it changes seldom enough for that to say something; empty: there is
/// none.
std::string input_behind(const MissingForce& missing, const std::vector<Stretch>& pulses) {
  constexpr std::size_t near = 3;
  constexpr double most = 0.8, seldom = 0.3;
  constexpr std::string_view recorded = "_given";  // as_recorded()
  for (std::size_t q = 0; q < missing.quantities.size(); ++q) {
    const std::string& name = missing.quantities[q];
    if (!name.ends_with(recorded)) continue;
    const std::vector<std::size_t> jumps = jumps_of(missing.values[q]);
    const auto follows_a_jump = [&](std::size_t sample) {
      return std::any_of(jumps.begin(), jumps.end(), [&](std::size_t jump) { return sample + near >= jump && sample <= jump + near; });
    };
    std::size_t often = 0;
    for (std::size_t k = 0; k < missing.t.size(); ++k) often += follows_a_jump(k) ? 1 : 0;
    const auto at_jumps = std::count_if(pulses.begin(), pulses.end(), [&](const Stretch& s) { return follows_a_jump(s.first); });
    const bool told = static_cast<double>(often) < seldom * static_cast<double>(missing.t.size());
    if (told && static_cast<double>(at_jumps) > most * static_cast<double>(pulses.size()))
      return name.substr(0, name.size() - recorded.size());
  }
  return "";
}

/// "what is missing on dT/dt comes in 11 pulses of 2.25 min to 2.75 min, all upward, of up to 0.01 K/s, at t = 1875 s, …: …".
std::string in_words(const ForcePulses& pulses, const std::string& input) {
  constexpr std::size_t named = 4;
  std::vector<double> lengths;
  for (std::size_t i = 0; i < pulses.begin.size(); ++i) lengths.push_back(pulses.end[i] - pulses.begin[i]);
  const auto [shortest, longest] = std::minmax_element(lengths.begin(), lengths.end());
  const std::string least = duration_in_words(*shortest), most = duration_in_words(*longest);
  const bool up = *std::max_element(pulses.peak.begin(), pulses.peak.end()) > 0.0,
             down = *std::min_element(pulses.peak.begin(), pulses.peak.end()) < 0.0;
  double largest = 0.0;
  for (const double peak : pulses.peak) largest = std::max(largest, std::abs(display_value(peak, pulses.port_unit)));
  const double two_digits = std::pow(10.0, std::floor(std::log10(largest)) - 1.0);
  std::vector<std::string> times;
  for (std::size_t i = 0; i < std::min(named, pulses.begin.size()); ++i) times.push_back(format_value(pulses.begin[i]) + " s");
  if (pulses.begin.size() > named) times.emplace_back("…");
  return fmt::format("what is missing on {} comes in {} pulses of {}, {}, of up to {}, at t = {}{}", pulses.port, pulses.begin.size(),
                     least == most ? least : least + " to " + most,
                     up && down ? "both upward and downward"
                     : up       ? "all upward"
                                : "all downward",
                     with_display_unit(format_to_step(largest, two_digits), pulses.port_unit), fmt::join(times, ", "),
                     input.empty() ? ": something acts then that no column shows" : ": most of them begin where " + input + " changes");
}

void add_pulses(const MissingForce& missing, std::size_t port, std::vector<ForcePulses>& out) {
  const std::vector<double>& force = missing.force[port];
  if (force.size() < 2) return;
  const double usual = median(force), step = usual_step(missing.t);
  const std::vector<double> z = standardised(force, missing.sigma[port]);
  if (z.empty()) return;
  const double usual_z = median(finite(z));
  const std::vector<Stretch> stretches = far_stretches(z, usual_z, mad_sigma(finite(z)));
  if (!stand_out(stretches, z, usual_z)) return;
  ForcePulses& pulses = out.emplace_back();
  pulses.experiment = missing.experiment;
  pulses.port = missing.ports[port];
  pulses.port_unit = missing.port_units[port];
  for (const Stretch& s : stretches) {
    pulses.begin.push_back(missing.t[s.first]);
    pulses.end.push_back(missing.t[s.last] + step);
    const auto largest =
        std::max_element(force.begin() + static_cast<std::ptrdiff_t>(s.first), force.begin() + static_cast<std::ptrdiff_t>(s.last) + 1,
                         [&](double a, double b) { return std::abs(a - usual) < std::abs(b - usual); });
    pulses.peak.push_back(*largest - usual);
  }
  pulses.sentence = in_words(pulses, input_behind(missing, stretches));
}

}  // namespace

std::vector<ForcePulses> pulses_of(const std::vector<MissingForce>& missing) {
  std::vector<ForcePulses> out;
  for (const MissingForce& experiment : missing) {
    for (std::size_t port = 0; port < experiment.ports.size(); ++port) add_pulses(experiment, port, out);
  }
  return out;
}

}  // namespace misfit
