#include "misfit/report/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "misfit/core/files.h"
#include "misfit/report/page.h"
#include "tests/core/temporary_folder.h"
#include "tests/report/html_faults.h"

namespace misfit::report {
namespace {

using testing::HasSubstr;

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

Verdict example_verdict() {
  Verdict verdict;
  verdict.kind = VerdictKind::effect_added;
  verdict.sentence = "drag was missing <b>";
  ErrorChange error;
  error.of = "w, 32 samples ahead";
  error.before = {8.0, 0.0, "V"};
  error.after = Estimate{1.2, 0.0, "V"};
  verdict.errors = {error};
  verdict.next = "misfit discover configs/motor";
  return verdict;
}

TEST(Report, ThePageNeedsNothingFromElsewhere) {
  const TemporaryFolder folder;
  const std::string page = read_file(write_report(folder.path(), example()));
  for (const char* outside : {"http:", "https:", "src=", "@import", "<link", "<script", "url(h"})
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
  for (std::size_t at = page.find("href="); at != std::string::npos; at = page.find("href=", at + 1)) {
    const bool within = page[at + 6] == '#', figure = page.compare(at + 6, 8, "figures/") == 0;
    EXPECT_TRUE(within || figure) << page.substr(at, 40);
  }
}

TEST(Report, ScriptsStandBehindTheDocumentAndMayAskNobody) {
  const TemporaryFolder folder;
  ReportInput input = example();
  input.explorer = [](std::size_t room) { return room > 7'000'000 ? "<script>go()</script>\n" : ""; };
  const std::string page = read_file(write_report(folder.path(), input));
  EXPECT_THAT(page, HasSubstr("</main>\n<script>go()</script>\n</body>"));
  EXPECT_THAT(page, HasSubstr("<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none';"));
  EXPECT_EQ(html_faults(page), std::vector<std::string>{});
}

TEST(InlineSvg, HasDotsOfOneKindInOnePath) {
  const auto dot = [](const std::string& place, const std::string& colour) {
    return "\t<use xlink:href='#gpPt6' transform='translate(" + place + ") scale(1.36)' color='rgb(" + colour + ")'/>\n";
  };
  const std::string defined =
      "<circle id='gpPt5' stroke-width='0.184' cx='0' cy='0' r='1'/><use xlink:href='#gpPt5' id='gpPt6' "
      "fill='currentColor' stroke='none'/>";
  const std::string black = "  0,   0,   0", red = "213,  94,   0";
  const std::string dots = dot("1.00,2.50", black) + dot("3.00,4.00", black) + dot("5.00,6.00", red) + "<g/>" + dot("7.00,8.00", red);
  const std::string with = inline_svg("<svg viewBox=\"0 0 9 9\">" + defined + dots + "</svg>", "f", "dots");
  EXPECT_THAT(with, HasSubstr("stroke=\"rgb(0,0,0)\" stroke-width=\"2.72\" stroke-linecap=\"round\" d=\"M1.00,2.50h0M3.00,4.00h0\"/>"));
  EXPECT_THAT(with, HasSubstr("stroke=\"rgb(213,94,0)\" stroke-width=\"2.72\" stroke-linecap=\"round\" d=\"M5.00,6.00h0\"/>\n<g/>"));
  EXPECT_THAT(with, HasSubstr("d=\"M7.00,8.00h0\"/>"));
  EXPECT_THAT(inline_svg("<svg viewBox=\"0 0 9 9\">" + dots + "</svg>", "f", "dots"), HasSubstr("translate(1.00,2.50)"))
      << "of another gnuplot";
}

TEST(Report, LinksToFiguresLeadToFilesThatAreThere) {
  const TemporaryFolder folder;
  const std::string page = read_file(write_report(folder.path(), example()));
  std::size_t links = 0;
  for (std::size_t at = page.find("href=\"figures/"); at != std::string::npos; at = page.find("href=\"figures/", at + 1), ++links) {
    const std::string file = page.substr(at + 6, page.find('"', at + 6) - at - 6);
    EXPECT_TRUE(std::filesystem::exists(folder.path() / file)) << file;
  }
  EXPECT_GE(links, 9U);
}

TEST(Report, IsValidHtml) {
  const TemporaryFolder folder;
  ReportInput input = example();
  input.verdict = example_verdict();
  EXPECT_EQ(html_faults(read_file(write_report(folder.path(), input))), std::vector<std::string>{});
}

TEST(Report, TheVerdictAndItsPictureComeFirstAndWhatFollowsIsFolded) {
  const TemporaryFolder folder;
  ReportInput input = example();
  input.verdict = example_verdict();
  const std::string page = read_file(write_report(folder.path(), input));
  const auto place = [&](const char* text) {
    EXPECT_NE(page.find(text), std::string::npos) << text;
    return page.find(text);
  };
  EXPECT_LT(place("drag was missing"), place("8\u00a0V to 1.2\u00a0V (−85\u00a0%)"));
  EXPECT_LT(place("misfit discover configs/motor"), place("<figure>"));
  EXPECT_LT(place("<figure>"), place("<h2>Results</h2>"));
  EXPECT_LT(place("<h2>Curves</h2>"), place("<details><summary><h2>"));
  for (const char* folded : {"Predicted motion and residuals", "Parameters", "Provenance"})
    EXPECT_NE(page.find(std::string("<details><summary><h2>") + folded), std::string::npos) << folded;
  const std::string drawn = "id=\"motion_filter_error_flight_P_y-gnuplot_canvas\"";
  EXPECT_EQ(page.find(drawn), page.rfind(drawn)) << "nothing is drawn twice";
}

TEST(Report, OfALadderTheLastRungIsOpenTheOthersCanBeChosenAndTheWordsAreExplained) {
  const TemporaryFolder folder;
  ReportInput input = example();
  Rung first, second;
  first.system = "motor";
  first.rms = {{"w", {0.30, 0.0, "V"}}};
  first.force = {{"dw/dt", {20.0, 1.0, "V/s"}}};
  second = first;
  second.id = 1;
  second.parent = 0;
  second.added = "coulomb_friction";
  second.actual_drop = 50.0;
  second.parameters = {{"friction", {5.0, 0.5, "V/s"}}};
  second.force = {{"dw/dt", {5.0, 0.4, "V/s"}}};
  input.ladder = Ladder{{first, second}};
  const std::string page = read_file(write_report(folder.path(), input));
  EXPECT_EQ(html_faults(page), std::vector<std::string>{});
  const std::size_t last = page.find("name=\"rung\" open><summary>Rung 1: coulomb_friction added");
  const std::size_t study = page.find("name=\"rung\"><summary>Rung 0: motor, the study");
  ASSERT_NE(last, std::string::npos);
  ASSERT_NE(study, std::string::npos);
  EXPECT_LT(last, study);
  const std::string shown = page.substr(last, study - last);
  for (const char* part :
       {"friction = 5.00\u00a0±\u00a00.50\u00a0V/s", "20.0\u00a0±\u00a01.0\u00a0V/s", "−75.0\u00a0%", "Drop: none predicted, 50.0 actual"})
    EXPECT_NE(shown.find(part), std::string::npos) << part << "\n" << shown;
  EXPECT_NE(page.find("<td>held-out gain</td>"), std::string::npos);
}

TEST(Report, ResultsOfTheLastModelComeBeforeThoseOfTheStudysOwn) {
  const TemporaryFolder folder;
  ReportInput input = example();
  Rung added;
  added.id = 1;
  added.parent = 0;
  added.added = "strut_wake";
  input.ladder = Ladder{{Rung{}, added}};
  LastModel last{1, "strut_wake", {input.fits[0]}, {}};
  last.fits[0].parameters = {{"R_cp", {3.27, 0.01, "m"}}};
  input.last_model = last;
  const std::string page = read_file(write_report(folder.path(), input));
  EXPECT_EQ(html_faults(page), std::vector<std::string>{});
  for (const char* section : {"Results", "Curves", "Predicted motion and residuals", "Parameters"}) {
    const std::size_t of_last = page.find(section + std::string(": rung 1, strut_wake added</h2>"));
    const std::size_t of_study = page.find(section + std::string(": the study&#39;s own model (rung 0)</h2>"));
    ASSERT_NE(of_last, std::string::npos) << section;
    ASSERT_NE(of_study, std::string::npos) << section;
    EXPECT_LT(of_last, of_study) << section;
  }
  EXPECT_LT(page.find("3.27"), page.find("3.15")) << "R_cp of the last model, then of the study's";
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "figures/rung_01_curve_C_m.svg"));
}

