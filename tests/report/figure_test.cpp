#include "misfit/report/figure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <regex>

#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "misfit/core/table.h"
#include "misfit/report/gnuplot_script.h"
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

std::vector<double> finite(std::vector<double> values) {
  std::erase_if(values, [](double v) { return !std::isfinite(v); });
  return values;
}

class NoPath {
 public:
  NoPath() : before_(std::getenv("PATH")) { ::setenv("PATH", "", 1); }
  ~NoPath() { ::setenv("PATH", before_.c_str(), 1); }

 private:
  std::string before_;
};

/// What is drawn: gnuplot names its drawings and their parts otherwise than write_figure() does, and begins with an empty group.
std::string without_titles(const std::string& svg) {
  static const std::regex titles("<title>[^<]*</title>|<desc>[^<]*</desc>|<g fill=\"none\" color=\"#FFFFFF\"[^>]*>\n</g>\n");
  return std::regex_replace(svg, titles, "");
}

TEST(Figure, WritesDrawingNumbersAndAScriptThatDrawsItAgain) {
  const TemporaryFolder folder;
  const auto path = write_figure(folder.path(), figure_of(line({1.0, 2.0, 1.5})));
  const std::string svg = read_file(path);
  EXPECT_NE(svg.find("</svg>"), std::string::npos);
  EXPECT_EQ(folder.entries(), 3U);
  std::filesystem::remove(path);
  ASSERT_EQ(std::system(("cd '" + folder.path().string() + "' && gnuplot test.gp").c_str()), 0);
  EXPECT_EQ(without_titles(read_file(path)), without_titles(svg));
}

TEST(Figure, LabelsAndNamesHaveTheirRoom) {
  Figure figure = figure_of(line({1.0, 2.0, 1.5}));
  const auto height_of_drawing = [&] {
    const std::string script = gnuplot_script(figure), before = "svg size 900,";
    const std::size_t at = script.find(before);
    return at == std::string::npos ? 0 : std::atoi(script.c_str() + at + before.size());
  };
  Panel& panel = figure.panels.front();
  panel.height = 80.0;
  panel.y_label = "short", panel.y_unit = "V";  // 10 letters with what stands between and the brackets
  const int low = height_of_drawing();
  panel.y_label = "a label that is longer than its axis";
  EXPECT_EQ(height_of_drawing() - low, 217) << "7 for each of the 31 letters more";
  panel.y_marks = {{1.0, "a name that is longer than the paper can bear beside the axes (at one of its places)"}};
  EXPECT_NE(gnuplot_script(figure).find("'a name that is longer than th…one of its places)'"), std::string::npos) << gnuplot_script(figure);
}

TEST(Figure, ADrawingIsCalledWhatItShowsAndNotByItsProgram) {
  const TemporaryFolder folder;
  Figure figure = figure_of(line({1.0, 2.0, 1.5}));
  figure.title = "Force & rate";
  figure.panels.front().series.front().legend.clear();
  const std::string svg = read_file(write_figure(folder.path(), figure));
  expect_parts(svg, {"<title>Force &amp; rate</title>", "<desc>Force &amp; rate; "});
  EXPECT_EQ(svg.find("Gnuplot"), std::string::npos);
  EXPECT_EQ(svg.find("<title>gnuplot_plot"), std::string::npos);
}

TEST(Figure, CsvHoldsEveryNumberWithUnitsAndOfALongSeriesWhatIsDrawnBesides) {
  const TemporaryFolder folder;
  Figure figure = figure_of(line(std::vector<double>(7000, 0.25)));
  figure.panels[0].series.push_back({"model", "", Style::band, palette(0), {1.0, 2.0}, {}, {0.0, 0.1}, {0.2, 0.3}});
  write_figure(folder.path(), figure);
  const Table table = read_csv(folder.path() / "test.csv");
  EXPECT_EQ(table.rows(), 7000U);
  EXPECT_EQ(finite(table.at("model.x").values).size(), 7000U);
  ASSERT_EQ(table.columns.size(), 7U);
  EXPECT_EQ(table.columns[0].header(), "model.x[deg]");
  EXPECT_EQ(table.columns[1].header(), "model.y[-]");
  EXPECT_EQ(table.columns[2].header(), "model_drawn.x[deg]");
  EXPECT_EQ(table.columns[5].header(), "model_2.lo[-]");
  EXPECT_TRUE(std::isnan(table.columns[5].values[2]));
  const std::string script = read_file(folder.path() / "test.gp");
  EXPECT_NE(script.find("using (v(3)):(v(4)) with lines"), std::string::npos) << script;
  EXPECT_NE(script.find("using (v(5)):(v(6)):(v(7)) with filledcurves"), std::string::npos) << script;
}

