// diagnosis.json, candidates.json, discovery.json and ladder.json: what is written is read back, and nothing that is not a number is
// written as one.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "misfit/data/candidates.h"
#include "misfit/data/diagnosis.h"
#include "misfit/data/ladder.h"
#include "tests/core/temporary_folder.h"

namespace misfit {
namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

nlohmann::json parsed(const std::filesystem::path& path) {
  const std::string text = read_file(path);
  EXPECT_EQ(text.find("nan"), std::string::npos) << path;
  EXPECT_EQ(text.find("inf"), std::string::npos) << path;
  return nlohmann::json::parse(text);
}

Diagnosis example_diagnosis() {
  Diagnosis d;
  d.method = "filter_error";
  d.sentences = {"first", "second"};
  d.seconds = 1.5;
  d.whiteness = {{"flight", "P_y", {1.0, 0.02, nan}, 0.03, 40, 55.0, 0.057, {0.1, 0.2}, {0.9, 3.0}, 0.2, 0.2, 3.0, 0.6}};
  d.maps = {{"pitching_moment",
             "N m",
             "phi",
             "rad",
             {-1.0, 0.0, 1.0},
             {41.0, nan, 2.0},
             {6.0, nan, 5.0},
             {100.0, 0.0, 90.0},
             47.0,
             2,
             1e-10,
             5e-9,
             "too high"}};
  d.pairs = {{"lateral_moment",
              "N m",
              "alpha_T",
              "rad",
              "phi",
              "rad",
              {0.1, 0.2},
              {0.0, 1.0},
              {1.0, nan, 3.0, 4.0},
              {1.0, nan, 1.0, 1.0},
              20.0,
              3,
              1e-4,
              0.01}};
  d.nis = {{"flight", {0.0, 1.0}, {1.1, 0.9}, 0.8, 1.2, 0.05}};
  d.missing = {
      {"flight", {0.0, 0.1}, {"moment_y"}, {"N m"}, {{3.0, -4.0}}, {{1.0, 1.5}}, {"phi", "n_y"}, {"rad", "-"}, {{0.5, nan}, {0.1, 0.2}}}};
  MissingForce other = d.missing.front();
  other.experiment = "second";
  other.force = {{7.0, 8.0}};
  d.missing.push_back(other);
  return d;
}

TEST(DiagnosisFiles, ReadBackWhatWasWritten) {
  const TemporaryFolder folder;
  const Diagnosis d = example_diagnosis();
  write_diagnosis(folder.path(), d);
  const Diagnosis back = read_diagnosis(folder.path());
  EXPECT_EQ(back.method, d.method);
  EXPECT_EQ(back.sentences, d.sentences);
  EXPECT_EQ(back.seconds, d.seconds);
  ASSERT_EQ(back.whiteness.size(), 1U);
  EXPECT_EQ(back.whiteness[0].channel, "P_y");
  EXPECT_EQ(back.whiteness[0].lags, 40);
  EXPECT_EQ(back.whiteness[0].autocorrelation[1], 0.02);
  EXPECT_TRUE(std::isnan(back.whiteness[0].autocorrelation[2]));
  EXPECT_EQ(back.whiteness[0].power, d.whiteness[0].power);
  EXPECT_EQ(back.whiteness[0].peak_p, 0.6);
  ASSERT_EQ(back.maps.size(), 1U);
  EXPECT_EQ(back.maps[0].x, d.maps[0].x);
  EXPECT_EQ(back.maps[0].p_corrected, 5e-9);
  EXPECT_EQ(back.maps[0].sentence, "too high");
  EXPECT_TRUE(std::isnan(back.maps[0].amplitude[1]));
  ASSERT_EQ(back.pairs.size(), 1U);
  EXPECT_EQ(back.pairs[0].quantity_y, "phi");
  EXPECT_EQ(back.pairs[0].amplitude[3], 4.0);
  ASSERT_EQ(back.nis.size(), 1U);
  EXPECT_EQ(back.nis[0].upper, 1.2);
  EXPECT_EQ(back.nis[0].nis, d.nis[0].nis);
  ASSERT_EQ(back.missing.size(), 2U);
  EXPECT_EQ(back.missing[0].force, d.missing[0].force);
  EXPECT_EQ(back.missing[1].force, d.missing[1].force);
  EXPECT_NEAR(back.missing[0].values[0][0], 0.5, 1e-8);
  EXPECT_TRUE(std::isnan(back.missing[0].values[0][1]));
}

TEST(DiagnosisFiles, ForceOverTimeIsATableWithSigmaQuantitiesAndUnits) {
  const TemporaryFolder folder;
  write_diagnosis(folder.path(), example_diagnosis());
  const std::string text = read_file(folder.path() / "missing_force.csv");
  EXPECT_EQ(text.substr(0, text.find('\n')), "t[s],moment_y[N m],moment_y_sigma[N m],phi[deg],n_y[-]");
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "missing_force_second.csv"));
  EXPECT_TRUE(parsed(folder.path() / "diagnosis.json")["maps"][0]["amplitude"][1].is_null());
}

