// The same blocks for the terminal and the report: units, headings, what is left out.
#include "misfit/show/results.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "misfit/data/curve_coefficient.h"
#include "tests/core/temporary_folder.h"

namespace misfit {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

TEST(ShownComparison, HasUnitsTheMethodsSideBySideAndWhatWasLeftOut) {
  Comparison c;
  MethodSummary one;
  one.method = "equation_error";
  one.trim = Estimate{10.0 * degree, 0.3 * degree, "rad"};
  one.slopes = {{"C_m", {-0.35, 0.04, "1/rad"}}};
  one.parameters = {{"k", {0.9265, 0.0024, "1/s"}}};
  c.methods = {one};
  c.reference_trims = {{"static_test", {12.0 * degree, 0.0, "rad"}}};
  c.trims = {{"equation_error", "static_test", true, {}, 4.0, "the trim of equation_error is 2 deg below that of static_test (4.0 sigma)"}};
  c.parameters = {{"k", "equation_error", "output_error", {}, 30.3, "k of equation_error is 0.0734 below that of output_error"}};
  c.not_compared = {{"output_error", "declined: the motion is driven"}};
  expect_parts(as_text(blocks_of(c)),
               {"equation_error", "static_test (reference)", "10.00 ± 0.30 deg", "-0.350 ± 0.040 1/rad", "0.9265 ± 0.0024 1/s",
                "The trim of equation_error", "(4.0 sigma).", "! k of equation_error is 0.0734", "Not compared", "output_error: declined"});
}

TEST(ShownDiscovery, SaysTheVerdictFirstAndNamesOnlyOtherEffectsAsIndistinguishable) {
  Discovery d;
  Candidate wake;
  wake.rank = 1;
  wake.effect = "strut_wake";
  wake.group = {"strut_wake", "coning"};
  wake.predicted_drop = 275.0;
  wake.p_value = 0.0;
  wake.why = "it is";
  d.candidates = {wake};
  d.verdict = "missing: strut_wake";
  d.tried = {"14 effects", "3 sensors"};
  d.not_tried = {{{"brake", {}}, "unit 'x' is unknown"}};
  const std::string text = as_text(blocks_of(d));
  EXPECT_LT(text.find("Missing: strut_wake."), text.find("rank"));
  expect_parts(text, {"275.0", "< 1e-300", "coning", "strut_wake: it is", "2 in discovery.json", "Effects that could not be tried",
                      "brake: not tried: unit 'x' is unknown"});
  EXPECT_EQ(text.find("strut_wake, coning"), std::string::npos);
  EXPECT_EQ(text.find("Estimates of a candidate"), std::string::npos) << "none is accepted";
  d.candidates.front().accepted = true;
  expect_parts(as_text(blocks_of(d)), {"Missing: strut_wake.", "Estimates of a candidate are those of the search"});
}

TEST(ShownDiscovery, CandidatesThatAreNotSignificantShareALineWithTheSmallestP) {
  Discovery d;
  for (const char* why : {"a part of it", "not significant: family-wise p = 0.5", "not significant: family-wise p = 0.33",
                          "not significant: family-wise p = 0.6; its refit does not explain the free run"}) {
    Candidate c;
    c.effect = "effect_" + std::to_string(d.candidates.size());
    c.why = why;
    c.p_value = d.candidates.size() == 1 ? 0.5 : 0.33;
    d.candidates.push_back(c);
  }
  const Blocks blocks = blocks_of(d);
  const std::string text = as_text(blocks);
  expect_parts(text, {"effect_0: a part of it", "effect_3: not significant: family-wise p = 0.6; its refit does not explain the free run",
                      "2 others: not significant, smallest p = 0.33 (effect_2)"});
  EXPECT_EQ(text.find("effect_1: "), std::string::npos);
  const auto* folded = std::get_if<List>(&blocks.all().back());
  ASSERT_NE(folded, nullptr);
  EXPECT_THAT(folded->items, testing::ElementsAre("effect_1: p = 0.5", "effect_2: p = 0.33"));
}

TEST(ShownUncertainty, HasTheBandOfThreeSigmasAndFourNumbersPerTableOfShares) {
  Uncertainty u;
  u.method = "sliding_bin";
  u.runs = 100;
  u.failed = 1;
  u.failures = {{"not_converged", 1}};
  const std::vector<VarianceShare> shares{{"mass", 0.9, 0.01, 0.5 * degree}};
  for (const char* name : {"trim", "b", "c", "d", "e"})
    u.numbers.push_back({name, "rad", 12.0 * degree, 0.1 * degree, 12.0 * degree, degree, 99, shares, 0.05});
  const std::string text = as_text(blocks_of(u));
  expect_parts(text, {"12.00 ± 0.10 deg", "12.0 deg", "9.0 to 15.0 deg", "90.0 ± 1.0 %", "+0.5 deg", "interactions",
                      "1 of 100 runs gave no result"});
  EXPECT_NE(text.find("share of the variance"), text.rfind("share of the variance"));
}

TEST(ShownFit, TheRangeOfACurveOfASmallQuantityIsNotZeroAndOfOneNeverVisitedIsMissing) {
  Fit fit;
  fit.method = "equation_error";
  fit.curves.resize(2);
  fit.curves[0].name = "k", fit.curves[1].name = "never";
  for (CurveEstimate& curve : fit.curves) curve.informative = true, curve.of = "gap", curve.of_unit = "m", curve.x = {0.0002, 0.0151};
  fit.curves[0].count = {9.0, 9.0};
  fit.curves[1].count = {0.0, 0.0};
  const std::string text = as_text(blocks_of(std::vector{fit}));
  expect_parts(text, {"from 0.0002 to 0.0151 m of gap", "curve never  –"});
  EXPECT_EQ(text.find("nan"), std::string::npos);
}

TEST(ShownDiagnosis, ASlowSpectralLineHasAFrequency) {
  Diagnosis d;
  d.whiteness.resize(1);
  d.whiteness[0].peak_frequency = 1.157e-5;
  expect_parts(as_text(blocks_of(d)), {"1.157e-05 Hz"});
}

TEST(ShownRung, RandomForcesOfDifferentUnitsHaveARowEach) {
  Rung before, after;
  before.force = {{"du/dt", {3.0, 0.1, "m/s^2"}}, {"dw/dt", {20.0, 1.0, "V/s"}}};
  after = before;
  after.id = 1;
  after.parent = 0;
  after.force["dw/dt"].value = 5.0;
  const std::string text = as_text(rung_blocks({{before, after}}, after));
  expect_parts(text, {"random force on du/dt", "within its sigma", "random force on dw/dt", "-75.0 %"});
}

TEST(ShownFit, NoiseIsNamedInWords) {
  Fit fit;
  fit.method = "filter_error";
  fit.noise = {{"w", {0.3, 0.01, "rad/s"}},
               {"w_coloured", {0.1, 0.01, "rad/s"}},
               {"w_coloured_damping", {0.5, 0.1, "-"}},
               {"w_coloured_frequency", {15.0, 0.5, "Hz"}},
               {"lamp_coloured", {0.2, 0.02, "V"}}};
  std::vector<std::string> names;
  for (const auto& row : parameter_table(fit).rows) names.push_back(row.front());
  EXPECT_THAT(names, testing::ElementsAre("noise of lamp_coloured", "noise of w", "coloured noise of w",
                                          "damping of the coloured noise of w", "frequency of the coloured noise of w"));
}

TEST(ShownLadder, WhereTheStudyHoldsNothingOutTheGainIsThatOfTheSearch) {
  Rung first, second;
  second.id = 1;
  second.parent = 0;
  second.added = "strut_wake";
  second.actual_drop = 270.7;
  second.gain_of_search = 27.70435967945741;
  std::string text = as_text(blocks_of(Ladder{{first, second}}));
  expect_parts(text, {"(+27.7)", "Gains in parentheses are of the search"});
  expect_parts(as_text(rung_blocks({{first, second}}, second), {.width = 400}),
               {"gain of the log-likelihood of the last quarter, without which discovery fitted: +27.7."});
  second.held_out_gain = 12.5;
  text = as_text(blocks_of(Ladder{{first, second}}));
  expect_parts(text, {"+12.5"});
  EXPECT_EQ(text.find("parentheses"), std::string::npos);
}

TEST(ShownFit, ASmoothedCurveHasItsEffectiveDegreesOfFreedomBesideItsRange) {
  Fit fit;
  fit.method = "equation_error";
  fit.curves.resize(2);
  fit.curves[0].name = "C_m", fit.curves[1].name = "C_mq";
  for (CurveEstimate& curve : fit.curves)
    curve.informative = true, curve.of = "alpha_T", curve.of_unit = "rad", curve.x = {0.1}, curve.count = {9.0};
  fit.facts[freedom_fact("C_m")] = "4.2";
  const std::string text = as_text(blocks_of(std::vector{fit}));
  expect_parts(text, {"from 5.73 to 5.73 deg of alpha_T; 4.2 effective degrees of freedom", "curve C_mq"});
  EXPECT_EQ(text.find("effective degrees"), text.rfind("effective degrees"));
}

TEST(ShownResampling, NothingAskedForIsNothingShown) { EXPECT_TRUE(blocks_of(Resampling{}).all().empty()); }

}  // namespace
}  // namespace misfit
