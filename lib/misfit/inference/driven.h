#pragma once

#include <functional>
#include <string>
#include <vector>

#include "misfit/data/signals.h"
#include "misfit/math/whiteness.h"
#include "misfit/model/system.h"

namespace misfit {

/// What the equations of motion leave of the measured accelerations; one entry per sample, NaN where not used. Any unit, the same for all.
struct EquationResiduals {
  const std::vector<double>& t;                   ///< [s]
  std::vector<double> residual;                   ///< less what the model explains
  std::vector<double> acceleration;               ///< as measured
  std::function<std::vector<double>()> of_noise;  ///< what noise as large as the measured one adds to it, one draw (with_more_noise());
                                                  ///< asked only where the model does not explain the motion
  int half_period = 0;                            ///< of the motion, in samples
  int stencil_reach = 0;                          ///< lags below this are the stencils' own
};

/// Is the motion driven by a force that the model lacks (lib/misfit/README.md, 5.8)? Single accelerations are mostly noise of the measured
/// positions; averaged over half a period, a noise of second differences nearly cancels and a force stays. The level of
/// the averaged noise is estimated from one added draw of it.
struct DrivenTest {
  WhitenessTest whiteness;   ///< of the residuals, from the stencils' reach to half a period
  int averaged = 0;          ///< samples
  double share = 0.0;        ///< median size of averaged residuals over that of averaged accelerations; NaN where there is no average
  double times_noise = 0.0;  ///< median size of averaged residuals over that of averaged noise; 0 where deterministic(); NaN as above
  /// Half a period of residuals is known somewhere without a gap, so that there is something to average. Otherwise neither driven() nor
  /// deterministic().
  [[nodiscard]] bool tested() const;
  /// Averaged residuals are above four times what measurement noise makes and above a fifth of the averaged acceleration (what curves of
  /// few coefficients or bins smooth away is below).
  [[nodiscard]] bool driven() const;
  /// They are at most a fifth of the averaged acceleration. Neither this nor driven(), though tested(): noise hides the motion.
  [[nodiscard]] bool deterministic() const { return share <= kSmallShare; }

  static constexpr double kSmallShare = 0.2;
};

[[nodiscard]] DrivenTest test_driven(const EquationResiduals& equation);

/// "equation residuals averaged over 8 samples are 0.85 of the averaged acceleration and 14 times what measurement noise makes of it; at
/// lags 5 to 15 …"; "residuals are not tested for a force …" where not tested().
[[nodiscard]] std::string in_words(const DrivenTest& test);

/// The signals with one draw of white noise more on each channel, as large as it already has (measurement_noise()), from a fixed seed; on
/// inputs as well that run smoothly between their samples, for they were measured.
[[nodiscard]] Signals with_more_noise(const SystemSpec& system, const Signals& signals);

}  // namespace misfit