TEST(DiagnosisFiles, ABrokenFileIsNamed) {
  const TemporaryFolder folder;
  folder.write("diagnosis.json", "{\"method\": 3}");
  expect_parts(message_of<InputError>([&] { static_cast<void>(read_diagnosis(folder.path())); }), {"diagnosis.json"});
}

Discovery example_discovery() {
  Discovery d;
  Candidate wake;
  wake.rank = 1;
  wake.effect = "strut_wake";
  wake.family = CandidateFamily::physics;
  wake.ports = {"pitching_moment", "lateral_moment"};
  wake.roles = {{"rate", "pitch_rate"}};
  wake.score = 280.0;
  wake.dof = 2;
  wake.predicted_drop = 275.0;
  wake.actual_drop = 290.0;
  wake.held_out_gain = 31.0;
  wake.p_value = 1e-50;
  wake.group = {"strut_wake", "other"};
  wake.accepted = true;
  wake.why = "it is";
  wake.parameters = {{"clock", {-1.57, 0.02, "rad"}}};
  wake.force = {{"moment", {26.9, 0.7, "N m"}}};
  Candidate other;
  other.rank = 2;
  other.effect = "unknown:pitching_moment(phi)";
  other.absorbed = true;
  other.predicted_drop = nan;
  wake.added = {{"flight", {0.0, 0.5}, {"pitching_moment", "lateral_moment"}, {"N m", "N m"}, {{1.0, -2.0}, {0.0, 3.5}}},
                {"second", {4.0}, {"lateral_moment"}, {"N m"}, {{7.0}}}};
  other.added = {{"flight", {0.0, 0.5}, {"dw/dt"}, {"rad/s^2"}, {{1.0, 2.0}}}};
  d.candidates = {wake, other};
  d.outcome = SearchOutcome::accepted;
  d.verdict = "add strut_wake";
  d.sentences = {"a remark"};
  d.tried = {"14 effects"};
  d.not_tried = {{{"lag", {{"input", "wind"}}}, "input 'wind' is not recorded"}};
  d.force = {{"moment", {31.0, 0.8, "N m"}}};
  d.sweep_asks = {"camera_roll"};
  d.fixed_parameters = {{"k is fixed at 39"}};
  d.unexplained_port = "dw/dt";
  d.unexplained_quantity = "w";
  d.unexplained_error = true;
  d.unexplained_effects = {{"unknown_error", {{"of", "w"}, {"output", "y"}}}};
  d.seconds = 12.0;
  return d;
}

TEST(DiscoveryFiles, CandidatesAreAnArrayWithTheKeysOfTheContract) {
  const TemporaryFolder folder;
  write_discovery(folder.path(), example_discovery());
  const nlohmann::json array = parsed(folder.path() / "candidates.json");
  ASSERT_TRUE(array.is_array());
  for (const char* key : {"rank", "effect", "ports", "score", "predicted_drop", "actual_drop", "held_out_gain", "p_value", "group",
                          "accepted", "why", "parameters"}) {
    EXPECT_TRUE(array[0].contains(key) && array[1].contains(key)) << key;
  }
  EXPECT_TRUE(array[1]["actual_drop"].is_null());
  EXPECT_TRUE(array[1]["predicted_drop"].is_null());
  EXPECT_EQ(array[0]["parameters"]["clock"]["unit"], "rad");
  EXPECT_EQ(parsed(folder.path() / "discovery.json")["verdict"], "add strut_wake");
}

