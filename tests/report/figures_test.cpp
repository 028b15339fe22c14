#include "misfit/report/figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <random>

namespace misfit::report {
namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Fit fit() {
  Fit f;
  f.method = "output_error";
  f.status = FitStatus::converged;
  f.trim = Estimate{2.0 * degree, 0.5 * degree, "rad"};
  f.curves = {{"C_m",
               "alpha_T",
               "rad",
               "-",
               {0.0, degree, 2 * degree, 3 * degree},
               {0.3, 0.2, 0.0, -0.2},
               {9.0, 0.1, 0.1, 0.1},
               {0.0, 5.0, 5.0, 5.0},
               true,
               "",
               true}};
  return f;
}

const Series* find(const Figure& figure, const std::string& key) {
  for (const Panel& panel : figure.panels) {
    for (const Series& s : panel.series) {
      if (s.key == key) return &s;
    }
  }
  return nullptr;
}

ChannelPrediction channel(std::size_t samples) {
  ChannelPrediction c{"flight", "alpha_T", "rad", {}, {}, {}, {}, {}};
  std::mt19937 generator(5);
  std::normal_distribution<double> noise(0.0, 0.01);
  for (std::size_t i = 0; i < samples; ++i) {
    c.t.push_back(0.02 * static_cast<double>(i));
    c.predicted.push_back(0.2);
    c.measured.push_back(0.2 + noise(generator));
    c.sigma.push_back(0.01);
    c.held_out.push_back(false);
  }
  return c;
}

/// The library knows no parachute: which curve's zero is the trim is in the data, and the first quantity needs no place in the name.
TEST(Figures, TheTrimStandsOnWhicheverCurveHasIt) {
  Fit ship = fit();
  ship.curves[0].name = "righting_lever";
  ship.curves[0].of = "heel";
  ship.curves.push_back(ship.curves[0]);
  ship.curves[1].of = "pitch";
  ship.curves[1].trimmed = false;
  const Figure lever = curve_figure("righting_lever", "heel", {ship}, {}), pitch = curve_figure("righting_lever", "pitch", {ship}, {});
  EXPECT_EQ(lever.name, "curve_righting_lever");
  EXPECT_NE(find(lever, "trim_output_error"), nullptr);
  EXPECT_EQ(pitch.name, "curve_righting_lever_of_pitch");
  EXPECT_EQ(find(pitch, "trim_output_error"), nullptr);
}

TEST(Figures, CurvesAreSolidWhereVisitedDashedElsewhereAndTheTrimStandsOnTheZeroLine) {
  const Figure figure = curve_figure("C_m", "alpha_T", {fit()}, {});
  const Series* solid = find(figure, "output_error");
  const Series* outside = find(figure, "output_error_outside");
  const Series* trim = find(figure, "trim_output_error");
  ASSERT_TRUE(solid != nullptr && outside != nullptr && trim != nullptr);
  EXPECT_EQ(outside->style, Style::dashed);
  EXPECT_TRUE(std::isnan(solid->y[0]));
  EXPECT_NEAR(solid->x[3], 3.0, 1e-12);
  EXPECT_DOUBLE_EQ(outside->y[0], 0.3);
  EXPECT_TRUE(std::isnan(outside->y[2]));
  EXPECT_NEAR(trim->lo[0], 1.5, 1e-12);
  EXPECT_NEAR(trim->y[0], 0.0, 1e-15);
  ASSERT_TRUE(figure.panels[0].y_range.has_value());
  EXPECT_LT((*figure.panels[0].y_range)[1], 1.0);  // the band of 9 where nothing was visited does not set the scale
}

TEST(Figures, ACurveWithoutInformationIsGreyDottedAndSaysSo) {
  Fit f = fit();
  f.curves[0].informative = false;
  f.curves[0].why = "the sum telescopes";
  const Figure figure = curve_figure("C_m", "alpha_T", {f}, {});
  const Series* s = find(figure, "output_error");
  ASSERT_NE(s, nullptr);
  EXPECT_EQ(s->style, Style::dotted);
  EXPECT_EQ(s->colour, grey);
  EXPECT_NE(s->legend.find("not informative"), std::string::npos);
  EXPECT_EQ(find(figure, "output_error_band"), nullptr);
  ASSERT_EQ(figure.notes.size(), 1U);
  EXPECT_NE(figure.notes[0].find("the sum telescopes"), std::string::npos);
}

TEST(Figures, ADeclinedFitIsNotDrawnButNoted) {
  Fit f = fit();
  f.status = FitStatus::declined;
  f.message = "the motion is driven";
  const Figure figure = curve_figure("C_m", "alpha_T", {f}, {});
  EXPECT_TRUE(figure.panels[0].series.empty());
  ASSERT_EQ(figure.notes.size(), 1U);
  EXPECT_NE(figure.notes[0].find("the motion is driven"), std::string::npos);
}

TEST(Figures, ReferencePointsHaveErrorBars) {
  const Reference reference{"static", "C_m", "alpha_T", "rad", "-", {degree}, {0.1}, {0.02}, Estimate{degree, 0.1 * degree, "rad"}, {}};
  const Figure figure = curve_figure("C_m", "alpha_T", {}, {reference});
  const Series* s = find(figure, "static");
  ASSERT_NE(s, nullptr);
  EXPECT_NEAR(s->x[0], 1.0, 1e-12);
  EXPECT_NEAR(s->lo[0], 0.08, 1e-12);
  EXPECT_NE(find(figure, "trim_static"), nullptr);
}

TEST(Figures, APredictionFromAnUnknownStateDoesNotSetTheAxisOfTheResiduals) {
  ChannelPrediction c = channel(200);
  for (std::size_t k = 0; k < c.t.size(); ++k) {
    c.measured[k] = c.predicted[k] + (k % 2 == 0 ? 0.5 : -0.5) * degree;
    c.sigma[k] = 0.4 * degree;
  }
  EXPECT_FALSE(motion_figure("filter_error", c, std::nullopt).panels[1].y_range);
  c.measured[1] = c.predicted[1] + 100.0 * degree;
  c.sigma[1] = 90.0 * degree;
  const Figure figure = motion_figure("filter_error", c, std::nullopt);
  ASSERT_TRUE(figure.panels[1].y_range);
  EXPECT_NEAR((*figure.panels[1].y_range)[1], 0.5 * 1.05, 1e-9);
  EXPECT_NEAR((*figure.panels[1].y_range)[0], -0.5 * 1.05, 1e-9);
  EXPECT_NE(figure.caption.find(" 1 of them, less certain"), std::string::npos) << figure.caption;
  EXPECT_NEAR(find(figure, "residual")->y[1], 100.0, 1e-6) << "it stays in the numbers";
}

TEST(Figures, ASpikeDoesNotSetTheAxisOfTheResidualsAndIsNamed) {
  ChannelPrediction c = channel(1000);
  for (std::size_t k = 0; k < c.t.size(); ++k) {
    c.measured[k] = c.predicted[k] + (k % 2 == 0 ? 0.5 : -0.5) * degree;
    c.sigma[k] = 0.4 * degree;
  }
  EXPECT_TRUE(motion_figure("filter_error", c, std::nullopt).notes.empty());
  c.measured[10] = c.predicted[10] + 2.0 * degree;
  c.measured[500] = c.predicted[500] - 30.0 * degree;
  const Figure figure = motion_figure("filter_error", c, std::nullopt);
  ASSERT_TRUE(figure.panels[1].y_range);
  EXPECT_NEAR((*figure.panels[1].y_range)[1], 2.0 * 0.5 * 1.05, 1e-9);
  ASSERT_EQ(figure.notes.size(), 1U);
  EXPECT_TRUE(figure.notes[0].starts_with("Residuals lie beyond the axis, the largest, -30 deg, at ")) << figure.notes[0];
  EXPECT_TRUE(figure.notes[0].ends_with(" s"));
}

TEST(Figures, ResidualIsMeasuredMinusPredictedInDegrees) {
  ChannelPrediction c = channel(3);
  c.measured = {0.2 + degree, nan, 0.2};
  c.held_out = {false, false, true};
  const Figure figure = motion_figure("output_error", c, std::nullopt);
  const Series* residual = find(figure, "residual");
  ASSERT_NE(residual, nullptr);
  EXPECT_NEAR(residual->y[0], 1.0, 1e-9);
  EXPECT_TRUE(std::isnan(residual->y[1]));
  const Series* held_out = find(figure, "measured_held_out");
  ASSERT_NE(held_out, nullptr);
  EXPECT_TRUE(std::isnan(held_out->y[0]));
  EXPECT_NEAR(held_out->y[2], 0.2 / degree, 1e-9);
}

TEST(Figures, AZoomHoldsOnlyItsInterval) {
  const ChannelPrediction c = channel(1000);
  const Figure figure = motion_figure("output_error", c, Interval{5.0, 6.0});
  EXPECT_EQ(find(figure, "measured")->x.size(), 51U);
  EXPECT_NE(figure.name, motion_figure("output_error", c, std::nullopt).name);
}

TEST(Figures, TheTypicalIntervalAvoidsGaps) {
  ChannelPrediction c = channel(3000);  // 60 s; the search starts at 18.3 s
  for (std::size_t i = 900; i < 1300; ++i) c.measured[i] = nan;
  const Interval part = typical_interval(c.t, c.measured, 5.0);
  EXPECT_NEAR(part.to - part.from, 5.0, 1e-12);
  EXPECT_GE(part.from, 25.9);
  const Interval all = typical_interval({0.0, 1.0}, {0.0, 0.0}, 5.0);
  EXPECT_EQ(all.to, 1.0);
}

/// Counted in samples: of a house that is read every ten minutes five seconds have none.
TEST(Figures, ThePartThatIsDrawnByItselfHasSoManySamplesHoweverSlowTheRecording) {
  const std::vector<double> values(1000, 1.0);
  for (const double step : {1e-3, 600.0}) {
    std::vector<double> t;
    for (std::size_t i = 0; i < values.size(); ++i) t.push_back(step * static_cast<double>(i));
    const auto part = part_to_draw(t, values, 300);
    ASSERT_TRUE(part) << step;
    EXPECT_NEAR((part->to - part->from) / step, 300.0, 1e-6);
    EXPECT_FALSE(part_to_draw(t, values, 500)) << "hardly shorter than the whole";
  }
}

/// Measured 0 throughout; predicted 32 samples ahead with the error `worst` in the middle fifth, and 1 elsewhere.
Fit predicting_ahead(const std::string& name, double worst, const std::string& other = "") {
  Fit fit;
  fit.method = "filter_error";
  for (const std::string& channel : {name, other}) {
    if (channel.empty()) continue;
    ChannelPrediction c{"flight", channel, "m", {}, {}, {}, {}, {}};
    for (std::size_t k = 0; k < 2000; ++k) {
      c.t.push_back(0.1 * static_cast<double>(k));
      c.measured.push_back(0.0);
      c.predicted.push_back(0.0);
      c.sigma.push_back(1.0);
      c.held_out.push_back(false);
      c.ahead.push_back(k < 32 ? nan : channel == name && k >= 800 && k < 1200 ? worst : 1.0);
    }
    fit.predictions.push_back(std::move(c));
  }
  return fit;
}

TEST(Figures, WhatIsPredictedFarAheadIsShownWhereItsErrorsFallMost) {
  const auto figure = change_ahead_figure(predicting_ahead("x", 5.0, "y"), predicting_ahead("x", 1.0, "y"), "lag");
  ASSERT_TRUE(figure.has_value());
  EXPECT_EQ(figure->panels.front().y_label, "x");
  const Series* before = find(*figure, "before");
  const Series* after = find(*figure, "after");
  ASSERT_TRUE(before != nullptr && after != nullptr);
  EXPECT_EQ(before->x.size(), 400U);
  EXPECT_NEAR(before->x.front(), 80.0, 1e-9);
  EXPECT_THAT(before->y, testing::Each(5.0));
  EXPECT_THAT(after->y, testing::Each(1.0));
  EXPECT_EQ(after->legend, "with lag");
}

TEST(Figures, ErrorsFarAheadThatHardlyFallAreNoPicture) {
  EXPECT_FALSE(change_ahead_figure(predicting_ahead("x", 1.1), predicting_ahead("x", 1.0), "lag").has_value());
  EXPECT_FALSE(change_ahead_figure(predicting_ahead("x", 1.0), predicting_ahead("x", 5.0), "lag").has_value()) << "they grow";
  EXPECT_FALSE(change_ahead_figure(predicting_ahead("x", 5.0), predicting_ahead("z", 1.0), "lag").has_value()) << "another channel";
}

TEST(Figures, WhiteResidualsStayInTheBandAndAnAlternatingOneDoesNot) {
  ChannelPrediction c = channel(4000);
  const Figure white = autocorrelation_figure("output_error", c, 60);
  const double limit = find(white, "white")->hi[0];
  EXPECT_NEAR(limit, 1.96 / std::sqrt(4000.0), 1e-12);
  int outside = 0;
  for (const double r : find(white, "residual")->y) outside += std::abs(r) > limit ? 1 : 0;
  EXPECT_LE(outside, 9);  // 3 expected of 60
  for (std::size_t i = 0; i < c.t.size(); ++i) c.measured[i] = 0.2 + (i % 2 == 0 ? 0.01 : -0.01);
  const Figure alternating = autocorrelation_figure("output_error", c, 4);
  EXPECT_NEAR(find(alternating, "residual")->y[0], -3999.0 / 4000.0, 1e-9);  // 1/n before the sum of n − lag products
  EXPECT_NEAR(find(alternating, "residual")->y[1], 3998.0 / 4000.0, 1e-9);
}

TEST(Figures, ResidualHistogramIsTheDensityOfTheEstimationPartInSigmas) {
  ChannelPrediction c{"flight", "P_z", "px", {}, {}, {}, {}, {}};
  const std::vector<double> sigmas = {0.1, 0.1, -0.1, -4.9, 7.0, nan, 0.1};  // the last is held out
  for (std::size_t i = 0; i < sigmas.size(); ++i) {
    c.t.push_back(static_cast<double>(i));
    c.predicted.push_back(10.0);
    c.sigma.push_back(2.0);
    c.measured.push_back(10.0 + 2.0 * sigmas[i]);
    c.held_out.push_back(i + 1 == sigmas.size());
  }
  const Figure figure = residual_histogram_figure("filter_error", c);
  const Series& boxes = *find(figure, "residual");
  const double each = 1.0 / (0.25 * 5.0);  // bins of 0.25, five residuals
  std::map<double, double> filled;         // lower edge → density
  for (std::size_t k = 0; k < boxes.y.size(); ++k) {
    if (boxes.y[k] > 0.0) filled[boxes.lo[k]] = boxes.y[k] / each;
  }
  EXPECT_THAT(filled, testing::ElementsAre(testing::Pair(-5.0, testing::DoubleNear(1.0, 1e-12)),
                                           testing::Pair(-0.25, testing::DoubleNear(1.0, 1e-12)),
                                           testing::Pair(0.0, testing::DoubleNear(2.0, 1e-12))));
  EXPECT_THAT(figure.notes, testing::ElementsAre("1 of 5 residuals are beyond ± 5 sigma"));
  const Series& normal = *find(figure, "normal");
  EXPECT_NEAR(*std::max_element(normal.y.begin(), normal.y.end()), 0.398942, 1e-6);
}

TEST(Figures, HistogramCountsEveryFiniteSampleOnce) {
  Attitude a;
  a.alpha_T = {0.2 * degree, 0.7 * degree, 0.8 * degree, nan, 3.1 * degree};
  const Figure figure = histogram_figure("flight", a);
  const Series* s = find(figure, "samples");
  EXPECT_EQ(s->y, (std::vector<double>{1.0, 2.0, 0.0, 0.0, 0.0, 0.0, 1.0}));
  EXPECT_DOUBLE_EQ(s->lo[6], 3.0);
}

TEST(Figures, TheClockAngleIsNotDrawnAcrossItsJump) {
  Attitude a;
  a.t = {0.0, 1.0, 2.0, 3.0};
  a.alpha_T = {0.1, 0.1, 0.1, 0.1};
  a.phi = {170 * degree, 179 * degree, -179 * degree, -170 * degree};
  const Series* phi = nullptr;
  const Figure figure = history_figure("flight", a);
  phi = find(figure, "phi");
  ASSERT_NE(phi, nullptr);
  EXPECT_TRUE(std::isnan(phi->y[2]));
  EXPECT_NEAR(phi->y[3], -170.0, 1e-9);
}

TEST(Figures, OutliersOfTheCalibrationAreSetApart) {
  Calibration c;
  c.residuals = {{1, 'z', 0.1, 10.0, 9.0, true}, {2, 'z', 0.1, 30.0, 9.0, false}};
  const Figure figure = calibration_residual_figure(c);
  ASSERT_EQ(figure.panels.size(), 1U);
  EXPECT_EQ(find(figure, "residual_1z")->y, (std::vector<double>{1.0}));
  EXPECT_TRUE(find(figure, "residual_2z")->y.empty());
  EXPECT_EQ(find(figure, "outliers_z")->y, (std::vector<double>{21.0}));
}

}  // namespace
}  // namespace misfit::report
