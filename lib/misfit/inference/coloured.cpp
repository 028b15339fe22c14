#include "misfit/inference/coloured.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "misfit/core/text.h"
#include "misfit/core/watch.h"
#include "misfit/inference/own_clocks.h"
#include "misfit/inference/short_record.h"
#include "misfit/math/decompositions.h"
#include "misfit/math/spectrum.h"
#include "misfit/math/whiteness.h"

namespace misfit {
namespace {

constexpr Eigen::Index longest_transform = 16384, max_lags = 2048;

/// Fourier transform of the derivatives in one piece of an experiment (long ones are cut, so that a transform fits into memory).
struct Stretch {
  const std::vector<Eigen::Index>* place = nullptr;  ///< of its columns among all unknowns
  /// Per channel: frequencies × columns.
  std::vector<Eigen::MatrixXd> real, imaginary;
};

using Densities = std::vector<Eigen::MatrixXcd>;  // per frequency: channels × channels

/// coloured_covariance() for channels with one clock: products of residuals by lag, their spectral density, and with it the middle of the
/// sandwich H⁻¹ (N + excess + P) H⁻¹; sums over all pairs of samples are products in the frequency domain.

class Sandwich {
 public:
  Sandwich(const std::vector<ResidualRows>& experiments, const Eigen::MatrixXd& plain, Eigen::Index channels)
      : plain_(plain), channels_(channels) {
    Eigen::Index longest = 1;
    double count = 0.0;
    for (const auto& e : experiments) {
      longest = std::max(longest, e.r.size() / channels);
      count += static_cast<double>(e.r.array().isFinite().count());
    }
    const double per_channel = count / static_cast<double>(channels);
    lags_ = std::min(max_lags, longest / 3);
    size_ = power_of_two(std::min(longest + lags_, longest_transform));
    products_.assign(lags_ + 1, Eigen::MatrixXd::Zero(channels, channels));
    pairs_ = products_;
    for (const auto& e : experiments) {
      const Eigen::Index samples = e.r.size() / channels, most = size_ - lags_;
      for (Eigen::Index first = 0; first < samples; first += most) accumulate(e, first, std::min(most, samples - first));
    }
    const auto least = static_cast<int>(std::ceil(std::cbrt(per_channel)));
    out_.lags = correlation_length(products_, pairs_, least);
    double squares = 1.0;
    for (int k = 1; k <= 2 * out_.lags; ++k) squares += 2.0 * std::pow(flat_top(k, out_.lags), 2);
    out_.degrees = per_channel / squares;
  }

  ColouredCovariance run() {
    LagProducts deficit(2 * out_.lags + 1, Eigen::MatrixXd::Zero(channels_, channels_));
    const std::vector<Densities> by_plain = leverage(plain_);
    constexpr int rounds = 6;
    for (int round = 0;; ++round) {
      const Densities density = spectral_density(correlations(deficit), size_);
      out_.excess = excess(density);
      out_.covariance = plain_ + plain_ * out_.excess * plain_;
      if (round == rounds) break;
      deficit = bias_correction(density, by_plain, leverage(out_.covariance));
    }
    return out_;
  }

 private:
  void accumulate(const ResidualRows& e, Eigen::Index first, Eigen::Index samples) {
    Stretch stretch;
    stretch.place = &e.place;
    std::vector<Eigen::VectorXcd> residuals, masks;
    for (Eigen::Index a = 0; a < channels_; ++a) {
      Eigen::VectorXd r = Eigen::VectorXd::Zero(samples), mask = r;
      Eigen::MatrixXd real(size_ / 2 + 1, e.J.cols()), imaginary(size_ / 2 + 1, e.J.cols());
      for (Eigen::Index i = 0; i < samples; ++i) {
        const double value = e.r[(first + i) * channels_ + a];
        if (!std::isfinite(value)) continue;
        r[i] = value;
        mask[i] = 1.0;
      }
      Eigen::VectorXd column(samples);
      for (Eigen::Index c = 0; c < e.J.cols(); ++c) {
        look_at_watch();
        for (Eigen::Index i = 0; i < samples; ++i) column[i] = e.J((first + i) * channels_ + a, c);
        const Eigen::VectorXcd line = fourier(column, size_);
        real.col(c) = line.real();
        imaginary.col(c) = line.imag();
      }
      stretch.real.push_back(std::move(real));
      stretch.imaginary.push_back(std::move(imaginary));
      residuals.push_back(fourier(r, size_));
      masks.push_back(fourier(mask, size_));
    }
    add_products(residuals, products_);
    add_products(masks, pairs_);
    stretches_.push_back(std::move(stretch));
  }

