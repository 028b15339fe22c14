// The choice among what was refitted, in worlds whose truth is known, with the order of the list given by hand.
#include "misfit/discover/accept.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "misfit/discover/candidate.h"
#include "misfit/discover/likeness.h"
#include "misfit/math/statistics.h"
#include "tests/discover/record.h"

namespace misfit {
namespace {

using namespace testing_records;

/// A cart whose model knows of viscous friction only, and all that the screen says of it.
struct World {
  std::vector<Signals> signals;
  ModelRequest request = cart({effect("viscous_friction")});
  FilterEstimate estimate;
  std::vector<Specimen> list;
  std::vector<Screened> screened;
  DiscoverOptions options;

  explicit World(Signals recorded, const std::map<std::string, double>& upper = {}) : signals{std::move(recorded)} {
    request.parameters["stiffness"].free = true;
    estimate = estimate_filter(assemble(request, registry()), {}, signals);
    for (const auto& [name, bound] : upper) request.parameters[name].upper = bound;  // of an effect that is not in it yet
    list = specimens(estimate, request, registry(), nullptr);
    screened = screen(estimate, ScoreTest(estimate), ForceColumns(estimate), list, 0);
  }

  [[nodiscard]] double families() const { return static_cast<double>(list.size()); }

  [[nodiscard]] Entry entry(const std::string& key, bool refitted = true) const {
    Entry e;
    for (const auto& s : screened) {
      if (s.specimen->effect == key && e.screened == nullptr) e.screened = &s;
    }
    if (e.screened == nullptr) throw std::runtime_error(key + " is not offered");
    e.candidate = named_candidate(*e.screened, families());
    e.log_p = e.screened->log_p;
    if (!refitted) return e;
    e.refit = refit(estimate, signals, *e.screened, registry(), 0);
    e.candidate.actual_drop = e.refit->drop;
    e.log_p = log_score_tail(*e.screened->specimen, e.refit->drop) + std::log(e.screened->cells_effective);
    e.candidate.p_value = sidak(std::min(1.0, std::exp(e.log_p)), families());
    return e;
  }

