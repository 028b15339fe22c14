#include "misfit/report/figure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>

#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "misfit/core/table.h"
#include "misfit/report/symbols.h"
#include "tests/core/temporary_folder.h"

namespace misfit::report {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Figure figure_of(Series series) {
  Figure figure;
  figure.name = "test";
  figure.title = "C_m of run_7";
  figure.x_label = "alpha_T";
  figure.x_unit = "deg";
  figure.panels = {{"C_m", "-", {std::move(series)}, std::nullopt, 0.0, 200.0, false}};
  return figure;
}

Series line(std::vector<double> y) {
  Series s{"model", "the model", Style::line, palette(0), {}, std::move(y), {}, {}};
  for (std::size_t i = 0; i < s.y.size(); ++i) s.x.push_back(static_cast<double>(i));
  return s;
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t found = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++found;
  return found;
}

/// The paths of the first series of a drawing.
std::string first_series(const std::string& svg) {
  const std::size_t begin = svg.find("gnuplot_plot_1");
  return svg.substr(begin, svg.find("gnuplot_plot_2", begin) - begin);
}

/// The path of the lone panel's data line: those of colour 0 (0072B2) with more than the two points of a legend's sample.
std::size_t pieces_of_line(const std::string& svg) {
  std::size_t pieces = 0;
  const std::string part = first_series(svg);
  for (std::size_t at = part.find(" d='M"); at != std::string::npos; at = part.find(" d='M", at + 1)) {
    const std::string path = part.substr(at, part.find('\'', at + 4) - at);
    pieces += count(path, "M");
  }
  return pieces;
}

class NoPath {
 public:
  NoPath() : before_(std::getenv("PATH")) { ::setenv("PATH", "", 1); }
  ~NoPath() { ::setenv("PATH", before_.c_str(), 1); }