TEST(DiscoveryFiles, AddedForcesAreTablesByRankAndPort) {
  const TemporaryFolder folder;
  const Discovery d = example_discovery();
  write_discovery(folder.path(), d);
  const std::string text = read_file(folder.path() / "added_force.csv");
  EXPECT_EQ(text.substr(0, text.find('\n')), "t[s],1 pitching_moment[N m],1 lateral_moment[N m],2 dw/dt[deg/s^2]");
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "added_force_second.csv"));
  const Discovery back = read_discovery(folder.path());
  for (std::size_t c = 0; c < d.candidates.size(); ++c) {
    ASSERT_EQ(back.candidates[c].added.size(), d.candidates[c].added.size());
    for (std::size_t e = 0; e < d.candidates[c].added.size(); ++e) {
      const AddedForce &read = back.candidates[c].added[e], &written = d.candidates[c].added[e];
      EXPECT_EQ(read.experiment, written.experiment);
      EXPECT_EQ(read.t, written.t);
      EXPECT_EQ(read.ports, written.ports);
      EXPECT_EQ(read.port_units, written.port_units);
      for (std::size_t p = 0; p < written.force.size(); ++p) {
        for (std::size_t k = 0; k < written.t.size(); ++k) EXPECT_NEAR(read.force[p][k], written.force[p][k], 1e-7);
      }
    }
  }
}

TEST(DiscoveryFiles, WithoutAddedForcesThereIsNoTable) {
  const TemporaryFolder folder;
  Discovery d = example_discovery();
  for (Candidate& c : d.candidates) c.added.clear();
  write_discovery(folder.path(), d);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "added_force.csv"));
  EXPECT_EQ(read_discovery(folder.path()).candidates.size(), d.candidates.size());
}

TEST(DiscoveryFiles, ReadBackWhatWasWritten) {
  const TemporaryFolder folder;
  const Discovery d = example_discovery();
  write_discovery(folder.path(), d);
  const Discovery back = read_discovery(folder.path());
  EXPECT_EQ(back.outcome, d.outcome);
  EXPECT_EQ(back.verdict, d.verdict);
  EXPECT_EQ(back.sentences, d.sentences);
  EXPECT_EQ(back.tried, d.tried);
  EXPECT_EQ(not_tried_in_words(back), not_tried_in_words(d));
  EXPECT_EQ(back.sweep_asks, d.sweep_asks);
  EXPECT_EQ(back.fixed_parameters, d.fixed_parameters);
  EXPECT_EQ(back.unexplained_port, "dw/dt");
  EXPECT_EQ(back.unexplained_quantity, "w");
  EXPECT_TRUE(back.unexplained_error);
  ASSERT_EQ(back.unexplained_effects.size(), 1U);
  EXPECT_EQ(back.unexplained_effects.front().effect, "unknown_error");
  EXPECT_EQ(back.unexplained_effects.front().roles, d.unexplained_effects.front().roles);
  EXPECT_EQ(back.force.at("moment").sigma, 0.8);
  ASSERT_EQ(back.candidates.size(), 2U);
  const Candidate& wake = back.candidates[0];
  EXPECT_EQ(wake.effect, "strut_wake");
  EXPECT_EQ(wake.family, CandidateFamily::physics);
  EXPECT_EQ(wake.ports, d.candidates[0].ports);
  EXPECT_EQ(wake.roles, d.candidates[0].roles);
  EXPECT_EQ(wake.actual_drop, 290.0);
  EXPECT_EQ(wake.held_out_gain, 31.0);
  EXPECT_EQ(wake.group, d.candidates[0].group);
  EXPECT_TRUE(wake.accepted);
  EXPECT_EQ(wake.dof, 2);
  EXPECT_EQ(wake.parameters.at("clock").value, -1.57);
  EXPECT_EQ(wake.force.at("moment").value, 26.9);
  EXPECT_TRUE(back.candidates[1].absorbed);
  EXPECT_FALSE(back.candidates[1].actual_drop.has_value());
}

