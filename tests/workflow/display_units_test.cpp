// Units in which a system has its results shown ([display] units) change what is shown and nothing else.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "misfit/core/units.h"
#include "misfit/export/exported.h"
#include "misfit/show/rows.h"
#include "misfit/workflow/assess/assess.h"
#include "tests/workflow/text_study.h"

namespace {

using namespace misfit;
using testing::HasSubstr;
using testing_text_study::TextStudy;

const std::string room = R"toml([states]
T = { unit = "K", scale = 3.0, initial = "free" }
[inputs]
out = { unit = "K", hold = "zero_order" }
P = { unit = "W", hold = "zero_order" }
[parameters]
loss = { unit = "1/s", value = 1e-3, free = true, bounds = [0.0, 1.0] }
gain = { unit = "K/s/W", value = 1e-6, free = true, bounds = [0.0, 1e-3] }
idle = { unit = "W", value = 40.0, free = true }
[equations]
T = "loss*(out - T) + gain*(P + idle)"
[outputs]
T = { unit = "K", noise = 0.05 }
)toml";

/// A hot plate in a draught, ten seconds apart; `vent` [1/s] cools it further above 24 degC.
std::string recording(bool si, double vent) {
  std::string text = si ? "t[s],out[K],P[W],T[K]\n" : "t[s],out[degC],P[kW],T[degC]\n";
  const double zero = si ? 273.15 : 0.0, kilo = si ? 1.0 : 1e-3;
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 0.05);
  double T = 20.0;
  for (std::size_t i = 0; i < 400; ++i) {
    const double out = 18.0 + std::round(40.0 * std::sin(0.02 * static_cast<double>(i))) / 10.0;
    const double power = i % 40 < 20 ? 500.0 : 100.0;
    char row[120];
    std::snprintf(row, sizeof row, "%zu,%.17g,%.17g,%.17g\n", 10 * i, out + zero, power * kilo, T + noise(random) + zero);
    text += row;
    for (int k = 0; k < 10; ++k) T += 2e-3 * (out - T) + 4e-5 * (power + 50.0) - vent * std::max(0.0, T - 24.0);
  }
  return text;
}

Fit fitted(const TextStudy& study) { return study.identification("filter_error", "").fit("filter_error"); }

TEST(DisplayUnits, ChangeNoEstimate) {
  const Fit si = fitted({room, recording(true, 0.0)});
  const Fit own = fitted({"[display]\nunits = [\"degC\", \"kW\"]\n" + room, recording(false, 0.0)});
  ASSERT_TRUE(si.usable() && own.usable()) << si.message << own.message;
  for (const auto& [name, estimate] : si.parameters) {
    EXPECT_NEAR(own.parameters.at(name).value, estimate.value, 1e-4 * estimate.sigma) << name;
    EXPECT_NEAR(own.parameters.at(name).sigma, estimate.sigma, 1e-4 * estimate.sigma) << name;
  }
  EXPECT_NEAR(own.loglik.value(), si.loglik.value(), 1e-4);
}

TEST(DisplayUnits, AreThoseOfNumbersAndOfStoredResultsAndSurviveBeingReadBack) {
  const TextStudy study("[display]\nunits = [\"degC\", \"kW\"]\n" + room, recording(false, 0.0));
  const Fit first = fitted(study), again = fitted(study);
  for (const Fit& fit : {first, again}) {
    ASSERT_TRUE(fit.usable()) << fit.message;
    EXPECT_THAT(shown(fit.parameters.at("idle")), HasSubstr(" kW"));
    EXPECT_NEAR(fit.parameters.at("idle").value, 50.0, 4.0 * fit.parameters.at("idle").sigma);
    EXPECT_EQ(fit.parameters.at("gain").unit, "K/s/W (shown in K/s/kW)");
    EXPECT_THAT(shown(fit.parameters.at("gain")), testing::EndsWith(" K/s/kW"));
    EXPECT_NEAR(fit.parameters.at("gain").value, 4e-5, 4.0 * fit.parameters.at("gain").sigma) << "SI";
    EXPECT_THAT(shown(fit.noise.at("T")), HasSubstr(" K")) << "an error is a difference";
    EXPECT_EQ(fit.predictions.front().unit, "K (shown in degC)");
    EXPECT_EQ(fit.parameters.at("idle").unit, "W (shown in kW)");
    EXPECT_THAT(fit.facts.at("residuals of T in 'one'"), HasSubstr(" K, "));
  }
  const auto read_back = testing::Pointwise(testing::NanSensitiveDoubleNear(1e-9), first.predictions.front().predicted);
  EXPECT_THAT(again.predictions.front().predicted, read_back);
  EXPECT_THAT(again.predictions.front().measured,
              testing::Pointwise(testing::NanSensitiveDoubleNear(1e-9), first.predictions.front().measured));
  EXPECT_THAT(again.predictions.front().sigma, testing::Pointwise(testing::NanSensitiveDoubleNear(1e-9), first.predictions.front().sigma));
}

TEST(DisplayUnits, AreThoseOfKnotsThatNameNoneButOfTemperatures) {
  const TextStudy study("[display]\nunits = [\"degC\", \"kW\"]\n" + room, recording(false, 0.0));
  const auto knots = [&](const std::string& curve) {
    Identification identification = study.identification("filter_error", "[effects.bias]\noutput = \"T\"\n[curves]\noffset = " + curve);
    return identification.session().model.request.curves.at("offset").knots;
  };
  EXPECT_THAT(knots("{ of = \"P\", knots = [0.1, 0.3, 0.5] }"), testing::Pointwise(testing::DoubleEq(), {100.0, 300.0, 500.0}));
  EXPECT_THAT(knots("{ of = \"T\", knots = [290.0, 295.0, 300.0] }"), testing::Pointwise(testing::DoubleEq(), {290.0, 295.0, 300.0}));
}

TEST(DisplayUnits, AreNotThoseOfWhatIsExported) {
  const TextStudy study("[display]\nunits = [\"degC\", \"kW\"]\n" + room, recording(false, 0.0));
  Exported exported;
  exported.fit = fitted(study);
  use_plain_units(exported);
  const std::string text = json_text(exported);
  EXPECT_THAT(text, HasSubstr("\"unit\": \"W\""));
  EXPECT_THAT(text, testing::Not(HasSubstr("shown in")));
}

TEST(DisplayUnits, ArePlacesOfWhereAModelFails) {
  const TextStudy study("[display]\nunits = [\"degC\", \"kW\"]\n" + room, recording(false, 5e-3));
  Identification identification = study.identification("filter_error", "");
  const auto diagnosis = diagnose_stage(identification.session());
  ASSERT_TRUE(diagnosis);
  bool found = false;
  for (const ForceMap& map : diagnosis->maps) {
    if (map.quantity != "T" || map.port != "dT/dt" || map.sentence.empty()) continue;
    found = true;
    EXPECT_THAT(map.sentence, HasSubstr(" degC"));
    EXPECT_THAT(map.sentence, HasSubstr(" K/s"));
  }
  EXPECT_TRUE(found);
}

}  // namespace
