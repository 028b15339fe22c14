// What a search could have tried but for a mistake: listed with its reason.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "misfit/discover/candidate_model.h"
#include "misfit/model/declared.h"
#include "misfit_models_registry.h"

namespace misfit {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;
using testing::Not;

const char* const carriage_text = R"toml(
[states]
x = { unit = "m", scale = 0.1 }
v = { unit = "m/s", rate_of = "x", scale = 1.0 }
[inputs]
u = { unit = "m/s^2" }
wind = { unit = "m/s" }
[parameters]
c = { unit = "1/s", value = 1.0, bounds = [0.0, 100.0], free = true }
[ports]
push = { unit = "m/s^2" }
[equations]
x = "v"
v = "u - c*v + push"
[outputs]
x = { unit = "m", noise = 1e-3 }
)toml";

/// Its formula is right; where it acts and what its coefficient is measured in, the tests say.
struct Brake {
  static constexpr const char* formula = "F = -b rate";
  static constexpr const char* symbols = "b";
  static constexpr const char* valid = "always";
  static constexpr const char* size = "any";
  static constexpr const char* source = "these tests";
  static constexpr const char* excludes = "nothing";
  enum Quantity { rate };
  static constexpr Role quantities[] = {{.name = "rate", .unit = "*"}};
  enum Port { port };
  static constexpr Role ports[] = {{.name = "port", .unit = "{rate}/s"}};
  enum Coefficient { b };
  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    F[port] = -in.c[b] * in.q[rate];
  }
  static std::vector<Example> examples() { return {{.quantities = {2.0}, .coefficients = {3.0}, .ports = {-6.0}, .source = "by hand"}}; }
};

struct SoundBrake : Brake {
  static constexpr CoefficientSpec coefficients[] = {{.name = "b", .unit = "1/s", .lower = -9.0, .upper = 9.0, .doc = "strength"}};
};

struct WrongUnitBrake : Brake {
  static constexpr CoefficientSpec coefficients[] = {{.name = "b", .unit = "{port}/{rate", .lower = -9.0, .upper = 9.0, .doc = "strength"}};
};

/// A programming mistake: its example has fewer numbers than its formula reads.
struct FaultyBrake : Brake {
  static constexpr CoefficientSpec coefficients[] = {{.name = "b", .unit = "1/s", .lower = -9.0, .upper = 9.0, .doc = "strength"}};
  template <class T, class K>
  static void add(const Reads<T, K>& /*in*/, T* /*F*/) {
    throw std::logic_error("a mistake in the formula's program");
  }
};

struct OtherTradeBrake : SoundBrake {
  static constexpr Role quantities[] = {{.name = "dynamic_pressure", .unit = "Pa"}};
  enum Quantity { dynamic_pressure };
};

/// The carriage, pushed by a sine; `wind` is not recorded.
Signals carriage() {
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0.0, 5e-4);
  Signals s;
  s.measured = {{"x", "m", {}, 0.0}};
  s.inputs = {{"u", "m/s^2", {}, 0.0}, {"wind", "m/s", {}, 0.0}};
  for (int k = 0; k < 300; ++k) {
    constexpr double swing = 0.05, omega = 6.0;
    const double t = 0.02 * k;
    s.t.push_back(t);
    s.measured[0].values.push_back(swing * std::sin(omega * t) + noise(random));
    s.inputs[0].values.push_back(swing * omega * (std::cos(omega * t) - omega * std::sin(omega * t)));
  }
  return s;
}

template <class Own>
CandidateList candidates_with(const char* key) {
  Registry known;
  misfit_models_register(known);
  known.add(std::make_unique<EffectOf<Own>>(key));
  known.add(declared_system(carriage_text, "carriage.toml", "carriage"));
  ModelRequest request;
  request.system = "carriage";
  const std::vector<Signals> signals = {carriage()};
  const FilterEstimate estimate = estimate_filter(assemble(request, known), {}, signals);
  return list_candidates(estimate, request, known, nullptr);
}

std::vector<std::string> keys_of(const CandidateList& list) {
  std::vector<std::string> out;
  for (const CandidateModel& model : list.models) out.push_back(model.effect);
  return out;
}

auto listed(const std::string& effect, const std::string& reason) {
  return Contains(AllOf(Field(&NotTried::place, Field(&EffectPlace::effect, effect)), Field(&NotTried::reason, HasSubstr(reason))));
}

TEST(NotTried, AnEffectThatIsDeclaredWronglyIsListedWithItsReason) {
  EXPECT_THAT(keys_of(candidates_with<SoundBrake>("brake")), Contains("brake"));
  const CandidateList wrong = candidates_with<WrongUnitBrake>("brake");
  EXPECT_THAT(keys_of(wrong), Not(Contains("brake")));
  EXPECT_THAT(keys_of(wrong), Contains("coulomb_friction")) << "the others are tried all the same";
  EXPECT_THAT(wrong.not_tried, listed("brake", "unit '{rate': '}' is missing"));
}

TEST(NotTried, AnInputWithoutValuesIsNamedWithWhatWouldLetItBeTried) {
  const CandidateList list = candidates_with<SoundBrake>("brake");
  EXPECT_THAT(list.not_tried, listed("input_lag", "input 'wind' is not recorded, or with gaps: it can be tried with a column of it"));
  for (const NotTried& n : list.not_tried) {
    if (n.place.effect == "feedthrough") continue;  // u may be under control
    EXPECT_THAT(n.reason, HasSubstr("'wind'")) << n.place.effect;
  }
}

TEST(NotTried, WhatBelongsToAnotherSystemIsNotListed) {
  const CandidateList list = candidates_with<OtherTradeBrake>("brake");
  EXPECT_THAT(keys_of(list), Not(Contains("brake")));
  EXPECT_THAT(list.not_tried, Not(listed("brake", "")));
}

TEST(NotTried, AProgrammingMistakeIsNotSwallowed) { EXPECT_THROW((void)candidates_with<FaultyBrake>("brake"), std::logic_error); }

TEST(NotTried, IsSaidInWordsByEffectAndPlace) {
  Discovery d;
  d.not_tried = {{{"input_lag", {{"input", "wind"}}}, "input 'wind' is not recorded"}};
  EXPECT_THAT(not_tried_in_words(d), ElementsAre("input_lag (input = wind): not tried: input 'wind' is not recorded"));
}

}  // namespace
}  // namespace misfit
