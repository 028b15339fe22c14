// Where the memory of an effect begins is computed with the values of its parameters: with those of the estimate, wherever the search
// began.
#include <gtest/gtest.h>

#include <cmath>

#include "misfit/core/table.h"
#include "misfit/fit/filter/filter_estimate.h"
#include "tests/model/declared_texts.h"
#include "tests/model/requests.h"
#include "tests/paths.h"

namespace misfit {
namespace {

using namespace testing_models;

const std::string servo_text = R"toml(
[states]
q = { unit = "rad", initial = "free" }
q_rate = { unit = "rad/s", rate_of = "q", initial = "free" }
[inputs]
u = { unit = "rad", hold = "zero_order" }
[parameters]
q_stiffness = { unit = "1/s^2", value = 80.0, free = true, bounds = [0.01, 1e4] }
q_damping = { unit = "1/s", value = 5.0, free = true, bounds = [0.005, 5e3] }
q_gain_u = { unit = "-", value = 0.95, free = true }
[equations]
q_rate = "q_stiffness*(q_gain_u*u - q) - q_damping*q_rate"
[outputs]
q = { unit = "rad", noise = 0.0044 }
)toml";

/// A servo whose command moves no faster than 1.3768 rad/s (bench of strangers, servo, seed 550).
Signals servo() {
  const Table table = read_csv(paths::source() / "tests/apps/records/servo_with_a_slew_limit.csv");
  Signals s;
  s.name = "servo";
  s.t = table.at("t").values;
  s.measured = {{"q", "rad", table.at("q").values, 0.0}};
  s.inputs = {{"u", "rad", table.at("u").values, 0.0}};
  return s;
}

FilterEstimate estimate_from(double rate_limit) {
  static const std::vector<Signals> signals{servo()};
  static const std::shared_ptr<Registry> systems = registry_with(servo_text);
  ModelRequest request = request_of("text", {effect("rate_limit", {{"input", "u"}, {"port", "u"}})});
  request.parameters["limited_gain"].value = 1.0;
  request.parameters["limited_gain"].free = false;
  request.parameters["rate_limit"].value = rate_limit;
  request.parameters["follow_time"].value = 0.015;
  return estimate_filter(assemble(request, *systems), {}, signals);
}

TEST(TheMemoryOfAnEffect, BeginsWhereTheEstimateSaysWhereverTheSearchBegan) {
  const FilterEstimate near = estimate_from(1.37), far = estimate_from(2.5);
  const auto limit = [](const FilterEstimate& e) {
    for (const Parameter& p : e.model.parameters) {
      if (p.name == "rate_limit") return p.value;
    }
    return 0.0;
  };
  EXPECT_NEAR(limit(near), 1.3768, 0.02);
  EXPECT_NEAR(limit(far), limit(near), 2e-3);
  constexpr int memory = 2;
  const auto beginning = [&](const FilterEstimate& e) { return e.data.front().start[memory]; };
  const auto sigma = [&](const FilterEstimate& e) { return std::sqrt(e.data.front().covariance(memory, memory)); };
  EXPECT_NEAR(beginning(far), beginning(near), 1e-3) << "0.43 and 0.12 rad as the starts have it, worth 8.7 in the log-likelihood";
  EXPECT_NEAR(sigma(far), sigma(near), 1e-3);
}

}  // namespace
}  // namespace misfit
