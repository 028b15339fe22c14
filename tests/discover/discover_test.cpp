#include "misfit/discover/discover.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "misfit/discover/candidate.h"
#include "misfit/discover/screen.h"
#include "misfit/discover/verdict.h"
#include "misfit/inference/beyond_record.h"
#include "tests/fit/flight.h"

namespace misfit {
namespace {

using namespace testing_flight;

struct Flight {
  std::vector<Signals> signals;
  ModelRequest request;
  FilterEstimate estimate;
  explicit Flight(const Signals& flight) : signals{flight}, request(request_for(signals)), estimate(fitted(request, signals)) {}
  [[nodiscard]] Discovery discover() const { return misfit::discover({estimate, request, registry(), signals}); }
};

TEST(Discover, IsSilentWhereNothingIsMissing) {
  const Discovery found = Flight(fly(15.0, 31)).discover();
  EXPECT_THAT(found.verdict, testing::StartsWith("No missing effect detected"));
  EXPECT_TRUE(found.unexplained_quantity.empty());
  for (const auto& c : found.candidates) EXPECT_FALSE(c.accepted) << c.effect;
}

TEST(Discover, NamesAPlantedFriction) {
  const Discovery found = Flight(fly(14.0, 32, {effect("coulomb_friction")}, {{"friction", 25.0}, {"width", 0.02}})).discover();
  ASSERT_FALSE(found.candidates.empty());
  const Candidate& first = found.candidates.front();
  EXPECT_EQ(first.effect, "coulomb_friction") << found.verdict;
  EXPECT_TRUE(first.accepted) << first.why;
  const Estimate friction = first.parameters.at("friction");
  EXPECT_LT(std::abs(friction.value - 25.0), 3.0 * friction.sigma) << friction.value << " ± " << friction.sigma;
  ASSERT_TRUE(first.actual_drop.has_value());
  EXPECT_GT(first.predicted_drop, 0.7 * *first.actual_drop);
  EXPECT_LT(first.predicted_drop, 1.4 * *first.actual_drop);
}

TEST(Discover, OnlyOneEffectIsPredictedAsInTheWholeSearch) {
  const Flight flight(fly(14.0, 32, {effect("coulomb_friction")}, {{"friction", 25.0}, {"width", 0.02}}));
  const Discovery whole = flight.discover();
  DiscoverOptions options;
  options.only = "coulomb_friction";
  const Discovery one = misfit::discover({flight.estimate, flight.request, registry(), flight.signals}, options);
  ASSERT_EQ(one.candidates.size(), 1U);
  const auto same =
      std::find_if(whole.candidates.begin(), whole.candidates.end(), [](const Candidate& c) { return c.effect == "coulomb_friction"; });
  ASSERT_NE(same, whole.candidates.end());
  EXPECT_DOUBLE_EQ(one.candidates[0].score, same->score);
  EXPECT_DOUBLE_EQ(one.candidates[0].predicted_drop, same->predicted_drop);
  EXPECT_FALSE(one.candidates[0].actual_drop.has_value());
  EXPECT_LT(one.candidates[0].p_value, 0.01);
  options.refit_best_of = [](const Candidate&) { return true; };
  const Discovery refitted = misfit::discover({flight.estimate, flight.request, registry(), flight.signals}, options);
  EXPECT_NEAR(refitted.candidates.at(0).actual_drop.value_or(0.0), same->actual_drop.value_or(1e9), 1e-6 * *same->actual_drop);
  options.only = "coning";  // in the spherical system already
  EXPECT_TRUE(misfit::discover({flight.estimate, flight.request, registry(), flight.signals}, options).candidates.empty());
}

TEST(Verdict, AStrengthAtItsBoundIsNamedAndOneAtZeroIsNot) {
  Model model = assemble(spherical({effect("strut_wake"), effect("coulomb_friction")}), registry());
  const int depth = model.find_parameter("wake_depth"), friction = model.find_parameter("friction");
  set(model, "wake_depth", 1.0 - 1e-5);
  set(model, "friction", 0.0);
  const auto found = ends_at_bound(model, {friction, depth});
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(*found, "its strength wake_depth ends at its bound 1");
  set(model, "wake_depth", 0.98);
  EXPECT_FALSE(ends_at_bound(model, {friction, depth}).has_value());
}

TEST(Verdict, ALagLongerThanHalfOfTheRecordingIsNone) {
  Model model = assemble(parachute(true, {effect("lag")}), registry());
  set(model, "tau", 62.0);
  const auto found = outlasts_recording(model, model.effects.back(), 40.0);
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(*found, "tau = 62 s is longer than half of the recording, 40 s");
  EXPECT_FALSE(outlasts_recording(model, model.effects.back(), 200.0).has_value());
  ModelRequest slow = cart({effect("periodic_forcing")});
  slow.parameters["frequency"].value = 0.02;
  const Model forced = assemble(slow, registry()), drifting = assemble(parachute(true, {effect("drift")}), registry());
  EXPECT_THAT(outlasts_recording(forced, forced.effects.back(), 40.0).value_or(""), testing::HasSubstr("less than one period"));
  EXPECT_FALSE(outlasts_recording(forced, forced.effects.back(), 60.0).has_value());
  EXPECT_FALSE(outlasts_recording(drifting, drifting.effects.back(), 40.0).has_value()) << "drift remembers nothing";
}

Signals position_of_cart(const std::function<double(double)>& position) {
  Signals s;
  s.measured = {{"position_reading", "-", {}}, {"speed_reading", "m/s", {}}};
  for (int i = 0; i < 400; ++i) {
    s.t.push_back(0.05 * i);
    s.measured[0].values.push_back(i % 50 == 7 ? std::nan("") : position(s.t.back()));
    s.measured[1].values.push_back(0.0);
  }
  return s;
}

TEST(Verdict, AStepOfAnOutputMustBeThatOfItsMeasurements) {
  Model model = assemble(cart({effect("sensor_quantisation", {{"output", "position_reading"}})}), registry());
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 0.003);
  const auto moving = [](double t) { return 3.95 + 0.2 * std::sin(0.7 * t); };
  const auto rounded = [&](double t) { return 0.02 * std::round(moving(t) / 0.02) + 0.007; };
  const Signals plain = position_of_cart([&](double t) { return moving(t) + noise(random); });
  const Signals steps = position_of_cart(rounded);
  const Signals noisy_steps = position_of_cart([&](double t) { return rounded(t) + noise(random); });

