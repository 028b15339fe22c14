#pragma once

#include <optional>
#include <string>
#include <vector>

#include "misfit/fit/filter/filter_run.h"

namespace misfit {

/// Measurements beyond the gate that come where a held input jumps: no wild ones, but an input or a sensor whose time is off, or something
/// that the model lacks and that shows at once. They are evidence and stay.
struct OutliersAtJumps {
  int input = -1;  ///< of the system
  double beyond = 0.0, at_jumps = 0.0,
         of_all = 0.0;  ///< how many are beyond the gate; of them at jumps; share of all measurements that are
};

/// Of the input at whose jumps most of them are; nullopt where less than half of them, or no more than by chance, are at jumps of any.
/// `all`: before the gate; `gated`: of each experiment the places in `use` that are beyond it.
[[nodiscard]] std::optional<OutliersAtJumps> outliers_at_jumps(const SystemSpec& system, const std::vector<FilterData>& all,
                                                               const std::vector<std::vector<std::size_t>>& gated);

/// The gated places of an experiment without those at jumps of the input.
[[nodiscard]] std::vector<std::size_t> without_those_at_jumps(const FilterData& data, int input, std::vector<std::size_t> gated);

/// "10 of 11 measurements more than 5 sigma from their prediction come within two samples of a jump of I, as 4 % of all do: …".
[[nodiscard]] std::string in_words(const OutliersAtJumps& found, const SystemSpec& system);

}  // namespace misfit
