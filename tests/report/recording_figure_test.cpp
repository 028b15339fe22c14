#include "misfit/report/recording_figure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace misfit::report {
namespace {

RecordingSurvey two_columns() {
  RecordingSurvey s;
  s.step = 1.0;
  s.columns.resize(3);
  s.columns[1].name = "u";
  s.columns[1].use = ColumnUse::input;
  s.columns[2].name = "angle";
  s.columns[2].use = ColumnUse::output;
  Table part;
  part.add("t", "s", {0.0, 1.0, 5.0, 6.0});
  part.add("u", "V", {0.0, 1.0, 1.0, 0.0});
  part.add("angle", "rad", {0.0, 3.14159265358979, 0.0, 0.0});
  s.parts = {part};
  s.gaps = {{1.0, 5.0}};
  return s;
}

TEST(RecordingFigure, HasAPanelPerColumnAndBreaksItsLinesAtGaps) {
  const Figure figure = recording_figure(two_columns(), 0, "swing", std::nullopt);
  ASSERT_EQ(figure.panels.size(), 2U);
  EXPECT_EQ(figure.panels[0].y_label, "u (input)");
  EXPECT_EQ(figure.panels[1].y_unit, "deg");
  const Series& angle = figure.panels[1].series.front();
  ASSERT_EQ(angle.y.size(), 5U);
  EXPECT_NEAR(angle.y[1], 180.0, 1e-9);
  EXPECT_TRUE(std::isnan(angle.y[2])) << "no line across the gap";
  ASSERT_EQ(figure.notes.size(), 1U);
  EXPECT_EQ(figure.notes.front(), "no samples from 1 s to 5 s");
}

TEST(RecordingFigure, AZoomHoldsItsPartAlone) {
  const Figure figure = recording_figure(two_columns(), 0, "swing", Interval{4.0, 6.0});
  EXPECT_EQ(figure.name, "data_swing_zoom");
  EXPECT_EQ(figure.panels[0].series.front().x.size(), 2U);
  EXPECT_TRUE(figure.notes.empty());
}

/// The gaps of the survey are those of all parts together.
TEST(RecordingFigure, GapsOfAnotherPartAreNotDrawn) {
  RecordingSurvey survey = two_columns();
  Table whole;
  whole.add("t", "s", {0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0});
  whole.add("u", "V", {0.0, 1.0, 1.0, 0.0, 1.0, 1.0, 0.0});
  survey.parts.insert(survey.parts.begin(), whole);
  const Figure figure = recording_figure(survey, 0, "swing", std::nullopt);
  EXPECT_TRUE(figure.notes.empty());
  EXPECT_EQ(figure.panels[0].series.front().x.size(), 7U);
}

}  // namespace
}  // namespace misfit::report
