#include "misfit/report/report.h"

#include <gtest/gtest.h>

#include <numbers>

#include "misfit/core/files.h"
#include "misfit/report/page.h"
#include "tests/core/temporary_folder.h"

namespace misfit::report {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

ReportInput example() {
  ReportInput input;
  input.study = "free <canopy> & \"friends\"";
  input.question = "Where does it trim? <script>alert(1)</script>";
  Fit fit;
  fit.method = "filter_error";
  fit.status = FitStatus::converged;
  fit.message = "a tolerance was met";
  fit.warnings = {"C_m scales with m_a"};
  fit.trim = Estimate{12.0 * degree, 0.2 * degree, "rad"};
  fit.parameters = {{"R_cp", {3.15, 0.02, "m"}}, {"C_m[0]", {1.0, 0.1, "-"}}};
  fit.curves = {{"C_m", "alpha_T", "rad", "-", {0.0, 0.1, 0.2}, {0.0, 0.01, 0.0}, {0.001, 0.001, 0.001}, {1.0, 2.0, 3.0}, true, ""}};
  fit.predictions = {{"flight", "P_y", "px", {0.0, 0.1, 0.2}, {1.0, 2.0, 3.0}, {1.1, 2.1, 2.9}, {0.5, 0.5, 0.5}, {false, false, false}}};
  Fit declined;
  declined.method = "output_error";
  declined.status = FitStatus::declined;
  declined.message = "the motion is driven; filter_error can work on it";
  input.fits = {fit, declined};
  input.experiments = {{"flight", Track{}, std::nullopt, "", std::nullopt}};
  input.experiments[0].track->notes = {"12 samples lost"};
  TrimDifference trim;
  trim.reference = true;
  trim.sentence = "the trim of filter_error is 1.90 ± 0.40 deg below that of static_test (4.6 sigma)";
  input.comparison.emplace().trims.push_back(trim);
  input.run = {"0.1.0", "abc1234", "misfit run study.toml", 7, {{"track.csv", "0123456789abcdef"}}, {{"fit", 2.5}}};
  return input;
}

TEST(Report, ThePageNeedsNothingFromElsewhere) {
  const TemporaryFolder folder;
  const std::string page = read_file(write_report(folder.path(), example()));
  for (const char* outside : {"http:", "https:", "src=", "@import", "<link", "<script", "url(h"})
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
  for (std::size_t at = page.find("href="); at != std::string::npos; at = page.find("href=", at + 1)) {
    EXPECT_EQ(page[at + 6], '#') << page.substr(at, 40);
  }
}

TEST(Report, TextsAreEscaped) {
  const TemporaryFolder folder;
  const std::string page = read_file(write_report(folder.path(), example()));
  EXPECT_NE(page.find("free &lt;canopy&gt; &amp; &quot;friends&quot;"), std::string::npos);
  EXPECT_NE(page.find("&lt;script&gt;alert(1)"), std::string::npos);
  EXPECT_EQ(page.find("<canopy>"), std::string::npos);
}

TEST(Report, SummaryComesFirstWithFindingsStatusAndWarnings) {
  const TemporaryFolder folder;
  const std::string page = read_file(write_report(folder.path(), example()));
  const std::size_t first_figure = page.find("<figure>");
  for (const char* text :
       {"12.00 ± 0.20", "4.6 sigma", "declined", "the motion is driven; filter_error can work on it", "scales with m_a"}) {
    EXPECT_LT(page.find(text), first_figure) << text;
  }
  expect_parts(page, {"3.150 ± 0.020", "12 samples lost", "abc1234", "0123456789abcdef", "track.csv", "misfit run study.toml"});
  EXPECT_EQ(page.find("C_m[0]"), std::string::npos);  // curve coefficients are not for reading
}

TEST(Report, EveryFigureIsOnThePageAndOnDisk) {
  const TemporaryFolder folder;
  const std::string page = read_file(write_report(folder.path(), example()));
  for (const char* name : {"curve_C_m", "motion_filter_error_flight_P_y", "autocorrelation_filter_error_flight_P_y"}) {
    for (const char* suffix : {".svg", ".csv", ".gp"})
      EXPECT_TRUE(std::filesystem::exists(folder.path() / "figures" / (std::string(name) + suffix)));
    EXPECT_NE(page.find("id=\"" + std::string(name) + "-gnuplot_canvas\""), std::string::npos) << name;
  }
}

TEST(Report, AnEmptyStudyStillGivesAPage) {
  const TemporaryFolder folder;
  const std::string page = read_file(write_report(folder.path(), {}));
  expect_parts(page, {"<h1>Report</h1>", "No sample was dropped or rejected", "Provenance"});
  EXPECT_EQ(page.find("<figure>"), std::string::npos);
}

TEST(Page, IdsOfDrawingsAreKeptApart) {
  const std::string svg =
      "<?xml version=\"1.0\"?>\n<svg width=\"9\" height=\"5\" viewBox=\"0 0 9 5\" xmlns=\"http://www.w3.org/2000/svg\">"
      "<title>T</title><circle id='dot'/><use xlink:href='#dot'/><g filter=\"url(#f)\" id=\"g1\"/></svg>";
  EXPECT_EQ(inline_svg(svg, "one", "a < b"),
            "<svg viewBox=\"0 0 9 5\" style=\"max-width:9px\" role=\"img\" aria-label=\"a &lt; b\"><circle id='one-dot'/><use "
            "xlink:href='#one-dot'/>"
            "<g filter=\"url(#one-f)\" id=\"one-g1\"/></svg>");
}

}  // namespace
}  // namespace misfit::report
