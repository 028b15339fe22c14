// The selection among what was refitted, in worlds whose truth is known, with the order of the list given by hand.
#include "misfit/discover/accept.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <memory>
#include <numbers>
#include <tuple>

#include "misfit/diagnose/features.h"
#include "misfit/discover/candidate.h"
#include "misfit/discover/lack_of_fit.h"
#include "misfit/math/statistics.h"
#include "tests/discover/record.h"

namespace misfit {
namespace {

using namespace testing_records;

/// Candidate models of one effect, and what the screen says of them.
struct Screened {
  std::vector<CandidateModel> models;
  std::vector<ScreeningResult> results;
};

/// A cart whose model knows of viscous friction only. An effect is screened when it is asked for.
struct World {
  std::vector<Signals> signals;
  ModelRequest request = cart({effect("viscous_friction")});
  FilterEstimate estimate;
  std::vector<CandidateModel> list;
  DiscoverOptions options;
  mutable std::map<std::string, std::unique_ptr<Screened>> screened;  ///< by effect

  explicit World(Signals recorded, const std::map<std::string, double>& upper = {}) : signals{std::move(recorded)} {
    request.parameters["stiffness"].free = true;
    estimate = estimate_filter(assemble(request, registry()), {}, signals);
    for (const auto& [name, bound] : upper) request.parameters[name].upper = bound;  // of an effect that is not in it yet
    list = candidate_models(estimate, request, registry(), nullptr);
  }

  /// At its first place of the list.
  [[nodiscard]] const ScreeningResult& screening_of(const std::string& key) const {
    std::unique_ptr<Screened>& there = screened[key];
    if (there) return there->results.front();
    there = std::make_unique<Screened>();
    std::copy_if(list.begin(), list.end(), std::back_inserter(there->models), [&](const CandidateModel& c) { return c.effect == key; });
    if (there->models.empty()) throw std::runtime_error(key + " is not offered");
    there->results = screen({estimate, ScoreTest(estimate), ForceSensitivity(estimate)}, there->models);
    return there->results.front();
  }

  [[nodiscard]] double families() const { return static_cast<double>(list.size()); }

  [[nodiscard]] RankedCandidate entry(const std::string& key, bool refitted = true) const {
    RankedCandidate e;
    e.screening = &screening_of(key);
    e.candidate = named_candidate(*e.screening, families());
    e.log_p = e.screening->log_p;
    if (!refitted) return e;
    e.refit = refit({estimate, signals, registry()}, *e.screening);
    e.candidate.actual_drop = e.refit->drop;
    e.log_p = log_drop_tail(*e.screening->candidate_model, e.refit->drop) + std::log(e.screening->cells_effective);
    e.candidate.p_value = sidak(std::min(1.0, std::exp(e.log_p)), families());
    return e;
  }

