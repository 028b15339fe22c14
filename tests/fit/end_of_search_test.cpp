// Where a search ends: digits, and what is said where it got stuck. Data and certified values: NIST StRD, Eckerle4 (Eckerle, K., NIST
// (197?), circular interference transmittance).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "misfit/fit/shooting/output_error.h"
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

const std::string mgh09_text = R"toml(
[states]
s = { unit = "-", initial = 0.0 }
[inputs]
x = { unit = "-" }
[parameters]
b1 = { unit = "-", value = 1.0, free = true }
b2 = { unit = "-", value = 1.0, free = true }
b3 = { unit = "-", value = 1.0, free = true }
b4 = { unit = "-", value = 1.0, free = true }
[equations]
s = "0"
[outputs]
y = { unit = "-", formula = "b1*(x^2 + x*b2)/(x^2 + x*b3 + b4)", noise = 0.01 }
)toml";

constexpr std::array<std::array<double, 2>, 11> mgh09 = {{{4.0, 0.1957},
                                                          {2.0, 0.1947},
                                                          {1.0, 0.1735},
                                                          {0.5, 0.16},
                                                          {0.25, 0.0844},
                                                          {0.167, 0.0627},
                                                          {0.125, 0.0456},
                                                          {0.1, 0.0342},
                                                          {0.0833, 0.0323},
                                                          {0.0714, 0.0235},
                                                          {0.0625, 0.0246}}};

template <std::size_t rows>
FittedModel fitted(const std::string& text, const std::array<std::array<double, 2>, rows>& data, const std::vector<double>& start_values) {
  const auto known = registry_with(text);
  ModelRequest request = request_of("text");
  for (std::size_t k = 0; k < start_values.size(); ++k) request.parameters["b" + std::to_string(k + 1)].value = start_values[k];
  Signals s;
  s.name = "table";
  s.measured = {{"y", "-", {}, 0.0}};
  s.inputs = {{"x", "-", {}, 0.0}};
  for (const auto& [x, y] : data) {
    s.t.push_back(static_cast<double>(s.t.size()));
    s.inputs[0].values.push_back(x);
    s.measured[0].values.push_back(y);
  }
  OutputErrorStart options;
  options.from_regression = false;
  FittedModel start{{}, assemble(request, *known), {}, {}};
  return output_error(start, {s}, options);
}

TEST(EndOfSearch, HasSixDigitsAtACertifiedMinimum) {
  const Fit fit = fitted(eckerle_text, eckerle, {1.5, 5.0, 450.0}).fit;
  ASSERT_EQ(fit.status, FitStatus::converged) << fit.message;
  constexpr double six_digits = 1e-6;
  EXPECT_NEAR(fit.parameters.at("b1").value / 1.5543827178, 1.0, six_digits);
  EXPECT_NEAR(fit.parameters.at("b2").value / 4.0888321754, 1.0, six_digits);
  EXPECT_NEAR(fit.parameters.at("b3").value / 451.54121844, 1.0, six_digits);
  EXPECT_NEAR(fit.plain_sigmas.at("b1") / 1.5408051163e-02, 1.0, 1e-4)
      << "three parameters of 35 values, the state that stands is no fourth";
}

TEST(EndOfSearch, HasSixDigitsInALongValley) {
  const std::vector<double> certified = {1.9280693458e-01, 1.9128232873e-01, 1.2305650693e-01, 1.3606233068e-01};
  const Fit fit = fitted(mgh09_text, mgh09, {0.25, 0.39, 0.415, 0.39}).fit;
  ASSERT_EQ(fit.status, FitStatus::converged) << fit.message;
  for (std::size_t k = 0; k < certified.size(); ++k)
    EXPECT_NEAR(fit.parameters.at("b" + std::to_string(k + 1)).value / certified[k], 1.0, 1e-6) << "b" << k + 1;
}

TEST(EndOfSearch, WhereItGotStuckNothingIsSaidOfTheData) {
  const Fit fit = fitted(eckerle_text, eckerle, {1.0, 10.0, 500.0}).fit;
  if (fit.status == FitStatus::converged) {  // found after all
    EXPECT_NEAR(fit.parameters.at("b3").value, 451.54, 0.01);
    return;
  }
  EXPECT_THAT(fit.message, HasSubstr("ended at no fit"));
  EXPECT_LT(fit.message.size(), 320U);
}

}  // namespace
}  // namespace misfit
