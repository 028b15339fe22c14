#include "misfit/discover/free_run.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "misfit/discover/discover.h"
#include "tests/discover/record.h"

namespace misfit {
namespace {

using namespace testing_records;

/// Keeps pointers to the recordings.
FilterEstimate estimate_of(const std::vector<Signals>& recorded) {
  ModelRequest model = cart({effect("viscous_friction")});
  model.parameters["stiffness"].free = true;
  return estimate_filter(assemble(model, registry()), {}, recorded);
}

TEST(FreeRun, IsNotLookedAtWhereTheRandomForceDoesNothing) {
  Signals swing;  // of a free cart
  swing.name = "swing";
  swing.inputs.push_back({"drive", "N", {}});
  swing.measured = {{"position_reading", "-", {}}, {"speed_reading", "m/s", {}}};
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  const double w = std::sqrt(30.0 / 2.0);
  for (int i = 0; i < 600; ++i) {
    swing.t.push_back(0.05 * i);
    swing.inputs[0].values.push_back(0.0);
    swing.measured[0].values.push_back(0.5 * std::cos(w * swing.t.back()) + 2e-3 * normal(random));
    swing.measured[1].values.push_back(-0.5 * w * std::sin(w * swing.t.back()) + 1e-2 * normal(random));
  }
  const std::vector<Signals> recorded = {swing};
  EXPECT_FALSE(free_run(estimate_of(recorded), {recorded}));
}

TEST(FreeRun, ShowsWhatTheRandomForceTakesOver) {
  const std::vector<Signals> recorded = {
      record_of_cart({effect("periodic_forcing")}, {{"cosine", 0.4}, {"sine", 0.3}, {"frequency", 0.15}})};
  const FilterEstimate estimate = estimate_of(recorded);
  const auto calm = free_run(estimate, {recorded});
  ASSERT_TRUE(calm);
  EXPECT_LT(calm->noise.force, 0.05 * estimate.noise.force);
  EXPECT_GT(calm->noise.channels.front().white, 1.2 * estimate.noise.channels.front().white);
  EXPECT_LT(calm->objective, estimate.objective) << "the estimate is the maximum";
}

/// A slow random force may have moved a parameter to where it explains nothing; the free run is fitted.
TEST(FreeRun, HasTheParametersThatItFitsBest) {
  const std::vector<Signals> recorded = {
      record_of_cart({effect("periodic_forcing")}, {{"cosine", 0.4}, {"sine", 0.3}, {"frequency", 0.15}})};
  FilterEstimate moved = estimate_of(recorded);
  const auto stiffness = static_cast<std::size_t>(moved.model.find_parameter("stiffness"));
  const double there = moved.model.parameters[stiffness].value;
  for (Model* model : {&moved.model, &moved.forced.model}) model->parameters[stiffness].value = 1.1 * there;
  const auto calm = free_run(moved, {recorded});
  ASSERT_TRUE(calm);
  EXPECT_NEAR(calm->model.parameters[stiffness].value, there, 0.03 * there);
}

/// Of a free run of 100 samples: three forces on one state explain more than any on another one, which lacks something of its own.
TEST(FreeRun, NominatesTheBestForceOfEveryState) {
  FilterEstimate calm;
  calm.traces.resize(1);
  calm.traces[0].counted = 100;
  std::vector<CandidateModel> models;
  models.reserve(6);
  std::vector<ScreeningResult> screened;
  const auto add = [&](const std::string& effect, const std::string& port, double explained, CandidateFamily family) {
    CandidateModel model;
    model.effect = effect;
    model.family = family;
    model.port_names = {port};
    models.push_back(std::move(model));
    ScreeningResult& s = screened.emplace_back();
    s.candidate_model = &models.back();
    s.result.chi2 = explained;
    s.result.dof = 1;
  };
  add("exchange", "dT2/dt", 40.0, CandidateFamily::physics);
  add("delay", "dT1/dt", 51.0, CandidateFamily::physics);
  add("radiation", "dT2/dt", 39.0, CandidateFamily::physics);
  add("input_lag", "dT1/dt", 50.0, CandidateFamily::physics);
  add("sensor_lag", "temperature_1", 60.0, CandidateFamily::sensor);
  add("rate_limit", "dT1/dt", 49.0, CandidateFamily::physics);
  std::vector<std::string> found;
  for (const ScreeningResult* s : forces_shown_by(calm, screened)) found.push_back(s->candidate_model->effect);
  EXPECT_EQ(found, (std::vector<std::string>{"delay", "input_lag", "rate_limit", "exchange"}));
  screened[0].result.chi2 = screened[2].result.chi2 = 19.0;
  EXPECT_EQ(forces_shown_by(calm, screened).size(), 3U) << "less than a fifth";
}

}  // namespace
}  // namespace misfit
