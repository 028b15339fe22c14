// The law of nested models: with one effect more, on the same measurements and with the same roughness, a model never fits worse than
// without it. Over every effect that suits a system, at its first place.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <random>
#include <set>

#include "misfit/core/error.h"
#include "misfit/core/stopwatch.h"
#include "misfit/discover/candidate_model.h"
#include "misfit/fit/filter/contained_start.h"
#include "misfit/fit/trajectory_start.h"
#include "tests/discover/record.h"
#include "tests/fit/flight.h"
#include "tests/fit/planar_model.h"
#include "tests/model/declared_texts.h"

namespace misfit {
namespace {

using namespace testing_models;

/// Direct-current motor: two domains, each with a random force of its own unit.
const char* const motor_text = R"toml(
[states]
i = { unit = "A", scale = 5.0 }
w = { unit = "rad/s", scale = 20.0 }
[inputs]
u = { unit = "V", hold = "zero_order" }
[parameters]
L = { unit = "V s/A", value = 0.02 }
R = { unit = "V/A", value = 1.0, bounds = [0.0, 100.0], free = true }
k = { unit = "V s", value = 0.1 }
J = { unit = "V A s^3", value = 0.01 }
b = { unit = "V A s^2", value = 0.02, bounds = [0.0, 1.0], free = true }
[equations]
i = "(u - R*i - k*w)/L"
w = "(k*i - b*w)/J"
[outputs]
i = { unit = "A", noise = 0.02 }
w = { unit = "rad/s", noise = 0.1 }
)toml";

/// A heated body that radiates, seen through its wall: a state that no output shows, and one by a curved formula.
const char* const furnace_text = R"toml(
[states]
T = { unit = "K", scale = 100.0, min = 0.0 }
W = { unit = "K", scale = 100.0, min = 0.0 }
[inputs]
P = { unit = "W", hold = "zero_order" }
[parameters]
gain = { unit = "K/J", value = 2.0, bounds = [0.0, 1e3], free = true }
exchange = { unit = "1/s", value = 0.2, bounds = [0.0, 1e3], free = true }
radiation = { unit = "1/K^3/s", value = 4e-11, bounds = [0.0, 1.0] }
loss = { unit = "1/s", value = 0.05, bounds = [0.0, 1e3], free = true }
T_0 = { unit = "K", value = 300.0 }
[equations]
T = "gain*P - exchange*(T - W) - radiation*(T^4 - T_0^4)"
W = "exchange*(T - W) - loss*(W - T_0)"
[outputs]
W = { unit = "K", noise = 0.5 }
glow = { unit = "K", formula = "sqrt(T^2 + W^2)", noise = 1.0 }
)toml";

/// MISFIT_NESTED_MODELS=all: every place of every effect, on twice as many samples (./dev check).
bool all_places() {
  const char* asked = std::getenv("MISFIT_NESTED_MODELS");
  return asked != nullptr && std::string(asked) == "all";
}

/// Where a system is, how often it is read, how strong its input is (held at random for 20 samples, above 0 or about 0).
struct Record {
  std::vector<double> start;
  double step = 0.0, input = 0.0;
  bool positive = false;
  std::size_t samples = 150;
};

/// The system's own motion at the values of its file, outputs read with their typical noise.
Signals simulated(const Model& truth, const Record& as) {
  const SystemSpec& spec = truth.system->spec();
  Signals s;
  s.name = "record";
  for (const auto& i : spec.inputs) s.inputs.push_back({i.name, i.unit, {}});
  for (const auto& o : spec.outputs) s.measured.push_back({o.name, o.unit, {}});
  std::mt19937_64 random(62);
  std::normal_distribution<double> normal;
  constexpr std::size_t held = 20;
  std::vector<double> u(spec.inputs.size() + 1, 0.0), x = as.start, y(s.measured.size() + 1);
  Stepper stepper(truth);
  const std::size_t samples = all_places() ? 2 * as.samples : as.samples;
  for (std::size_t k = 0; k < samples; ++k) {
    const double drawn = normal(random);
    if (k % held == 0) u[0] = as.input * (as.positive ? 1.0 + 0.3 * drawn : drawn);
    if (k == 0) stepper.prepare(x.data(), u.data(), 0.0);
    s.t.push_back(as.step * static_cast<double>(k));
    for (std::size_t i = 0; i < s.inputs.size(); ++i) s.inputs[i].values.push_back(u[i]);
    stepper.evaluator().predict(x.data(), u.data(), s.t[k], y.data());
    for (std::size_t o = 0; o < s.measured.size(); ++o) s.measured[o].values.push_back(y[o] + spec.outputs[o].noise * normal(random));
    EXPECT_TRUE(stepper.step(x.data(), {s.t[k], s.t[k] + as.step, u.data(), u.data()}));
  }
  return s;
}

/// A study's model without the effect and its record.
struct Parent {
  std::shared_ptr<const Registry> known;
  std::vector<Signals> signals;
  ModelRequest request;
  FilterEstimate estimate;
  Parent(Signals record, ModelRequest asked,
         std::shared_ptr<const Registry> registry = std::make_shared<Registry>(Registry::over(testing_models::registry())))
      : known(std::move(registry)), signals{std::move(record)}, request(std::move(asked)), estimate(fit()) {}

