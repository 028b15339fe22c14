#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "misfit/report/figure_batch.h"
#include "misfit/report/figures_uncertainty.h"
#include "tests/core/temporary_folder.h"

namespace misfit::report {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

Uncertainty example() {
  Uncertainty u;
  u.method = "sliding_bin";
  u.runs = 10;
  SpreadNumber trim;
  trim.name = "trim";
  trim.unit = "rad";
  trim.mean = 2.0 * degree;
  trim.sigma = 0.1 * degree;
  trim.shares = {{"R", 0.9, 0.01, 0.1}, {"K", 0.08, 0.01, 0.1}};
  trim.rest = 0.02;
  SpreadNumber slope = trim;
  slope.name = "slope of C_m";
  slope.unit = "1/rad";
  u.numbers = {trim, slope};
  u.curves = {{"C_m",
               "alpha_T",
               "rad",
               "-",
               {degree, 2.0 * degree, 3.0 * degree},
               {0.2, 0.0, -0.2},
               {0.21, 0.0, -0.5},
               {0.01, 0.02, 5.0},
               {10.0, 10.0, 2.0},
               true,
               "",
               true}};
  return u;
}

const Series& series(const Figure& figure, const std::string& key) {
  for (const Series& s : figure.panels.front().series) {
    if (s.key == key) return s;
  }
  throw std::runtime_error("no series " + key);
}

TEST(SpreadFigure, ShowsTheBandTheNominalFitAndTheTrim) {
  const Uncertainty u = example();
  const Figure figure = spread_figure(u.curves[0], u, {});
  EXPECT_EQ(figure.name, "uncertainty_C_m");
  EXPECT_EQ(figure.x_unit, "deg");
  EXPECT_NEAR(series(figure, "band").lo[0], 0.18, 1e-12);
  EXPECT_NEAR(series(figure, "band").hi[1], 0.06, 1e-12);
  EXPECT_NEAR(series(figure, "trim").lo[0], 1.7, 1e-9);
  EXPECT_EQ(series(figure, "nominal").y, u.curves[0].nominal);
  // The place that only two of ten runs reach is pale, and does not set the scale.
  EXPECT_TRUE(std::isfinite(series(figure, "band_few").lo[2]));
  EXPECT_LT((*figure.panels.front().y_range)[1], 1.0);
}

TEST(SpreadFigure, TheTrimStandsOnWhicheverCurveHasIt) {
  Uncertainty u = example();
  u.curves[0].name = "righting_lever";
  u.curves[0].of = "heel";
  u.numbers[1].name = "slope of righting_lever";
  u.curves.push_back(u.curves[0]);
  u.curves[1].of = "pitch";
  u.curves[1].trimmed = false;
  EXPECT_EQ(spread_figure(u.curves[0], u, {}).name, "uncertainty_righting_lever");
  EXPECT_NEAR(series(spread_figure(u.curves[0], u, {}), "trim").lo[0], 1.7, 1e-9);
  EXPECT_EQ(spread_figure(u.curves[1], u, {}).name, "uncertainty_righting_lever_pitch");
  EXPECT_THROW((void)series(spread_figure(u.curves[1], u, {}), "trim"), std::runtime_error);
  EXPECT_EQ(shares_figure(u).panels.size(), 2U) << "the trim and the slope of its curve";
}

TEST(SharesFigure, HasTheTrimAndTheSlopeSideBySide) {
  const Figure figure = shares_figure(example());
  ASSERT_EQ(figure.panels.size(), 2U);
  EXPECT_TRUE(figure.panels[1].beside);
  EXPECT_EQ(figure.panels[0].y_marks.size(), 3U);
  EXPECT_NEAR(figure.panels[0].series[0].x[0], 90.0, 1e-9);
  EXPECT_NEAR(figure.panels[0].series[0].x[2], 2.0, 1e-9);
}

TEST(UncertaintyFigures, AreDrawn) {
  const TemporaryFolder folder;
  const auto names = write_uncertainty_figures(folder.path(), example(), {});
  EXPECT_EQ(names.size(), 6U);
  for (const auto& name : names) EXPECT_GT(std::filesystem::file_size(folder.path() / name), 100U) << name;
}

TEST(BatchFigure, ShowsEveryNumberWithItsMeanTheTrimFirst) {
  Batch batch;
  for (int k = 0; k < 3; ++k) {
    BatchRow row;
    row.study = "test" + std::to_string(k);
    row.method = "m";
    row.values["a"] = {1.0 + k, 0.5, "kg"};
    if (k != 1) row.values["trim"] = {(10.0 + k) * degree, 0.5 * degree, "rad"};
    batch.rows.push_back(row);
  }
  BatchSummary a, trim;
  a.method = trim.method = "m";
  a.name = "a";
  a.unit = "kg";
  trim.name = "trim";
  trim.unit = "rad";
  trim.mean = 11.0 * degree;
  batch.summary = {a, trim};
  const Figure figure = batch_figure(batch, "m");
  ASSERT_EQ(figure.panels.size(), 2U);
  EXPECT_EQ(figure.panels[0].series[0].x, (std::vector<double>{1.0, 3.0}));
  EXPECT_NEAR(figure.panels[0].series[0].y[1], 12.0, 1e-9);
  EXPECT_NEAR(figure.panels[0].series[0].lo[1], 11.5, 1e-9);
  EXPECT_EQ(figure.x_marks.size(), 3U);
}

}  // namespace
}  // namespace misfit::report
