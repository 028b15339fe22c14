// Experiments of different size and outputs that show little, fitted together by output error.
#include <gtest/gtest.h>

#include "tests/fit/first_order.h"

namespace misfit {
namespace {

using namespace testing_first_order;

void expect_right(const Fit& fit) {
  ASSERT_EQ(fit.status, FitStatus::converged) << fit.message;
  for (const char* name : {"a", "b"}) EXPECT_NEAR(fit.parameters.at(name).value, 1.0, 4.0 * fit.parameters.at(name).sigma) << name;
}

TEST(SeveralExperiments, OneAtRestWhoseSensorShowsAConstantDoesNotLoseTheOthers) {
  Signals rest = record("rest", 0.0, 1, 0.0);
  for (double& v : rest.measured[0].values) v = 0.004;
  expect_right(fitted(one_output, {record("moves", 1.0, 2), rest}).fit);
}

TEST(SeveralExperiments, OneAtRestWithABiasDoesNotLoseTheOthers) {
  Signals rest = record("rest", 0.0, 1, 0.0);
  for (double& v : rest.measured[0].values) v += 0.08;
  const Fit fit = fitted(one_output, {record("moves", 1.0, 2), rest}).fit;
  EXPECT_EQ(fit.status, FitStatus::converged) << fit.message;
}

TEST(SeveralOutputs, OneThatShowsNothingButAConstantDoesNotLoseTheMotion) {
  Signals both = record("both", 1.0, 2, 0.5, 2);
  for (double& v : both.measured[1].values) v = 0.0;
  std::string text = two_outputs;
  text.replace(text.find("formula = \"x\", noise", text.find("z =")), 20, "formula = \"0.001*x\", noise");
  expect_right(fitted(text, {both}).fit);
}

/// A ripple that the model lacks, 7 % of the motion where there is motion, ten times what the experiment at rest shows.
TEST(SeveralExperiments, WhatTheModelLeavesOfThemIsComparedWithTheMotionOfAll) {
  Signals moves = record("moves", 1.0, 2);
  for (std::size_t i = 0; i < moves.samples(); ++i) moves.measured[0].values[i] += 0.05 * std::sin(3.0 * moves.t[i]);
  const Fit fit = fitted(one_output, {record("rest", 0.0, 1, 0.0), moves}).fit;
  EXPECT_EQ(fit.status, FitStatus::converged) << fit.message;
  EXPECT_TRUE(fit.coloured);
}

}  // namespace
}  // namespace misfit