 private:
  [[nodiscard]] FilterEstimate fit() {
    request.curves.clear();
    choose_all_knots(request, *known, signals, 5);
    const Model model = assemble(request, *known);
    return estimate_filter(trajectory_start(model, signals).from.model, curve_penalties(model), signals);
  }
};

/// As the ladder compares (lib/misfit/README.md, 6.6): 2 [log L(with) − log L(without)], each from its own estimate, the larger model also
/// from the smaller one's.
double drop(const Parent& parent, const Model& child) {
  FilterOptions options;
  options.reference = parent.estimate.reference;
  options.choose_roughness = false;
  options.use.emplace();
  for (const auto& data : parent.estimate.data) options.use->push_back(data.use);
  const FilterStart own{parent.estimate.model, parent.estimate.penalties, parent.estimate.noise};
  const FilterEstimate without = estimate_filter(std::vector<FilterStart>{own}, parent.signals, options);
  options.plans = plans_of(without);
  const std::vector<FilterStart> starts = starts_from(contained_fit(without), child);
  EXPECT_FALSE(starts.empty());
  return 2.0 * (estimate_filter(starts, parent.signals, options).objective - without.objective);
}

/// Names and drops of the effects that lose or cannot be fitted; all are tried.
std::vector<std::string> losers(const Parent& parent, std::size_t fewest) {
  constexpr double rounding = 1e-6;
  std::vector<std::string> out;
  std::set<std::string> tried;
  const Stopwatch clock;
  double longest = 0.0;
  std::string slowest;
  for (const CandidateModel& candidate : candidate_models(parent.estimate, parent.request, *parent.known, nullptr)) {
    if (!tried.insert(candidate.effect).second && !all_places()) continue;
    const double before = clock.seconds();
    try {
      const double gained = drop(parent, assemble(candidate.request, *parent.known));
      if (!(gained > -2.0 * rounding)) out.push_back(candidate.effect + ": " + std::to_string(gained));
    } catch (const RunError& error) {
      out.push_back(candidate.effect + ": " + error.what());
    }
    if (clock.seconds() - before <= longest) continue;
    longest = clock.seconds() - before;
    slowest = candidate.effect;
  }
  std::printf("%zu effects in %.1f s, the longest %s: %.1f s\n", tried.size(), clock.seconds(), slowest.c_str(), longest);
  EXPECT_GE(tried.size(), fewest);
  return out;
}

TEST(LargerModels, NeverLoseOnAFlight) {
  const Parent parent(testing_flight::fly(5.0, 61), spherical());
  EXPECT_THAT(losers(parent, 10), testing::IsEmpty());
}

/// The first samples of a record.
Signals shortened(Signals record, std::size_t samples) {
  record.t.resize(samples);
  for (auto* channels : {&record.measured, &record.inputs})
    for (auto& channel : *channels) channel.values.resize(samples);
  return record;
}

TEST(LargerModels, NeverLoseOnAPlanarMotion) {
  const Parent parent(shortened(testing_planar::validation_signals(), 300), testing_planar::eq_8());
  EXPECT_THAT(losers(parent, 8), testing::IsEmpty());
}

TEST(LargerModels, NeverLoseOnASystemGivenAsText) {
  const ModelRequest duffing = declared("duffing", {});
  const Signals record = testing_records::record(duffing, {}, 1.0 / 610.0, 0.15, {1e-3, 0.5}, 62);
  EXPECT_THAT(losers({shortened(record, all_places() ? 500 : 200), duffing}, 5), testing::IsEmpty());
}

TEST(LargerModels, NeverLoseOnAPendulum) {
  const ModelRequest pendulum = declared("pendulum", {});
  EXPECT_THAT(losers({simulated(assemble(pendulum, registry()), {{1.2, 0.0}, 0.02}), pendulum}, 5), testing::IsEmpty());
}

TEST(LargerModels, NeverLoseOnTanks) {
  const ModelRequest tanks = declared("cascaded_tanks", {});
  const Record as{.start = {4.0, 4.0}, .step = 4.0, .input = 3.0, .positive = true};
  EXPECT_THAT(losers({simulated(assemble(tanks, registry()), as), tanks}, 5), testing::IsEmpty());
}

TEST(LargerModels, NeverLoseOnAMotor) {
  const auto known = registry_with(motor_text);
  const ModelRequest motor = request_of("text");
  const Record as{.start = {0.0, 0.0}, .step = 0.01, .input = 6.0};
  EXPECT_THAT(losers({simulated(assemble(motor, *known), as), motor, known}, 5), testing::IsEmpty());
}

TEST(LargerModels, NeverLoseOnAFurnace) {
  const auto known = registry_with(furnace_text);
  const ModelRequest furnace = request_of("text");
  const Record as{.start = {600.0, 500.0}, .step = 1.0, .input = 15.0, .positive = true};
  EXPECT_THAT(losers({simulated(assemble(furnace, *known), as), furnace, known}, 5), testing::IsEmpty());
}

}  // namespace
}  // namespace misfit
