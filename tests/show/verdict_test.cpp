// The sentence that a run ends with, over what may have come out.
#include "misfit/show/verdict.h"

#include <gmock/gmock.h>

#include "misfit/core/files.h"
#include "misfit/show/error_changes.h"
#include "tests/core/temporary_folder.h"

namespace misfit {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

Fit filter_fit() {
  Fit fit;
  fit.method = "filter_error";
  fit.status = FitStatus::converged;
  fit.driven = true;
  fit.rms = {{"w", {0.30, 0.0, "V"}}};
  fit.predictions = {{"bench", "w", "V", {0.0, 0.02, 0.04, 0.06}, {}, {}, {}, {}, 0.3, 0.015}};
  fit.force = {{"correlation_time", {0.2, 0.01, "s"}}, {"dw/dt", {20.0, 1.0, "V/s"}}};
  return fit;
}

Candidate candidate(const std::string& effect, double p, bool accepted) {
  Candidate c;
  c.effect = effect;
  c.p_value = p;
  c.accepted = accepted;
  if (accepted) {
    c.parameters = {{"friction", {5.0, 0.5, "V/s"}}};
    c.force = {{"dw/dt", {5.0, 0.4, "V/s"}}};
  }
  return c;
}

/// Everything that a verdict may be made of; `input()` points at what a test has put there.
struct Case {
  std::vector<Fit> fits{filter_fit()};
  std::optional<Calibration> calibration;
  std::optional<Comparison> comparison;
  std::optional<Diagnosis> diagnosis, rung_diagnosis;
  std::optional<Discovery> discovery;
  std::optional<Ladder> ladder;

