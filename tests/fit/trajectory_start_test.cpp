#include "misfit/fit/trajectory_start.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "misfit/fit/filter/filter_error.h"
#include "misfit/fit/regression/equation_error.h"
#include "misfit/inference/curves.h"
#include "tests/fit/flight.h"
#include "tests/fit/planar_model.h"

namespace misfit {
namespace {

std::vector<double> of_curve(const Model& model, const std::string& name) {
  const Curve* curve = model.find_curve(name);
  if (curve == nullptr) throw std::runtime_error(name + " is no curve");
  std::vector<double> out;
  for (int i = 0; i < curve->spline.size(); ++i) out.push_back(model.parameters[static_cast<std::size_t>(curve->first + i)].value);
  return out;
}

bool all_zero(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return v == 0.0; });
}

TEST(TrajectoryStart, OfADrivenFlightHasItsStaticCurveAndNoDamping) {
  const std::vector<Signals> flights{testing_flight::fly(20.0, 3)};
  const Model asked = assemble(testing_flight::request_for(flights), testing_flight::registry());
  const TrajectoryStart start = trajectory_start(asked, flights);
  ASSERT_TRUE(start.regressed && start.from.fit.driven);
  EXPECT_FALSE(all_zero(of_curve(start.from.model, "C_m")));
  EXPECT_TRUE(all_zero(of_curve(start.from.model, "C_mq")));
}

TEST(TrajectoryStart, OfADrivenFlightKeepsTheDampingThatTheStudyHolds) {
  const std::vector<Signals> flights{testing_flight::fly(20.0, 3)};
  Model asked = assemble(testing_flight::request_for(flights), testing_flight::registry());
  const Curve& damping = *asked.find_curve("C_mq");
  for (int i = 0; i < damping.spline.size(); ++i) {
    Parameter& p = asked.parameters[static_cast<std::size_t>(damping.first + i)];
    p.value = -0.1;
    p.free = false;
  }
  const TrajectoryStart start = trajectory_start(asked, flights);
  ASSERT_TRUE(start.regressed && start.from.fit.driven);
  EXPECT_THAT(of_curve(start.from.model, "C_mq"), testing::Each(-0.1));
}

TEST(TrajectoryStart, OfAFreeMotionKeepsItsDamping) {
  const std::vector<Signals> motion{testing_planar::validation_signals()};
  ModelRequest request = testing_planar::eq_8();
  request.curves.clear();
  choose_all_knots(request, testing_planar::registry(), motion, 10);
  const Model asked = assemble(request, testing_planar::registry());
  const FittedModel whole = equation_error(asked, motion);
  int called = 0;
  const TrajectoryStart start = trajectory_start(asked, motion, [&]() -> const FittedModel& {
    ++called;
    return whole;
  });
  EXPECT_EQ(called, 1);
  ASSERT_TRUE(start.regressed);
  EXPECT_FALSE(start.from.fit.driven);
  EXPECT_EQ(of_curve(start.from.model, "C_m_alphadot"), of_curve(whole.model, "C_m_alphadot"));
}

TEST(TrajectoryStart, AFreeShapeStaysWhereTheStudyPutsItAndIsFreeAfterwards) {
  const std::vector<Signals> motion{testing_planar::validation_signals()};
  ModelRequest request = testing_planar::eq_8({"static_moment", "pitch_damping", "periodic_forcing"});
  request.curves.clear();
  choose_all_knots(request, testing_planar::registry(), motion, 10);
  constexpr double hertz = 1.3;
  request.parameters["frequency"].value = hertz;
  request.parameters["frequency"].free = true;
  const Model asked = assemble(request, testing_planar::registry());
  const TrajectoryStart start = trajectory_start(asked, motion, []() -> const FittedModel& { throw std::logic_error("not asked for"); });
  const Parameter& frequency = start.from.model.parameters[static_cast<std::size_t>(asked.find_parameter("frequency"))];
  EXPECT_EQ(frequency.value, hertz);
  EXPECT_TRUE(frequency.free);
  ASSERT_EQ(start.from.penalties.size(), 2U);
  for (const auto& p : start.from.penalties) EXPECT_GT(p.lambda, 0.0);
}

}  // namespace
}  // namespace misfit
