// A curve of unknown form in the model, with its knots too far apart for a stop: what a finer curve would describe is no effect beside it.
#include "misfit/discover/beside_a_curve.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "misfit/discover/discover.h"
#include "misfit/inference/curves.h"
#include "tests/discover/slide.h"
#include "tests/model/declared_texts.h"

namespace misfit {
namespace {

using namespace testing_models;

TEST(BesideACurve, AStopBetweenItsKnotsIsNoErrorOfTheSensor) {
  const auto stop = [](double x) { return -150.0 * std::max(x - 0.063, 0.0); };
  const std::vector<Signals> signals = {slide({.samples = 1500, .force = 6.0, .seed = 4}, stop)};
  const auto known = registry_with(slide_of_unknown_mass_text);
  ModelRequest request = request_of("text", {effect("unknown_force", {{"of", "x"}, {"port", "dv/dt"}})});
  request.parameters["k"].free = false;  // the curve takes over what it does
  choose_all_knots(request, *known, signals, 10);
  const FilterEstimate estimate = estimate_filter(assemble(request, *known), {}, signals);
  const Discovery found = discover({estimate, request, *known, signals});
  for (const Candidate& c : found.candidates) EXPECT_FALSE(c.accepted) << c.effect << ": " << found.verdict;
  const auto scale =
      std::find_if(found.candidates.begin(), found.candidates.end(), [](const Candidate& c) { return c.effect == "sensor_scale"; });
  ASSERT_NE(scale, found.candidates.end());
  EXPECT_LT(scale->p_value, 1e-6) << "by its score alone it would be one";
  EXPECT_TRUE(scale->absorbed);
  EXPECT_THAT(scale->why, testing::HasSubstr("if its knots were closer together"));
}

}  // namespace
}  // namespace misfit
