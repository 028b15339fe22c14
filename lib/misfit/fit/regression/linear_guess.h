#pragma once

// References
//   [L]  L. Ljung, System Identification (1999), section 4.2: ARX models by linear regression; 7.3: their bias under measurement noise.

#include <string>
#include <vector>

namespace misfit {

/// One output with what drives it; NaN: missing.
struct GuessData {
  std::vector<double> t;                    ///< [s], increasing
  std::vector<double> y;                    ///< [output]
  std::vector<std::vector<double>> inputs;  ///< each as long as t
};

/// A linear model to start from: order 1, tau y' = Σ gain u + rest − y, or order 2, y'' = −stiffness (y − rest − Σ gain u) − damping y'.
struct LinearGuess {
  int order = 1;
  double tau = 1.0;                       ///< [s], order 1
  double stiffness = 0.0, damping = 0.0;  ///< [1/s^2], [1/s], order 2
  double rest = 0.0;                      ///< [output]
  std::vector<double> gain;               ///< static, per input [output/input]
  std::string why;                        ///< in words
};

/// Regression of y on its own two last values and the inputs [L], at about ten samples per swing (mean crossings): a complex pair of poles
/// below 0.9 of critical damping makes order 2, else the slower pole order 1. Only a start: noise biases it towards quick decay [L, 7.3].
/// Where the regression has no stable answer, order 1 with a tenth of the record as tau, and gain 0.
[[nodiscard]] LinearGuess guess_linear(const GuessData& data);

}  // namespace misfit