  set(model, "step", 0.77);
  const auto found = off_whole_steps(model, {steps, plain});
  ASSERT_TRUE(found.has_value());
  EXPECT_THAT(*found, testing::AllOf(testing::HasSubstr("its step = 0.77, but the measurements are 0.1"),
                                     testing::HasSubstr("(RMS) from multiples of it")));
  set(model, "step", 0.02);
  EXPECT_FALSE(off_whole_steps(model, {plain}).has_value()) << "3 mm of noise hide whether there are steps of 20 mm";
  EXPECT_FALSE(off_whole_steps(model, {steps, noisy_steps}).has_value());
  EXPECT_EQ(on_whole_steps(model, {steps}), "the measurements are in whole steps of 0.02 all the same, noise of 0.0057735 to a filter");
  EXPECT_FALSE(on_whole_steps(model, {steps, plain}).has_value()) << "hidden is not seen";
  set(model, "step", 0.07);
  EXPECT_TRUE(off_whole_steps(model, {steps}).has_value());
  EXPECT_FALSE(off_whole_steps(assemble(cart({effect("sensor_lag", {{"output", "position_reading"}})}), registry()), {plain}).has_value());
}

/// Sigmas 8 N m of the friction and 0.2 of the wake's depth.
TEST(Verdict, StrengthsThatAreAllBelowTheirSigmaAreNotDetermined) {
  Model model = assemble(spherical({effect("strut_wake"), effect("coulomb_friction")}), registry());
  const int depth = model.find_parameter("wake_depth"), friction = model.find_parameter("friction");
  const std::vector<int> free = model.free_parameters();
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(std::ssize(free), std::ssize(free));
  const Eigen::Index f = std::find(free.begin(), free.end(), friction) - free.begin(),
                     d = std::find(free.begin(), free.end(), depth) - free.begin();
  ASSERT_TRUE(f < covariance.rows() && d < covariance.rows());
  covariance(f, f) = 64.0;
  covariance(d, d) = 0.04;
  set(model, "friction", 5.0);
  set(model, "wake_depth", 0.1);
  const auto found = undetermined_strengths(model, covariance, {friction, depth});
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(*found, "its strength is not determined: friction = 5.0 ± 8.0 N m, wake_depth = 0.10 ± 0.20");
  set(model, "friction", 20.0);
  EXPECT_FALSE(undetermined_strengths(model, covariance, {friction, depth}).has_value()) << "one is known";
  EXPECT_TRUE(undetermined_strengths(model, covariance, {depth}).has_value());
  EXPECT_FALSE(undetermined_strengths(model, Eigen::MatrixXd(), {depth}).has_value()) << "nothing is known of its sigma";
}

/// A scale of the model, 0.999 of whose error is the strength's too: given that scale, the friction is 5.0 ± 0.4 N m.
TEST(Verdict, AStrengthIsDeterminedWhereOnlyTheScaleOfTheModelIsNot) {
  Model model = assemble(spherical({effect("strut_wake"), effect("coulomb_friction")}), registry());
  const std::vector<int> free = model.free_parameters();
  const auto column = [&](const std::string& name) {
    return std::find(free.begin(), free.end(), model.find_parameter(name)) - free.begin();
  };
  const Eigen::Index f = column("friction"), scale = column("wake_depth");  // of another effect, as of the system
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(std::ssize(free), std::ssize(free));
  covariance(f, f) = 64.0;
  covariance(f, scale) = covariance(scale, f) = 0.999 * 8.0;
  set(model, "friction", 5.0);
  const std::vector<int> friction = {model.find_parameter("friction")};
  EXPECT_FALSE(undetermined_strengths(model, covariance, friction).has_value());
  covariance(f, scale) = covariance(scale, f) = 0.5 * 8.0;
  EXPECT_TRUE(undetermined_strengths(model, covariance, friction).has_value()) << "5.0 ± 6.9 N m given the scale";
}

/// The friction planted is 25 N m, a study that says "at most 10" stops the refit there.
TEST(Discover, DoesNotAcceptWhatEndsAtItsBound) {
  const Flight flight(fly(14.0, 32, {effect("coulomb_friction")}, {{"friction", 25.0}, {"width", 0.02}}));
  ModelRequest request = flight.request;
  request.parameters["friction"].upper = 10.0;
  const Discovery found = misfit::discover({flight.estimate, request, registry(), flight.signals});
  const auto friction =
      std::find_if(found.candidates.begin(), found.candidates.end(), [](const Candidate& c) { return c.effect == "coulomb_friction"; });
  ASSERT_NE(friction, found.candidates.end());
  EXPECT_FALSE(friction->accepted);
  EXPECT_THAT(friction->why, testing::HasSubstr("friction ends at its bound 10 N m")) << found.verdict;
}

Calibration asking_for_roll() {
  Calibration calibration;
  CameraTest roll;
  roll.name = "camera_roll";
  roll.p_value = 1e-9;
  calibration.tests = {roll};
  return calibration;
}

Discovery accepting(const std::string& effect, CandidateFamily family) {
  Discovery d;
  d.candidates.resize(1);
  d.candidates[0].effect = effect;
  d.candidates[0].family = family;
  d.candidates[0].accepted = true;
  return d;
}

TEST(Verdict, WhatTheSweepAsksForIsNotAcceptedButCalibrated) {
  const Calibration calibration = asking_for_roll();
  Discovery d = accepting("camera_roll", CandidateFamily::sensor);
  add_camera_remarks(&calibration, 0.01, d);
  EXPECT_FALSE(d.candidates[0].accepted);
  EXPECT_THAT(d.candidates[0].why, testing::HasSubstr("add camera_roll to [camera] free, then misfit run"));
  EXPECT_EQ(d.outcome, SearchOutcome::camera_incomplete);
  EXPECT_THAT(d.verdict, testing::StartsWith("The camera model is incomplete"));
  EXPECT_THAT(d.sweep_asks, testing::ElementsAre("camera_roll"));
}

TEST(Verdict, PhysicsSeenThroughACameraThatItsSweepDoubtsIsNotAccepted) {
  const Calibration calibration = asking_for_roll();
  Discovery d = accepting("strut_wake", CandidateFamily::physics);
  add_camera_remarks(&calibration, 0.01, d);
  EXPECT_FALSE(d.candidates[0].accepted);
  EXPECT_EQ(d.outcome, SearchOutcome::camera_against_flight);
  EXPECT_THAT(d.verdict, testing::StartsWith("Sweep and flight disagree"));
  EXPECT_THAT(d.verdict, testing::HasSubstr("the flight gives evidence of strut_wake"));
}

TEST(Verdict, AForceThatNothingExplainsIsNotTheCamerasAlone) {
  const Calibration calibration = asking_for_roll();
  Discovery d = accepting("camera_roll", CandidateFamily::sensor);
  d.unexplained_port = "moment";
  d.unexplained_quantity = "alpha_T";
  add_camera_remarks(&calibration, 0.01, d);
  EXPECT_THAT(d.verdict, testing::StartsWith("Sweep and flight disagree"));
  EXPECT_THAT(d.verdict, testing::HasSubstr("the flight gives evidence of a force on moment that depends on alpha_T"));
  EXPECT_FALSE(d.candidates[0].accepted);
}

TEST(Verdict, SignificantPhysicsThatWasRefusedIsNotTheCamerasAlone) {
  const Calibration calibration = asking_for_roll();
  Discovery d;
  d.candidates.resize(2);
  d.candidates[0].effect = "strut_wake";
  d.candidates[0].family = CandidateFamily::physics;
  d.candidates[0].p_value = 0.02;
  d.candidates[1].effect = "unknown:moment(phi)";
  d.candidates[1].family = CandidateFamily::unknown;
  d.candidates[1].p_value = 0.005;
  Discovery weaker = d;
  weaker.candidates[1].p_value = 0.05;
  add_camera_remarks(&calibration, 0.01, d);
  EXPECT_THAT(d.verdict, testing::StartsWith("Sweep and flight disagree"));
  EXPECT_THAT(d.verdict, testing::HasSubstr("the flight gives evidence of unknown:moment(phi) (family-wise p = 0.005)"));
  add_camera_remarks(&calibration, 0.01, weaker);
  EXPECT_THAT(weaker.verdict, testing::StartsWith("The camera model is incomplete"));
}

TEST(Verdict, ALargerDropThatIsRefusedIsNamed) {
  Discovery d;
  d.candidates.resize(2);
  d.candidates[0].effect = "strut_wake";
  d.candidates[0].accepted = true;
  d.candidates[0].actual_drop = 97.0;
  d.candidates[1].effect = "upwash";
  d.candidates[1].actual_drop = 100.0;
  d.candidates[1].why = "the held-out likelihood does not rise (-0.4)";
  write_verdict(d, std::nullopt, 0.01, false);
  EXPECT_EQ(d.outcome, SearchOutcome::accepted);
  EXPECT_THAT(d.verdict, testing::StartsWith("Missing: strut_wake"));
  EXPECT_THAT(d.sentences,
              testing::Contains("upwash has a larger drop (100) but is not accepted: the held-out likelihood does not rise (-0.4)"));
}

TEST(Screen, AStrengthThatCannotBeNegativeIsNot) {
  const Flight flight(fly(15.0, 33, {effect("viscous_friction")}, {{"viscosity", -12.0}}));
  const std::vector<CandidateModel> list = candidate_models(flight.estimate, flight.request, registry(), nullptr);
  const ScoreTest score(flight.estimate);
  const ForceSensitivity force(flight.estimate);
  int one_sided = 0;
  for (const auto& s : screen({flight.estimate, score, force}, list)) {
    if (s.candidate_model->strengths.size() != 1 || !s.candidate_model->one_sided.front() || !s.runs) continue;
    ++one_sided;
    EXPECT_GE(s.result.amplitude[0], 0.0) << s.candidate_model->effect;
    if (s.result.amplitude[0] == 0.0) {
      EXPECT_EQ(s.result.chi2, 0.0) << s.candidate_model->effect;
    }
  }
  EXPECT_GE(one_sided, 1);
}

TEST(Screen, FindsTheFrequencyOfALine) {
  const Flight flight(fly(15.0, 34, {effect("vortex_shedding")}, {{"y_cosine", 0.006}, {"z_sine", 0.004}, {"shedding_frequency", 2.7}}));
  const std::vector<CandidateModel> all = candidate_models(flight.estimate, flight.request, registry(), nullptr);
  std::vector<CandidateModel> list;
  for (const auto& s : all) {
    if (s.effect == "vortex_shedding") list.push_back(s);
  }
  ASSERT_EQ(list.size(), 1U);
  const ScoreTest score(flight.estimate);
  const ForceSensitivity force(flight.estimate);
  const std::vector<ScreeningResult> found = screen({flight.estimate, score, force}, list);
  EXPECT_NEAR(found[0].cell.back(), 2.7, 1.0 / (4.0 * 15.0));
  EXPECT_LT(found[0].p_value, 1e-4);
}

TEST(CandidateModels, LeaveOutWhatDoesNotSuit) {
  const Flight flight(fly(5.0, 35));
  std::vector<std::string> names;
  for (const auto& s : candidate_models(flight.estimate, flight.request, registry(), nullptr)) names.push_back(s.effect);
  EXPECT_THAT(names, testing::IsSupersetOf({"strut_wake", "vortex_shedding", "coulomb_friction", "camera_roll"}));
  for (const char* other : {"static_moment", "gravity", "gust", "apex_jitter", "coning", "periodic_forcing", "lag"})
    EXPECT_THAT(names, testing::Not(testing::Contains(other))) << "in the model, driven by noise, of another system, or specialised";
  for (const NotTried& n : list_candidates(flight.estimate, flight.request, registry(), nullptr).not_tried)
    ADD_FAILURE() << n.place.effect << ": " << n.reason;
}

/// Its coefficient is C_n/sin(alpha_T), as the formula reads it.
TEST(CandidateModels, ASideMomentIsLookedForThoughAStudyHasItAsACurve) {
  const Flight flight(fly(5.0, 35));
  const std::vector<CandidateModel> all = candidate_models(flight.estimate, flight.request, registry(), nullptr);
  const auto found = std::find_if(all.begin(), all.end(), [](const CandidateModel& s) { return s.effect == "side_moment"; });
  ASSERT_NE(found, all.end());
  ASSERT_EQ(found->strengths.size(), 1U);
  EXPECT_EQ(found->model.parameters[found->strengths.front()].name, "C_n");
  const CellScore cell = score_cell(flight.estimate, ScoreTest(flight.estimate), *found, found->cells.front());
  ASSERT_EQ(cell.result.dof, 1);
  EXPECT_LT(std::abs(cell.result.amplitude[0]), 4.0 * cell.result.sigma[0]) << "there is none";
  EXPECT_LT(cell.result.sigma[0], 1.0) << "and that is known";
}

/// Eq. 8 of the paper: the damping is called C_m_alphadot there, and alpha_T carries its sign.
TEST(CandidateModels, ADampingIsLookedForUnderTheNameThatTheSystemGivesIt) {
  Signals s;
  s.measured = {{"alpha_T", "rad", {}, 0.0}};
  s.inputs = {{"phi", "rad", {}, 0.0}, {"phi_rate", "rad/s", {}, 0.0}};
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 2e-3);
  for (int k = 0; k < 240; ++k) {
    s.t.push_back(k / 60.0);
    s.measured[0].values.push_back((12.0 + 5.0 * std::sin(7.0 * s.t.back())) * degree + noise(random));
    for (Signal& input : s.inputs) input.values.push_back(0.0);
  }
  ModelRequest request = parachute(false);
  request.effects = {effect("static_moment"), effect("gravity")};
  request.curves.erase("C_m_alphadot");
  const std::vector<Signals> signals = {s};
  const std::vector<CandidateModel> all = candidate_models(fitted(request, signals), request, registry(), nullptr);
  const auto damping = std::find_if(all.begin(), all.end(), [](const CandidateModel& c) { return c.effect == "pitch_damping"; });
  ASSERT_NE(damping, all.end());
  EXPECT_EQ(damping->model.parameters[damping->strengths.front()].name, "C_m_alphadot");
}

