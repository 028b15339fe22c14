// An input that a system declares and no equation needs, as `misfit init` leaves it beside a model that the data want without it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "misfit/workflow/assess/assess.h"
#include "tests/workflow/swing.h"
#include "tests/workflow/text_study.h"

namespace {

using namespace misfit;
using testing_text_study::TextStudy;

constexpr const char* valve = "valve = { unit = \"V\", hold = \"zero_order\" }\n";

TEST(AnInputThatNoEquationNeeds, ChangesNoEstimate) {
  const std::string recording = testing_swing::recording(7);
  TextStudy with(testing_swing::system(valve), recording), without(testing_swing::system(), recording);
  for (const char* method : {"equation_error", "output_error", "filter_error"}) {
    const Fit a = with.fit(method, ""), b = without.fit(method, "");
    ASSERT_EQ(a.status, FitStatus::converged) << method << ": " << a.message;
    for (const char* name : {"k", "d", "b"}) EXPECT_EQ(a.parameters.at(name).value, b.parameters.at(name).value) << method << ", " << name;
  }
}

TEST(AnInputThatNoEquationNeeds, DoesNotHinderAComparisonFromALaterSampleOn) {
  TextStudy study(testing_swing::system(valve), testing_swing::recording(7));
  Identification identification = study.identification("filter_error", "", "exclude = 7\n");
  EXPECT_TRUE(compare_stage(identification.session(), identification.fit()).motion);
}

/// y' = u + valve - y, of whose inputs the model has u alone.
TextStudy of_two_inputs(const std::string& missing = "") {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::string text = "t[s],u[V],valve[V],y[V]\n";
  double y = 0.0;
  for (int k = 0; k < 1000; ++k) {
    const int u = k / 40 % 3, opening = k / 56 % 2;
    text += fmt::format("{:.1f},{},{},{:.4f}\n", 0.1 * k, u, k == 500 && !missing.empty() ? missing : std::to_string(opening),
                        y + 0.02 * normal(random));
    y += (u + opening - y) * (1.0 - std::exp(-0.1));
  }
  return {R"toml([system]
doc = "first order"
[states]
y = { unit = "V", initial = "free" }
[inputs]
u = { unit = "V", hold = "zero_order" }
valve = { unit = "V", hold = "zero_order" }
[parameters]
tau = { unit = "s", value = 1.2, bounds = [0.01, 100.0], free = true }
gain = { unit = "-", value = 0.8, free = true }
rest = { unit = "V", value = 0.0, free = true }
[equations]
y = "(rest + gain*u - y)/tau"
[outputs]
y = { unit = "V", noise = 0.02 }
)toml",
          text};
}

TEST(AnInputThatNoEquationNeeds, IsFoundToActWhereItActs) {
  const TextStudy study = of_two_inputs();
  Identification identification = study.identification("filter_error", "");
  const auto of_valve = predict_effect(identification.session(), "input_gain", asked_place({"input=valve"}));
  ASSERT_TRUE(of_valve);
  EXPECT_FALSE(of_valve->absorbed) << of_valve->why;
  EXPECT_GT(of_valve->predicted_drop, 50.0);
  const auto u = predict_effect(identification.session(), "input_gain", asked_place({"input=u", "port=dy/dt"}));
  ASSERT_TRUE(u) << "its default place may be named";
  EXPECT_TRUE(u->roles.empty());
  EXPECT_TRUE(u->absorbed) << "its gain is free";
}

/// The fit did without its values, so that there is nothing to test.
TEST(AnInputThatNoEquationNeeds, IsNotCalledDescribedWhereItHasGaps) {
  const TextStudy study = of_two_inputs("nan");
  Identification identification = study.identification("filter_error", "");
  EXPECT_THROW(static_cast<void>(predict_effect(identification.session(), "input_gain", asked_place({"input=valve"}))), InputError);
}

}  // namespace
