#pragma once

// References
//   [B]  L. I. Bluestein, IEEE Trans. Audio Electroacoust. 18 (1970); L. R. Rabiner, R. W. Schafer, C. M. Rader, Bell Syst. Tech. J. 48
//   (1969): transforms at any equally spaced frequencies as a convolution with a chirp.

#include <Eigen/Core>

namespace misfit {

/// Σ_k x_k exp(2πi (first + f step) k), f = 0 … count − 1, by three fast transforms [B]; first and step in cycles per sample. Relative
/// error of the phases about 1e-16 step k².
[[nodiscard]] Eigen::VectorXcd chirp_transform(const Eigen::Ref<const Eigen::VectorXd>& series, double first, double step,
                                               Eigen::Index count);

}  // namespace misfit