  /// Adds Σ_i x_a,i x_b,i+k to `out`, for every pair of channels a, b and lag k.
  void add_products(const std::vector<Eigen::VectorXcd>& x, LagProducts& out) const {
    for (Eigen::Index a = 0; a < channels_; ++a) {
      for (Eigen::Index b = 0; b < channels_; ++b) {
        const auto& from = x[a];
        const auto& to = x[b];
        const Eigen::VectorXd by_lag = inverse_fourier(from.conjugate().cwiseProduct(to), size_);
        for (Eigen::Index k = 0; k <= lags_; ++k) out[k](a, b) += by_lag[k];
      }
    }
  }

  /// Estimates of E[v_a,i v_b,i+k] of the noise v, multiplied with the flat-top window: products of the residuals, and what the fit has
  /// taken out of them (`deficit`), over the number of pairs.
  LagProducts correlations(const LagProducts& deficit) {
    LagProducts out(deficit.size(), Eigen::MatrixXd::Zero(channels_, channels_));
    out_.largest_correlation = 0.0;
    out_.squared_correlations = Eigen::VectorXd::Ones(channels_);
    for (std::size_t k = 0; k < out.size() && k < products_.size(); ++k) {
      const Eigen::MatrixXd sums = products_[k] + deficit[k];
      for (Eigen::Index a = 0; a < channels_; ++a) {
        for (Eigen::Index b = 0; b < channels_; ++b) {
          constexpr double fewest = 0.5;  // pairs are counted by a transform: whole numbers but for rounding
          if (pairs_[k](a, b) > fewest) out[k](a, b) = flat_top(static_cast<int>(k), out_.lags) * sums(a, b) / pairs_[k](a, b);
        }
        if (k > 0 && out[0](a, a) > 0.0) out_.squared_correlations[a] += 2.0 * std::pow(out[k](a, a) / out[0](a, a), 2);
        if (k == 0 || std::abs(out[k](a, a)) <= std::abs(out_.largest_correlation) * out[0](a, a)) continue;
        out_.largest_correlation = out[k](a, a) / out[0](a, a);
        out_.largest_lag = static_cast<int>(k);
      }
    }
    return out;
  }

  [[nodiscard]] Eigen::MatrixXd local(const Eigen::MatrixXd& whole, const Stretch& stretch) const {
    return whole(*stretch.place, *stretch.place);
  }

  /// Spectrum of S A Sᵀ, A over the unknowns: conj(z) A zᵀ at each frequency of every stretch, z the transformed derivatives, channels ×
  /// columns.
  std::vector<Densities> leverage(const Eigen::MatrixXd& A) const {
    std::vector<Densities> out;
    for (const Stretch& s : stretches_) {
      const Eigen::MatrixXd here = local(A, s);
      Densities density(size_ / 2 + 1, Eigen::MatrixXcd(channels_, channels_));
      for (std::size_t b = 0; b < s.real.size(); ++b) {
        const Eigen::MatrixXd real = s.real[b] * here, imaginary = s.imaginary[b] * here;
        for (std::size_t a = 0; a < s.real.size(); ++a) {
          const Eigen::VectorXd even =
              s.real[a].cwiseProduct(real).rowwise().sum() + s.imaginary[a].cwiseProduct(imaginary).rowwise().sum();
          const Eigen::VectorXd odd = s.real[a].cwiseProduct(imaginary).rowwise().sum() - s.imaginary[a].cwiseProduct(real).rowwise().sum();
          for (Eigen::Index f = 0; f < even.size(); ++f) density[f](a, b) = {even[f], odd[f]};
        }
      }
      out.push_back(std::move(density));
    }
    return out;
  }