Ladder example_ladder() {
  Ladder ladder;
  Rung first;
  first.study = "../study.toml";
  first.system = "parachute_planar";
  first.method = "filter_error";
  first.loglik = -1000.0;
  first.force = {{"pitching_moment", {31.0, 0.8, "N m"}}};
  first.rms = {{"alpha_T", {0.01, 0.0, "rad"}}};
  first.k_step = {{"alpha_T", {0.01, 0.02, nan}}};
  first.trim = Estimate{12.0 * degree, 0.2 * degree, "rad"};
  Rung second = first;
  second.id = 1;
  second.parent = 0;
  second.added = "coning";
  second.study = "rungs/01_coning/study.toml";
  second.predicted_drop = 500.0;
  second.actual_drop = 517.0;
  second.held_out_gain = 120.0;
  second.validation_loglik = -300.0;
  second.validation_rms = {{"alpha_T", {0.011, 0.0, "rad"}}};
  second.parameters = {{"c_coning", {1.02, 0.03, "-"}}};
  second.trim.reset();
  second.note = "words";
  second.gain_of_search = 27.7;
  second.remained = "an unknown curve dw/dt(w)";
  ladder.rungs = {first, second};
  return ladder;
}

Candidate imitation(const std::string& effect, double drop, double held_out_gain) {
  Candidate c;
  c.effect = effect;
  c.actual_drop = drop;
  c.held_out_gain = held_out_gain;
  c.remaining = "an unknown curve dw/dt(w)";
  c.ports = {"dw/dt"};
  return c;
}

Discovery of_unknown_form(std::vector<Candidate> candidates) {
  Discovery d;
  d.candidates = std::move(candidates);
  d.unexplained_port = "dw/dt";
  return d;
}

TEST(CandidateToBeginWith, GainsMostInAllOfThoseBesideWhichSomethingRemains) {
  EXPECT_EQ(candidate_to_begin_with(of_unknown_form({})), nullptr);
  Discovery d = of_unknown_form({imitation("cubic_damping", 310.0, 20.0), imitation("coulomb_friction", 300.0, 190.0)});
  ASSERT_NE(candidate_to_begin_with(d), nullptr);
  EXPECT_EQ(candidate_to_begin_with(d)->effect, "coulomb_friction") << "340 against 175";
  d.candidates[1].remaining.reset();  // refused for something else
  ASSERT_NE(candidate_to_begin_with(d), nullptr);
  EXPECT_EQ(candidate_to_begin_with(d)->effect, "cubic_damping");
}

Candidate short_ahead(const std::string& effect, double drop, double held_out_gain, double growth) {
  Candidate c = imitation(effect, drop, held_out_gain);
  c.remaining.reset();
  c.grows_ahead = growth;
  return c;
}

Candidate accepted(Candidate c) {
  c.accepted = true;
  return c;
}

TEST(CandidateShortAhead, GainsMostOfAllAndIsRefusedForItsPredictionsFartherAheadAlone) {
  Discovery d;
  d.candidates = {short_ahead("coulomb_friction", 610.0, 1260.0, 1.28), imitation("lag", 61.0, 185.0)};
  ASSERT_NE(candidate_short_ahead(d), nullptr);
  EXPECT_EQ(candidate_short_ahead(d)->effect, "coulomb_friction");
  d.candidates[1] = imitation("input_dead_zone", 900.0, 1260.0);
  EXPECT_EQ(candidate_short_ahead(d), nullptr) << "another one, refused for something else, gains more";
  d.candidates[1] = imitation("input_dead_zone", 1300.0, 0.0);
  d.candidates[1].held_out_gain.reset();
  EXPECT_EQ(candidate_short_ahead(d), nullptr) << "what was refused before explains more than twice as much";
  d.candidates[1] = accepted(imitation("lag", 61.0, 185.0));
  EXPECT_EQ(candidate_short_ahead(d), nullptr) << "one is accepted";
  d.candidates = {short_ahead("coulomb_friction", 610.0, 1260.0, 2.1)};
  EXPECT_EQ(candidate_short_ahead(d), nullptr) << "it loses the motion";
  EXPECT_EQ(candidate_short_ahead({}), nullptr);
}

