#pragma once

#include <string>
#include <vector>

#include "misfit/fit/regression/window_search.h"

namespace misfit {

/// One output with what may drive it; NaN: missing.
struct GuessData {
  std::vector<double> t;     ///< [s], increasing
  std::vector<double> y;     ///< [output]
  std::vector<double> rate;  ///< [output/s], its measured rate; empty: none
  std::vector<GuessDriver> drivers;
  bool without_inertia = false;  ///< a temperature: what is stored has no momentum
};

/// A linear model to start from:
///   order 1: tau y' = Σ gain u + rest − y;  order 2: y'' = −stiffness (y − rest − Σ gain u) − damping y';
///   integrates: without the pull back to rest, y' = Σ gain u + rest, or y'' = Σ gain u + rest − damping y'.
struct LinearGuess {
  int order = 1;
  bool integrates = false;
  double tau = 1.0;                       ///< [s], order 1
  double stiffness = 0.0, damping = 0.0;  ///< [1/s^2], [1/s], order 2
  double rest = 0.0;                      ///< [output], or [output/s^order] where it integrates
  std::vector<double> gain;               ///< per driver, static or (integrates) to y^(order); 0: that driver is not in the model
  double undriven = 1.0;                  ///< the held-out error without any driver, over that with them (mean squares less the noise)
  std::string why;                        ///< in words
};

/// Order, drivers and parameters by the data: models are fitted over every second window of about two swings, each with its own initial
/// state (linear_windows.h), and compared over the windows between, and the other way round. A driver is in the model if the held-out error
/// (mean square less the measurement noise, at least 0.3 of it) falls with it by 5 %, beside another output by 20 %, another output if it
/// falls by half; of inputs the best one always is, and so are those that the user named: a gain that is not needed is estimated as 0 and
/// does little harm, a missing one makes other effects look like it; what is constant, but for rounding, never is. Where all drivers
/// together lower it by less than 20 %, the initial states of the windows explain the motion, which says nothing of the drivers (a second
/// order without a pull back to rest follows much by its two initial values alone): then over windows twice as long, and again, as long as
/// four are left. An input that only windows twice as long need is in the model, too: its effect is slow. Order 2 is taken if the rate is
/// measured, or if its held-out error is lower than that of order 1 by a sixth (mean square: 0.7; a twentieth, 0.9, where its damping ratio
/// is between 0.05 and 0.5) and its damping ratio below 0.9 (two time constants are one and a lag, which discovery names); without a pull
/// back also where the time constant of order 1 is longer than the record; never without a pull back for what has no inertia. Where order 1
/// with a drift in time halves that of order 1 without, and leaves no more than order 2 without a pull back, it is order 1, without the
/// drift; a pull back to rest if the mean square is 0.5 % higher without. Where nothing can be fitted: order 1 with a tenth of the record
/// as tau, and every input with the gain σ(y)/σ(u).
[[nodiscard]] LinearGuess guess_linear(const GuessData& data);

}  // namespace misfit