  /// E[v vᵀ − r rᵀ] summed by lag: the residuals r of a fit are smaller than the noise v, and less correlated.
  LagProducts bias_correction(const Densities& density, const std::vector<Densities>& by_plain,
                              const std::vector<Densities>& by_covariance) const {
    const std::size_t half = size_ / 2 + 1;
    Densities Pi_R(half, Eigen::MatrixXcd::Zero(channels_, channels_)), S_Sigma_S = Pi_R;
    for (std::size_t s = 0; s < stretches_.size(); ++s) {
      for (std::size_t f = 0; f < half; ++f) {
        const Eigen::MatrixXcd one = by_plain[s][f] * density[f];
        Pi_R[f] += one + one.adjoint();
        S_Sigma_S[f] += by_covariance[s][f];
      }
    }
    LagProducts out(2 * out_.lags + 1, Eigen::MatrixXd::Zero(channels_, channels_));
    const auto series = [&](const Densities& from, Eigen::Index a, Eigen::Index b) {
      Eigen::VectorXcd line(half);
      for (std::size_t f = 0; f < half; ++f) line[f] = from[f](a, b);
      return inverse_fourier(line, size_);
    };
    for (Eigen::Index a = 0; a < channels_; ++a) {
      for (Eigen::Index b = 0; b < channels_; ++b) {
        const Eigen::VectorXd lags_Pi_R = series(Pi_R, a, b), lags_S_Sigma_S = series(S_Sigma_S, a, b);
        for (std::size_t k = 0; k < out.size() && k < pairs_.size(); ++k) {
          const double share = pairs_.front()(a, a) > 0.0 ? pairs_[k](a, b) / pairs_.front()(a, a) : 0.0;
          out[k](a, b) = share * lags_Pi_R[k] - lags_S_Sigma_S[k];
        }
      }
    }
    return out;
  }

  /// conj(density), on the diagonal less the 1 of white residuals, with the weight of each frequency in a sum over the whole spectrum (all
  /// but the first and the last stand for two).
  [[nodiscard]] Eigen::VectorXcd weighted(const Densities& density, Eigen::Index a, Eigen::Index b) const {
    Eigen::VectorXcd out(std::ssize(density));
    for (Eigen::Index f = 0; f < out.size(); ++f) {
      const double weight = (f == 0 || f == out.size() - 1 ? 1.0 : 2.0) / static_cast<double>(size_);
      const std::complex<double> g = std::conj(density[f](a, b));
      out[f] = {weight * (g.real() - (a == b ? 1.0 : 0.0)), weight * g.imag()};
    }
    return out;
  }

  /// Σ_ij S_iᵀ (ℛ(i − j) − 1 at equal i, j and channel) S_j over all unknowns.
  Eigen::MatrixXd excess(const Densities& density) const {
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(plain_.rows(), plain_.cols());
    const Eigen::Index half = size_ / 2 + 1;
    for (const Stretch& s : stretches_) {
      Eigen::MatrixXd here = Eigen::MatrixXd::Zero(s.real.front().cols(), s.real.front().cols());
      for (std::size_t a = 0; a < s.real.size(); ++a) {
        Eigen::MatrixXd real = Eigen::MatrixXd::Zero(half, here.cols()), imaginary = real;
        for (std::size_t b = 0; b < s.real.size(); ++b) {
          const Eigen::VectorXcd line = weighted(density, a, b);
          const Eigen::VectorXd even = line.real(), odd = line.imag();
          real += even.asDiagonal() * s.real[b];
          imaginary += even.asDiagonal() * s.imaginary[b];
          if (a == b) continue;
          real -= odd.asDiagonal() * s.imaginary[b];
          imaginary += odd.asDiagonal() * s.real[b];
        }
        here += s.real[a].transpose() * real + s.imaginary[a].transpose() * imaginary;
      }
      out(*s.place, *s.place) += here;
    }
    return 0.5 * (out + out.transpose());
  }