TEST(CandidatesBeside, AreThreeThatGainOnWhatIsHeldOutTheLargestFirst) {
  Discovery d;
  Candidate refused = imitation("delay", 190.0, 400.0);
  refused.remaining.reset();
  d.candidates = {refused,
                  imitation("load_friction", 46.0, 143.0),
                  imitation("sensor_quantisation", 74.0, -620.0),
                  imitation("lag", 61.0, 185.0),
                  accepted(imitation("bias", 20.0, 3.0)),
                  imitation("drift", 20.0, 2.0)};
  const std::vector<Candidate> beside = candidates_beside(d);
  ASSERT_EQ(beside.size(), 3U);
  EXPECT_EQ(beside[0].effect, "lag");
  EXPECT_EQ(beside[1].effect, "load_friction");
  EXPECT_EQ(beside[2].effect, "bias");
}

/// The curve holds the line, which could only stand in its way.
TEST(CandidateToBeginWith, IsNoPartOfTheChangeOfAParameterThatIsFound) {
  Candidate line = imitation("varying_parameter", 300.0, 190.0);
  line.ports = {"Bl"};
  line.roles = {{"parameter", "Bl"}, {"with", "x"}};
  Discovery d = of_unknown_form({line});
  d.unexplained_port = "Bl";
  d.unexplained_quantity = "x";
  d.unexplained_parameter = true;
  EXPECT_EQ(candidate_to_begin_with(d), nullptr);
  d.unexplained_quantity = "v";
  EXPECT_NE(candidate_to_begin_with(d), nullptr) << "a change with something else";
}

TEST(CandidateToBeginWith, ActsWhereTheModelFails) {
  Discovery d = of_unknown_form({imitation("sensor_lag", 310.0, 20.0)});
  d.candidates.front().ports = {"y"};
  EXPECT_EQ(candidate_to_begin_with(d), nullptr);
}

TEST(CandidateToBeginWith, IsAForceWhereWhatItLeavesLooksLikeAnErrorOfAnOutput) {
  Discovery d = of_unknown_form({imitation("load_friction", 243.0, 90.0)});
  d.unexplained_port = "angle";
  EXPECT_EQ(candidate_to_begin_with(d), nullptr) << "a force elsewhere";
  d.unexplained_error = true;
  EXPECT_NE(candidate_to_begin_with(d), nullptr);
  d.candidates.front().family = CandidateFamily::sensor;
  EXPECT_EQ(candidate_to_begin_with(d), nullptr) << "of another output";
}

TEST(CandidateToBeginWith, IsNotChosenPastWhatExplainsMore) {
  Candidate curve;
  curve.effect = "unknown:dw/dt(w)";
  curve.family = CandidateFamily::unknown;
  curve.dof = 8;
  curve.score = 315.0;
  Discovery d = of_unknown_form({imitation("coulomb_friction", 300.0, 190.0), curve});
  d.unexplained_effects = {{"unknown_force", {{"of", "w"}, {"port", "dw/dt"}}}};
  EXPECT_NE(candidate_to_begin_with(d), nullptr) << "299 after its 8 coefficients";
  d.candidates.back().score = 317.0;
  EXPECT_EQ(candidate_to_begin_with(d), nullptr);
  d.unexplained_effects.clear();
  EXPECT_NE(candidate_to_begin_with(d), nullptr) << "a curve that nothing adds stands in the way of nothing";
  d.candidates.back().score = 617.0;
  EXPECT_EQ(candidate_to_begin_with(d), nullptr) << "more than twice as much";
  Candidate refused;
  refused.effect = "delay";
  refused.actual_drop = 599.0;
  d.candidates.back() = refused;
  EXPECT_NE(candidate_to_begin_with(d), nullptr);
  d.candidates.back().actual_drop = 601.0;
  EXPECT_EQ(candidate_to_begin_with(d), nullptr) << "more than twice as much";
}

