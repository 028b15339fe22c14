// Where a search ends: digits, and what is said where it got stuck. Data and certified values: NIST StRD, Eckerle4 (Eckerle, K., NIST
// (197?), circular interference transmittance).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "misfit/fit/output_error.h"
#include "tests/model/declared_texts.h"

namespace misfit {
namespace {

using namespace testing_models;
using testing::HasSubstr;
using testing::Not;

/// y = f(x; b) as a system: one state that stands, x as an input, the row as time.
const std::string eckerle_text = R"toml(
[states]
s = { unit = "-", initial = 0.0 }
[inputs]
x = { unit = "-" }
[parameters]
b1 = { unit = "-", value = 1.0, free = true }
b2 = { unit = "-", value = 10.0, free = true }
b3 = { unit = "-", value = 500.0, free = true }
[equations]
s = "0"
[outputs]
y = { unit = "-", formula = "b1/b2*exp(-0.5*((x - b3)/b2)^2)", noise = 0.01 }
)toml";

constexpr std::array<std::array<double, 2>, 35> eckerle = {
    {{400.0, 0.0001575}, {405.0, 0.0001699}, {410.0, 0.0002350}, {415.0, 0.0003102}, {420.0, 0.0004917}, {425.0, 0.0008710},
     {430.0, 0.0017418}, {435.0, 0.0046400}, {436.5, 0.0065895}, {438.0, 0.0097302}, {439.5, 0.0149002}, {441.0, 0.0237310},
     {442.5, 0.0401683}, {444.0, 0.0712559}, {445.5, 0.1264458}, {447.0, 0.2073413}, {448.5, 0.2902366}, {450.0, 0.3445623},
     {451.5, 0.3698049}, {453.0, 0.3668534}, {454.5, 0.3106727}, {456.0, 0.2078154}, {457.5, 0.1164354}, {459.0, 0.0616764},
     {460.5, 0.0337200}, {462.0, 0.0194023}, {463.5, 0.0117831}, {465.0, 0.0074357}, {470.0, 0.0022732}, {475.0, 0.0008800},
     {480.0, 0.0004579}, {485.0, 0.0002345}, {490.0, 0.0001586}, {495.0, 0.0001143}, {500.0, 0.0000710}}};

FittedModel fitted(double b1, double b2, double b3) {
  const auto known = registry_with(eckerle_text);
  ModelRequest request = request_of("text");
  request.parameters["b1"].value = b1;
  request.parameters["b2"].value = b2;
  request.parameters["b3"].value = b3;
  Signals s;
  s.name = "eckerle";
  s.measured = {{"y", "-", {}, 0.0}};
  s.inputs = {{"x", "-", {}, 0.0}};
  for (std::size_t i = 0; i < eckerle.size(); ++i) {
    s.t.push_back(static_cast<double>(i));
    s.inputs[0].values.push_back(eckerle[i][0]);
    s.measured[0].values.push_back(eckerle[i][1]);
  }
  OutputErrorStart options;
  options.from_regression = false;
  FittedModel start{{}, assemble(request, *known), {}, {}};
  return output_error(start, {s}, options);
}

TEST(EndOfSearch, HasSixDigitsAtACertifiedMinimum) {
  const Fit fit = fitted(1.5, 5.0, 450.0).fit;
  ASSERT_EQ(fit.status, FitStatus::converged) << fit.message;
  constexpr double six_digits = 1e-6;
  EXPECT_NEAR(fit.parameters.at("b1").value / 1.5543827178, 1.0, six_digits);
  EXPECT_NEAR(fit.parameters.at("b2").value / 4.0888321754, 1.0, six_digits);
  EXPECT_NEAR(fit.parameters.at("b3").value / 451.54121844, 1.0, six_digits);
  EXPECT_NEAR(fit.plain_sigmas.at("b1") / 1.5408051163e-02, 1.0, 1e-4)
      << "three parameters of 35 values, the state that stands is no fourth";
}

TEST(EndOfSearch, WhereItGotStuckNothingIsSaidOfTheData) {
  const Fit fit = fitted(1.0, 10.0, 500.0).fit;
  if (fit.status == FitStatus::converged) {  // found after all
    EXPECT_NEAR(fit.parameters.at("b3").value, 451.54, 0.01);
    return;
  }
  EXPECT_THAT(fit.message, HasSubstr("ended at no fit"));
  EXPECT_LT(fit.message.size(), 320U);
}

}  // namespace
}  // namespace misfit
