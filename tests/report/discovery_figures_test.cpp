// Figures and sections of what the model lacks: ladder, diagnosis, candidates.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "misfit/core/files.h"
#include "misfit/core/table.h"
#include "misfit/report/figures_discovery.h"
#include "misfit/report/gnuplot_script.h"
#include "misfit/report/report.h"
#include "tests/core/temporary_folder.h"

namespace misfit::report {
namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

const Series* find(const Figure& figure, const std::string& key) {
  for (const Panel& panel : figure.panels) {
    for (const Series& s : panel.series) {
      if (s.key == key) return &s;
    }
  }
  return nullptr;
}

Rung rung(int id, const std::string& added, double force) {
  Rung r;
  r.id = id;
  r.parent = id - 1;
  r.added = added;
  r.system = "parachute_spherical";
  r.force = {{"correlation_time", {0.1, 0.01, "s"}}, {"moment_y", {force, 0.5, "N m"}}, {"moment_z", {force, 0.5, "N m"}}};
  r.rms = {{"P_y", {1.80 - 0.02 * id, 0.0, "px"}}, {"P_z", {1.85 - 0.02 * id, 0.0, "px"}}};
  r.k_step = {{"P_y", {1.8, 2.5, 5.0, 11.0, 20.0, 33.0 - id}}, {"P_z", {1.85, 2.6, 5.1, 11.5, 21.0, 36.0 - id}}};
  r.trim = Estimate{(12.3 - 0.2 * id) * degree, 0.2 * degree, "rad"};
  return r;
}

Ladder ladder() {
  Rung planar = rung(0, "", 35.0);
  planar.system = "parachute_planar";
  planar.force = {{"pitching_moment", {35.0, 0.8, "N m"}}};
  planar.rms = {{"eta", {0.1 * degree, 0.0, "rad"}}};
  planar.k_step = {{"eta", {0.1 * degree, 0.2 * degree, 0.5 * degree, 1.1 * degree, 2.0 * degree, 3.0 * degree}}};
  Rung wake = rung(2, "strut_wake", 26.9);
  wake.predicted_drop = 275.0;
  wake.actual_drop = 290.0;
  wake.parameters = {{"wake_phi", {-1.57, 0.02, "rad"}}};
  return {{planar, rung(1, "system:parachute_spherical", 31.0), wake}};
}

ForceMap map() {
  ForceMap m{"pitching_moment", "N m", "phi", "rad", {}, {}, {}, {}, 120.0, 12, 1e-19, 3e-18, "the in-plane moment is 41 ± 6 N m too high"};
  for (int i = -6; i <= 6; ++i) {
    m.x.push_back(30.0 * i * degree);
    m.amplitude.push_back(i == -3 ? 41.0 : 2.0 * std::sin(i));
    m.sigma.push_back(i == 5 ? nan : 6.0);
    m.count.push_back(200.0 + 10.0 * i);
  }
  return m;
}

PairMap pair() {
  PairMap m{"lateral_moment", "N m", "alpha_T", "rad", "phi", "rad", {}, {}, {}, {}, 80.0, 30, 1e-5, 1e-3};
  for (int i = 0; i < 6; ++i) m.x.push_back((8.0 + 2.0 * i) * degree);
  for (int j = -4; j <= 4; ++j) m.y.push_back(40.0 * j * degree);
  for (int i = 0; i < 6; ++i) {
    for (int j = -4; j <= 4; ++j) {
      m.amplitude.push_back(i == 5 && j == 4 ? nan : 10.0 * std::sin(j) * i);
      m.sigma.push_back(i == 5 && j == 4 ? nan : 8.0);
    }
  }
  return m;
}

std::vector<WhitenessReport> whiteness() {
  std::vector<WhitenessReport> out;
  for (const char* channel : {"P_y", "P_z"}) {
    WhitenessReport w;
    w.experiment = "flight";
    w.channel = channel;
    w.band = 0.03;
    for (int lag = 0; lag < 50; ++lag) w.autocorrelation.push_back(lag == 0 ? 1.0 : 0.02 * std::sin(7.0 * lag));
    for (int k = 1; k <= 300; ++k) {
      w.frequency.push_back(0.1 * k);
      w.power.push_back(k == 37 && out.empty() ? 60.0 : 1.0 + 0.3 * std::sin(k));
    }
    out.push_back(w);
  }
  return out;
}

MissingForce missing() {
  MissingForce m;
  m.experiment = "flight";
  m.ports = {"moment_y", "moment_z"};
  m.port_units = {"N m", "N m"};
  m.quantities = {"phi"};
  m.quantity_units = {"rad"};
  m.force.resize(2);
  m.sigma.resize(2);
  m.values.resize(1);
  for (int i = 0; i < 1500; ++i) {
    m.t.push_back(0.0167 * i);
    m.force[0].push_back(30.0 * std::sin(0.11 * i));
    m.force[1].push_back(20.0 * std::cos(0.07 * i));
    m.sigma[0].push_back(9.0);
    m.sigma[1].push_back(9.0);
    m.values[0].push_back(std::remainder(0.03 * i, 2.0 * std::numbers::pi));
  }
  return m;
}

std::vector<Candidate> candidates() {
  std::vector<Candidate> out(3);
  out[0].effect = "strut_wake";
  out[0].predicted_drop = 275.0;
  out[0].actual_drop = 290.0;
  out[0].accepted = true;
  out[1].effect = "unknown:pitching_moment(phi)";
  out[1].predicted_drop = 180.0;
  out[1].actual_drop = 170.0;
  out[2].effect = "coulomb_friction";
  out[2].predicted_drop = 3.0;
  for (std::size_t k = 0; k < out.size(); ++k) out[k].rank = static_cast<int>(k) + 1;
  return out;
}

TEST(LadderFigure, ForceStandsWithItsSigmaAndTheTrimWithNinetyFivePercent) {
  const Figure figure = ladder_figure(ladder());
  const Series* force = find(figure, "force");
  ASSERT_NE(force, nullptr);
  EXPECT_EQ(force->y, (std::vector<double>{35.0, 31.0, 26.9}));
  EXPECT_EQ(force->style, Style::error_bars);
  EXPECT_NEAR(force->hi[0] - force->y[0], 0.8, 1e-12);
  const Series* trim = find(figure, "trim");
  ASSERT_NE(trim, nullptr);
  EXPECT_NEAR(trim->hi[1] - trim->y[1], 1.96 * 0.2, 1e-9);
  ASSERT_EQ(figure.x_marks.size(), 3U);
  EXPECT_EQ(figure.x_marks[1].text, "+ parachute_spherical");
  EXPECT_EQ(figure.x_marks[2].text, "+ strut_wake");
}

TEST(LadderFigure, ChannelsOfOneSystemKeepTheirUnits) {
  Ladder one = ladder();
  one.rungs.erase(one.rungs.begin());
  const Figure figure = ladder_figure(one);
  std::vector<std::string> units;
  for (const Panel& panel : figure.panels) units.push_back(panel.y_unit);
  EXPECT_EQ(units, (std::vector<std::string>{"", "N m", "px", "px", "deg"}));
  EXPECT_EQ(find(figure, "P_y_RMS__one_sample_ahead")->y, (std::vector<double>{1.78, 1.76}));
}

TEST(LadderFigure, RandomForcesOfDifferentUnitsHaveAPanelEach) {
  Ladder one = ladder();
  for (Rung& r : one.rungs) r.force["drag"] = {10.0 - r.id, 0.1, "N"};
  const Figure figure = ladder_figure(one);
  std::vector<std::string> labels;
  for (const Panel& panel : figure.panels) labels.push_back(panel.y_label);
  EXPECT_EQ(labels[1], "random force on drag");
  EXPECT_EQ(labels[2], "random force on pitching_moment");
  EXPECT_EQ(figure.panels[1].series[0].y, (std::vector<double>{10.0, 9.0, 8.0}));
  EXPECT_EQ(figure.panels[2].series[0].y, (std::vector<double>{35.0, 31.0, 26.9}));
}

TEST(LadderFigure, ASmallChangeIsSeenAndDoesNotLookLarge) {
  Ladder one = ladder();
  one.rungs.erase(one.rungs.begin());
  Figure figure = ladder_figure(one);
  const auto range_of = [&](std::size_t panel) { return figure.panels[panel].y_range.value_or(std::array<double, 2>{}); };
  EXPECT_EQ(range_of(0)[0], 0.0) << "drops are bars: from 0";
  const auto [low, high] = range_of(2);
  EXPECT_GT(low, 1.5) << "1.78 px and 1.76 px: about them";
  EXPECT_GT(high - low, 0.178) << "at least a tenth of the value high";
  EXPECT_LT(high - low, 0.25);
  one.rungs.back().rms.at("P_y").value = 0.4;
  figure = ladder_figure(one);
  EXPECT_EQ(range_of(2)[0], 0.0) << "to a fraction: from 0";
}

TEST(LadderFigure, ChannelsOfDifferentSystemsAreDrawnOverTheirFirstValue) {
  const Figure figure = ladder_figure(ladder());
  std::vector<std::string> units;
  for (const Panel& panel : figure.panels) units.push_back(panel.y_unit);
  EXPECT_EQ(units, (std::vector<std::string>{"", "N m", "% of first", "% of first", "deg"}));
  EXPECT_EQ(find(figure, "eta_RMS__8_samples_ahead")->y, std::vector<double>{100.0});
  EXPECT_NEAR(find(figure, "P_y_RMS__one_sample_ahead")->y.at(1), 100.0 * 1.76 / 1.78, 1e-9);
}

TEST(LadderFigure, DropsStandSideBySideWhereThereAreAny) {
  const Figure figure = ladder_figure(ladder());
  EXPECT_EQ(find(figure, "predicted_drop")->y, std::vector<double>{275.0});
  EXPECT_EQ(find(figure, "actual_drop")->y, std::vector<double>{290.0});
  EXPECT_LT(find(figure, "predicted_drop")->hi[0], find(figure, "actual_drop")->lo[0] + 1e-9);
}

TEST(MapFigure, AmplitudesHaveBarsOfOneSigmaInTheUnitsPeopleRead) {
  const Figure figure = map_figure(map());
  const Series* amplitude = find(figure, "amplitude");
  ASSERT_NE(amplitude, nullptr);
  EXPECT_NEAR(amplitude->x[3], -90.0, 1e-9);
  EXPECT_EQ(amplitude->y[3], 41.0);
  EXPECT_NEAR(amplitude->hi[3] - amplitude->lo[3], 12.0, 1e-9);
  EXPECT_TRUE(figure.panels[0].zero_line);
  EXPECT_NE(figure.caption.find("41 ± 6 N m too high"), std::string::npos);
}

TEST(PairFigure, LeavesOutCellsWithTooFewSamplesAndShowsSigmas) {
  const Figure figure = pair_figure(pair());
  const Series* cells = find(figure, "force");
  ASSERT_NE(cells, nullptr);
  EXPECT_EQ(cells->x.size(), 53U);
  EXPECT_NEAR(cells->z[9 + 5], 10.0 * std::sin(1) / 8.0, 1e-12);
}

TEST(PairFigure, ItsColoursEndAtAWholeNumberOfSigmasThreeAtLeast) {
  Figure figure = pair_figure(pair());
  Series& cells = figure.panels.front().series.front();
  for (double& z : cells.z) z = std::clamp(z, -0.7, 0.7);
  EXPECT_EQ(colour_limit(figure), 3.0);
  EXPECT_NE(gnuplot_script(figure).find("set cbrange [-3:3]"), std::string::npos);
  cells.z.front() = -4.2;
  EXPECT_EQ(colour_limit(figure), 5.0);
  EXPECT_EQ(colour_limit(map_figure({})), 0.0);
}

TEST(PeriodogramFigure, RunsFromNothingToOneAndJumpsAtALine) {
  const Figure figure = periodogram_figure(whiteness());
  const Series* line = find(figure, "flight_P_y");
  ASSERT_NE(line, nullptr);
  EXPECT_NEAR(line->y.back(), 1.0, 1e-12);
  EXPECT_GT(line->y[36] - line->y[35], 0.1);
  EXPECT_LT(line->y[35] - line->y[34], 0.01);
}

TEST(CandidatesFigure, TheBestIsOnTopAndTheAcceptedHasAColourOfItsOwn) {
  const Figure figure = candidates_figure(candidates());
  EXPECT_EQ(figure.panels[0].y_marks.front().text, "strut_wake");
  EXPECT_GT(figure.panels[0].y_marks.front().at, figure.panels[0].y_marks.back().at);
  const Series* accepted = find(figure, "accepted");
  ASSERT_NE(accepted, nullptr);
  EXPECT_EQ(accepted->x, std::vector<double>{290.0});
  EXPECT_EQ(find(figure, "actual")->x, std::vector<double>{170.0});
  EXPECT_EQ(find(figure, "predicted")->x.size(), 3U);
  EXPECT_EQ(candidates_figure(candidates(), 2).notes.size(), 1U);
}

TEST(CandidatesFigure, ProbabilitiesStandBesideTheDropsWithTheThreshold) {
  std::vector<Candidate> list = candidates();
  list[0].p_value = 0.0;
  list[1].p_value = 1e-4;
  const Figure figure = candidates_figure(list);
  ASSERT_EQ(figure.panels.size(), 2U);
  EXPECT_TRUE(figure.panels[1].beside.has_value());
  EXPECT_EQ(find(figure, "minus_log10_p")->x, (std::vector<double>{20.0, 4.0, 0.0}));
  EXPECT_EQ(find(figure, "threshold")->x, (std::vector<double>{2.0, 2.0}));
  EXPECT_EQ(figure.notes.size(), 1U) << "says that the longest bar is cut";
}

/// Of strut_wake, on the second port alone, from the second sample on.
std::vector<AddedForce> added() {
  AddedForce out{"flight", missing().t, {"moment_z"}, {"N m"}, {missing().force[1]}};
  out.t.erase(out.t.begin());
  out.force[0].erase(out.force[0].begin());
  return {out};
}

TEST(MissingForceFigure, HasWhatACandidateAddsOnItsPort) {
  Candidate wake = candidates()[0];
  wake.added = added();
  const Figure figure = added_force_figure(missing(), wake, std::nullopt);
  EXPECT_EQ(figure.name, "added_missing_force_flight");
  ASSERT_EQ(figure.panels.size(), 2U);
  EXPECT_EQ(figure.panels[0].series.size(), 2U);
  ASSERT_EQ(figure.panels[1].series.size(), 3U);
  const Series& line = figure.panels[1].series[2];
  EXPECT_EQ(line.legend, "strut_wake");
  EXPECT_EQ(line.x, wake.added[0].t);
  EXPECT_EQ(line.y, wake.added[0].force[0]);
  const Figure part = added_force_figure(missing(), wake, Interval{5.0, 6.0});
  const Series& cut = part.panels[1].series[2];
  EXPECT_GE(cut.x.front(), 5.0);
  EXPECT_LE(cut.x.back(), 6.0);
  EXPECT_EQ(cut.x.size(), cut.y.size());
  EXPECT_EQ(part.panels[1].series[1].x, cut.x);
}

TEST(MissingForceFigure, OfACandidateThatAddsNoneIsItself) {
  const Figure figure = added_force_figure(missing(), candidates()[2], std::nullopt);
  for (const Panel& panel : figure.panels) EXPECT_EQ(panel.series.size(), 2U);
}

ReportInput example() {
  ReportInput input;
  input.study = "study";
  input.ladder = ladder();
  Diagnosis d;
  d.method = "filter_error";
  d.sentences = {"it fails in the wake"};
  d.maps = {map()};
  d.pairs = {pair()};
  d.whiteness = whiteness();
  d.nis = {{"flight", {0.0, 1.0, 2.0}, {1.0, 1.1, 1.4}, 0.8, 1.2, 0.33}};
  d.missing = {missing()};
  input.diagnosis = d;
  Discovery found;
  found.candidates = candidates();
  found.candidates[0].added = added();
  found.verdict = "add strut_wake";
  found.tried = {"14 effects"};
  input.discovery = found;
  return input;
}

TEST(DiscoveryReport, TheLadderIsTheFirstPictureAndEveryFigureIsDrawn) {
  const TemporaryFolder folder;
  const std::string page = read_file(write_report(folder.path(), example()));
  EXPECT_EQ(page.find("id=\"ladder-gnuplot_canvas\""), page.find("-gnuplot_canvas\"") - std::string("id=\"ladder").size());
  for (const char* name : {"ladder", "map_pitching_moment_by_phi", "map_lateral_moment_by_alpha_T_and_phi", "innovations_autocorrelation",
                           "innovations_periodogram", "nis_flight", "missing_force_flight", "missing_force_flight_zoom",
                           "missing_force_flight_by_phi", "candidates", "added_missing_force_flight_zoom"}) {
    for (const char* suffix : {".svg", ".csv", ".gp"})
      EXPECT_TRUE(std::filesystem::exists(folder.path() / "figures" / (std::string(name) + suffix))) << name << suffix;
  }
  expect_parts(page, {"It fails in the wake.", "Add strut_wake.", "14 effects", "26.90\u00a0±\u00a00.50"});
}

TEST(DiscoveryReport, CellsAndBarsAreInTheTableWithUnits) {
  const TemporaryFolder folder;
  static_cast<void>(write_figure(folder.path(), pair_figure(pair())));
  const std::string text = read_file(folder.path() / "map_lateral_moment_by_alpha_T_and_phi.csv");
  EXPECT_EQ(text.substr(0, text.find('\n')), "force.x[deg],force.y[deg],force.lo[deg],force.hi[deg],force.z[-]");
  const std::string svg = read_file(folder.path() / "map_lateral_moment_by_alpha_T_and_phi.svg");
  EXPECT_EQ(svg.find("no data"), std::string::npos);
}

TEST(DiscoveryReport, ARungsFindingsStandUnderItsName) {
  const TemporaryFolder folder;
  ReportInput input = example();
  input.rung = RungInput{2, "strut_wake", std::nullopt, input.discovery};
  input.rung->discovery->verdict = "nothing more";
  const std::string page = read_file(write_report(folder.path(), input));
  expect_parts(page, {"What could be missing: the study&#39;s own model (rung 0)", "What could be missing: rung 2, strut_wake added",
                      "Nothing more."});
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "figures/rung_02_candidates.svg"));
}

TEST(DiscoveryReport, AnEmptyDiagnosisStillGivesAPage) {
  const TemporaryFolder folder;
  ReportInput input;
  input.ladder.emplace();
  input.diagnosis.emplace();
  input.discovery.emplace();
  const std::string page = read_file(write_report(folder.path(), input));
  expect_parts(page, {"Where it fails (residuals of ", "What could be missing"});
}

}  // namespace
}  // namespace misfit::report
