// One line per stage, for whoever watches a run.
#include "misfit/show/lines.h"

#include <gmock/gmock.h>

namespace misfit {
namespace {

Fit filter() {
  Fit fit;
  fit.method = "filter_error";
  fit.status = FitStatus::converged;
  fit.parameters = {{"gain", {2.0, 0.1, "V"}}};
  fit.predictions = {{"bench", "w", "V", {}, {}, {}, {}, {}, 0.3, 0.015}};
  return fit;
}

TEST(LineOfAFit, GivesTheRandomForceOrWithoutOneTheResiduals) {
  Fit fit = filter();
  EXPECT_EQ(line_of(fit), "gain 2.00 ± 0.10 V; RMS error of w 0.3 V, 1.5 % of the motion");
  fit.predictions.push_back({"again", "w", "V", {}, {}, {}, {}, {}, 0.4, 0.02});
  EXPECT_EQ(line_of(fit),
            "gain 2.00 ± 0.10 V; RMS error of w in 'bench' 0.3 V, 1.5 % of the motion, of w in 'again' 0.4 V, 2 % of the motion");
  fit.force = {{"dw/dt", {20.0, 1.0, "V/s"}}};
  EXPECT_EQ(line_of(fit), "gain 2.00 ± 0.10 V; random force 20.0 ± 1.0 V/s");
}

TEST(LineOfAFit, SaysWhatAWarningOfAnExperimentIsAbout) {
  Fit fit = filter();
  fit.warnings = {
      "experiment 'bench': the gaps are not random: in 30 of 31 missing samples a sensor at its limit, or a marker out of the picture"};
  EXPECT_THAT(line_of(fit), testing::HasSubstr("; ! the gaps are not random"));
  EXPECT_THAT(line_of(fit), testing::Not(testing::HasSubstr("experiment")));
}

TEST(LineOfAFit, NamesEveryCurveThatIsNotInformativeAndWhy) {
  Fit fit = filter();
  fit.curves.resize(2);
  fit.curves[1].name = "C_m_alpha_rate";
  fit.curves[1].informative = false;
  fit.curves[1].why = "driven motion: the sum of acceleration times rate telescopes";
  EXPECT_THAT(line_of(fit), testing::EndsWith("; C_m_alpha_rate not informative: driven motion"));
}

TEST(LineOfAFit, SaysWhatItLeavesOut) {
  Fit fit = filter();
  for (const char* name : {"a", "b", "c", "d", "e"}) fit.parameters[name] = {1.0, 0.1, "V"};
  fit.force = {{"dw/dt", {0.02, 0.0, "V/s"}}};
  fit.warnings = {"a ends at its bound, 1 V: the best value may lie beyond",
                  "the innovations of w in 'bench' are not white (Ljung-Box p = 0)",
                  "b and c are collinear: a combination of them is known much better", "and so on"};
  EXPECT_EQ(line_of(fit),
            "a 1.00 ± 0.10 V, b 1.00 ± 0.10 V, c 1.00 ± 0.10 V, d 1.00 ± 0.10 V, and 2 more; random force not distinguishable from 0; "
            "! a ends at its bound, 1 V; the innovations of w in 'bench' are not white; and 2 more (--verbose)");
  fit.driven = true;
  EXPECT_THAT(line_of(fit), testing::HasSubstr("random force 0.02 V/s"));
}

TEST(LineOfAFit, ThatDeclinedGivesTheReasonWithoutItsConsequence) {
  Fit fit = filter();
  fit.status = FitStatus::declined;
  fit.message = "a force drives it, so it cannot follow: more words";
  EXPECT_EQ(line_of(fit), "declined: a force drives it");
}

TEST(LineOfADiscovery, NamesTheAcceptedEffectElseThatOfTheSmallestP) {
  Discovery d;
  Candidate c;
  c.effect = "lag";
  c.p_value = 0.7;
  d.candidates = {c, c};
  EXPECT_EQ(line_of(d), "1 effect at 2 places tested, none accepted; smallest p: lag (p = 0.7)");
  d.candidates.back().absorbed = true;
  EXPECT_THAT(line_of(d), testing::StartsWith("1 effect tested, none accepted"));
  d.candidates.front().p_value = 1e-9;
  d.candidates.front().why = "its strength is not determined: drag = 1 ± 3";
  EXPECT_THAT(line_of(d), testing::EndsWith("smallest p: lag (p = 1e-09)")) << "not refitted, so not judged";
  d.candidates.front().actual_drop = 30.0;
  EXPECT_THAT(line_of(d), testing::EndsWith("smallest p: lag (p = 1e-09), rejected: its strength is not determined"));
  d.outcome = SearchOutcome::not_decided;
  EXPECT_THAT(line_of(d), testing::EndsWith("smallest p: lag (p = 1e-09)"));
  d.outcome = SearchOutcome::none_missing;
  d.unexplained_port = "dw/dt";
  d.unexplained_quantity = "w";
  EXPECT_THAT(line_of(d), testing::HasSubstr("a force on dw/dt that depends on w is of unknown form"));
  d.unexplained_error = true;
  EXPECT_THAT(line_of(d), testing::HasSubstr("an error of dw/dt that depends on w is of unknown form"));
  d.candidates.front().accepted = true;
  d.candidates.front().actual_drop = 270.7;
  d.candidates.front().p_value = 1e-60;
  EXPECT_EQ(line_of(d), "missing: lag (drop 270.7, p = 1e-60)");
}

TEST(LineOfARung, GivesItsFirstParametersAndTheForceThatIsLeft) {
  Rung rung;
  rung.parameters = {{"a", {1.0, 0.1, "V"}}, {"b", {2.0, 0.1, "V"}}, {"c", {3.0, 0.1, "V"}}};
  rung.force = {{"dw/dt", {20.0, 1.0, "V/s"}}};
  EXPECT_EQ(line_of(rung), "a 1.00 ± 0.10 V, b 2.00 ± 0.10 V, random force 20.0 ± 1.0 V/s");
}

TEST(LineOfARung, NamesThePortsOfRandomForcesInSeveralUnits) {
  Rung rung;
  rung.force = {{"correlation_time", {0.1, 0.01, "s"}},
                {"dv/dt", {3.0, 0.1, "m/s^2"}},
                {"du/dt", {3.0, 0.1, "m/s^2"}},
                {"dw/dt", {20.0, 1.0, "V/s"}}};
  EXPECT_EQ(line_of(rung), "random force 3.00 ± 0.10 m/s^2 on du/dt and dv/dt, 20.0 ± 1.0 V/s on dw/dt");
}

}  // namespace
}  // namespace misfit
