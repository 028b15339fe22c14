#include "misfit/fit/filter/outliers_at_jumps.h"

#include <fmt/format.h>

#include <algorithm>

#include "misfit/core/lists.h"

namespace misfit {
namespace {

/// Samples within two of a jump of a held input; empty of one that changes at more than every fifth sample.
std::vector<bool> near_jumps(const std::vector<double>& input) {
  constexpr std::size_t samples = 2, least_apart = 5;
  std::vector<bool> out(input.size(), false);
  std::size_t jumps = 0;
  for (std::size_t k = 1; k < input.size(); ++k) {
    if (input[k] == input[k - 1]) continue;
    ++jumps;
    for (std::size_t j = k; j < std::min(k + samples, input.size()); ++j) out[j] = true;
  }
  return jumps * least_apart > input.size() ? std::vector<bool>{} : out;
}

/// Numbers of measurements.
struct Counts {
  double counted = 0.0, near = 0.0, beyond = 0.0, beyond_near = 0.0;
};

void add(const FilterData& data, const std::vector<bool>& near, const std::vector<std::size_t>& gated, Counts& out) {
  const std::size_t channels = data.signals->measured.size();
  const auto is_near = [&](std::size_t at) { return !near.empty() && near[at / channels]; };
  for (std::size_t at = data.first * channels; at < data.use.size(); ++at) {
    if (data.use[at] != SampleRole::counted) continue;
    out.counted += 1.0;
    if (is_near(at)) out.near += 1.0;
  }
  out.beyond += static_cast<double>(gated.size());
  out.beyond_near += static_cast<double>(std::count_if(gated.begin(), gated.end(), is_near));
}

}  // namespace

std::optional<OutliersAtJumps> outliers_at_jumps(const SystemSpec& system, const std::vector<FilterData>& all,
                                                 const std::vector<std::vector<std::size_t>>& gated) {
  constexpr double fewest = 3.0, least_share = 0.5, by_chance = 5.0;
  std::optional<OutliersAtJumps> out;
  const bool none = std::all_of(gated.begin(), gated.end(), [](const auto& places) { return places.empty(); });
  for (int input = 0; input < int_size(system.inputs) && !none; ++input) {
    if (system.inputs[input].hold != Hold::zero_order) continue;
    Counts n;
    for (std::size_t e = 0; e < all.size(); ++e) add(all[e], near_jumps(all[e].signals->inputs[input].values), gated[e], n);
    const double of_all = n.counted > 0.0 ? n.near / n.counted : 1.0, share = n.beyond_near / n.beyond;
    const bool significant = n.beyond_near >= fewest && share >= least_share && share >= by_chance * of_all;
    if (significant && (!out || n.beyond_near > out->at_jumps)) out = OutliersAtJumps{input, n.beyond, n.beyond_near, of_all};
  }
  return out;
}

std::vector<std::size_t> without_those_at_jumps(const FilterData& data, int input, std::vector<std::size_t> gated) {
  const std::vector<bool> near = near_jumps(data.signals->inputs[input].values);
  const std::size_t channels = data.signals->measured.size();
  if (!near.empty()) std::erase_if(gated, [&](std::size_t at) { return near[at / channels]; });
  return gated;
}

std::string in_words(const OutliersAtJumps& found, const SystemSpec& system) {
  const std::string& input = system.inputs[found.input].name;
  return fmt::format(
      "{:.0f} of {:.0f} measurements more than 5 sigma from their prediction come within two samples of a jump of {}, as {:.2g} % of all "
      "do: they are kept. The time of {} or of a sensor may be off, or the model lacks something that shows at once",
      found.at_jumps, found.beyond, input, 100.0 * found.of_all, input);
}

}  // namespace misfit