  [[nodiscard]] Verdict verdict() const {
    VerdictInput input{"configs/motor", "", &fits};
    if (calibration) input.calibration = &*calibration;
    if (comparison) input.comparison = &*comparison;
    if (diagnosis) input.diagnosis = &*diagnosis;
    if (rung_diagnosis) input.rung_diagnosis = &*rung_diagnosis;
    if (discovery) input.discovery = &*discovery;
    if (ladder) input.ladder = &*ladder;
    return verdict_of(input);
  }
  void add_effect() {
    Rung first, second;
    first.rms = {{"w", {0.30, 0.0, "V"}}};
    first.k_step = {{"w", {0.3, 0.5, 1.0, 2.0, 4.0, 8.0}}};
    first.force = filter_fit().force;
    second = first;
    second.id = 1;
    second.parent = 0;
    second.added = "coulomb_friction";
    second.k_step = {{"w", {0.3, 0.3, 0.4, 0.5, 0.8, 1.2}}};
    second.actual_drop = 700.0;
    second.force = {{"dw/dt", {5.0, 0.4, "V/s"}}};
    ladder = Ladder{{first, second}};
  }
  void fail_at_rest() {
    ForceMap map;
    map.port = "dw/dt", map.quantity = "w";
    map.p_corrected = 1e-20;
    map.sentence = "the model's dw/dt is 5.0 ± 0.5 V/s too low where w is between 0 V and 1 V";
    diagnosis.emplace().maps = {map};
  }
};

Discovery searched(const std::vector<Candidate>& candidates, SearchOutcome outcome, const std::string& verdict) {
  Discovery d;
  d.outcome = outcome;
  d.candidates = candidates;
  d.verdict = verdict;
  return d;
}

TEST(Verdict, NothingMissingNamesTheRandomForceThatDrivesTheMotion) {
  Case c;
  c.discovery = searched({candidate("drag", 0.9, false), candidate("lag", 1.0, false)}, SearchOutcome::none_missing,
                         "No missing effect detected: none of 2 candidates");
  Verdict v = c.verdict();
  EXPECT_EQ(v.kind, VerdictKind::random_force);
  EXPECT_THAT(v.sentence, AllOf(HasSubstr("none of the 2 effects that were tested"), EndsWith("a random force of 20.0 ± 1.0 V/s.")));
  EXPECT_THAT(v.notes, ElementsAre(HasSubstr("an effect that the library does not have")));
  c.fits.front().force.at("dw/dt") = {1.0, 14.0, "V/s"};
  EXPECT_EQ(c.verdict().kind, VerdictKind::nothing_missing) << "none that is not known to be there";
  c.fits.front().driven = false;
  v = c.verdict();
  EXPECT_EQ(v.kind, VerdictKind::nothing_missing);
  EXPECT_THAT(v.sentence, Not(HasSubstr("random force")));
  EXPECT_TRUE(v.notes.empty());
  c.discovery->candidates.pop_back();
  EXPECT_EQ(c.verdict().sentence, "No effect is found missing: the one that was tested is not needed.");
  c.discovery->candidates.front().absorbed = true;
  EXPECT_EQ(c.verdict().sentence, "No effect is found missing, but none of the library was tested.");
}

TEST(Verdict, WhereNothingIsMissingTheFittedModelIsTheAnswer) {
  Case c;
  c.fits.front().parameters = {{"gain", {2.0, 0.1, "rad/s"}}, {"tau", {0.5, 0.0, "s"}}, {"C[0]", {1.0, 0.1, "-"}}};
  c.discovery = searched({candidate("drag", 0.9, false)}, SearchOutcome::none_missing, "No missing effect detected: none of 1 candidates");
  EXPECT_EQ(c.verdict().parameters, "gain = 114.6 ± 5.7 deg/s and tau = 0.5 s");
  constexpr std::size_t wide = 200;
  EXPECT_THAT(as_text(blocks_of(c.verdict()), {wide}),
              HasSubstr("parameters of the fitted model: gain = 114.6 ± 5.7 deg/s and tau = 0.5 s"));
  c.discovery = searched({}, SearchOutcome::unknown_form, "Something is missing that depends on w");
  c.discovery->unexplained_port = "dw/dt", c.discovery->unexplained_quantity = "w";
  EXPECT_THAT(c.verdict().parameters, HasSubstr("gain = "));
  c.discovery = searched({candidate("drag", 1e-9, true)}, SearchOutcome::accepted, "Missing: drag");
  EXPECT_THAT(c.verdict().parameters, IsEmpty()) << "drag changes them";
}

TEST(Verdict, OfDataThatDetermineNothingItDoesNotSayThatNothingIsMissing) {
  Case c;
  c.discovery = searched({candidate("drag", 0.9, false)}, SearchOutcome::none_missing, "No missing effect detected: none of 1 candidates");
  Fit& fit = c.fits.front();
  fit.parameters = {{"gain", {2.0, 0.0, "1/s"}}, {"tau", {0.5, 0.0, "s"}}};
  EXPECT_EQ(c.verdict().kind, VerdictKind::not_decided);
  EXPECT_THAT(c.verdict().sentence, AllOf(HasSubstr("cannot be said"), HasSubstr("too few"), Not(HasSubstr("No effect is found missing"))));
  fit.parameters.at("tau").sigma = 0.1;
  EXPECT_THAT(c.verdict().sentence, testing::StartsWith("No effect is found missing"));
  fit.predictions.resize(1);
  fit.predictions.front().nrmse = 1.1;
  EXPECT_EQ(c.verdict().kind, VerdictKind::not_decided);
  EXPECT_THAT(c.verdict().sentence, HasSubstr("no better than its mean"));
  fit.predictions.front().nrmse = 0.2;
  EXPECT_THAT(c.verdict().sentence, testing::StartsWith("No effect is found missing"));
}

TEST(Verdict, NothingMissingNamesTheRandomForceOfTheSearchWhereTheFitHasNone) {
  Case c;
  c.fits.front().method = "output_error";
  c.fits.front().force.clear();
  c.fits.front().driven = false;
  c.discovery = searched({candidate("drag", 0.9, false)}, SearchOutcome::none_missing, "No missing effect detected");
  c.discovery->force = {{"dw/dt", {113.0, 5.0, "V/s"}}, {"di/dt", {0.003, 0.0, "A/s"}}};
  EXPECT_THAT(c.verdict().sentence, EndsWith("and what is left is a random force of 113.0 ± 5.0 V/s."));
  c.discovery->force = {{"di/dt", {0.003, 0.0, "A/s"}}};
  EXPECT_EQ(c.verdict().kind, VerdictKind::nothing_missing) << "a strength without a sigma is none that was found";
}

TEST(Verdict, NothingMissingIsDoubtedWhereTheSimulatedMotionIsAnother) {
  Case c;
  c.discovery = searched({candidate("drag", 0.9, false)}, SearchOutcome::none_missing, "No missing effect detected: none of 1 candidates");
  c.comparison.emplace().motion.emplace().p_value = 0.2;
  EXPECT_THAT(c.verdict().notes, Not(Contains(HasSubstr("statistics"))));
  c.comparison->motion->p_value = 0.005;
  EXPECT_THAT(c.verdict().notes, Contains(AllOf(HasSubstr("statistics of the measured motion"), HasSubstr("0.005"))));
}

TEST(Verdict, NothingMissingIsDoubtedWhereAMapOfTheMissingForceIsSignificant) {
  Case c;
  c.discovery = searched({candidate("drag", 0.9, false)}, SearchOutcome::none_missing, "");
  c.fail_at_rest();
  EXPECT_THAT(c.verdict().notes, Contains("All the same, the missing dw/dt against w is significant (p = 1e-20)."));
  c.add_effect();
  c.rung_diagnosis = c.diagnosis;
  c.rung_diagnosis->maps.front().p_corrected = 0.004;
  EXPECT_THAT(c.verdict().notes, Contains("All the same, the missing dw/dt against w is significant (p = 0.004)."));
  c.rung_diagnosis->maps.front().p_corrected = 0.4;
  EXPECT_THAT(c.verdict().notes, Not(Contains(HasSubstr("All the same"))));
}

TEST(Verdict, WhatCouldNotBeToldFromAnEffectWhenItWasAddedIsSaidWithItsValues) {
  Case c;
  c.add_effect();
  Candidate from = candidate("coulomb_friction", 1e-9, true);
  from.group = {"coulomb_friction", "stribeck_friction"};
  describe_added(from, c.ladder->rungs.back());
  c.ladder->rungs.back().parameters = {{"friction", {2.0, 0.1, "V/s"}}};
  ASSERT_FALSE(c.verdict().added.empty());
  EXPECT_THAT(c.verdict().added.front(), EndsWith("; when it was added these data could not tell it from stribeck_friction"));
  from.group.clear();
  Rung alone;
  describe_added(from, alone);
  EXPECT_FALSE(alone.alike);
}

TEST(Verdict, OfManyParametersTheFirstAreNamedAndTheRestCounted) {
  Case c;
  for (int i = 10; i < 24; ++i) c.fits.front().parameters["p" + std::to_string(i)] = {1.0, 0.1, "V"};
  c.discovery = searched({candidate("drag", 0.9, false)}, SearchOutcome::none_missing, "No missing effect detected: none of 1 candidates");
  EXPECT_THAT(c.verdict().parameters, AllOf(testing::StartsWith("p10 = 1.00 ± 0.10 V, "), EndsWith("p21 = 1.00 ± 0.10 V and 2 more")));
}

TEST(Verdict, WithoutASearchTheResidualsSpeakAndDiscoverIsNext) {
  Case c;
  c.fail_at_rest();
  Verdict v = c.verdict();
  EXPECT_EQ(v.kind, VerdictKind::not_searched);
  EXPECT_THAT(v.where, HasSubstr("between 0 V and 1 V (p = 1e-20)."));
  EXPECT_EQ(v.next, "misfit discover configs/motor");

  c.diagnosis->maps.clear();
  v = c.verdict();
  EXPECT_EQ(v.kind, VerdictKind::not_searched);
  EXPECT_THAT(v.sentence, HasSubstr("no map of the missing force is significant"));
  c.diagnosis.reset();
  v = c.verdict();
  EXPECT_EQ(v.kind, VerdictKind::not_searched);
  EXPECT_EQ(v.sentence, "Fitted, not diagnosed yet: whether and where the model fails has not been looked at.");
  EXPECT_EQ(v.next, "misfit diagnose configs/motor");
  c.fits.front().force.clear();
  c.fits.front().method = "output_error";
  EXPECT_THAT(c.verdict().sentence, HasSubstr("output_error are not white, since forces that it does not have drive the motion"));
  c.fits.front().driven = false;
  EXPECT_THAT(c.verdict().sentence, HasSubstr("nothing stands out in the residuals of output_error"));
  c.fits.front().coloured = true;
  EXPECT_EQ(c.verdict().kind, VerdictKind::not_searched);
  EXPECT_THAT(c.verdict().sentence, AllOf(HasSubstr("or the measurement noise is autocorrelated: the residuals of output_error"),
                                          EndsWith("whether an effect is missing has not been looked for.")));
}

TEST(Verdict, AnAcceptedEffectIsNamedWithItsValuesTheForceThatItLeavesAndTheCommandThatAddsIt) {
  Case c;
  c.discovery = searched({candidate("coulomb_friction", 1e-60, true)}, SearchOutcome::accepted, "Missing: coulomb_friction");
  const Verdict v = c.verdict();
  EXPECT_EQ(v.kind, VerdictKind::missing);
  EXPECT_EQ(v.sentence, "Missing: coulomb_friction, with friction = 5.00 ± 0.50 V/s (p = 1e-60).");
  EXPECT_EQ(v.next, "misfit add configs/motor coulomb_friction");
  ASSERT_EQ(v.errors.size(), 2U);
  EXPECT_EQ(shown(v.errors[0]), "20.0 ± 1.0 V/s to 5.00 ± 0.40 V/s (-75 %)");
  EXPECT_EQ(shown(v.errors[1]), "0.3 V (1.5 % of the motion)");
}

TEST(Verdict, EffectsThatTheDataCannotDistinguishAreAllNamed) {
  Case c;
  Candidate best = candidate("camera_roll", 1e-9, true);
  best.group = {"camera_roll", "image_centre"};
  c.discovery = searched({best}, SearchOutcome::accepted, "Missing: camera_roll");
  const Verdict v = c.verdict();
  EXPECT_EQ(v.kind, VerdictKind::several_possible);
  EXPECT_THAT(v.sentence, HasSubstr("One of camera_roll and image_centre is missing, and these data cannot say which"));
}

TEST(Verdict, TheHorizonOfAnErrorHasItsTimeAndTheLastModelItsOtherNumbers) {
  Case c;
  EXPECT_EQ(c.verdict().errors.front().what(), "RMS error of w one sample ahead in the estimation data") << "of a filter";
  c.add_effect();
  c.ladder->rungs.back().parameters = {{"friction", {5.0, 0.5, "V/s"}}};
  c.ladder->rungs.back().estimates = {{"friction", {5.0, 0.5, "V/s"}}, {"gain", {2.0, 0.1, "1/s"}}};
  const Verdict v = c.verdict();
  EXPECT_EQ(v.errors.front().what(), "RMS error of w 32 samples (0.64 s) ahead in the estimation data");
  EXPECT_THAT(v.added, testing::ElementsAre(testing::StartsWith("coulomb_friction: friction = 5.0"),
                                            "other parameters of the last model: gain = 2.00 ± 0.10 1/s"));
}

TEST(Verdict, AForceThatIsNotSeenIsSaidNotToBe) {
  Case c;
  c.fits.front().driven = false;
  c.fits.front().force = {{"dw/dt", {0.181, 0.0, "V/s"}}};
  EXPECT_EQ(shown(c.verdict().errors.back()), "0.181 V/s (not distinguishable from 0)");
}

TEST(Verdict, AnAddedEffectIsGivenWithTheErrorBeforeAndAfterInItsUnitAndInPerCent) {
  Case c;
  c.add_effect();
  c.fail_at_rest();
  c.rung_diagnosis = c.diagnosis;
  c.rung_diagnosis->maps.front().p_corrected = 0.7;
  c.discovery = searched({candidate("drag", 0.9, false)}, SearchOutcome::none_missing, "No missing effect detected: none of 1 candidates");
  Verdict v = c.verdict();
  EXPECT_EQ(v.kind, VerdictKind::effect_added);
  EXPECT_EQ(v.sentence,
            "coulomb_friction was missing: with it the RMS error of w 32 samples (0.64 s) ahead in the estimation data falls from 8 V to "
            "1.2 V (-85 %); nothing "
            "more is found "
            "missing.");
  EXPECT_THAT(v.where, AllOf(testing::StartsWith("Without coulomb_friction, the model's dw/dt is "),
                             EndsWith("(p = 1e-20); in the last model p = 0.7.")));
  EXPECT_EQ(v.next, "misfit export configs/motor --to json");

  c.discovery.reset();
  v = c.verdict();
  EXPECT_THAT(v.sentence, EndsWith("whether more is missing has not been looked for."));
  EXPECT_EQ(v.next, "misfit discover configs/motor");
}

TEST(Verdict, WhatIsHeldOutStandsBesideWhatWasFitted) {
  Case c;
  c.fits.front().validation_rms = {{"w", {0.35, 0.0, "V"}}};
  ASSERT_EQ(c.verdict().errors.size(), 3U);
  EXPECT_EQ(c.verdict().errors[1].what(), "RMS error of w one sample ahead in the held-out data");
  c.add_effect();
  c.ladder->rungs[0].validation_rms = c.ladder->rungs[1].validation_rms = {{"w", {0.35, 0.0, "V"}}};
  EXPECT_EQ(c.verdict().errors[1].what(), "RMS error of w one sample ahead in the held-out data");
  c.ladder->rungs[0].validation_k_step = {{"w", {0.3, 0.5, 1.0, 2.0, 4.0, 9.0}}};
  c.ladder->rungs[1].validation_k_step = {{"w", {0.3, 0.3, 0.4, 0.5, 0.8, 1.5}}};
  EXPECT_EQ(c.verdict().errors[1].what(), "RMS error of w 32 samples (0.64 s) ahead in the held-out data");
  EXPECT_EQ(shown(c.verdict().errors[1]), "9 V to 1.5 V (-83 %)");
}

TEST(Verdict, FreeRunsOfTheLadderComeFirstWhereTheirErrorsFallClearly) {
  Case c;
  c.add_effect();
  const std::map<std::string, Estimate> before = {{"w", {3.0, 0.0, "V"}}}, held_out = {{"w", {5.0, 0.0, "V"}}};
  c.ladder->rungs[0].free_rms = before;
  EXPECT_THAT(c.verdict().errors.front().what(), HasSubstr("samples")) << "that of the last rung is not known";
  c.ladder->rungs[0].validation_free_rms = held_out;
  c.ladder->rungs[1].free_rms = c.ladder->rungs[1].validation_free_rms = {{"w", {1.5, 0.0, "V"}}};
  const Verdict v = c.verdict();
  ASSERT_GE(v.errors.size(), 3U);
  EXPECT_EQ(v.errors[0].what(), "RMS error of w in a free run in the estimation data");
  EXPECT_EQ(shown(v.errors[0]), "3 V to 1.5 V (-50 %)");
  EXPECT_EQ(v.errors[1].what(), "RMS error of w in a free run in the held-out data");
  EXPECT_EQ(shown(v.errors[1]), "5 V to 1.5 V (-70 %)");
  EXPECT_THAT(v.sentence, HasSubstr("with it the RMS error of w in a free run in the estimation data falls from 3 V to 1.5 V"));
  c.ladder->rungs[1].free_rms = before;
  c.ladder->rungs[1].validation_free_rms = held_out;
  EXPECT_THAT(c.verdict().errors.front().what(), HasSubstr("samples")) << "no change";
}

TEST(Verdict, ARandomForceThatIsGoneIsSaidNotToBeDistinguishableFrom0) {
  Case c;
  c.add_effect();
  c.ladder->rungs[1].force = {{"dw/dt", {0.09, 0.0, "V/s"}}};
  EXPECT_EQ(shown(c.verdict().errors.back()), "20.0 ± 1.0 V/s to 0.09 V/s (not distinguishable from 0)");
}

TEST(Verdict, ARandomForceThatWasNotSeenBeforeHasNoChangeInPerCent) {
  Case c;
  c.add_effect();
  c.ladder->rungs.front().force = {{"dw/dt", {1e-4, 0.0, "V/s"}}};
  const std::string sentence = c.verdict().sentence;
  EXPECT_THAT(sentence, HasSubstr("the random force rises from 0.0001 V/s (not distinguishable from 0) to 5.00 ± 0.40 V/s"));
}

TEST(Verdict, AnErrorOfATrajectoryIsThatOfAFreeRun) {
  Case c;
  c.fits.front().method = "output_error";
  c.fits.front().force.clear();
  EXPECT_EQ(c.verdict().errors.front().what(), "RMS error of w in a free run in the estimation data");
}

TEST(Verdict, EveryPortThatFailsIsNamedWithItsMostSignificantPlace) {
  Case c;
  c.fail_at_rest();
  ForceMap same = c.diagnosis->maps.front(), other = same, whole = same;
  same.quantity = "V", same.sentence = "the model's dw/dt is too high at another place";
  other.port = "dT/dt", other.p_corrected = 0.0004, other.sentence = "the model's dT/dt is 2.0 ± 0.4 K/s too high";
  whole.port = "di/dt", whole.p_corrected = 0.6, whole.sentence = "";
  c.diagnosis->maps.insert(c.diagnosis->maps.end(), {same, other, whole});
  EXPECT_EQ(c.verdict().where,
            "The model's dw/dt is 5.0 ± 0.5 V/s too low where w is between 0 V and 1 V (p = 1e-20). The model's dT/dt is 2.0 ± 0.4 K/s "
            "too high (p = 0.0004).");
  c.add_effect();
  c.rung_diagnosis = c.diagnosis;
  for (ForceMap& map : c.rung_diagnosis->maps) map.p_corrected = 0.8;
  EXPECT_THAT(c.verdict().where, AllOf(HasSubstr("(p = 1e-20); in the last model p = 0.8. The model's dT/dt"),
                                       EndsWith("(p = 0.0004); in the last model p = 0.8.")));
}

TEST(Verdict, AParameterThatWasKnownAndNoLongerIsMakesTheModelDoubtful) {
  Case c;
  c.add_effect();
  c.ladder->rungs[0].estimates =
      std::map<std::string, Estimate>{{"tau", {5000.0, 50.0, "s"}}, {"rest", {5.6, 0.1, "K"}}, {"gain", {2.0, 1.0, "K/W"}}};
  c.ladder->rungs[1].estimates =
      std::map<std::string, Estimate>{{"tau", {5100.0, 90.0, "s"}}, {"rest", {-1.5, 2.3, "K"}}, {"gain", {5.0, 15.0, "K/W"}}};
  EXPECT_THAT(c.verdict().doubts, IsEmpty()) << "rest is known to 2.3 K of 5.6 K, and gain was never known";
  c.ladder->rungs[1].estimates->at("tau") = {2.1e6, 6.2e6, "s"};
  EXPECT_THAT(c.verdict().doubts, ElementsAre(testing::StartsWith("tau is no longer determined beside what was added: ")));
  EXPECT_THAT(c.verdict().sentence, HasSubstr("describes what was missing"));
}

TEST(Verdict, WhatWasFixedOnTheWayIsNamedSinceSigmasAreThoseBesideIt) {
  Case c;
  c.add_effect();
  c.ladder->rungs[0].estimates = std::map<std::string, Estimate>{{"tau", {5000.0, 50.0, "s"}}, {"rest", {5.6, 0.1, "K"}}};
  c.ladder->rungs[1].estimates = std::map<std::string, Estimate>{{"tau", {5100.0, 1.0, "s"}}};
  EXPECT_THAT(c.verdict().added, testing::Contains(testing::StartsWith("fixed on the way: rest;")));
  c.ladder->rungs[1].estimates->emplace("rest", Estimate{5.7, 0.1, "K"});
  EXPECT_THAT(c.verdict().added, testing::Not(testing::Contains(HasSubstr("fixed on the way"))));
}

TEST(Verdict, AnEstimateThatLaterRungsHaveMovedIsGivenOfBothModels) {
  Case c;
  c.add_effect();
  Rung& first = c.ladder->rungs.back();
  first.parameters = {{"friction", {20.6, 1.2, "V/s"}}};
  Rung second = first;
  second.id = 2, second.parent = 1, second.added = "time_offset";
  second.parameters = {{"clock_offset", {0.011, 0.002, "s"}}};
  second.estimates = {{"friction", {21.8, 1.3, "V/s"}}, {"clock_offset", {0.011, 0.002, "s"}}};
  c.ladder->rungs.push_back(second);
  EXPECT_THAT(c.verdict().added,
              testing::ElementsAre("coulomb_friction: friction = 21.8 ± 1.3 V/s in the last model (friction = 20.6 ± 1.2 V/s in rung 1)",
                                   "time_offset: clock_offset = 0.0110 ± 0.0020 s"));
}

/// Named all the same, but not as what was missing.
TEST(Verdict, ALastModelWhoseParametersAreDoubtfulIsNoProofOfWhatWasAdded) {
  Case c;
  c.add_effect();
  c.discovery = searched({}, SearchOutcome::none_missing, "");
  EXPECT_THAT(c.verdict().sentence, testing::StartsWith("coulomb_friction was missing"));
  c.ladder->rungs.back().doubts = {"input_tau is not determined by these data", "damping ends at its bound, 0.047 1/s"};
  const Verdict v = c.verdict();
  EXPECT_THAT(v.sentence, testing::StartsWith("coulomb_friction describes what was missing: with it"));
  EXPECT_THAT(v.notes, ElementsAre("What was added may stand for something else, since the last model is doubtful."));
  EXPECT_EQ(v.doubts, *c.ladder->rungs.back().doubts);
}

TEST(Verdict, DoubtsOfTheFittedModelAreSaidWithItsParameters) {
  Case c;
  c.fits.front().add_doubt("tau ends at its bound, 0.01 s");
  EXPECT_THAT(c.verdict().doubts, testing::ElementsAre("tau ends at its bound, 0.01 s"));
}

/// By hand, say: its drop is what chance gives.
TEST(Verdict, AnAddedEffectThatExplainsNothingIsNotCalledMissing) {
  Case c;
  c.add_effect();
  c.fail_at_rest();
  c.rung_diagnosis = c.diagnosis;
  Rung& rung = c.ladder->rungs.back();
  rung.actual_drop = 0.3;
  rung.held_out_gain = -3.4;
  rung.parameters = {{"friction", {0.1, 0.2, "V/s"}}};
  rung.estimates = {{"friction", {0.2, 0.3, "V/s"}}};
  const Verdict v = c.verdict();
  EXPECT_THAT(v.sentence, testing::StartsWith("coulomb_friction was added and explains no more than chance does; "));
  EXPECT_THAT(v.sentence, testing::Not(HasSubstr("was missing")));
  EXPECT_THAT(v.where, HasSubstr("in the last model p = "));
  EXPECT_THAT(v.added, testing::ElementsAre("coulomb_friction: friction = 0.20 ± 0.30 V/s; held-out gain -3.4"))
      << "as the last model has it";
}

/// A curve has no parameter with a name: its coefficients count all the same.
TEST(Verdict, TheDropOfACurveIsTestedWithAllItsCoefficients) {
  Case c;
  c.add_effect();
  Rung& rung = c.ladder->rungs.back();
  rung.actual_drop = 15.0;
  EXPECT_THAT(c.verdict().sentence, testing::StartsWith("coulomb_friction was missing")) << "15 for one parameter: p = 1e-4";
  rung.new_parameters = 10;
  EXPECT_THAT(c.verdict().sentence, HasSubstr("explains no more than chance does")) << "p = 0.13";
}

TEST(Verdict, WhatPredictsWorseIsNotCalledMissing) {
  Case c;
  c.add_effect();
  c.ladder->rungs.back().actual_drop = 15.0;
  c.ladder->rungs.back().held_out_gain = -4.7;
  EXPECT_THAT(c.verdict().sentence,
              AllOf(testing::StartsWith("coulomb_friction was added, and what is held out is predicted worse with it"),
                    testing::Not(HasSubstr("was missing"))));
}

TEST(Verdict, WhatStaysForTheFreeRunIsSaidWithWhatSpeaksForIt) {
  Case c;
  c.add_effect();
  Rung& rung = c.ladder->rungs.back();
  rung.actual_drop = 15.0;
  rung.held_out_gain = -4.7;
  rung.parameters = {{"friction", {0.1, 0.02, "V/s"}}};
  rung.stays_for_free_run = "the errors of the free run fall by 40 %, of what is held out by 30 %";
  const Verdict v = c.verdict();
  EXPECT_THAT(v.sentence, testing::StartsWith("coulomb_friction was added, and stays for the free run, though one sample ahead what is "
                                              "held out is predicted worse with it"));
  EXPECT_THAT(v.added, testing::ElementsAre("coulomb_friction: friction = 0.100 ± 0.020 V/s; held-out gain -4.7; the errors of the free "
                                            "run fall by 40 %, of what is held out by 30 %"));
}

TEST(Verdict, WhatLeftALackOfFitIsAPartOfWhatIsMissingUntilNothingIsMissingAnyMore) {
  Case c;
  c.add_effect();
  c.ladder->rungs.back().remained = "an unknown curve dw/dt(w)";
  EXPECT_THAT(c.verdict().sentence, testing::StartsWith("coulomb_friction explains a part of what is missing: with it")) << "not searched";
  c.discovery = searched({}, SearchOutcome::unknown_form, "");
  c.discovery->unexplained_port = "dw/dt";
  c.discovery->unexplained_quantity = "w";
  EXPECT_THAT(c.verdict().sentence, AllOf(testing::StartsWith("coulomb_friction explains a part of what is missing: with it"),
                                          HasSubstr("something is still missing that depends on w"), Not(HasSubstr("was missing"))));
  c.discovery = searched({}, SearchOutcome::none_missing, "");
  EXPECT_THAT(c.verdict().sentence, AllOf(testing::StartsWith("coulomb_friction was missing"), Not(HasSubstr("a part"))));
}

TEST(Verdict, WhatWasChosenBesideAnEffectThatNoTestAcceptedIsNotCalledMissing) {
  Case c;
  c.add_effect();
  c.ladder->rungs.back().remained = "an unknown curve dw/dt(w)";
  Rung second = c.ladder->rungs.back();
  second.id = 2, second.parent = 1, second.added = "bilinear";
  second.remained.reset();
  c.ladder->rungs.push_back(second);
  c.discovery = searched({}, SearchOutcome::none_missing, "");
  EXPECT_THAT(c.verdict().sentence,
              AllOf(testing::StartsWith("coulomb_friction and bilinear describe what was missing: with them"), Not(HasSubstr("begun"))));
  EXPECT_THAT(c.verdict().notes,
              ElementsAre(testing::StartsWith("coulomb_friction was begun with though by itself it left a lack of fit")));
}

TEST(Verdict, WhatTheSearchAcceptedAndItsRungDidNotBearOutIsNotCalledMissing) {
  Case c;
  c.add_effect();
  Candidate best = candidate("input_lag", 1e-9, true);
  c.discovery = searched({best}, SearchOutcome::accepted, "Missing: input_lag");
  EXPECT_THAT(c.verdict().sentence, testing::StartsWith("Still missing: input_lag"));
  c.ladder->rungs.back().why_too_little = std::map<std::string, std::string>{{"input_lag", "the held-out log-likelihood rises by 0.1"}};
  EXPECT_THAT(c.verdict().sentence, EndsWith("whether more is missing is not decided."));
  EXPECT_THAT(
      c.verdict().notes,
      ElementsAre("input_lag was accepted, added and taken off again, since once fitted the held-out log-likelihood rises by 0.1."));
  EXPECT_EQ(c.verdict().kind, VerdictKind::not_decided);
  EXPECT_THAT(c.verdict().next, testing::StartsWith("misfit export")) << "not to be added again";
}

TEST(Verdict, WhatMakesTheErrorsLargerWasNotMissing) {
  Case c;
  c.add_effect();
  c.discovery = searched({}, SearchOutcome::none_missing, "");
  std::swap(c.ladder->rungs.front().k_step, c.ladder->rungs.back().k_step);
  EXPECT_THAT(c.verdict().sentence, AllOf(testing::StartsWith("coulomb_friction was added: with it"), HasSubstr("rises")));
}

TEST(Verdict, HalfASamplingIntervalIsTheHoldOfAnInput) {
  Case c;
  c.add_effect();
  c.ladder->rungs.back().added = "time_offset";
  c.ladder->rungs.back().holds = std::map<std::string, std::string>{{"u", "zero_order"}};
  c.discovery = searched({}, SearchOutcome::none_missing, "");
  EXPECT_THAT(c.verdict().sentence,
              testing::StartsWith("time_offset is half a sampling interval late: it is the hold of an input that is wrong, not the model"));
}

TEST(Verdict, AnInputThatIsHeldOtherwiseComesBeforeTheEffectThatItLooksLike) {
  Case c;
  Candidate clock = candidate("time_offset", 1e-9, true);
  clock.parameters = {{"clock_offset", {-0.05, 0.006, "s"}}};
  clock.holds = std::map<std::string, std::string>{{"wind", "zero_order"}};
  c.discovery = searched({clock}, SearchOutcome::accepted, "Missing: time_offset");
  EXPECT_THAT(
      c.verdict().sentence,
      testing::StartsWith("Between its samples wind is rather constant, where the model takes it as a straight line: half a sampling "
                          "interval is what time_offset, with clock_offset = -0.0500 ± 0.0060 s (p = 1e-09) needs to make up for "
                          "that."));
  EXPECT_THAT(c.verdict().notes, ElementsAre(testing::StartsWith("The right hold comes first")));
  EXPECT_THAT(c.verdict().next, AllOf(testing::StartsWith("misfit set "), HasSubstr("system.hold.wind=zero_order"),
                                      HasSubstr(" && misfit run "), EndsWith(" --auto")));
  c.discovery->candidates.front().holds = std::map<std::string, std::string>{{"sun", "first_order"}, {"wind", "first_order"}};
  EXPECT_THAT(c.verdict().sentence,
              testing::StartsWith("Between their samples sun and wind are rather straight, where the model takes them as constant"));
}

TEST(Verdict, AShapeThatIsKeptIsSaidWithTheEstimates) {
  Case c;
  c.add_effect();
  c.ladder->rungs.back().parameters = {{"friction", {5.0, 0.5, "V/s"}}};
  c.ladder->rungs.back().kept = "width is fixed at 0.5 V";
  EXPECT_THAT(c.verdict().added, testing::Contains("coulomb_friction: friction = 5.00 ± 0.50 V/s; width is fixed at 0.5 V"));
}

TEST(Verdict, WhatIsAddedWithNothingToEstimateHasItsValuesToo) {
  Case c;
  c.add_effect();
  Rung& rung = c.ladder->rungs.back();
  rung.added = "sensor_quantisation";
  rung.parameters.clear();
  rung.new_parameters = 0;
  rung.kept = "rounded is fixed at 1 and step is fixed at 0.25 V";
  rung.held_out_gain = -3.0;
  EXPECT_THAT(c.verdict().sentence, testing::StartsWith("sensor_quantisation was missing")) << "it is seen in the measurements";
  EXPECT_THAT(c.verdict().added,
              testing::Contains(testing::StartsWith("sensor_quantisation: rounded is fixed at 1 and step is fixed at 0.25 V")));
}

TEST(Verdict, WhatNoLikelihoodComparesIsNotCalledMissing) {
  Case c;
  c.add_effect();
  c.ladder->rungs.back().actual_drop.reset();
  EXPECT_THAT(c.verdict().sentence, AllOf(testing::StartsWith("coulomb_friction was added, and no likelihood compares it with the model "
                                                              "before: with it the RMS error of w"),
                                          HasSubstr("(-85 %); whether")));
}

TEST(Verdict, EachPartOfItAgreesInNumber) {
  Case c;
  c.add_effect();
  Rung other = c.ladder->rungs.back(), third = other;
  other.id = 2, other.parent = 1, other.added = "drag", other.actual_drop = 0.2;
  third.id = 3, third.parent = 2, third.added = "lag", third.actual_drop = 0.3;
  c.ladder->rungs.push_back(other);
  EXPECT_THAT(c.verdict().sentence, AllOf(testing::StartsWith("coulomb_friction was missing: with all that was added the RMS error of w"),
                                          HasSubstr("; drag was added and explains no more than chance does; whether")));
  c.ladder->rungs.push_back(third);
  EXPECT_THAT(c.verdict().sentence, HasSubstr("; drag and lag were added and explain no more than chance does; whether"));
}

TEST(Verdict, AnErrorThatClearlyRisesIsSaidBesideOneThatFalls) {
  Case c;
  c.add_effect();
  for (auto& [rung, last] : {std::pair<Rung&, double>(c.ladder->rungs[0], 2.0), std::pair<Rung&, double>(c.ladder->rungs[1], 7.0)}) {
    rung.rms["x"] = {0.1, 0.0, "m"};
    rung.k_step["x"] = {0.1, 0.1, 0.1, 0.1, 0.1, last};
  }
  EXPECT_THAT(
      c.verdict().sentence,
      AllOf(HasSubstr("the RMS error of w 32 samples (0.64 s) ahead in the estimation data falls from 8 V to 1.2 V (-85 %), but the RMS "
                      "error of x 32 samples (0.64 s) ahead in the estimation data rises from 2 m to 7 m (+250 %)")));
  c.ladder->rungs[1].k_step = c.ladder->rungs[0].k_step;
  c.ladder->rungs[1].force.clear();
  EXPECT_THAT(c.verdict().sentence, HasSubstr(" stays at "));
}

TEST(Verdict, OfOneThatPredictsWorseFartherAheadByItselfSaysThatTwoAreLookedFor) {
  Case c;
  Candidate friction = candidate("coulomb_friction", 1e-30, false);
  friction.actual_drop = 610.0;
  friction.held_out_gain = 1260.0;
  friction.why = "predictions farther ahead get worse: their RMS errors grow by 28 %";
  friction.grows_ahead = 1.28;
  c.discovery = searched({friction}, SearchOutcome::best_rejected, "No effect accepted; " + best_rejected(friction) + ".");
  Verdict v = c.verdict();
  EXPECT_THAT(v.sentence, EndsWith("grow by 28 %."));
  EXPECT_THAT(v.notes, ElementsAre("Something else may be missing beside it, with which they do not: --auto looks for both."));
  EXPECT_EQ(v.next, "misfit discover configs/motor --auto");
  Candidate larger = candidate("input_dead_zone", 1e-40, false);
  larger.actual_drop = 700.0;
  c.discovery = searched({larger, friction}, SearchOutcome::best_rejected, "No effect accepted; " + best_rejected(larger) + ".");
  EXPECT_THAT(c.verdict().notes, Not(Contains(HasSubstr("beside it")))) << "another one is spoken of";
}

TEST(Verdict, ASearchThatRefusesItsBestDoesNotHideWhatWasAdded) {
  Case c;
  c.add_effect();
  Candidate lag = candidate("lag", 1e-9, false);
  lag.actual_drop = 50.0;
  lag.why = "its size is odd";
  c.discovery = searched({lag}, SearchOutcome::best_rejected, "No effect accepted; " + best_rejected(lag) + ".");
  const Verdict v = c.verdict();
  EXPECT_EQ(v.kind, VerdictKind::not_decided);
  EXPECT_THAT(v.sentence, AllOf(testing::StartsWith("coulomb_friction was missing"),
                                EndsWith("(-85 %); something is still missing, and no effect of the library is accepted.")));
  EXPECT_THAT(v.notes, ElementsAre("Best candidate lag (drop 50, family-wise p = 1e-09), rejected: its size is odd.",
                                   testing::StartsWith("lag can be added by hand")));
  c.discovery->candidates.front().p_value = 0.002;
  EXPECT_THAT(c.verdict().sentence, EndsWith("(-85 %); whether more is missing is not decided."));
  c.discovery->candidates.front().why = "the held-out log-likelihood does not rise";
  EXPECT_EQ(c.verdict().next, "misfit open configs/motor") << "there is always something next";
}

TEST(Verdict, ASearchThatWasCutOffDoesNotHideWhatWasAdded) {
  Case c;
  c.add_effect();
  c.discovery = searched({candidate("lag", 1e-9, false)}, SearchOutcome::not_decided, "Not decided: the refit of lag was not finished.");
  const Verdict v = c.verdict();
  EXPECT_EQ(v.kind, VerdictKind::not_decided);
  EXPECT_THAT(v.sentence, AllOf(testing::StartsWith("coulomb_friction was missing"), EndsWith("whether more is missing is not decided.")));
  EXPECT_THAT(v.notes, ElementsAre("Not decided: the refit of lag was not finished."));
  EXPECT_THAT(v.next, HasSubstr("--time-limit"));
}

TEST(Verdict, WhatIsStillMissingComesBeforeWhatWasAdded) {
  Case c;
  c.add_effect();
  c.discovery = searched({candidate("drag", 1e-12, true)}, SearchOutcome::accepted, "Missing: drag");
  const Verdict v = c.verdict();
  EXPECT_EQ(v.kind, VerdictKind::missing);
  EXPECT_THAT(v.sentence, AllOf(testing::StartsWith("Still missing: drag"), HasSubstr("with coulomb_friction the RMS error")));
}

TEST(Verdict, AnErrorThatRisesIsNotSaidToFall) {
  Case c;
  c.add_effect();
  c.ladder->rungs[1].force = {{"dw/dt", {22.0, 1.0, "V/s"}}};
  c.ladder->rungs[1].k_step = {};
  EXPECT_THAT(c.verdict().sentence, HasSubstr("with it the random force rises from 20.0 ± 1.0 V/s to 22.0 ± 1.0 V/s (+10 %)"));
}

TEST(Verdict, AChangeWithinItsSigmaIsCalledSoAndTheMapWhereTheModelFailedLeads) {
  Case c;
  c.add_effect();
  c.ladder->rungs[1].force = {{"dw/dt", {19.4, 0.9, "V/s"}}};
  c.ladder->rungs[1].k_step = {{"w", {0.3, 0.5, 1.0, 2.0, 4.0, 7.9}}};
  EXPECT_THAT(c.verdict().sentence,
              HasSubstr("with it the RMS error of w 32 samples (0.64 s) ahead in the estimation data falls from 8 V to 7.9 V (-1.2 %)"));
  c.ladder->rungs[1].k_step = {{"w", {0.3, 0.5, 1.0, 2.0, 4.0, 7.9999}}};
  EXPECT_THAT(c.verdict().sentence, HasSubstr("with it the RMS error of w 32 samples (0.64 s) ahead in the estimation data stays at 8 V"));
  c.ladder->rungs[1].k_step = {{"w", {0.3, 0.5, 1.0, 2.0, 4.0, 7.9}}};
  c.fail_at_rest();
  c.rung_diagnosis = c.diagnosis;
  c.rung_diagnosis->maps.front().p_corrected = 0.7;
  const Verdict v = c.verdict();
  EXPECT_THAT(
      v.sentence,
      HasSubstr("was missing: with it the missing dw/dt against w is no longer significant (p = 1e-20 before, p = 0.7 now); whether"));
  ASSERT_EQ(v.errors.size(), 2U);
  EXPECT_EQ(shown(v.errors[1]), "20.0 ± 1.0 V/s to 19.40 ± 0.90 V/s (within its sigma)");
  c.ladder->rungs[1].force = {{"dw/dt", {18.4, 0.9, "V/s"}}};
  EXPECT_THAT(c.verdict().sentence, HasSubstr("with it the random force falls from 20.0 ± 1.0 V/s to 18.4")) << "beyond its sigma it leads";
  c.ladder->rungs[1].force = {{"dw/dt", {19.4, 0.9, "V/s"}}};
  c.ladder->rungs[1].k_step = {};
  c.diagnosis.reset();
  EXPECT_THAT(c.verdict().sentence, HasSubstr("the random force changes by less than its sigma, from 20.0 ± 1.0 V/s to 19.40 ± 0.90 V/s"));
}

TEST(Verdict, SaysWhichFixedParameterExplainsAsMuch) {
  Case c;
  c.discovery = searched({}, SearchOutcome::none_missing, "nothing");
  c.discovery->fixed_parameters = {{"k is fixed at 39 1/s^2, but these data ask for 40 1/s^2: estimate it", "m is fixed"}};
  EXPECT_THAT(c.verdict().sentence, AllOf(testing::StartsWith("No effect is found missing"),
                                          testing::EndsWith(" k is fixed at 39 1/s^2, but these data ask for 40 1/s^2: estimate it.")));
}

TEST(Verdict, ACalibrationThatItsSweepContradictsComesBeforeEveryEffect) {
  Case c;
  c.calibration.emplace().rms_px = 4.58;
  c.discovery = searched({candidate("camera_roll", 0.0, false)}, SearchOutcome::camera_incomplete, "The camera model is incomplete: …");
  c.discovery->sweep_asks = {"camera_roll", "image_centre"};
  const Verdict v = c.verdict();
  EXPECT_EQ(v.kind, VerdictKind::calibration);
  EXPECT_THAT(v.sentence, AllOf(testing::StartsWith("It is the camera, not the physics"), HasSubstr("4.58 px RMS")));
  EXPECT_THAT(v.sentence, EndsWith("; estimate them, too, and run the study again."));
  EXPECT_EQ(v.next, "misfit set configs/motor 'camera.free=[\"camera_roll\", \"image_centre\"]' && misfit run configs/motor");
  c.calibration->names = {"h_c", "K", "centre_y", "centre_z"};
  c.discovery->sweep_asks = {"lens_k1"};
  EXPECT_THAT(c.verdict().next, HasSubstr("'camera.free=[\"image_centre\", \"lens_k1\"]'")) << "what is free already stays free";
  c.discovery->outcome = SearchOutcome::camera_against_flight;
  EXPECT_THAT(c.verdict().sentence, testing::StartsWith("The camera comes first"));
}

TEST(Verdict, ASearchThatWasCutOffOrRefusesItsBestDecidesNothing) {
  Case c;
  for (const auto& [outcome, words] : {std::pair(SearchOutcome::not_finished, "Not finished: the time limit of 1 s was reached."),
                                       std::pair(SearchOutcome::not_decided, "Not decided: the refit of lag was not finished."),
                                       std::pair(SearchOutcome::best_rejected, "No effect accepted; best candidate lag.")}) {
    c.discovery = searched({candidate("lag", 1e-9, false)}, outcome, words);
    EXPECT_EQ(c.verdict().kind, VerdictKind::not_decided) << words;
    EXPECT_THAT(c.verdict().sentence, testing::StartsWith(words));
  }
  EXPECT_THAT(c.verdict().notes, ElementsAre("lag can be added by hand, to compare the errors before and after."));
  EXPECT_EQ(c.verdict().next, "misfit open configs/motor") << "nothing says that it predicts better";
  c.discovery->candidates.front().held_out_gain = -0.3;
  EXPECT_EQ(c.verdict().next, "misfit open configs/motor");
  c.discovery->candidates.front().held_out_gain = 2.0;
  EXPECT_EQ(c.verdict().next, "misfit add configs/motor lag");
  c.discovery->outcome = SearchOutcome::not_decided;
  EXPECT_EQ(c.verdict().next, "misfit discover configs/motor --time-limit 3600 --round-limit 36000") << "a refit has a limit of its own";
  c.discovery->outcome = SearchOutcome::not_finished;
  EXPECT_EQ(c.verdict().next, "misfit discover configs/motor --round-limit 3600");
  c.discovery = searched({}, SearchOutcome::none_suits, "No effect of the library suits this system: none was tested.");
  EXPECT_THAT(c.verdict().sentence, EndsWith("none was tested."));
  EXPECT_THAT(c.verdict().notes, ElementsAre("Write one as a formula under [effects]."));
  EXPECT_EQ(c.verdict().next, "misfit help study");
}

TEST(Verdict, ADependenceOfUnknownFormIsSaidWithItsPortAndQuantity) {
  Case c;
  c.discovery = searched({candidate("lag", 0.5, false)}, SearchOutcome::unknown_form, "Something is missing that depends on w");
  c.discovery->unexplained_port = "dw/dt";
  c.discovery->unexplained_quantity = "w";
  EXPECT_EQ(c.verdict().kind, VerdictKind::unknown_form);
  EXPECT_THAT(c.verdict().sentence, HasSubstr("depends on w: a force on dw/dt that no effect of the library explains"));
  EXPECT_THAT(c.verdict().notes, ElementsAre(testing::StartsWith("Look where it fails, then write the effect as one line of the study")));
  EXPECT_EQ(c.verdict().next, "misfit open configs/motor");
  c.discovery->unexplained_effects = {{"unknown_force", {{"of", "w"}, {"port", "dw/dt"}}}};
  EXPECT_THAT(c.verdict().next,
              AllOf(testing::StartsWith("misfit add "), HasSubstr(" unknown_force"), testing::EndsWith("--at 'of=w' --at 'port=dw/dt'")));
  c.add_effect();
  EXPECT_EQ(c.verdict().kind, VerdictKind::unknown_form);
  EXPECT_THAT(c.verdict().sentence,
              AllOf(testing::StartsWith("coulomb_friction was missing"), HasSubstr("still missing that depends on w")));
}

/// A curve of a quantity describes where the pulses happened to be.
TEST(Verdict, OfPulsesItSaysWhenTheyComeWhateverTheyDependOn) {
  Case c;
  c.fail_at_rest();
  ForcePulses pulses;
  pulses.sentence = "what is missing on dw/dt comes in 11 pulses of 2.5 min";
  c.diagnosis->pulses = {pulses};
  c.discovery = searched({candidate("lag", 0.5, false)}, SearchOutcome::unknown_form, "Something is missing that depends on w");
  c.discovery->unexplained_port = "dw/dt";
  c.discovery->unexplained_quantity = "w";
  c.discovery->unexplained_effects = {{"unknown_force", {{"of", "w"}, {"port", "dw/dt"}}}};
  const auto says_so = AllOf(HasSubstr("missing that no effect of the library explains: what is missing on dw/dt comes in 11 pulses"),
                             testing::Not(HasSubstr("depends on w")));
  EXPECT_EQ(c.verdict().kind, VerdictKind::unknown_form);
  EXPECT_THAT(c.verdict().sentence, says_so);
  EXPECT_EQ(c.verdict().next, "misfit open configs/motor");
  c.discovery = searched({}, SearchOutcome::none_missing, "No missing effect detected");
  EXPECT_THAT(c.verdict().sentence, says_so) << "something is missing, though no test found what";
  c.add_effect();
  EXPECT_THAT(c.verdict().sentence, testing::Not(HasSubstr("pulses"))) << "the last model lacks none";
  c.rung_diagnosis = c.diagnosis;
  EXPECT_THAT(c.verdict().sentence, HasSubstr("; something is still missing that no effect of the library explains: what is missing"));
}

TEST(Verdict, OfSomethingUnknownTheNearestEffectOfTheLibraryIsNamedWithWhatItLeaves) {
  Case c;
  Candidate nearest = candidate("rate_limit", 1e-9, false);
  nearest.actual_drop = 258.9;
  nearest.remaining = "an unknown surface dw/dt(w, U)";
  c.discovery = searched({nearest}, SearchOutcome::unknown_form, "Something is missing that depends on w");
  c.discovery->unexplained_port = "dw/dt";
  c.discovery->unexplained_quantity = "w";
  EXPECT_THAT(c.verdict().notes,
              ElementsAre("Of the library rate_limit comes nearest (drop 258.9), and leaves an unknown surface dw/dt(w, U).",
                          testing::StartsWith("Look where")));
  EXPECT_EQ(c.verdict().next, "misfit open configs/motor") << "nothing says that it predicts better";
  c.discovery->candidates.front().held_out_gain = 3.0;
  EXPECT_EQ(c.verdict().next, "misfit add configs/motor rate_limit");
  c.add_effect();
  EXPECT_EQ(c.verdict().next, "misfit open configs/motor") << "--auto has looked for more";
}

TEST(Verdict, OfACurveThatWasRefusedItSaysWhatDecidedAndWhatIsNext) {
  Case c;
  c.add_effect();
  c.discovery = searched({candidate("lag", 0.5, false)}, SearchOutcome::unknown_form, "Something is missing that depends on w");
  c.discovery->unexplained_port = "dw/dt", c.discovery->unexplained_quantity = "w";
  c.discovery->unexplained_effects = {{"unknown_force", {{"of", "w"}, {"port", "dw/dt"}}}};
  const std::string name = "unknown_force (of = w, port = dw/dt)";
  Rung& last = c.ladder->rungs.back();
  last.gained_too_little = {name};
  EXPECT_THAT(c.verdict().notes, Contains(EndsWith("in its place, " + name + ", was added and taken off again."))) << "old";
  last.why_too_little = {{name, "what it gains may be chance (drop 9.1 with 10 parameters, p = 0.52 among 4 that were tried)"}};
  EXPECT_THAT(c.verdict().notes,
              Contains(HasSubstr("was added and taken off again: what it gains may be chance (drop 9.1 with 10 parameters")));
  EXPECT_EQ(c.verdict().next, "misfit open configs/motor");
  last.added = "unknown_force", last.roles = {{"of", "w"}, {"port", "dw/dt"}};
  EXPECT_THAT(c.verdict().notes, Contains("Its curve of unknown form, " + name + ", is in the last model already and leaves this."));
  EXPECT_EQ(c.verdict().next, "misfit open configs/motor");
}

TEST(Verdict, ACurveOfUnknownFormThatWasAddedIsCalledWhatItIsACurveOf) {
  Case c;
  c.add_effect();
  c.discovery = searched({}, SearchOutcome::none_missing, "");
  Rung& last = c.ladder->rungs.back();
  last.added = "unknown_variation", last.roles = {{"parameter", "Bl"}, {"with", "x"}};
  EXPECT_THAT(c.verdict().sentence,
              testing::StartsWith("A change of Bl that depends on x (unknown_variation, a curve) was missing: with it"));
  last.added = "unknown_force", last.roles = {{"of", "w"}, {"port", "dw/dt"}};
  EXPECT_THAT(c.verdict().sentence,
              testing::StartsWith("A force on dw/dt that depends on w (unknown_force, a curve) was missing: with it"));
  last.roles.reset();  // of an older file
  EXPECT_THAT(c.verdict().sentence, testing::StartsWith("unknown_force was missing"));
  c.discovery = searched({}, SearchOutcome::unknown_form, "");
  c.discovery->unexplained_port = "dw/dt", c.discovery->unexplained_quantity = "time";
  EXPECT_THAT(c.verdict().sentence, testing::StartsWith("unknown_force explains a part of what is missing")) << "a curve takes up anything";
}

/// What the sentence says is not said again in the list below it.
TEST(Verdict, AnErrorOfTheSentenceIsNotListed) {
  Case c;
  c.add_effect();
  const Verdict v = c.verdict();
  ASSERT_FALSE(v.errors.empty());
  const std::string said = v.errors.front().what() + ": ";
  const std::string text = as_text(blocks_of(v));
  EXPECT_THAT(v.sentence, HasSubstr(v.errors.front().what()));
  EXPECT_THAT(text, Not(HasSubstr(said)));
  ASSERT_GT(v.errors.size(), 1U);
  EXPECT_THAT(text, HasSubstr(v.errors.back().what() + ": "));
}

TEST(Verdict, AnErrorOfUnknownFormIsNotCalledAForce) {
  Case c;
  c.discovery = searched({candidate("lag", 0.5, false)}, SearchOutcome::unknown_form, "Something is missing that depends on w");
  c.discovery->unexplained_port = "V";
  c.discovery->unexplained_quantity = "w";
  c.discovery->unexplained_error = true;
  EXPECT_THAT(c.verdict().sentence, AllOf(HasSubstr("depends on w: an error of V that no effect"), Not(HasSubstr("force"))));
}

TEST(Verdict, WhatIsOutdatedIsNamedWithTheReasonAndTheCommandThatMakesItAnew) {
  Case c;
  VerdictInput input{"configs/motor", "", &c.fits};
  input.left_out = "earlier results in out (diagnosis.json) are left out: they are of another build of misfit (0.1, a; this one is 0.2, b)";
  input.anew = "misfit run configs/motor";
  EXPECT_THAT(verdict_of(input).sentence,
              AllOf(testing::StartsWith("Earlier results in out (diagnosis.json) are left out: they are of another build of misfit"),
                    EndsWith("; where the model fails and what it lacks are to be looked for again."), Not(HasSubstr("not been looked"))));
  EXPECT_EQ(verdict_of(input).next, "misfit run configs/motor");
  c.add_effect();
  input.ladder = &*c.ladder;
  EXPECT_THAT(verdict_of(input).sentence, AllOf(testing::StartsWith("coulomb_friction was missing"), HasSubstr("; earlier results in out"),
                                                EndsWith("; whether more is missing is to be looked for again.")));
}

TEST(Verdict, WithoutAUsableFitItSaysWhy) {
  Case c;
  c.fits.front().status = FitStatus::declined;
  c.fits.front().message = "too few samples";
  EXPECT_EQ(c.verdict().kind, VerdictKind::no_result);
  EXPECT_THAT(c.verdict().sentence, HasSubstr("filter_error declined: too few samples"));
  EXPECT_EQ(c.verdict().next, "");
}

TEST(Verdict, TheTrimStandsWithItsIntervalBesideTheReferences) {
  Case c;
  c.add_effect();
  c.ladder->rungs[0].trim = Estimate{0.20, 0.01, "m"};
  c.ladder->rungs[1].trim = Estimate{0.30, 0.01, "m"};
  Comparison comparison;
  comparison.reference_trims = {{"truth", {0.31, 0.0, "m"}}};
  VerdictInput input{"configs/motor", "", &c.fits};
  input.ladder = &*c.ladder;
  input.comparison = &comparison;
  ASSERT_TRUE(verdict_of(input).trim);
  EXPECT_EQ(shown(*verdict_of(input).trim), "0.200 ± 0.010 m to 0.300 ± 0.010 m (95 %: 0.280 to 0.320 m; truth: 0.31 m)");
}

TEST(Verdict, IsWrittenWithTheChangeInPerCent) {
  const TemporaryFolder folder;
  Case c;
  c.add_effect();
  write_verdict(folder.path() / "verdict.json", c.verdict());
  expect_parts(read_file(folder.path() / "verdict.json"), {"\"verdict\": \"effect_added\"", "\"change_per_cent\": -85.0", "\"unit\": \"V\"",
                                                           "\"next\": \"misfit discover configs/motor\""});
}

TEST(Verdict, CommandsNameTheRunFolderAndQuoteWhatAShellWouldSplit) {
  const std::vector<Fit> fits{filter_fit()};
  const VerdictInput input{"my studies/motor", "out 2", &fits};
  EXPECT_EQ(verdict_of(input).next, "misfit diagnose 'my studies/motor' --out 'out 2'");
}

}  // namespace
}  // namespace misfit
