#include "misfit/math/spectrum.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace misfit {
namespace {

struct Correlogram {
  LagProducts products, pairs;
};

/// Of first-order noise of correlation `phi` from one measurement to the next, read at every `every`-th of the samples only.
Correlogram first_order(int measurements, int every, double phi, int lags) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  std::vector<double> v(static_cast<std::size_t>(measurements * every), std::nan(""));
  double at = normal(random);
  for (int i = 0; i < measurements; ++i) {
    v[static_cast<std::size_t>(i * every)] = at;
    at = phi * at + std::sqrt(1.0 - phi * phi) * normal(random);
  }
  Correlogram out;
  for (int k = 0; k <= lags; ++k) {
    double sum = 0.0, count = 0.0;
    for (std::size_t i = 0; i + static_cast<std::size_t>(k) < v.size(); ++i) {
      const double product = v[i] * v[i + static_cast<std::size_t>(k)];
      if (!std::isfinite(product)) continue;
      sum += product;
      count += 1.0;
    }
    out.products.emplace_back(Eigen::MatrixXd::Constant(1, 1, sum));
    out.pairs.emplace_back(Eigen::MatrixXd::Constant(1, 1, count));
  }
  return out;
}

TEST(MemoryOf, WhiteMeasurementsIsTheLeast) {
  const Correlogram white = first_order(2000, 1, 0.0, 400);
  EXPECT_EQ(correlation_length(white.products, white.pairs, 13), 13);
}

TEST(MemoryOf, FirstOrderNoiseIsAsLongAsItsCorrelationStandsOut) {
  const Correlogram one = first_order(2000, 1, 0.9, 400);
  // By chance sqrt(Σ ρ²/n) = sqrt(9.5/2000) = 0.07; 1.75 sqrt(log10 2000) = 3.2 of them are 0.22 = 0.9^14.
  EXPECT_NEAR(correlation_length(one.products, one.pairs, 5), 14, 5);
}

TEST(MemoryOf, MeasurementsFarApartIsThatOfTheMeasurementsInSamples) {
  const Correlogram each = first_order(600, 1, 0.9, 100), far = first_order(600, 50, 0.9, 5000);
  const int measurements = correlation_length(each.products, each.pairs, 9);
  EXPECT_EQ(correlation_length(far.products, far.pairs, 9), 50 * measurements);
}

}  // namespace
}  // namespace misfit