/// 8 Hz recorded at 1000 Hz: every 25th row of it would be a slow wave, or none.
TEST(Figure, OfALongLineTheExtremesOfEveryStretchAreDrawnAndOneMissingValueBreaksIt) {
  const TemporaryFolder folder;
  Series s = line(std::vector<double>(120'000));
  for (std::size_t k = 0; k < s.x.size(); ++k) {
    s.x[k] = 0.001 * static_cast<double>(k);
    s.y[k] = std::sin(2.0 * std::numbers::pi * 8.0 * s.x[k]);
  }
  s.y[44'444] = 3.0;
  s.y[77'777] = nan;
  write_figure(folder.path(), figure_of(s));
  const Table table = read_csv(folder.path() / "test.csv");
  const std::vector<double> x = finite(table.at("model_drawn.x").values), all = table.at("model_drawn.y").values;
  const std::vector<double> y(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(x.size()));
  EXPECT_LT(x.size(), 5100U);
  EXPECT_EQ(std::count_if(y.begin(), y.end(), [](double v) { return std::isnan(v); }), 1);
  EXPECT_EQ(std::count(y.begin(), y.end(), 3.0), 1);
  int ups = 0;
  for (std::size_t k = 1; k < y.size(); ++k) ups += y[k - 1] < 0.0 && y[k] >= 0.0 ? 1 : 0;
  EXPECT_NEAR(ups, 8 * 120, 3) << "the cycles of the recording";
  EXPECT_GE(pieces_of_line(read_file(folder.path() / "test.svg")), 2U);
}

TEST(Figure, OfManyDotsNoneIsDrawnWhereAnotherIsAndTheLonelyOneStays) {
  const TemporaryFolder folder;
  Series s = line(std::vector<double>(50'000));
  s.style = Style::points;
  for (std::size_t k = 0; k < s.y.size(); ++k) s.y[k] = std::sin(0.7 * static_cast<double>(k * k % 1013));
  s.y[31'415] = 9.0;
  write_figure(folder.path(), figure_of(s));
  const std::vector<double> y = finite(read_csv(folder.path() / "test.csv").at("model_drawn.y").values);
  EXPECT_LT(y.size(), 3001U);
  EXPECT_GT(y.size(), 1000U);
  EXPECT_EQ(std::count(y.begin(), y.end(), 9.0), 1);
}

TEST(Figure, TimesFarFromZeroAreDrawnToTheDigitsOfTheirSpan) {
  const TemporaryFolder folder;
  Series s = line({101325.01, 101325.02, 101325.03, 101325.04});
  for (std::size_t k = 0; k < s.x.size(); ++k) s.x[k] = 1.7e9 + 0.05 * static_cast<double>(k);
  const std::string svg = read_file(write_figure(folder.path(), figure_of(s)));
  const Table table = read_csv(folder.path() / "test.csv");
  for (std::size_t k = 0; k < s.x.size(); ++k) {
    EXPECT_NEAR(table.columns[0].values[k], s.x[k], 1e-6);
    EXPECT_NEAR(table.columns[1].values[k], s.y[k], 1e-6);
  }
  for (const char* tic : {">1700000000.05<", ">1700000000.1<", ">101325.015<"}) EXPECT_NE(svg.find(tic), std::string::npos) << tic;
}

TEST(Figure, LongTimesAreShownInHoursOrDaysAndStaySecondsInTheNumbers) {
  constexpr double hour = 3600.0;
  const auto script_over = [](double span) {
    Figure figure = figure_of(line({1.0, 2.0, 3.0}));
    figure.x_label = "time", figure.x_unit = std::string("s");
    figure.panels.front().series.front().x = {0.0, 0.5 * span, span};
    return gnuplot_script(figure);
  };
  EXPECT_NE(script_over(2.0 * hour).find("[s]"), std::string::npos);
  EXPECT_NE(script_over(12.0 * hour).find("[h]"), std::string::npos);
  EXPECT_NE(script_over(12.0 * hour).find("'4' 14400"), std::string::npos);
  EXPECT_NE(script_over(240.0 * hour).find("[d]"), std::string::npos);
  EXPECT_NE(script_over(240.0 * hour).find("'4' 345600"), std::string::npos);
}

/// gnuplot's own formats write 2e-6 and 2.2e-6 as 0.000002.
TEST(Figure, SmallNumbersBesideAnAxisCanBeToldApart) {
  EXPECT_NE(gnuplot_script(figure_of(line({1.4e-6, 2.0e-6, 2.8e-6}))).find("set format y '%.3g'"), std::string::npos);
  EXPECT_EQ(gnuplot_script(figure_of(line({1.4, 2.0, 2.8}))).find("set format y '%.3g'"), std::string::npos);
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
  EXPECT_EQ(html_text("m/s^2 and kg^-1 and a^b"), "m/s<sup>2</sup> and kg<sup>−1</sup> and a^b");
  EXPECT_EQ(gnuplot_text("C_m run_7"), "C_{m}\u200b run\\_7");
  EXPECT_EQ(gnuplot_text("it's {x}"), "it’s \\{x\\}");
}

}  // namespace
}  // namespace misfit::report
