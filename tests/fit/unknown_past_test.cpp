// What inputs were before the recording, where a delay reads it.
#include "misfit/fit/filter/unknown_past.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "misfit/fit/filter/filter_estimate.h"
#include "tests/model/declared_texts.h"
#include "tests/model/requests.h"

namespace misfit {
namespace {

using namespace testing_models;

const std::string motor_text = R"toml(
[states]
w = { unit = "rad/s", initial = "free" }
[inputs]
u = { unit = "V", hold = "zero_order" }
[parameters]
tau = { unit = "s", value = 0.5, free = true }
gain = { unit = "rad/s/V", value = 2.0, free = true }
[equations]
w = "(gain*u - w)/tau"
[outputs]
w = { unit = "rad/s", noise = 0.02 }
)toml";

constexpr double step = 0.1, true_delay = 0.35, noise_of_w = 0.02, first_command = 1.0;

/// At rest until the recording begins, with the command on from its first sample; then steps of another size every second.
Signals from_rest() {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  Signals s;
  s.name = "from rest";
  s.measured = {{"w", "rad/s", {}, 0.0}};
  s.inputs = {{"u", "V", {}, 0.0}};
  const auto command = [](double t) {
    return t < 0.0 ? 0.0 : std::floor(t + 1e-9) == 0.0 ? first_command : std::sin(3.7 * std::floor(t + 1e-9));
  };
  constexpr int fine = 200;
  double w = 0.0;
  for (int k = 0; k < 200; ++k) {
    const double t = step * k;
    s.t.push_back(t);
    s.inputs[0].values.push_back(command(t));
    s.measured[0].values.push_back(w + noise_of_w * normal(random));
    for (int i = 0; i < fine; ++i) w += step / fine * (2.0 * command(t + step * (i + 0.5) / fine - true_delay) - w) / 0.5;
  }
  return s;
}

/// As if it had been recorded before, too, when the command was `before` and nobody read w.
Signals with_past(const Signals& of, double before) {
  Signals out = of;
  constexpr int samples = 10;
  for (int k = 1; k <= samples; ++k) {
    out.t.insert(out.t.begin(), -step * k);
    out.inputs[0].values.insert(out.inputs[0].values.begin(), before);
    out.measured[0].values.insert(out.measured[0].values.begin(), std::nan(""));
  }
  return out;
}

ModelRequest with_delay(double seconds) {
  ModelRequest request = request_of("text", {effect("delay", {{"input", "u"}, {"port", "u"}})});
  request.parameters["delayed_gain"].value = 1.0;
  request.parameters["delayed_gain"].free = false;
  request.parameters["delay"].value = seconds;
  return request;
}

FilterNoise some_noise(const FilterModel& model) {
  FilterNoise noise;
  noise.force = 0.3;
  noise.force_time = model.force_time();
  noise.channels = {{.white = noise_of_w, .coloured = 0.03, .coloured_frequency = 0.8, .coloured_damping = 0.3}};
  return noise;
}

const std::shared_ptr<Registry>& systems() {
  static const std::shared_ptr<Registry> out = registry_with(motor_text);
  return out;
}

/// The model is linear in the past, so that the likelihood of each past is a parabola in it, and its mean over all pasts an integral that
/// is known.
TEST(UnknownPast, TheLikelihoodIsThatOfEveryPastWeighedByItsProbability) {
  const FilterModel model = with_random_force(assemble(with_delay(true_delay), *systems()));
  const FilterNoise noise = some_noise(model);
  const auto loglik = [&](const Signals& signals) {
    const FilterData data = filter_data(model, signals);
    FilterRunner runner(model, false);
    FilterTrace trace;
    EXPECT_TRUE(runner.run(data, noise, trace));
    return trace.loglik;
  };
  const Signals recorded = from_rest();
  const double low = loglik(with_past(recorded, first_command - 1.0)), at = loglik(with_past(recorded, first_command)),
               high = loglik(with_past(recorded, first_command + 1.0));
  const double slope = 0.5 * (high - low), bend = high - 2.0 * at + low;
  const FilterData data = filter_data(model, recorded);
  const double sigma = data.input_departures.front();
  ASSERT_NEAR(sigma, 1.2, 0.3);
  const double precision = 1.0 / (sigma * sigma) - bend;
  const double all = at + 0.5 * slope * slope / precision - 0.5 * std::log(sigma * sigma * precision);
  EXPECT_LT(at, low - 50.0) << "the command was off, not as at the first sample";
  EXPECT_NEAR(loglik(recorded), all, 1e-6 * std::abs(all));
}

TEST(UnknownPast, ALinearRunRepeatsTheRun) {
  const FilterModel model = with_random_force(assemble(with_delay(true_delay), *systems()));
  const FilterNoise noise = some_noise(model);
  const Signals signals = from_rest();
  const FilterData data = filter_data(model, signals);
  FilterRunner runner(model, false);
  FilterTrace trace;
  ASSERT_TRUE(runner.run(data, noise, trace));
  EXPECT_EQ(trace.past_mean.size(), 3U) << "a delay of 3.5 samples, from the second one";
  EXPECT_NEAR(-minus_loglik(data, run_linear(model, data, trace, noise)), trace.loglik, 1e-8 * std::abs(trace.loglik));
  FilterNoise other = noise;
  other.channels.front().white *= 1.5;
  FilterTrace with_other;
  ASSERT_TRUE(runner.run(data, other, with_other));
  EXPECT_NEAR(-minus_loglik(data, run_linear(model, data, trace, other)), with_other.loglik, 1e-8 * std::abs(with_other.loglik));
}

/// With the first value for the past, what the delay did not explain of the first samples went into gain and time constant.
TEST(UnknownPast, LeavesTheEstimatesWhereTheyAreIfItIsKnown) {
  const auto estimate_of = [](const Signals& recorded) {
    const std::vector<Signals> signals = {recorded};
    const FilterEstimate out = estimate_filter(assemble(with_delay(0.3), *systems()), {}, signals);
    EXPECT_TRUE(out.converged);
    return out.model;
  };
  const Model unknown = estimate_of(from_rest()), known = estimate_of(with_past(from_rest(), 0.0)),
              wrong = estimate_of(with_past(from_rest(), first_command));
  const auto value = [](const Model& model, const char* name) { return model.parameters[model.find_parameter(name)].value; };
  EXPECT_NEAR(value(known, "delay"), true_delay, 0.003);
  for (const char* name : {"delay", "gain", "tau"}) {
    const double far = std::abs(value(wrong, name) - value(known, name));
    EXPECT_LT(std::abs(value(unknown, name) - value(known, name)), 0.2 * far) << name;
  }
}

TEST(UnknownPast, OfAModelThatReadsNoneOfItNothingChanges) {
  const FilterModel model = with_random_force(assemble(request_of("text"), *systems()));
  const Signals signals = from_rest();
  const FilterData data = filter_data(model, signals);
  FilterRunner runner(model, false);
  FilterTrace trace;
  ASSERT_TRUE(runner.run(data, some_noise(model), trace));
  EXPECT_TRUE(trace.past_mean.empty());
}

}  // namespace
}  // namespace misfit
