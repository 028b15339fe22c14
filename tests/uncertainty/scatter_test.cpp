#include "misfit/uncertainty/scatter.h"

#include <gtest/gtest.h>

#include <cmath>

namespace misfit {
namespace {

BatchRow row(const std::string& study, const std::string& method, double value, double sigma) {
  BatchRow out;
  out.study = study;
  out.method = method;
  out.status = "converged";
  out.values["trim"] = {value, sigma, "rad"};
  return out;
}

/// Weights 4 : 1 → mean 1.2; χ² = (0.2/0.5)² + (0.8/1)² = 0.8, one degree of freedom: p = 0.3711.
TEST(Scatter, MeanIsWeightedAndTheTestKnown) {
  const auto summary = summarise({row("a", "m", 1.0, 0.5), row("b", "m", 2.0, 1.0)});
  ASSERT_EQ(summary.size(), 1U);
  EXPECT_EQ(summary[0].count, 2U);
  EXPECT_NEAR(summary[0].mean, 1.2, 1e-12);
  EXPECT_NEAR(summary[0].mean_sigma, 1.0 / std::sqrt(5.0), 1e-12);
  EXPECT_NEAR(summary[0].scatter, std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(summary[0].own_sigma, std::sqrt(0.625), 1e-12);
  EXPECT_NEAR(summary[0].p_value.value(), 0.37109, 1e-4);
}

TEST(Scatter, WhatHasNotConvergedIsLeftOut) {
  auto stuck = row("c", "m", 50.0, 0.01);
  stuck.status = "not_converged";
  const auto summary = summarise({row("a", "m", 1.0, 0.5), stuck, row("b", "m", 2.0, 1.0)});
  ASSERT_EQ(summary.size(), 1U);
  EXPECT_EQ(summary[0].count, 2U);
  EXPECT_NEAR(summary[0].mean, 1.2, 1e-12);
}

TEST(Scatter, WithoutSigmasThereIsAPlainMeanAndNoTest) {
  const auto summary = summarise({row("a", "m", 1.0, 0.5), row("b", "m", 2.0, 0.0)});
  EXPECT_NEAR(summary[0].mean, 1.5, 1e-12);
  EXPECT_FALSE(summary[0].p_value);
  EXPECT_EQ(summary[0].own_sigma, 0.0);
}

TEST(Scatter, MethodsStayApartAndOneStudyIsNoScatter) {
  const auto summary = summarise({row("a", "m", 1.0, 0.5), row("a", "n", 3.0, 0.5), row("b", "m", 1.0, 0.5)});
  ASSERT_EQ(summary.size(), 1U);
  EXPECT_EQ(summary[0].method, "m");
}

}  // namespace
}  // namespace misfit