TEST(CandidateModels, WhatRunsWithTheClockReadsTheTime) {
  const Flight flight(fly(5.0, 35));
  int seen = 0;
  for (const auto& s : candidate_models(flight.estimate, flight.request, registry(), nullptr)) {
    const bool reads = std::find(s.quantities.begin(), s.quantities.end(), kTime) != s.quantities.end();
    if (s.effect != "dynamic_pressure_drift" && s.effect != "vortex_shedding" && s.effect != "strut_wake") continue;
    ++seen;
    EXPECT_EQ(reads, s.effect != "strut_wake") << s.effect;
  }
  EXPECT_EQ(seen, 3);
}

TEST(Screen, SaysWhichFrequenciesItLookedAt) {
  CandidateModel candidate_model;
  candidate_model.effect = "vortex_shedding";
  candidate_model.family = CandidateFamily::physics;
  ScreeningResult s;
  s.candidate_model = &candidate_model;
  s.cells = 8;
  s.cells_effective = 500.0;
  s.frequencies = {0.2, 0.01, 1001, 10.2};
  EXPECT_EQ(what_was_tried(s), "vortex_shedding (physics): 8 cells, 500 effective tests, 0.2 to 10.2 Hz");
  s.frequencies.wanted = 22.5;
  EXPECT_THAT(what_was_tried(s), testing::HasSubstr("0.2 to 10.2 Hz, not up to 22.5 Hz: too many unevenly spaced samples"));
}