  std::optional<Unexplained> accept(std::vector<RankedCandidate>& ranked, const std::vector<UnknownCurve>& unknown = {}) const {
    return accept_best(ranked, unknown, {estimate, registry(), signals, options, families()});
  }
};

World with_friction(double friction) { return World(record_of_cart({effect("coulomb_friction")}, {{"friction", friction}})); }

const Candidate& of(const std::vector<RankedCandidate>& ranked, const std::string& key) {
  for (const auto& e : ranked) {
    if (e.candidate.effect == key) return e.candidate;
  }
  throw std::runtime_error(key + " is not in the list");
}

bool leaves_something(const RankedCandidate& e, const World& world) {
  return remaining_lack_of_fit(e.refit->estimate, *e.screening->candidate_model, {e.refit->drop}, world.options).has_value();
}

/// A cart whose damping grows with its position: on the mean over the motion neither position nor speed alone shows it.
Signals record_of_uneven_damping(double slope) {
  ModelRequest request = cart({effect("viscous_friction")});
  request.curves["viscosity"] = {"x", {-1.0, 0.0, 1.0}, {}, {}};
  Model truth = assemble(request, registry());
  set_line(truth, "viscosity", 0.0, 1.5, slope);
  Values values;
  const Curve& curve = *truth.find_curve("viscosity");
  for (int i = 0; i < curve.spline.size(); ++i) {
    const Parameter& p = truth.parameters[curve.first + i];
    values[p.name] = p.value;
  }
  return record(request, values, 0.05, 15.0, {2e-3, 1e-2}, 43);
}

/// The least p over the surfaces of the quantity x, corrected for their number, and which it is.
std::pair<double, std::string> most_significant_surface(const World& world) {
  const int x = index_of(world.estimate.model.system->spec().quantities, "x");
  const std::vector<UnknownCurve> surfaces =
      unknown_surfaces({world.estimate, ScoreTest(world.estimate), ForceSensitivity(world.estimate)}, {x});
  const auto best = std::min_element(surfaces.begin(), surfaces.end(), [](const auto& a, const auto& b) { return a.log_p < b.log_p; });
  return {sidak(best->p_value, static_cast<double>(surfaces.size())), best->label()};
}

TEST(UnknownSurfaces, ShowAForceThatDependsOnTwoQuantitiesAndNothingWhereThereIsNone) {
  const World uneven(record_of_uneven_damping(1.2)), even(record_of_uneven_damping(0.0));
  const auto [p, label] = most_significant_surface(uneven);
  EXPECT_LT(p, 1e-6) << label;
  EXPECT_THAT(label, testing::StartsWith("an unknown surface force(x, v"));
  for (const UnknownCurve& curve : unknown_curves({uneven.estimate, ScoreTest(uneven.estimate), ForceSensitivity(uneven.estimate)}))
    EXPECT_GT(curve.p_value, p) << curve.label();
  const auto [chance, where] = most_significant_surface(even);
  EXPECT_GT(chance, 0.01) << where;
}

/// Of outputs, and of forces.
std::pair<std::vector<UnknownCurve>, std::vector<UnknownCurve>> errors_and_forces(const World& world) {
  std::vector<UnknownCurve> errors = unknown_curves({world.estimate, ScoreTest(world.estimate), ForceSensitivity(world.estimate)}), forces;
  const auto first_force =
      std::stable_partition(errors.begin(), errors.end(), [](const UnknownCurve& c) { return c.kind == PortKind::sensor; });
  forces.assign(first_force, errors.end());
  errors.erase(first_force, errors.end());
  return {errors, forces};
}

TEST(UnknownErrors, AreThoseOfTheOutputThatIsWrongAndOfWhatItDependsOn) {
  Signals recorded = record_of_cart({}, {});
  for (std::size_t k = 0; k < recorded.samples(); ++k)
    recorded.measured[0].values[k] += 0.004 * std::pow(recorded.measured[1].values[k], 2);  // position, by the square of the speed
  const auto [errors, forces] = errors_and_forces(World(std::move(recorded)));
  const auto best = std::min_element(errors.begin(), errors.end(), [](const auto& a, const auto& b) { return a.log_p < b.log_p; });
  EXPECT_EQ(best->label(), "an error of position_reading that depends on v");
  EXPECT_LT(best->p_value, 1e-6);
  for (const UnknownCurve& force : forces) EXPECT_GT(force.p_value, best->p_value) << force.label();
}

TEST(UnknownErrors, AreNoneWhereNoiseIsAllThereIs) {
  const auto [errors, forces] = errors_and_forces(with_friction(0.0));
  ASSERT_GT(errors.size(), 4U);
  for (const UnknownCurve& error : errors) EXPECT_GT(error.p_value, 0.05 / static_cast<double>(errors.size())) << error.label();
}

/// Where the noise is large, a filtered state follows the very measurement that corrects it: errors that depend on it would be seen in
/// noise alone.
TEST(UnknownErrors, DoNotDependOnTheMeasurementThatTheyAreLookedForIn) {
  ModelRequest cart_alone = cart({effect("viscous_friction")});
  const World world(record(cart_alone, {{"viscosity", 1.5}}, 0.05, 2.0, {0.3, 1.0}, 44));
  const auto [errors, forces] = errors_and_forces(world);
  for (const UnknownCurve& error : errors) EXPECT_GT(error.p_value, 0.05 / static_cast<double>(errors.size())) << error.label();
  const ScoreTest score(world.estimate);
  const ForceSensitivity force(world.estimate);
  double least = 1.0;
  for (const Features& hats : features_of(world.estimate, force, hats_of_unknown_curves)) {
    Eigen::MatrixXd filtered = hats.f;  // of the sample itself, in place of what the sample before predicted
    filtered.topRows(filtered.rows() - 1) = hats.f.bottomRows(filtered.rows() - 1);
    for (const int output : {0, 1}) {
      const ScoreResult found = score.test(force.output_columns(output, hats.f, filtered));
      least = std::min(least, chi_square_tail(found.chi2, found.dof));
    }
  }
  EXPECT_LT(least, 1e-6);
}

TEST(UnknownErrors, OfACalibratedCameraAreNotLookedFor) {
  const World world = with_friction(0.0);
  const ScoreTest score(world.estimate);
  const ForceSensitivity force(world.estimate);
  const ScoreWork work{world.estimate, score, force}, calibrated{world.estimate, score, force, 0, true};
  const std::vector<UnknownCurve> of_camera = unknown_curves(calibrated);
  EXPECT_EQ(of_camera.size(), count_of_unknown_curves(calibrated));
  EXPECT_EQ(unknown_curves(work).size(), count_of_unknown_curves(work));
  EXPECT_LT(of_camera.size(), count_of_unknown_curves(work));
  for (const UnknownCurve& curve : of_camera) EXPECT_NE(curve.kind, PortKind::sensor) << curve.label();
}

/// The drive follows what is asked for at a limited rate: not as a lag does, of which the rate is in proportion to what is left.
TEST(Accept, ALagThatIsOfAnotherFormIsAnImitation) {
  const auto limited = [](double last, double asked) { return last + std::clamp(asked - last, -2.0, 2.0); };  // 40 N/s
  const World slow(record_of_cart({}, {}, 41, limited));
  const RankedCandidate lag = slow.entry("input_lag");
  const auto left = remaining_lack_of_fit(lag.refit->estimate, *lag.screening->candidate_model, {lag.refit->drop}, slow.options);
  ASSERT_TRUE(left.has_value());
  EXPECT_LT(left->p_value, 1e-6) << left->label();
  double last = 0.0;
  const World late(record_of_cart({}, {}, 41, [&](double, double asked) { return last += 0.2 * (asked - last); }));  // 0.22 s
  EXPECT_FALSE(leaves_something(late.entry("input_lag"), late));
}

TEST(UnknownCurves, SeeThatThePastOfAnInputCounts) {
  const auto limited = [](double last, double asked) { return last + std::clamp(asked - last, -2.0, 2.0); };
  const auto of_the_past = [](const World& world) {
    const auto curves = unknown_curves({world.estimate, ScoreTest(world.estimate), ForceSensitivity(world.estimate)});
    const auto found =
        std::find_if(curves.begin(), curves.end(), [](const auto& c) { return c.label() == "an unknown curve force(the past of drive)"; });
    EXPECT_NE(found, curves.end());
    for (const UnknownCurve& other : curves) EXPECT_TRUE(other.log_p >= found->log_p || found->p_value > 1e-3) << other.label();
    return found->p_value;
  };
  EXPECT_LT(of_the_past(World(record_of_cart({}, {}, 41, limited))), 1e-6);
  EXPECT_GT(of_the_past(with_friction(0.0)), 0.01);
}

TEST(CandidateModels, ThatLagAreThoseWithALinearMemory) {
  for (const CandidateModel& c : with_friction(1.5).list)
    EXPECT_EQ(c.lags, c.effect.ends_with("lag") || c.effect.ends_with("delay")) << c.effect;
}

/// Position in whole steps, as a display gives it: 0.013 m is one of its values.
World with_whole_steps(double step) {
  Signals recorded = record_of_cart({}, {});
  for (double& x : recorded.measured[0].values) x = 0.013 + step * std::round((x - 0.013) / step);
  return World(std::move(recorded));
}

TEST(CandidateModels, OfWholeStepsTakeThemFromTheMeasurements) {
  const auto cells = [](const World& world) {
    const CandidateModel& candidate_model = *world.entry("sensor_quantisation", false).screening->candidate_model;
    EXPECT_THAT(candidate_model.port_names, testing::ElementsAre("position_reading"));
    return candidate_model.cells;
  };
  const auto whole = cells(with_whole_steps(0.05));
  ASSERT_EQ(whole.size(), 1U);
  EXPECT_THAT(whole[0], testing::ElementsAre(testing::DoubleNear(0.05, 1e-9), testing::DoubleNear(0.013, 1e-9)));
  EXPECT_EQ(cells(with_friction(0.0)).size(), 3U) << "in no such steps";
}

TEST(Accept, WholeStepsOfAnOutputAreFound) {
  const World world = with_whole_steps(0.05);
  std::vector<RankedCandidate> ranked = {world.entry("sensor_quantisation")};
  EXPECT_FALSE(world.accept(ranked).has_value());
  EXPECT_TRUE(ranked[0].candidate.accepted) << ranked[0].candidate.why;
  EXPECT_EQ(ranked[0].refit->parameters.at("rounded").value, 1.0);
  EXPECT_GT(*ranked[0].candidate.held_out_gain, 0.0) << "read as intervals they are not predicted too surely";
}

TEST(Accept, WholeStepsThatAreMostOfWhatIsNotPredictedAreFoundWhateverIsHeldOut) {
  const World world = with_whole_steps(0.05);
  std::vector<RankedCandidate> ranked = {world.entry("sensor_quantisation")};
  ranked[0].candidate.held_out_gain = -3.0;
  world.accept(ranked);
  EXPECT_TRUE(ranked[0].candidate.accepted);
  EXPECT_THAT(ranked[0].candidate.why, testing::HasSubstr("held-out gain -3; it is seen in the measurements themselves"));
}

TEST(Accept, WholeStepsOfWhichAPartIsFoundAreSaidAllTheSame) {
  const World world = with_whole_steps(0.05);
  std::vector<RankedCandidate> ranked = {world.entry("sensor_quantisation")};
  ranked[0].refit->partial = "rounded = 0.5";
  world.accept(ranked);
  EXPECT_FALSE(ranked[0].candidate.accepted);
  EXPECT_THAT(ranked[0].candidate.why,
              testing::HasSubstr("rounded = 0.5; the measurements are in whole steps of 0.05 all the same, noise of "
                                 "0.014434 to a filter"));
}

TEST(WholeSteps, AreCoarseWhereTheyAreMostOfWhatIsNotPredicted) {
  const World world = with_whole_steps(0.05);
  Model model = world.entry("sensor_quantisation", false).screening->candidate_model->model;
  const auto set = [&](double step) {
    const BoundEffect& effect = model.effects.back();
    for (const BoundCoefficient& c : effect.coefficients) {
      if (c.parameter >= 0 && model.parameters[c.parameter].name == "step") model.parameters[c.parameter].value = step;
    }
  };
  set(0.05);
  EXPECT_TRUE(are_coarse_steps(model, world.estimate));
  set(0.005);
  EXPECT_FALSE(are_coarse_steps(model, world.estimate));
}

/// Hysteresis catches a little of the friction and would be accepted by itself; the order is as if it had caught the most.
TEST(NamedCandidate, WhatTheModelAllButDescribesIsDescribedUnlessTheRestIsBeyondDoubt) {
  const World world = with_friction(3.0);
  ScreeningResult screening = *world.entry("coulomb_friction", false).screening;
  const auto described = [&](double independent, double p) {
    screening.result.independent = independent;
    screening.p_value = p;
    return named_candidate(screening, world.families()).absorbed;
  };
  EXPECT_FALSE(described(0.5, 0.5));
  EXPECT_TRUE(described(0.005, 0.01));
  EXPECT_FALSE(described(0.005, 1e-9)) << "half a percent of a strong effect";
  EXPECT_TRUE(described(1e-9, 1e-9)) << "rounding";
}

TEST(Refit, FromOneStepOnEndsWhereTheEstimateWithTheEffectDoes) {
  const World world = with_friction(3.0);
  const ScreeningResult& screening = *world.entry("coulomb_friction", false).screening;
  const RefitWork work{world.estimate, world.signals, registry()};
  const OneStep step = one_step(work, ScoreTest(world.estimate), screening);
  ASSERT_TRUE(step.model.has_value());
  EXPECT_GE(step.drop, screening.result.chi2);
  const Refit plain = refit(work, screening), onwards = refit(work, screening, step);
  ASSERT_TRUE(plain.ok && onwards.ok) << plain.why << onwards.why;
  EXPECT_NEAR(onwards.drop, plain.drop, 0.1);
  EXPECT_LE(onwards.estimate.linearisations, plain.estimate.linearisations);
}

/// Wherever it is cut off: in its searches, or in what is tried after them.
TEST(Refit, ThatIsCutOffIsUnfinishedAndThrowsNothing) {
  const World world(record_of_cart({effect("delay")}, {{"delay", 0.05}}));
  const ScreeningResult& screening = world.screening_of("delay");
  RefitWork work{world.estimate, world.signals, registry()};
  for (const double seconds : {1e-6, 0.01, 0.03, 0.1, 0.3}) {
    work.time_limit = seconds;
    Refit found;
    ASSERT_NO_THROW(found = refit(work, screening)) << seconds;
    EXPECT_TRUE(found.ok || found.out_of_time) << seconds << found.why;
  }
}

/// Above all displacements a stop does nothing, whatever its stiffness.
TEST(Refit, OfAnEdgeThatIsThrownOutOfTheDataFindsItAllTheSame) {
  const World world(record_of_cart({effect("upper_stop")}, {{"stop_stiffness", 20.0}, {"edge", 1.0}}));
  const ScreeningResult& screening = world.screening_of("upper_stop");
  OneStep thrown{0.0, start_model(world.estimate, screening, registry()), world.estimate.noise};
  thrown.model->parameters[screening.candidate_model->shapes.front()].value = 1e3;  // [m]
  const Refit found = refit({world.estimate, world.signals, registry()}, screening, thrown);
  ASSERT_TRUE(found.ok) << found.why;
  EXPECT_GT(found.drop, screening.result.chi2);
  EXPECT_NEAR(found.parameters.at("edge").value, 1.0, 4.0 * found.parameters.at("edge").sigma);
  EXPECT_NEAR(found.parameters.at("stop_stiffness").value, 20.0, 4.0 * found.parameters.at("stop_stiffness").sigma);
}

TEST(Refit, AfreshEndsThereToo) {
  const World world = with_friction(3.0);
  const RankedCandidate known = world.entry("coulomb_friction");
  RefitWork work{world.estimate, world.signals, registry()};
  work.afresh = true;
  const ScreeningResult start = as_refitted(*known.screening, known.refit->estimate.model);
  EXPECT_DOUBLE_EQ(start.result.amplitude[0], known.refit->parameters.at("friction").value);
  const Refit afresh = refit(work, start);
  ASSERT_TRUE(afresh.ok) << afresh.why;
  EXPECT_GT(afresh.drop, known.refit->drop - 0.1) << "at least: the noise is looked for anew";
  EXPECT_NEAR(afresh.parameters.at("friction").value, known.refit->parameters.at("friction").value, 1e-3);
  const Refit from_there =
      refit({world.estimate, world.signals, registry()}, *known.screening, {0.0, afresh.estimate.model, afresh.estimate.noise});
  ASSERT_TRUE(from_there.ok) << from_there.why;
  EXPECT_NEAR(from_there.drop, afresh.drop, 0.1) << "that is a maximum of the ordinary refit, too";
}

/// Against the density of all held-out residuals at once, N(0, 1 + J C Jᵀ), and without uncertainty that of the estimate.
TEST(PredictiveLoglik, IsTheDensityOfTheHeldOutResidualsWithUncertainParameters) {
  const World world = with_friction(1.5);
  FilterEstimate estimate = world.estimate;
  FilterData& data = estimate.data.front();
  for (std::size_t i = data.use.size() - data.use.size() / 8; i < data.use.size(); ++i) data.use[i] = SampleRole::validation;
  FilterData swapped = data;
  for (SampleRole& role : swapped.use) {
    role = role == SampleRole::validation ? SampleRole::counted : role == SampleRole::counted ? SampleRole::update : role;
  }
  FilterRunner runner(estimate.forced, true);
  runner.set_parameters(estimate.forced.model.values());
  FilterTrace trace;
  FilterJacobian held_out;
  ASSERT_TRUE(runner.run(swapped, estimate.noise, trace, {&held_out}));
  estimate.covariance *= 25.0;  // enough to matter
  const Eigen::Index n = held_out.r.size();
  const Eigen::MatrixXd J = held_out.J, spread = Eigen::MatrixXd::Identity(n, n) + J * estimate.covariance * J.transpose();
  const double of_estimate = trace.loglik + 0.5 * held_out.r.squaredNorm();
  const double expected =
      of_estimate - 0.5 * held_out.r.dot(spread.ldlt().solve(held_out.r)) - 0.5 * spread.ldlt().vectorD().array().log().sum();
  EXPECT_NEAR(predictive_loglik(estimate), expected, 1e-6 * std::abs(expected));
  EXPECT_GT(std::abs(expected - trace.loglik), 0.1);
  estimate.covariance.setZero();
  EXPECT_NEAR(predictive_loglik(estimate), trace.loglik, 1e-9 * std::abs(trace.loglik));
}

TEST(Accept, AnImitationIsNotPreferredToAnEffectThatGainsMore) {
  const World world = with_friction(1.5);
  std::vector<RankedCandidate> ranked = {world.entry("hysteresis"), world.entry("coulomb_friction")};
  ASSERT_TRUE(leaves_something(ranked[0], world));
  ASSERT_FALSE(leaves_something(ranked[1], world));
  EXPECT_FALSE(world.accept(ranked).has_value());
  EXPECT_EQ(ranked.front().candidate.effect, "coulomb_friction");
  EXPECT_TRUE(ranked.front().candidate.accepted) << ranked.front().candidate.why;
  const Candidate& imitation = of(ranked, "hysteresis");
  EXPECT_FALSE(imitation.accepted);
  EXPECT_GT(imitation.held_out_gain.value_or(0.0), 0.0) << "not refused, though it gains less";
  EXPECT_THAT(imitation.why, testing::StartsWith("explains less than coulomb_friction"));
}

/// Beside the friction, which alone explains all, hysteresis is not needed: it must not be accepted on the friction's account.
TEST(Accept, AnImitationNotSignificantBesideTheSecondEffectIsNotAccepted) {
  const World world = with_friction(1.5);
  std::vector<RankedCandidate> ranked = {world.entry("hysteresis"), world.entry("coulomb_friction", false)};
  const auto left = world.accept(ranked);
  ASSERT_TRUE(left.has_value());
  EXPECT_EQ(left->quantity, "v");
  for (const auto& e : ranked) EXPECT_FALSE(e.candidate.accepted) << e.candidate.effect << ": " << e.candidate.why;
}

TEST(Accept, NothingIsChosenPastAnUnknownFormWorthTwiceAsMuch) {
  const World world = with_friction(0.2);
  UnknownCurve curve;
  curve.port = "force";
  curve.quantity = "x";
  curve.result.dof = 7;
  curve.log_p = -1e3;
  curve.p_value = 1e-300;
  const auto accepted_beside = [&](double share, bool narrow = false) {
    std::vector<RankedCandidate> ranked = {world.entry("coulomb_friction")};
    curve.result.chi2 = share * ranked[0].refit->drop + 2.0 * curve.result.dof;
    const SearchContext context{world.estimate, registry(), world.signals, world.options, world.families()};
    const std::vector<UnknownCurve> none, one = {curve};
    const auto unknown = accept_best(ranked, narrow ? none : one, context, narrow ? one : none);
    EXPECT_EQ(unknown.has_value(), !ranked[0].candidate.accepted) << ranked[0].candidate.why;
    EXPECT_TRUE(!unknown || (unknown->port == "force" && unknown->quantity == "x" && unknown->kind == PortKind::dynamic));
    return ranked[0].candidate;
  };
  EXPECT_TRUE(accepted_beside(1.9).accepted);
  EXPECT_TRUE(accepted_beside(1.9, true).accepted);
  EXPECT_FALSE(accepted_beside(2.1, true).accepted) << "a narrow curve stands in its way like any other";
  const Candidate passed_over = accepted_beside(2.1);
  EXPECT_FALSE(passed_over.accepted);
  EXPECT_EQ(passed_over.why, "explains less than half of what an unknown curve force(x) does; no known effect describes the larger one");
}

/// The drive is limited in its rate, which no known effect describes, and there is a little friction: that is right, but says nothing of
/// what is missing. Both are made to read nothing, else the friction, too, would be tested for what the lag leaves and be an imitation.
TEST(Accept, NothingIsChosenPastALargerImitationThatNoSecondEffectExplains) {
  const auto limited = [](double last, double asked) { return last + std::clamp(asked - last, -2.0, 2.0); };
  const World world(record_of_cart({effect("coulomb_friction")}, {{"friction", 0.6}}, 41, limited));
  std::vector<RankedCandidate> ranked = {world.entry("input_lag"), world.entry("coulomb_friction")};
  std::vector<CandidateModel> models;
  std::vector<ScreeningResult> screening;
  for (const auto& e : ranked) {
    models.push_back(*e.screening->candidate_model);
    models.back().quantities.clear();
    screening.push_back(*e.screening);
  }
  for (std::size_t k = 0; k < ranked.size(); ++k) {
    screening[k].candidate_model = &models[k];
    ranked[k].screening = &screening[k];
  }
  ASSERT_TRUE(leaves_something(ranked[0], world));
  ASSERT_FALSE(leaves_something(ranked[1], world));
  ASSERT_GT(ranked[0].refit->drop, 2.0 * ranked[1].refit->drop);
  ASSERT_LT(ranked[1].candidate.p_value, 1e-3);
  const auto left = world.accept(ranked);
  for (const auto& e : ranked) EXPECT_FALSE(e.candidate.accepted) << e.candidate.effect << ": " << e.candidate.why;
  EXPECT_TRUE(left.has_value());
  EXPECT_THAT(of(ranked, "coulomb_friction").why, testing::HasSubstr("the larger one leaves a lack of fit that no second effect removes"));
}

/// The frequency of a force rises slowly: one at rest finds a part of it, of which the held-out rest knows nothing.
TEST(Accept, ARefusedPeriodicForceLeavesNoUnknownForm) {
  int k = 0;
  const World world(record_of_cart({}, {}, 41, [&](double, double asked) {
    const double t = 0.05 * ++k;
    return asked + 6.0 * std::sin(2.0 * std::numbers::pi * (0.5 + 0.0004 * t) * t);
  }));
  std::vector<RankedCandidate> ranked = {world.entry("periodic_forcing")};
  ASSERT_TRUE(leaves_something(ranked[0], world));
  ASSERT_LT(ranked[0].candidate.p_value, 1e-6);
  ranked[0].candidate.held_out_gain = -5.0;
  EXPECT_FALSE(world.accept(ranked).has_value());
  EXPECT_FALSE(ranked[0].candidate.accepted);
  ranked[0].screening = world.entry("quadratic_drag", false).screening;  // the same lack of fit beside an effect that is no line
  EXPECT_TRUE(world.accept(ranked).has_value());
}

/// Two that are there: neither by itself leaves nothing, both together do.
TEST(Accept, OneOfTwoIsAcceptedWhereTheOtherExplainsTheRest) {
  const World world(record_of_cart({effect("coulomb_friction"), effect("quadratic_drag")}, {{"friction", 1.0}, {"drag", 1.5}}));
  std::vector<RankedCandidate> ranked = {world.entry("quadratic_drag"), world.entry("coulomb_friction", false)};
  ASSERT_TRUE(leaves_something(ranked[0], world));
  EXPECT_FALSE(world.accept(ranked).has_value());
  EXPECT_TRUE(ranked[0].candidate.accepted) << ranked[0].candidate.why;
  EXPECT_THAT(ranked[0].candidate.why, testing::HasSubstr("coulomb_friction explains what remains"));
}

/// The drag leaves a lack of fit that the friction removes, but the friction is only found as a part of itself.
TEST(Accept, NothingIsChosenBesideARefusedSecondEffectThatExplainsTwiceAsMuch) {
  const World world(record_of_cart({effect("coulomb_friction"), effect("quadratic_drag")}, {{"friction", 1.0}, {"drag", 1.5}}));
  for (const double share : {1.9, 2.1}) {
    std::vector<RankedCandidate> ranked = {world.entry("quadratic_drag"), world.entry("coulomb_friction")};
    ASSERT_TRUE(leaves_something(ranked[0], world));
    ranked[1].refit->partial = "a part";
    ranked[1].refit->drop = share * ranked[0].refit->drop;
    std::ignore = world.accept(ranked);
    EXPECT_EQ(of(ranked, "quadratic_drag").accepted, share < 2.0) << share << ": " << of(ranked, "quadratic_drag").why;
    EXPECT_FALSE(of(ranked, "coulomb_friction").accepted);
  }
}

/// hasty_friction is the same formula: whichever comes first, the two are indistinguishable; a refused candidate before them does not
/// change that.
TEST(Accept, TheAcceptedOneIsGroupedWithIndistinguishableOnes) {
  const World world = with_friction(0.2);
  std::vector<RankedCandidate> ranked = {world.entry("quadratic_drag"), world.entry("coulomb_friction"), world.entry("hasty_friction")};
  EXPECT_FALSE(world.accept(ranked).has_value());
  const Candidate& chosen = ranked.front().candidate;
  EXPECT_EQ(chosen.effect, "coulomb_friction");
  EXPECT_TRUE(chosen.accepted) << chosen.why;
  EXPECT_THAT(chosen.group, testing::ElementsAre("coulomb_friction", "hasty_friction"));
  EXPECT_EQ(of(ranked, "hasty_friction").why, "these data cannot distinguish it from coulomb_friction");
  EXPECT_THAT(of(ranked, "quadratic_drag").group, testing::IsEmpty());
}

/// An effect that cannot be in one model with the other has not been tested against it.
TEST(Accept, AnEffectThatCannotBeTestedBesideTheOtherIsNotGroupedWithIt) {
  const World world = with_friction(0.2);
  std::vector<RankedCandidate> ranked = {world.entry("coulomb_friction"), world.entry("hasty_friction")};
  CandidateModel elsewhere = *ranked[1].screening->candidate_model;
  elsewhere.effect = ranked[1].candidate.effect = "offered_nowhere";
  ScreeningResult screened = *ranked[1].screening;
  screened.candidate_model = &elsewhere;
  ranked[1].screening = &screened;
  EXPECT_FALSE(world.accept(ranked).has_value());
  EXPECT_TRUE(ranked.front().candidate.accepted);
  EXPECT_THAT(ranked.front().candidate.group, testing::IsEmpty());
}

TEST(Accept, ARefitThatHasNotConvergedIsNot) {
  const World world = with_friction(0.2);
  std::vector<RankedCandidate> ranked = {world.entry("coulomb_friction")};
  ranked[0].refit->estimate.converged = false;
  ranked[0].refit->estimate.message = "iteration limit";
  ranked[0].refit->estimate.newton_decrement.reset();
  EXPECT_FALSE(world.accept(ranked).has_value());
  EXPECT_FALSE(ranked[0].candidate.accepted);
  EXPECT_EQ(ranked[0].candidate.why, "its refit has not converged: iteration limit");
}

/// As a refit that explains each sample, and whose free motion is that of a spring four times as stiff.
TEST(Accept, WhatPredictsWorseFartherAheadIsNot) {
  const World world = with_friction(0.2);
  std::vector<RankedCandidate> ranked = {world.entry("coulomb_friction")};
  ASSERT_LT(HeldOut(world.estimate, world.signals, 1).growth_ahead(ranked[0].refit->estimate), 1.0) << "the truth";
  for (Parameter& p : ranked[0].refit->estimate.forced.model.parameters) p.value *= p.name == "stiffness" ? 4.0 : 1.0;
  world.accept(ranked);
  EXPECT_FALSE(ranked[0].candidate.accepted);
  EXPECT_THAT(ranked[0].candidate.why, testing::StartsWith("predictions farther ahead get worse: their RMS errors grow "));
}

TEST(Accept, ARefitThatCouldGainLittleMoreIs) {
  const World world = with_friction(0.2);
  std::vector<RankedCandidate> ranked = {world.entry("coulomb_friction")};
  Refit& refit = *ranked[0].refit;
  refit.estimate.converged = false;
  refit.estimate.message = "the log-likelihood could still rise";
  refit.estimate.newton_decrement = 0.02 * refit.drop;
  EXPECT_FALSE(world.accept(ranked).has_value());
  EXPECT_FALSE(ranked[0].candidate.accepted) << "4 % of the drop";
  refit.estimate.newton_decrement = 0.002 * refit.drop;
  EXPECT_FALSE(world.accept(ranked).has_value());
  EXPECT_TRUE(ranked[0].candidate.accepted);
  EXPECT_NE(ranked[0].candidate.why.find(refit.estimate.message), std::string::npos);
}

/// A cart with dry friction and, where asked for, a constant force.
World with_offset_and_friction(double offset) {
  return World(record_of_cart({effect("coulomb_friction"), effect("input_offset")}, {{"friction", 1.5}, {"input_offset", offset}}));
}

/// The list as after a refit of dry friction that predicts worse what is held out, as beside an offset that nobody has modelled.
std::vector<RankedCandidate> friction_that_gains_nothing(const World& world) {
  std::vector<RankedCandidate> ranked = {world.entry("coulomb_friction"), world.entry("input_offset", false)};
  ranked[0].candidate.held_out_gain = -1.0;
  return ranked;
}

TEST(Pairs, TwoThatHideEachOtherAreAcceptedTogether) {
  const World world = with_offset_and_friction(1.0);
  std::vector<RankedCandidate> ranked = friction_that_gains_nothing(world);
  world.accept(ranked);
  const Candidate& friction = of(ranked, "coulomb_friction");
  EXPECT_TRUE(friction.accepted) << friction.why;
  EXPECT_THAT(friction.why, testing::HasSubstr("it takes two: together with input_offset"));
}

TEST(Pairs, WhatGainsNothingByItselfIsNotAcceptedWithoutASecond) {
  const World world = with_offset_and_friction(0.0);
  std::vector<RankedCandidate> ranked = friction_that_gains_nothing(world);
  world.accept(ranked);
  const Candidate& friction = of(ranked, "coulomb_friction");
  EXPECT_FALSE(friction.accepted) << friction.why;
  EXPECT_THAT(friction.why, testing::HasSubstr("the held-out log-likelihood does not rise"));
}

std::vector<UnknownCurve> curves_of(const World& world) {
  const ScoreTest score(world.estimate);
  const ForceSensitivity force = sensitivity_of_forces_and_parameters(world.estimate);
  return unknown_curves({world.estimate, score, force});
}

const UnknownCurve& force_over_the_rate(const std::vector<UnknownCurve>& curves) {
  return *std::find_if(curves.begin(), curves.end(),
                       [](const UnknownCurve& c) { return c.kind == PortKind::dynamic && c.quantity == "v"; });
}

/// What an offset explains is not the friction, of which the curve of the rate is left; friction leaves nothing of it.
TEST(MostlyLeft, IsTheCurveThatTheRefittedEffectDoesNotExplain) {
  const World world = with_offset_and_friction(1.0);
  const UnknownCurve rubs = force_over_the_rate(curves_of(world));
  ASSERT_GT(rubs.worth(), 50.0);
  const auto left = mostly_left(world.entry("input_offset").refit->estimate, {rubs}, world.options);
  ASSERT_TRUE(left.has_value());
  EXPECT_EQ(left->quantity, "v");
  EXPECT_FALSE(mostly_left(world.entry("coulomb_friction").refit->estimate, {rubs}, world.options).has_value());
  EXPECT_FALSE(mostly_left(world.entry("input_offset").refit->estimate, {}, world.options).has_value());
}

/// A cart with a constant force whose sensor of the position is not straight.
World with_offset_and_crooked_sensor() {
  Signals recorded = record_of_cart({effect("input_offset")}, {{"input_offset", 0.8}});
  for (double& x : recorded.measured.front().values) x += 0.02 * std::sin(3.0 * x) * std::sin(3.0 * x);
  return World(std::move(recorded));
}

TEST(Choice, IsNotMadePastALargerCurveThatItLeaves) {
  const World world = with_offset_and_crooked_sensor();
  const std::vector<UnknownCurve> curves = curves_of(world);
  std::vector<RankedCandidate> alone = {world.entry("input_offset")}, beside = {world.entry("input_offset")};
  world.accept(alone);
  EXPECT_TRUE(alone[0].candidate.accepted) << alone[0].candidate.why;
  const auto unexplained = world.accept(beside, curves);
  EXPECT_FALSE(beside[0].candidate.accepted);
  EXPECT_THAT(beside[0].candidate.why, testing::HasSubstr("of which more than half is left with it in the model"));
  ASSERT_TRUE(unexplained.has_value());
  ASSERT_TRUE(unexplained->curve.has_value());
  EXPECT_EQ(unexplained->curve->kind, PortKind::sensor);
}

TEST(IsOfUnknownForm, WhereACurvePromisesTwiceWhatAnyCandidateDoes) {
  const World world = with_friction(1.5);
  const SearchContext context{world.estimate, registry(), world.signals, world.options, world.families()};
  const std::vector<UnknownCurve> curves = curves_of(world);
  EXPECT_TRUE(is_of_unknown_form({world.entry("input_offset", false)}, curves, context));
  EXPECT_FALSE(is_of_unknown_form({world.entry("input_offset", false), world.entry("coulomb_friction", false)}, curves, context));
  EXPECT_FALSE(is_of_unknown_form({}, {}, context));
}

TEST(Refit, ThatEndsFarBelowItsScoreHasFailedAndSaysNothingAgainstItsEffect) {
  const World world = with_friction(1.5);
  std::vector<RankedCandidate> ranked = {world.entry("coulomb_friction")};
  ASSERT_GT(ranked[0].screening->result.chi2, 100.0);
  ranked[0].refit->drop = 2.0;
  ranked[0].candidate.p_value = 0.9;
  world.accept(ranked);
  EXPECT_FALSE(ranked[0].candidate.accepted);
  EXPECT_THAT(ranked[0].candidate.why,
              testing::AllOf(testing::StartsWith("its refit failed: it ends at a drop of 2 where the score test predicts"),
                             testing::HasSubstr("no evidence against it")));
}

}  // namespace
}  // namespace misfit