TEST(CandidateToBeginWith, IsChosenPastTheCurveThatWasAddedInVain) {
  Candidate curve, elsewhere;
  curve.effect = "unknown:angle(w)";
  elsewhere.effect = "unknown:dw/dt(w)";
  curve.family = elsewhere.family = CandidateFamily::unknown;
  curve.dof = elsewhere.dof = 24;
  curve.score = 744.0;
  elsewhere.score = 610.0;
  Discovery d = of_unknown_form({imitation("coulomb_friction", 297.0, 191.0), curve, elsewhere});
  d.unexplained_port = "angle";
  d.unexplained_quantity = "w";
  d.unexplained_error = true;
  d.unexplained_effects = {{"unknown_error", {{"of", "w"}, {"output", "angle"}}}};
  EXPECT_EQ(candidate_to_begin_with(d), nullptr);
  const auto after = candidate_after_the_curve(d);
  ASSERT_TRUE(after);
  EXPECT_EQ(after->effect, "coulomb_friction") << "562 of the other curve are less than twice 297";
  d.candidates.back().score = 650.0;
  EXPECT_FALSE(candidate_after_the_curve(d)) << "more than twice as much";
}

TEST(LadderFile, ReadsBackWhatWasWritten) {
  const TemporaryFolder folder;
  const Ladder ladder = example_ladder();
  write_ladder(folder.path() / "ladder.json", ladder);
  const nlohmann::json array = parsed(folder.path() / "ladder.json");
  for (const char* key :
       {"id", "parent", "study", "added", "predicted_drop", "actual_drop", "held_out_gain", "force", "rms", "validation_rms"}) {
    EXPECT_TRUE(array[0].contains(key)) << key;
  }
  EXPECT_TRUE(array[0]["parent"].is_null());
  EXPECT_NEAR(array[0]["trim_deg"]["value"].get<double>(), 12.0, 1e-12);
  const Ladder back = read_ladder(folder.path() / "ladder.json");
  ASSERT_EQ(back.rungs.size(), 2U);
  EXPECT_EQ(back.rungs[0].parent, -1);
  EXPECT_FALSE(back.rungs[0].predicted_drop.has_value());
  EXPECT_EQ(back.rungs[0].system, "parachute_planar");
  EXPECT_EQ(back.rungs[0].loglik, -1000.0);
  EXPECT_TRUE(std::isnan(back.rungs[0].k_step.at("alpha_T")[2]));
  EXPECT_NEAR(back.rungs[0].trim->sigma, 0.2 * degree, 1e-15);
  const Rung& second = back.rungs[1];
  EXPECT_EQ(second.id, 1);
  EXPECT_EQ(second.parent, 0);
  EXPECT_EQ(second.added, "coning");
  EXPECT_EQ(second.predicted_drop, 500.0);
  EXPECT_EQ(second.actual_drop, 517.0);
  EXPECT_EQ(second.held_out_gain, 120.0);
  EXPECT_EQ(second.validation_loglik, -300.0);
  EXPECT_EQ(second.rms.at("alpha_T").unit, "rad");
  EXPECT_EQ(second.validation_rms.at("alpha_T").value, 0.011);
  EXPECT_EQ(second.parameters.at("c_coning").sigma, 0.03);
  EXPECT_FALSE(second.trim.has_value());
  EXPECT_EQ(second.note, "words");
  EXPECT_EQ(second.gain_of_search, 27.7);
  EXPECT_EQ(second.remained, "an unknown curve dw/dt(w)");
  EXPECT_FALSE(back.rungs[0].remained.has_value());
}

TEST(LadderFile, ABrokenFileIsNamed) {
  const TemporaryFolder folder;
  const auto path = folder.write("ladder.json", "[{}]");
  expect_parts(message_of<InputError>([&] { static_cast<void>(read_ladder(path)); }), {"ladder.json", "id"});
}

}  // namespace
}  // namespace misfit
