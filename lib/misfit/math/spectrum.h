#pragma once

// References
//   [P1] D. N. Politis, J. Nonparametric Statist. 15 (2003): flat-top lag windows and their width from the correlogram.
//   [P2] D. N. Politis, Econometric Theory 27 (2011): positive semi-definite estimates of spectral densities.

#include <Eigen/Core>
#include <complex>
#include <vector>

namespace misfit {

/// Discrete Fourier transform of a real series, zeros appended up to `size` (a power of two): Σ x_k e^{−2πi f k/size}, f = 0 … size/2.
[[nodiscard]] Eigen::VectorXcd fourier(const Eigen::Ref<const Eigen::VectorXd>& series, Eigen::Index size);
/// Back from the half spectrum of a real series of `size` values.
[[nodiscard]] Eigen::VectorXd inverse_fourier(const Eigen::VectorXcd& half, Eigen::Index size);

/// Smallest power of two that is at least `least`.
[[nodiscard]] Eigen::Index power_of_two(Eigen::Index least);

/// Products of several channels with each other by lag: `at(k)(a, b)` = Σ_i x_a,i x_b,i+k for k = 0 … lags. Negative lags are transposes.
using LagProducts = std::vector<Eigen::MatrixXd>;

/// Lag up to which channels remember: the smallest m ≥ `least` after which for 20 lags in a row |ρ| stays below 1.75 sqrt(log10 n) standard
/// deviations of what chance gives, for every pair of channels [P1]; by chance: sqrt(Σ ρ_aa ρ_bb/n) over the lags before (Bartlett), since
/// the correlogram of a series with memory has memory itself. Lags without pairs (channels read at every k-th sample only) are passed over,
/// `least` counts those that have some. At most half of the lags given. `products`: of residuals, `pairs`: how many
/// pairs are behind each of them.
[[nodiscard]] int correlation_length(const LagProducts& products, const LagProducts& pairs, int least);

/// Flat-top lag window of [P1]: 1 up to m, straight down to 0 at 2 m.
[[nodiscard]] double flat_top(int lag, int m);

/// Spectral density matrices at f = 0 … size/2 from autocovariances (windowed by the caller, 0 beyond those given), with eigenvalues below
/// 0 set to 0 [P2]: then Σ_ij z_i' C(i−j) z_j ≥ 0 for whatever z.
[[nodiscard]] std::vector<Eigen::MatrixXcd> spectral_density(const LagProducts& covariances, Eigen::Index size);

}  // namespace misfit
