#include "misfit/math/chirp.h"

#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>

#include "misfit/math/spectrum.h"

namespace misfit {

Eigen::VectorXcd chirp_transform(const Eigen::Ref<const Eigen::VectorXd>& series, double first, double step, Eigen::Index count) {
  const Eigen::Index n = series.size();
  if (n == 0 || count == 0) return Eigen::VectorXcd::Zero(count);
  const Eigen::Index size = power_of_two(n + count - 1);
  const auto chirp = [step](Eigen::Index k) {
    const auto x = static_cast<double>(k);
    return std::polar(1.0, std::numbers::pi * step * (x * x));
  };
  // f k = (f² + k² − (f − k)²)/2
  Eigen::VectorXcd turned = Eigen::VectorXcd::Zero(size), answer = Eigen::VectorXcd::Zero(size);
  for (Eigen::Index k = 0; k < n; ++k)
    turned[k] = series[k] * std::polar(1.0, 2.0 * std::numbers::pi * first * static_cast<double>(k)) * chirp(k);
  for (Eigen::Index k = 0; k < count; ++k) answer[k] = std::conj(chirp(k));
  for (Eigen::Index k = 1; k < n; ++k) answer[size - k] = std::conj(chirp(k));
  Eigen::FFT<double> transform;
  Eigen::VectorXcd a(size), b(size);
  transform.fwd(a.data(), turned.data(), size);
  transform.fwd(b.data(), answer.data(), size);
  a.array() *= b.array();
  transform.inv(b.data(), a.data(), size);
  Eigen::VectorXcd out(count);
  for (Eigen::Index f = 0; f < count; ++f) out[f] = b[f] * chirp(f);
  return out;
}

}  // namespace misfit