 private:
  std::string before_;
};

TEST(Figure, WritesDrawingNumbersAndAScriptThatDrawsItAgain) {
  const TemporaryFolder folder;
  const auto path = write_figure(folder.path(), figure_of(line({1.0, 2.0, 1.5})));
  const std::string svg = read_file(path);
  EXPECT_NE(svg.find("</svg>"), std::string::npos);
  EXPECT_EQ(folder.entries(), 3U);
  std::filesystem::remove(path);
  ASSERT_EQ(std::system(("cd '" + folder.path().string() + "' && gnuplot test.gp").c_str()), 0);
  EXPECT_EQ(read_file(path), svg);
}

TEST(Figure, CsvHoldsEveryNumberWithUnits) {
  const TemporaryFolder folder;
  Figure figure = figure_of(line(std::vector<double>(7000, 0.25)));
  figure.panels[0].series.push_back({"model", "", Style::band, palette(0), {1.0, 2.0}, {}, {0.0, 0.1}, {0.2, 0.3}});
  write_figure(folder.path(), figure);
  const Table table = read_csv(folder.path() / "test.csv");
  EXPECT_EQ(table.rows(), 7000U);
  ASSERT_EQ(table.columns.size(), 5U);
  EXPECT_EQ(table.columns[0].header(), "model.x[deg]");
  EXPECT_EQ(table.columns[1].header(), "model.y[-]");
  EXPECT_EQ(table.columns[3].header(), "model_2.lo[-]");
  EXPECT_TRUE(std::isnan(table.columns[3].values[2]));
  EXPECT_NE(read_file(folder.path() / "test.gp").find("every 2 with lines"), std::string::npos);
}

TEST(Figure, AMissingValueBreaksTheLine) {
  const TemporaryFolder folder;
  const std::string whole = read_file(write_figure(folder.path(), figure_of(line({1.0, 2.0, 1.5, 2.5, 1.0}))));
  const std::string broken = read_file(write_figure(folder.path(), figure_of(line({1.0, 2.0, nan, 2.5, 1.0}))));
  EXPECT_EQ(pieces_of_line(broken), pieces_of_line(whole) + 1);
}

TEST(Figure, EmptySeriesSayNoData) {
  const TemporaryFolder folder;
  EXPECT_NE(read_file(write_figure(folder.path(), figure_of(line({})))).find("no data"), std::string::npos);
  EXPECT_NE(read_file(write_figure(folder.path(), figure_of(line({nan, nan})))).find("no data"), std::string::npos);
  Figure figure = figure_of(line({1.0, 2.0}));
  EXPECT_EQ(read_file(write_figure(folder.path(), figure)).find("no data"), std::string::npos);
  figure.panels[0].series.push_back({"lost", "lost one", Style::points, palette(1), {nan}, {1.0}, {}, {}});
  EXPECT_NE(read_file(write_figure(folder.path(), figure)).find("lost one (no data)"), std::string::npos);
  figure.panels.clear();
  EXPECT_NO_THROW(write_figure(folder.path(), figure));
}

TEST(Figure, EveryStyleDraws) {
  const TemporaryFolder folder;
  Figure figure = figure_of(line({1.0, 2.0}));
  for (const Style style : {Style::dashed, Style::dotted, Style::points, Style::markers, Style::error_bars, Style::x_bars, Style::band,
                            Style::pale_band, Style::steps, Style::boxes}) {
    Series s{"s", "s", style, palette(3), {1.0, 2.0}, {1.0, 1.5}, {0.5, 1.0}, {1.5, 2.5}};
    figure.panels.push_back({"y", "m/s^2", {s}, std::nullopt, 0.0, 60.0, true});
  }
  EXPECT_NO_THROW(write_figure(folder.path(), figure));
}

TEST(Figure, TextsOfTheUserCannotBreakTheScript) {
  const TemporaryFolder folder;
  Figure figure = figure_of(line({1.0, 2.0}));
  figure.title = "it's 100 % {odd} @ ~x \\n & <b>";
  figure.panels[0].series[0].legend = "'; system('false') #";
  figure.notes = {"two\nlines", "ends in \\"};
  EXPECT_NE(read_file(write_figure(folder.path(), figure)).find("system("), std::string::npos);
}

TEST(Figure, AFolderWithQuotesAndBlanksIsDrawnInto) {
  const TemporaryFolder folder;
  EXPECT_TRUE(std::filesystem::exists(write_figure(folder.path() / "it's a folder", figure_of(line({1.0, 2.0})))));
}

TEST(Figure, WithoutGnuplotTheErrorSaysSo) {
  const TemporaryFolder folder;
  const NoPath guard;
  expect_parts(message_of<RunError>([&] { write_figure(folder.path(), figure_of(line({1.0}))); }), {"gnuplot is not installed"});
}

TEST(Figure, WhatGnuplotSaysIsInTheError) {
  const TemporaryFolder folder;
  Figure figure = figure_of(line({1.0, 2.0}));
  figure.panels[0].series[0].colour = "no such colour";
  expect_parts(message_of<RunError>([&] { write_figure(folder.path(), figure); }), {"gnuplot failed", "test.gp", "color"});
  EXPECT_EQ(folder.entries(), 2U);  // numbers and script stay, no half drawing
}

TEST(Figure, BadNamesAndLengthsAreRefused) {
  const TemporaryFolder folder;
  Figure figure = figure_of(line({1.0, 2.0}));
  figure.name = "../x";
  EXPECT_THROW(write_figure(folder.path(), figure), InputError);
  figure.name = "x";
  figure.panels[0].series[0].y.pop_back();
  expect_parts(message_of<InputError>([&] { write_figure(folder.path(), figure); }), {"'x'", "'model'", "y and x differ"});
}

TEST(Symbols, KnownWordsAreTypesetAndOthersEscaped) {
  EXPECT_EQ(html_text("C_m of alpha_T < 3"), "C<sub>m</sub> of α<sub>T</sub> &lt; 3");
  EXPECT_EQ(html_text("my_C_m alphabet"), "my_C_m alphabet");
  EXPECT_EQ(html_text("V^0.5/s and x^2."), "V<sup>0.5</sup>/s and x<sup>2</sup>.");
  EXPECT_EQ(html_text("m/s^2 and kg^-1 and a^b"), "m/s<sup>2</sup> and kg<sup>-1</sup> and a^b");
  EXPECT_EQ(gnuplot_text("C_m run_7"), "C_{m}\u200b run\\_7");
  EXPECT_EQ(gnuplot_text("it's {x}"), "it’s \\{x\\}");
}

}  // namespace
}  // namespace misfit::report
