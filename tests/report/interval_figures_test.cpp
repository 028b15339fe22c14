#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "misfit/core/files.h"
#include "misfit/report/figures_intervals.h"
#include "misfit/report/report.h"
#include "tests/core/temporary_folder.h"

namespace misfit::report {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

Bootstrap bootstrap() {
  Bootstrap b{"output_error", "residuals in blocks on the predicted motion", 55, 200, 2, 1, {{"failed: no state", 2}}, {}, {}, {}};
  BootstrapCurve c{"C_m", "alpha_T", "rad", "-", {}, {}, {}, {}, {}, {}, {}, {}};
  for (int i = 0; i <= 60; ++i) {
    const double x = (9.0 + 0.1 * i) * degree, value = -0.36 * (x - 12.0 * degree),
                 sigma = 2e-4 + 1e-3 * std::pow((x - 12.0 * degree) / 0.05, 2);
    c.x.push_back(x);
    c.value.push_back(value);
    c.fit_sigma.push_back(sigma);
    c.mean.push_back(value + 1e-4);
    c.sigma.push_back(1.1 * sigma);
    c.lower.push_back(value - 2.2 * sigma);
    c.upper.push_back(value + 2.1 * sigma);
    c.count.push_back(i < 3 || i > 57 ? 0.0 : 10.0);
  }
  b.curves.push_back(std::move(c));
  return b;
}

LikelihoodProfile profile() {
  LikelihoodProfile p;
  p.method = "output_error";
  p.parameter = "wake_phi";
  p.unit = "rad";
  p.best = -1.5;
  p.sigma = 0.1;
  p.plain_sigma = 0.05;
  p.scale = 4.0;
  for (int i = -5; i <= 6; ++i) {
    const double z = 0.5 * i;
    p.value.push_back(p.best + 0.1 * z);
    p.drop.push_back(4.0 * z * z * (1.0 + 0.1 * z));
  }
  p.lower = -1.71;
  p.upper = -1.32;
  p.lower_found = p.upper_found = true;
  p.words = {"autocorrelated residuals: drops are multiplied by 0.25"};
  return p;
}

TEST(IntervalFigures, ABootstrapIsDrawnWhereTheCurveIsVisited) {
  const Figure figure = bootstrap_figure("C_m", {bootstrap()});
  const Series& band = figure.panels.front().series.front();
  EXPECT_EQ(band.style, Style::band);
  EXPECT_TRUE(std::isnan(band.lo[1]));
  EXPECT_TRUE(std::isfinite(band.lo[30]));
  EXPECT_NEAR(band.x[30], 12.0, 1e-9);
  EXPECT_NE(figure.notes.front().find("2 gave no fit"), std::string::npos);
}

TEST(IntervalFigures, AProfileIsDrawnOverItsScaleInDegrees) {
  const Figure figure = profile_figure(profile());
  const Series& line = figure.panels.front().series.front();
  EXPECT_NEAR(line.x[5], -1.5 / degree, 1e-9);
  EXPECT_NEAR(line.y[0], 6.25 * 0.75, 1e-9);
  EXPECT_EQ(figure.x_unit, "deg");
}

MultiStart starts() {
  return {"output_error",
          6,
          1,
          3,
          {{"failed: no state", 1}},
          {-12.0, 0.0, 0.1, 3.0, 25000.0},
          2,
          2,
          1,
          {{"wake_phi", "rad", -1.5, 0.1, -1.2}},
          {"the fit is not at the global maximum"}};
}

TEST(IntervalFigures, StartsThatEndElsewhereStandApart) {
  const Figure figure = starts_figure(starts());
  const Panel& panel = figure.panels.front();
  ASSERT_EQ(panel.series.size(), 2U);
  EXPECT_EQ(panel.series[0].x, (std::vector<double>{2.0, 3.0}));
  EXPECT_EQ(panel.series[1].x, (std::vector<double>{1.0, 4.0, 5.0}));
  EXPECT_LT(panel.series[1].y[0], 0.0) << "higher than the fit";
  EXPECT_NEAR(panel.series[1].y[2], std::log10(25001.0), 1e-12);
  const TemporaryFolder folder;
  EXPECT_NE(read_file(write_figure(folder.path(), figure)).find("<svg"), std::string::npos);
}

TEST(IntervalFigures, AreWrittenWithTheirData) {
  const TemporaryFolder folder;
  const std::vector<std::string> files = write_interval_figures(folder.path(), {{bootstrap()}, {profile()}, {}});
  ASSERT_EQ(files.size(), 6U);
  for (const auto& file : files) {
    const char* what = file.ends_with(".svg") ? "<svg" : file.ends_with(".gp") ? "plot" : "[deg]";
    EXPECT_NE(read_file(folder.path() / file).find(what), std::string::npos) << file;
  }
}

TEST(IntervalsInTheReport, EndsOfIntervalsHaveNoSigmaAndWhatFailedIsNamed) {
  const TemporaryFolder folder;
  ReportInput input;
  input.resampling.emplace(Resampling{{bootstrap()}, {profile()}, {"sliding_bin is not resampled"}, {starts()}});
  Resampling& r = *input.resampling;
  r.bootstraps[0].numbers = {{"trim", "rad", 12.0 * degree, 0.1 * degree, 12.01 * degree, 0.2 * degree, 11.6 * degree, 12.4 * degree, 198}};
  r.bootstraps[0].notes = {"blocks are cut"};
  r.profiles[0].upper_found = false;
  const std::string page = read_file(write_report(folder.path(), input));
  expect_parts(page,
               {"Bootstrap, profile likelihood and random starts", "12.00\u00a0±\u00a00.10\u00a0deg", "12.01\u00a0±\u00a00.20\u00a0deg",
                ">11.60", ">12.40", "not reached", "blocks are cut", "output_error: 2 of 200 runs gave no result: failed: no state",
                "sliding_bin is not resampled", "Block bootstrap: C_m", "Profile likelihood: wake_phi", "Random starts: output_error",
                "runs gave no result: failed: no state", "not at the global maximum"});
  EXPECT_EQ(page.find("11.60\u00a0±"), std::string::npos);
}

}  // namespace
}  // namespace misfit::report