TEST(Report, PagesOnPaperHaveNumbersTheStudyAndTheDate) {
  const TemporaryFolder folder;
  ReportInput input = example();
  input.run.date = "2026-11-22";
  const std::string page = read_file(write_report(folder.path(), input));
  expect_parts(page, {"counter(page)", "2026-11-22", "@page"});
  const std::string style = page.substr(0, page.find("</style>"));
  EXPECT_EQ(style.find("<canopy>"), std::string::npos) << "a name cannot end the style sheet";
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
       {"12.00\u00a0±\u00a00.20", "4.6 sigma", "declined", "the motion is driven; filter_error can work on it", "scales with m_a"}) {
    EXPECT_LT(page.find(text), first_figure) << text;
  }
  expect_parts(page, {"3.150\u00a0±\u00a00.020", "12 samples lost", "abc1234", "0123456789abcdef", "track.csv", "misfit run study.toml"});
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
  expect_parts(page, {"<h1>Report</h1>", "No notes on the data", "Provenance"});
  EXPECT_EQ(page.find("<figure>"), std::string::npos);
}

TEST(Report, WhatWasDoneToTheRowsOfARecordingIsADataNoteOnce) {
  const TemporaryFolder folder;
  ReportInput input = example();
  input.experiments.clear();
  for (Fit& fit : input.fits) fit.facts["data: part_1"] = "3 rows without time dropped; channel y: 2 isolated outliers rejected";
  const std::string page = read_file(write_report(folder.path(), input));
  const std::string note = "<li>part_1: 3 rows without time dropped; channel y: 2 isolated outliers rejected</li>";
  EXPECT_NE(page.find(note), std::string::npos);
  EXPECT_EQ(page.find(note), page.rfind(note)) << "two methods, one recording";
  EXPECT_EQ(page.find("No notes on the data"), std::string::npos);
}