TEST(Screen, SaysWhichSpacingsItLookedAt) {
  CandidateModel candidate_model;
  candidate_model.effect = "ripple";
  candidate_model.recurs_along = {.quantity = 0};
  candidate_model.model.parameters.emplace_back().unit = "V";
  candidate_model.frequency = 0;
  ScreeningResult s;
  s.candidate_model = &candidate_model;
  s.cells = 8;
  s.cells_effective = 500.0;
  s.frequencies = {0.25, 0.125, 7, 1.0};  // waves per volt
  EXPECT_THAT(what_was_tried(s), testing::EndsWith("8 cells, 500 effective tests, every 1 V to 4 V"));
  s.frequencies.wanted = 4.0;
  EXPECT_THAT(what_was_tried(s), testing::EndsWith("every 1 V to 4 V, not down to 0.25 V: too many samples"));
}

/// The model turns with a rolled camera: held gains would call the roll known nine times better than it is.
TEST(CandidateModels, ARolledCameraIsHardlySeenInTheMotion) {
  const Flight flight(fly(15.0, 36));
  for (const auto& s : candidate_models(flight.estimate, flight.request, registry(), nullptr)) {
    if (s.effect != "camera_roll") continue;
    const ScoreResult result = ScoreTest(flight.estimate).test(sensitivity_columns(flight.estimate, s, {}));
    EXPECT_GT(result.sigma[0], 1.0 * degree) << "only the camera's height distinguishes up from down";
  }
}