  const Eigen::MatrixXd& plain_;
  Eigen::Index channels_, size_ = 2, lags_ = 0;
  LagProducts products_, pairs_;
  std::vector<Stretch> stretches_;
  ColouredCovariance out_;
};

bool counts(const ResidualRows& e, Eigen::Index channels, Eigen::Index sample, Eigen::Index channel) {
  return std::isfinite(e.r[sample * channels + channel]);
}

bool have_own_clocks(const std::vector<ResidualRows>& experiments, Eigen::Index channels) {
  MeasuredTogether together(channels);
  Eigen::VectorXd measured(channels);
  for (const ResidualRows& e : experiments) {
    for (Eigen::Index i = 0; i < e.r.size() / channels; ++i) {
      for (Eigen::Index a = 0; a < channels; ++a) measured[a] = counts(e, channels, i, a) ? 1.0 : 0.0;
      together.add(measured);
    }
  }
  return together.have_own_clocks();
}

/// The residuals of one channel that count, without the gaps between them: lags are then in its own samples.
std::vector<ResidualRows> of_channel(const std::vector<ResidualRows>& experiments, Eigen::Index channels, Eigen::Index channel) {
  std::vector<ResidualRows> out;
  for (const ResidualRows& e : experiments) {
    std::vector<Eigen::Index> rows;
    for (Eigen::Index i = 0; i < e.r.size() / channels; ++i) {
      if (counts(e, channels, i, channel)) rows.push_back(i * channels + channel);
    }
    if (!rows.empty()) out.push_back({e.J(rows, Eigen::all), e.r(rows), e.place});
  }
  return out;
}

/// Each channel by itself, lags in its own samples; correlations between channels are neglected, since their samples do not pair.
ColouredCovariance by_own_clocks(const std::vector<ResidualRows>& experiments, const Eigen::MatrixXd& plain, Eigen::Index channels) {
  ColouredCovariance out = white_covariance(plain, channels);
  for (Eigen::Index a = 0; a < channels; ++a) {
    const std::vector<ResidualRows> own = of_channel(experiments, channels, a);
    double measurements = 0.0;
    for (const ResidualRows& e : own) measurements += static_cast<double>(e.r.size());
    if (own.empty()) continue;
    const ColouredCovariance one = residual_covariance(own, plain, 1, measurements);
    out.excess += one.excess;
    out.squared_correlations[a] = one.squared_correlations[0];
    out.degrees = std::min(out.degrees, one.degrees);
    out.lags = std::max(out.lags, one.lags);
    if (std::abs(one.largest_correlation) <= std::abs(out.largest_correlation)) continue;
    out.largest_correlation = one.largest_correlation;
    out.largest_lag = one.largest_lag;
  }
  out.covariance = plain + plain * out.excess * plain;
  return out;
}

}  // namespace

ColouredCovariance coloured_covariance(const std::vector<ResidualRows>& experiments, const Eigen::MatrixXd& plain, Eigen::Index channels) {
  if (channels > 1 && have_own_clocks(experiments, channels)) return by_own_clocks(experiments, plain, channels);
  return Sandwich(experiments, plain, channels).run();
}

bool residuals_are_white(const std::vector<ResidualRows>& experiments, Eigen::Index channels, double unknowns) {
  constexpr double coloured_p = 0.05;
  constexpr int lags = 10;
  for (Eigen::Index a = 0; a < channels; ++a) {
    std::vector<std::vector<double>> series;
    for (const ResidualRows& e : experiments) {
      series.emplace_back();
      for (Eigen::Index i = a; i < e.r.size(); i += channels) series.back().push_back(e.r[i]);
    }
    if (whiteness(joined_series(series), 1, lags, unknowns / static_cast<double>(channels)).p_value < coloured_p) return false;
  }
  return true;
}

ColouredCovariance widening_only(ColouredCovariance covariance, const Eigen::MatrixXd& plain) {
  const std::optional<Eigen::MatrixXd> L = cholesky(plain);
  if (!L) return covariance;
  const SymmetricEigen eigen = symmetric_eigen(L->transpose() * covariance.excess * *L);
  const Eigen::MatrixXd back = L->transpose().triangularView<Eigen::Upper>().solve(eigen.vectors);
  covariance.excess = back * eigen.values.cwiseMax(0.0).asDiagonal() * back.transpose();
  covariance.covariance = plain + plain * covariance.excess * plain;
  return covariance;
}

ColouredCovariance white_covariance(const Eigen::MatrixXd& plain, Eigen::Index channels) {
  ColouredCovariance out;
  out.covariance = plain;
  out.excess = Eigen::MatrixXd::Zero(plain.rows(), plain.cols());
  out.squared_correlations = Eigen::VectorXd::Ones(channels);
  return out;
}

ColouredCovariance residual_covariance(const std::vector<ResidualRows>& experiments, const Eigen::MatrixXd& plain, Eigen::Index channels,
                                       double degrees) {
  if (degrees >= kShortRecord) return coloured_covariance(experiments, plain, channels);
  double measurements = 0.0;
  for (const ResidualRows& e : experiments) measurements += static_cast<double>(e.r.array().isFinite().count());
  if (residuals_are_white(experiments, channels, measurements - degrees)) return white_covariance(plain, channels);
  return widening_only(coloured_covariance(experiments, plain, channels), plain);
}

std::string in_words(const ColouredCovariance& covariance) {
  if (covariance.lags == 0 && std::isinf(covariance.degrees))
    return "no autocorrelation of the residuals is significant in this short record: sigmas are those of white residuals";
  return "allows for autocorrelated residuals (Morelli and Klein): correlations up to lag " + std::to_string(covariance.lags) +
         " samples count, the largest is " + format_value(std::round(1000.0 * covariance.largest_correlation) / 1000.0) + " at lag " +
         std::to_string(covariance.largest_lag) + "; plain_sigma is that of white residuals";
}

}  // namespace misfit
