#pragma once

#include <string>
#include <vector>

#include "misfit/data/diagnosis.h"
#include "misfit/diagnose/score.h"

namespace misfit {

/// Hat functions of one quantity along the filter's path.
struct Features {
  std::string quantity, unit;
  int index = -1;              ///< of the quantity in the system; −1: time
  std::vector<double> centre;  ///< [unit]
  std::vector<double> count;   ///< samples under each hat (its weights summed)
  Eigen::MatrixXd f, ahead;    ///< all samples × hats: at the filtered state, and as predicted for the end of the step
};

/// A force may act on the dynamic port: not on that of a state whose rate is another state, unless the random force does (no force turns a
/// speed into something else; what seems to is the sensor's).
[[nodiscard]] bool may_be_forced(const SystemSpec& system, int port);

/// Of recordings of three days and more, whatever they are of: what people do and the sun does recurs every 24 h, and a model without it
/// blames an input that follows.
inline constexpr const char* time_of_day = "time of day";
[[nodiscard]] bool lasts_days(const std::vector<double>& t);
/// [h] From t = 0 on: 0 to 24.
[[nodiscard]] double hour_of_day(double t);

/// Quantities that maps are drawn over: those of the system that `explains` and vary, then time and time_of_day. `most` hats each, equally
/// spaced over 0.5 % to 99.5 % of the visited values (ends extended); hats with fewer than 25 samples under them are left out. Hats of time
/// lie in what is not held out.
[[nodiscard]] std::vector<Features> features_of(const FilterEstimate& estimate, const ForceSensitivity& force, int most = 10);

/// How a memory of a quantity is called: "the past of u".
[[nodiscard]] std::string past_of(const std::string& quantity);

/// Of each input that a quantity gives, what has not yet become of its last changes: u − z with dz/dt = (u − z)/tau, tau 2, 8 and 32 usual
/// sampling intervals. What comes late, in whatever form, depends on one of them. Each is called past_of(u); `index` is that of u.
[[nodiscard]] std::vector<Features> features_of_pasts(const FilterEstimate& estimate, const ForceSensitivity& force, int most);

/// The same of an effect's own states: each state, and its rate (called "d(name)/dt", constant over each step). `index` is that of the
/// state, counted over the model's own states.
[[nodiscard]] std::vector<Features> features_of_own_states(const FilterEstimate& estimate, const ForceSensitivity& force,
                                                           const BoundEffect& effect, int most);

/// Products of two families of hats, `quantity` and `index` of the first; those with fewer than 25 samples under them are left out.
[[nodiscard]] Features products_of(const Features& a, const Features& b);

}  // namespace misfit
