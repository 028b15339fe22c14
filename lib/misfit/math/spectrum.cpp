#include "misfit/math/spectrum.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/FFT>

#include "misfit/core/lists.h"
#include "misfit/math/decompositions.h"

namespace misfit {

Eigen::VectorXcd fourier(const Eigen::Ref<const Eigen::VectorXd>& series, Eigen::Index size) {
  Eigen::VectorXd padded = Eigen::VectorXd::Zero(size);
  padded.head(series.size()) = series;
  Eigen::FFT<double> transform;
  transform.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  Eigen::VectorXcd out(size / 2 + 1);
  transform.fwd(out.data(), padded.data(), size);
  return out;
}

Eigen::VectorXd inverse_fourier(const Eigen::VectorXcd& half, Eigen::Index size) {
  Eigen::FFT<double> transform;
  transform.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  Eigen::VectorXd out(size);
  transform.inv(out.data(), half.data(), size);
  return out;
}

Eigen::Index power_of_two(Eigen::Index least) {
  Eigen::Index size = 2;
  while (size < least) size *= 2;
  return size;
}

namespace {

/// Does any correlation at lag k stand out of chance? `spread`, Σ ρ_aa ρ_bb over the lags before, takes this lag in.
bool stands_out(const LagProducts& products, const LagProducts& pairs, std::size_t k, Eigen::MatrixXd& spread) {
  const Eigen::Index channels = products.front().rows();
  const auto correlation = [&](Eigen::Index a, Eigen::Index b) {
    const double size = std::sqrt(products.front()(a, a) * products.front()(b, b) / (pairs.front()(a, a) * pairs.front()(b, b)));
    return pairs[k](a, b) > 0.0 && size > 0.0 ? products[k](a, b) / pairs[k](a, b) / size : 0.0;
  };
  bool any = false;
  for (Eigen::Index a = 0; a < channels; ++a) {
    for (Eigen::Index b = 0; b < channels; ++b) {
      const double n = pairs.front()(a, a), here = pairs[k](a, b);
      if (!(here > 1.0)) continue;
      constexpr double limit_factor = 1.75;
      const double chance = std::sqrt(std::max(spread(a, b), 1.0) / here);
      any = any || std::abs(correlation(a, b)) > limit_factor * std::sqrt(std::log10(n)) * chance;
      spread(a, b) += 2.0 * correlation(a, a) * correlation(b, b);
    }
  }
  return any;
}

}  // namespace

int correlation_length(const LagProducts& products, const LagProducts& pairs, int least) {
  constexpr int quiet_lags = 20;
  const auto lags = int_size(products) - 1;
  Eigen::MatrixXd spread = Eigen::MatrixXd::Ones(products.front().rows(), products.front().cols());
  int last = 0, quiet = 0, known = 0;
  for (int lag = 1; lag <= lags && (quiet < quiet_lags || known < least); ++lag) {
    if (!(pairs[lag].maxCoeff() > 1.0)) continue;
    ++quiet;
    ++known;
    if (stands_out(products, pairs, lag, spread)) {
      last = lag;
      quiet = 0;
    }
    if (known == least) last = std::max(last, lag);
  }
  return std::min(std::max(last, least), std::max(lags / 2, 0));
}

double flat_top(int lag, int m) {
  if (lag <= m) return 1.0;
  return std::max(0.0, 2.0 - 1.0 * lag / m);
}

std::vector<Eigen::MatrixXcd> spectral_density(const LagProducts& covariances, Eigen::Index size) {
  const Eigen::Index channels = covariances.front().rows(), half = size / 2 + 1;
  std::vector<Eigen::MatrixXcd> out(half, Eigen::MatrixXcd(channels, channels));
  for (Eigen::Index a = 0; a < channels; ++a) {
    for (Eigen::Index b = 0; b < channels; ++b) {
      Eigen::VectorXd circular = Eigen::VectorXd::Zero(size);
      circular[0] = covariances.front()(a, b);
      for (std::size_t k = 1; k < covariances.size(); ++k) {
        circular[k] = covariances[k](a, b);
        circular[size - k] = covariances[k](b, a);
      }
      const Eigen::VectorXcd line = fourier(circular, size);
      for (Eigen::Index f = 0; f < half; ++f) out[f](a, b) = line[f];
    }
  }
  for (Eigen::MatrixXcd& density : out) {
    if (channels == 1) {
      density(0, 0) = std::max(density(0, 0).real(), 0.0);
      continue;
    }
    density = nearest_positive_semidefinite(density);
  }
  return out;
}

}  // namespace misfit