  std::optional<UnknownCurve> accept(std::vector<Entry>& entries) const {
    return accept_best(entries, {estimate, registry(), signals, options, families()});
  }
};

World with_friction(double friction) { return World(record_of_cart({effect("coulomb_friction")}, {{"friction", friction}})); }

const Candidate& of(const std::vector<Entry>& entries, const std::string& key) {
  for (const auto& e : entries) {
    if (e.candidate.effect == key) return e.candidate;
  }
  throw std::runtime_error(key + " is not in the list");
}

bool leaves_something(const Entry& e, const World& world) {
  return what_is_left(e.refit->estimate, *e.screened->specimen, e.refit->drop, world.options).has_value();
}

/// Hysteresis catches a little of the friction and would be accepted by itself; the order is as if it had caught the most.
TEST(NamedCandidate, WhatTheModelAllButDescribesIsDescribedUnlessTheRestIsBeyondDoubt) {
  const World world = with_friction(3.0);
  Screened screened = *world.entry("coulomb_friction", false).screened;
  const auto described = [&](double independent, double p) {
    screened.result.independent = independent;
    screened.p_value = p;
    return named_candidate(screened, world.families()).described;
  };
  EXPECT_FALSE(described(0.5, 0.5));
  EXPECT_TRUE(described(0.005, 0.01));
  EXPECT_FALSE(described(0.005, 1e-9)) << "half a percent of a strong effect";
  EXPECT_TRUE(described(1e-9, 1e-9)) << "rounding";
}

TEST(Refit, FromOneStepOnEndsWhereTheEstimateWithTheEffectDoes) {
  const World world = with_friction(3.0);
  const Screened& screened = *world.entry("coulomb_friction", false).screened;
  const OneStep step = one_step(world.estimate, ScoreTest(world.estimate), screened, registry(), 0);
  ASSERT_TRUE(step.model.has_value());
  EXPECT_GE(step.drop, screened.result.chi2);
  const Refit plain = refit(world.estimate, world.signals, screened, registry(), 0),
              onwards = refit(world.estimate, world.signals, screened, registry(), 0, step);
  ASSERT_TRUE(plain.ok && onwards.ok) << plain.why << onwards.why;
  EXPECT_NEAR(onwards.drop, plain.drop, 0.1);
  EXPECT_LE(onwards.estimate.linearisations, plain.estimate.linearisations);
}

TEST(Accept, ALikenessGivesWayToWhatLeavesNothing) {
  const World world = with_friction(1.5);
  std::vector<Entry> entries = {world.entry("hysteresis"), world.entry("coulomb_friction")};
  ASSERT_TRUE(leaves_something(entries[0], world));
  ASSERT_FALSE(leaves_something(entries[1], world));
  EXPECT_FALSE(world.accept(entries).has_value());
  EXPECT_EQ(entries.front().candidate.effect, "coulomb_friction");
  EXPECT_TRUE(entries.front().candidate.accepted) << entries.front().candidate.why;
  const Candidate& likeness = of(entries, "hysteresis");
  EXPECT_FALSE(likeness.accepted);
  EXPECT_GT(likeness.held_out_gain.value_or(0.0), 0.0) << "it holds out, and is refused for what it leaves";
  EXPECT_THAT(likeness.why, testing::StartsWith("most of the departure remains"));
}

/// Beside the friction, which alone explains all, hysteresis is not needed: it must not be accepted on the friction's account.
TEST(Accept, WhatTheSecondEffectMakesNeedlessIsNotAccepted) {
  const World world = with_friction(1.5);
  std::vector<Entry> entries = {world.entry("hysteresis"), world.entry("coulomb_friction", false)};
  const auto left = world.accept(entries);
  ASSERT_TRUE(left.has_value());
  EXPECT_EQ(left->quantity, "v");
  for (const auto& e : entries) EXPECT_FALSE(e.candidate.accepted) << e.candidate.effect << ": " << e.candidate.why;
}

/// Two that are there: neither by itself leaves nothing, both together do.
TEST(Accept, OneOfTwoIsAcceptedWhereTheOtherExplainsTheRest) {
  const World world(record_of_cart({effect("coulomb_friction"), effect("quadratic_drag")}, {{"friction", 1.0}, {"drag", 1.5}}));
  std::vector<Entry> entries = {world.entry("quadratic_drag"), world.entry("coulomb_friction", false)};
  ASSERT_TRUE(leaves_something(entries[0], world));
  EXPECT_FALSE(world.accept(entries).has_value());
  EXPECT_TRUE(entries[0].candidate.accepted) << entries[0].candidate.why;
  EXPECT_THAT(entries[0].candidate.why, testing::HasSubstr("what remains after it, coulomb_friction explains"));
}

/// hasty_friction is the same formula: whichever stands first, no one can tell them apart; what stands before them and is refused does not
/// change that.
TEST(Accept, TheOneChosenIsTestedForInseparableOnes) {
  const World world = with_friction(0.2);
  std::vector<Entry> entries = {world.entry("quadratic_drag"), world.entry("coulomb_friction"), world.entry("hasty_friction")};
  EXPECT_FALSE(world.accept(entries).has_value());
  const Candidate& chosen = entries.front().candidate;
  EXPECT_EQ(chosen.effect, "coulomb_friction");
  EXPECT_TRUE(chosen.accepted) << chosen.why;
  EXPECT_THAT(chosen.group, testing::ElementsAre("coulomb_friction", "hasty_friction"));
  EXPECT_EQ(of(entries, "hasty_friction").why, "these data cannot tell it from coulomb_friction");
  EXPECT_THAT(of(entries, "quadratic_drag").group, testing::IsEmpty());
}

/// An effect that cannot be put beside the other has not been tested against it.
TEST(Accept, WhatCannotBeRunBesideTheOtherIsNotCalledInseparable) {
  const World world = with_friction(0.2);
  std::vector<Entry> entries = {world.entry("coulomb_friction"), world.entry("hasty_friction")};
  entries[1].candidate.effect = "offered_nowhere";
  EXPECT_FALSE(world.accept(entries).has_value());
  EXPECT_TRUE(entries.front().candidate.accepted);
  EXPECT_THAT(entries.front().candidate.group, testing::IsEmpty());
}

TEST(Accept, ARefitThatHasNotConvergedIsNot) {
  const World world = with_friction(0.2);
  std::vector<Entry> entries = {world.entry("coulomb_friction")};
  entries[0].refit->estimate.converged = false;
  entries[0].refit->estimate.message = "iteration limit";
  EXPECT_FALSE(world.accept(entries).has_value());
  EXPECT_FALSE(entries[0].candidate.accepted);
  EXPECT_EQ(entries[0].candidate.why, "its refit has not converged: iteration limit");
}

}  // namespace
}  // namespace misfit
