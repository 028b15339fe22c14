#pragma once

// References
//   [J]  A. H. Jazwinski, Stochastic Processes and Filtering Theory (1970): Ornstein–Uhlenbeck, discretisation of linear noise.

#include <array>
#include <string>
#include <vector>

#include "misfit/data/signals.h"
#include "misfit/inference/prior.h"
#include "misfit/model/model.h"

namespace misfit {

/// Noise of one measured channel: white measurement noise and a resonance (coloured noise of second order, AR(2) when sampled), stationary.
struct ChannelNoise {
  double white = 1.0;               ///< sigma [unit]
  double coloured = 0.0;            ///< stationary sigma of the resonance [unit]
  double coloured_frequency = 1.0;  ///< [Hz]
  double coloured_damping = 0.3;    ///< of critical
  bool given = false;               ///< by the study: white noise, and nothing else
  bool no_coloured = false;         ///< white is all there is
  double rounding = 0.0;  ///< of a reference: sigma of readings in whole steps, step/sqrt(12) [unit], below which `white` does not go
};

/// Log-normal: log of a group's strength ~ N(log median, log_sigma²).
struct ForcePrior {
  int group = -1;  ///< −1: none
  double median = 1.0, log_sigma = 1.0;
};

/// The random force: one Ornstein–Uhlenbeck process per force port, independent, of one common correlation time, and of one common strength
/// for the ports of one unit (FilterModel::force_group).
struct FilterNoise {
  double force = 0.0;       ///< stationary sigma on the ports of the first group [port unit]
  double force_time = 0.1;  ///< correlation time [s]
  std::vector<ChannelNoise> channels;
  bool time_is_given = false;               ///< the correlation time is known
  std::vector<double> further_forces = {};  ///< the same of the further groups [port unit]
  ForcePrior prior = {};                    ///< what is known of a strength beforehand

  [[nodiscard]] double force_of(int group) const { return group == 0 ? force : further_forces[group - 1]; }
};

/// Logarithms in a fixed order: force, force_time, then per channel white, coloured noise, coloured_frequency, coloured_damping, then
/// further_forces. Bounds keep a likelihood that does not depend on one of them from running away.
struct NoiseVector {
  std::vector<double> value, lower, upper;
  ColumnPriors prior;              ///< of the logarithms
  std::vector<std::string> names;  ///< "force", "force_time", "P_y", "P_y_coloured", …
};
/// Places in it.
namespace place_in_noise {
inline constexpr std::size_t force = 0, force_time = 1, per_channel = 4;
[[nodiscard]] constexpr std::size_t white(std::size_t output) { return 2 + per_channel * output; }
[[nodiscard]] constexpr std::size_t coloured(std::size_t output) { return white(output) + 1; }
[[nodiscard]] constexpr std::size_t coloured_frequency(std::size_t output) { return white(output) + 2; }
[[nodiscard]] constexpr std::size_t coloured_damping(std::size_t output) { return white(output) + 3; }
}  // namespace place_in_noise
[[nodiscard]] NoiseVector pack(const FilterNoise& noise, const SystemSpec& spec,
                               const FilterNoise& reference);  ///< `reference`: bounds and prior
/// log density of the noise's prior, constants left out.
[[nodiscard]] double log_prior(const FilterNoise& noise, const SystemSpec& spec, const FilterNoise& reference);
[[nodiscard]] FilterNoise unpack(const std::vector<double>& logs, const SystemSpec& spec);
/// With the least random force that the bounds about `reference` allow, and white noise alone, as large as it was with its coloured noise.
[[nodiscard]] FilterNoise hardly_forced(FilterNoise noise, const FilterNoise& reference);
/// Place of a group's strength among them; of the number of groups: how many logarithms there are.
[[nodiscard]] std::size_t place_of_force(int group, const SystemSpec& spec);

/// Exact discretisation over one step h of everything whose noise does not depend on the state.
struct NoiseStep {
  /// Second moments of a force's noise on rows of three kinds: the force itself (0), a rate (1), a level (2), the last two relative to
  /// the row's response Φ to the force at the start of the step; i.e. Q_ij = m[kind_i][kind_j] Φ_if Φ_jf with Φ_ff taken as 1
  /// (lib/misfit/README.md (29)). [J]
  std::array<std::array<double, 3>, 3> m{};  ///< of a force of the first group
  std::vector<double> variance_ratio;        ///< of each group to the first
  struct Coloured {
    std::array<double, 4> phi{};  ///< of (j, j'/ω), row-major
    std::array<double, 3> q{};    ///< covariance: 00, 01, 11
  };
  std::vector<Coloured> coloured;
};
[[nodiscard]] NoiseStep discretise(const FilterNoise& noise, double h);

}  // namespace misfit
