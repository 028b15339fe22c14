#include "misfit/fit/filter/outliers_at_jumps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "misfit/core/lists.h"

namespace misfit {
namespace {

/// Samples within two of a jump of a held input; empty of one that changes at more than every fifth sample.
std::vector<bool> near_jumps(const std::vector<double>& input) {
  constexpr std::size_t after = 2, least_apart = 5;
  std::vector<bool> out(input.size(), false);
  std::size_t jumps = 0;
  for (std::size_t k = 1; k < input.size(); ++k) {
    if (input[k] == input[k - 1]) continue;
    ++jumps;
    for (std::size_t j = k; j < std::min(k + after, input.size()); ++j) out[j] = true;
  }
  return jumps * least_apart > input.size() ? std::vector<bool>{} : out;
}

/// Numbers of measurements.
struct Counts {
  double rejected = 0.0, rejected_near = 0.0, all = 0.0, near = 0.0;
};

void count(const FilterData& data, std::size_t input, Counts& out) {
  const Signals& signals = *data.signals;
  const std::vector<bool> near = near_jumps(signals.inputs[input].values);
  if (near.empty()) return;
  const std::size_t channels = signals.measured.size();
  for (std::size_t k = data.first; k < signals.samples(); ++k) {
    for (std::size_t o = 0; o < channels; ++o) {
      if (!std::isfinite(signals.measured[o].values[k])) continue;
      const bool rejected = data.use[k * channels + o] == SampleRole::none;
      out.all += 1.0;
      out.near += near[k] ? 1.0 : 0.0;
      out.rejected += rejected ? 1.0 : 0.0;
      out.rejected_near += rejected && near[k] ? 1.0 : 0.0;
    }
  }
}

}  // namespace

std::string outliers_at_jumps(const FilterEstimate& estimate) {
  constexpr double fewest = 3.0, least_share = 0.5, by_chance = 5.0;
  if (estimate.outliers == 0 || !estimate.nonlinear.empty()) return {};
  std::string out;
  double most = 0.0;
  const std::vector<InputSpec>& inputs = estimate.model.system->spec().inputs;
  for (int input = 0; input < int_size(inputs); ++input) {
    if (inputs[input].hold != Hold::zero_order) continue;
    Counts found;
    for (const FilterData& data : estimate.data) count(data, input, found);
    const double share = found.rejected_near / found.rejected, of_all = found.near / found.all;
    if (found.rejected_near < std::max(fewest, most + 1.0) || share < least_share || share < by_chance * of_all) continue;
    most = found.rejected_near;
    out = fmt::format(
        ": {:.0f} of them within two samples of a jump of {}, as {:.2g} % of all are. The time of {} or of a sensor may be off, or the "
        "model "
        "may lack what shows at once",
        most, inputs[input].name, 100.0 * of_all, inputs[input].name);
  }
  return out;
}

}  // namespace misfit