/// χ² with one degree of freedom above 2.706: 0.1000; of one side half of it.
TEST(LogDropTail, OneSidedStrengthsHaveHalfTheChance) {
  CandidateModel s;
  s.strengths = {0};
  s.one_sided = {false};
  EXPECT_NEAR(std::exp(log_drop_tail(s, 2.70554)), 0.1, 1e-6);
  s.one_sided = {true};
  EXPECT_NEAR(std::exp(log_drop_tail(s, 2.70554)), 0.05, 1e-6);
  EXPECT_EQ(log_drop_tail(s, 0.0), 0.0) << "nothing there: p 1, not a half";
}

/// Two strengths whose columns are one: the score has a single degree of freedom.
TEST(LogScoreTail, CountsIndependentDirectionsAndNotStrengths) {
  CandidateModel s;
  s.strengths = {0, 1};
  s.one_sided = {false, false};
  ScoreResult score;
  score.chi2 = 2.70554;
  score.dof = 1;
  EXPECT_NEAR(std::exp(log_score_tail(s, score)), 0.1, 1e-6);
  score.dof = 2;
  EXPECT_NEAR(std::exp(log_score_tail(s, score)), std::exp(-0.5 * 2.70554), 1e-6);
}

/// Sigma 0.11 s of the lag's time.
TEST(Verdict, AMemoryWhoseTimeIsBelowTwoSigmasIsNotDetermined) {
  Model model = assemble(parachute(true, {effect("lag")}), registry());
  const std::vector<int> free = model.free_parameters();
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(std::ssize(free), std::ssize(free));
  const auto column = std::find(free.begin(), free.end(), model.find_parameter("tau")) - free.begin();
  ASSERT_LT(column, covariance.rows());
  covariance(column, column) = 0.11 * 0.11;
  set(model, "tau", 0.16);
  EXPECT_EQ(undetermined_time(model, covariance).value_or(""), "its time is not determined: tau = 0.16 ± 0.11 s");
  EXPECT_FALSE(undetermined_time(model, Eigen::MatrixXd()).has_value()) << "nothing is known of its sigma";
  set(model, "tau", 0.23);
  EXPECT_FALSE(undetermined_time(model, covariance).has_value());
  Model late = assemble(cart({effect("delay")}), registry());
  const std::size_t unknowns = late.free_parameters().size();
  set(late, "delay", 0.16);
  EXPECT_TRUE(undetermined_time(late, Eigen::MatrixXd::Identity(unknowns, unknowns)).has_value()) << "a delay has no states, and remembers";
  EXPECT_TRUE(outlasts_recording(late, late.effects.back(), 0.3).has_value());
  EXPECT_FALSE(outlasts_recording(late, late.effects.back(), 0.4).has_value());
  Model forced = assemble(cart({effect("periodic_forcing")}), registry());
  const std::size_t size = forced.free_parameters().size();
  EXPECT_FALSE(undetermined_time(forced, 1e6 * Eigen::MatrixXd::Identity(size, size)).has_value()) << "it remembers nothing";
}

}  // namespace
}  // namespace misfit