TEST(Report, CommandsAndNamesOfFilesStandLetterByLetter) {
  const TemporaryFolder folder;
  ReportInput input = example();
  input.verdict = example_verdict();
  input.verdict->next = "misfit add study drag --at incidence=alpha_T";
  input.run.command = "misfit run study.toml --set C_m=2^3";
  input.run.hashes = {{"alpha_T.csv", "0123456789abcdef"}};
  expect_parts(read_file(write_report(folder.path(), input)), {"next: misfit add study drag --at incidence=alpha_T</p>",
                                                               "<td>misfit run study.toml --set C_m=2^3</td>", "<td>alpha_T.csv</td>"});
}

TEST(Page, ColumnsOfNumbersAreAlignedToTheRight) {
  Page page("title");
  Blocks blocks;
  blocks.heading("Results");
  blocks.table({columns("method|trim|why"), {{"one", "12.0 ± 0.1 deg", "3 reasons"}, {"two", "–", "none"}}});
  page.show(blocks);
  expect_parts(page.text(), {"<th scope=\"col\" class=\"number\">trim</th>", "<td class=\"number\">12.0\u00a0±\u00a00.1\u00a0deg</td>",
                             "<td>3 reasons</td>", "<td>one</td>"});
}

TEST(Page, AListInALineUnfolds) {
  Blocks blocks;
  blocks.list({{"one: p = 0.5", "two: p = 0.6"}, Tone::plain, {}, "2 others: not significant"});
  Page page("study");
  page.show(blocks);
  expect_parts(page.text(),
               {"<details class=\"inner\"><summary>2 others: not significant</summary><div>\n<ul>\n<li>one: p\u00a0=\u00a00.5</li>"});
  EXPECT_EQ(as_text(blocks), "  2 others: not significant\n");
}

TEST(Page, ATableIsFittedToPaperByItsLongestWords) {
  Page page("study");
  page.table({columns("name|value"), {{"a name of five words", "12.0 ± 0.1 deg"}}});
  expect_parts(page.text(), {"<table style=\"--letters: 23\">"});  // "words" and the value in one piece: 5 + 14, and 2 beside each
  EXPECT_EQ(page.text().find("th, td { overflow-wrap"), std::string::npos);
}

TEST(Page, WhatAFigureShowsIsSaidWithAxesRangesAndNames) {
  Figure figure;
  figure.title = "Missing moment against rate";
  figure.x_label = "rate", figure.x_unit = "deg/s";
  Panel panel{"moment", "N m", {}, std::nullopt, 0.0, 230.0, true, {}};
  panel.series = {{"a", "before (p = 1e-19)", Style::line, black, {-80.0, 80.0}, {-17.0, 14.0}, {}, {}}};
  figure.panels = {panel};
  EXPECT_EQ(alt_text(figure),
            "Missing moment against rate; moment in N m: -17 to 14; over rate in deg/s: -80 to 80. Drawn: before (p = 1e-19).");
}

TEST(Page, OfAFigureOfNamesTheNamesAreSaid) {
  Figure figure;
  figure.title = "What could be missing";
  figure.x_label = "drop";
  Panel names{"", "", {}, std::nullopt, 0.0, 230.0, false, {{2.0, "friction"}, {1.0, "drag"}}}, beside;
  names.series = {{"a", "", Style::bars, black, {0.0, 80.0}, {1.0, 2.0}, {0.8, 1.8}, {1.2, 2.2}}};
  beside.series = {{"p", "", Style::bars, black, {1.0, 3.0}, {1.0, 2.0}, {0.8, 1.8}, {1.2, 2.2}}};
  beside.beside = OwnX{"evidence", {0.0, 4.0}};
  figure.panels = {names, beside};
  EXPECT_EQ(alt_text(figure), "What could be missing; friction, drag; over drop: 0 to 80; beside it evidence: 1 to 3.");
}

TEST(HtmlFaults, AreFound) {
  const auto page = [](const std::string& body) {
    return "<!DOCTYPE html>\n<html lang=\"en\"><head><title>t</title></head><body>" + body + "</body></html>";
  };
  EXPECT_TRUE(html_faults(page("<p>one &amp; two</p><img alt=\"x\" src=\"y\">")).empty());
  for (const char* body : {"<p>one", "<p>one</div>", "<p><div></div></p>", "a & b", "<i id=\"a\"></i><i id=\"a\"></i>",
                           "<a href=\"#none\">x</a>", "<th>x</th>", "<p class=x>y</p>", "<img src=\"y\">", "<svg></svg>"})
    EXPECT_FALSE(html_faults(page(body)).empty()) << body;
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
