// report.html as the page of `misfit open` without a server: what is put into it, and what is not.
#include "misfit/page/embedded_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>
#include <tuple>

#include "misfit/page/assets.h"
#include "misfit/page/views.h"
#include "misfit/report/unbroken.h"
#include "tests/core/temporary_folder.h"

namespace misfit::page {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

/// A study that was never run.
class Embedded : public testing::Test {
 protected:
  static constexpr const char* hostile = "</script><script>alert('x')</script>&amp;\"";

  Embedded() {
    folder.write("study.toml", std::string("[study]\nname = '") + "</script>" + "'\n");
    page.study = page.question = hostile;
    page.places = places_of(folder.path() / "study.toml", folder.path() / "out");
  }
  [[nodiscard]] json all(std::size_t most = room) const { return json::parse(embedded_answers(page, most)); }

  static constexpr std::size_t room = 1'000'000;
  TemporaryFolder folder;
  EmbeddedPage page;
};

TEST_F(Embedded, AnswersWhatThePageAsks) {
  const json answers = all()["answers"];
  for (const char* asked :
       {"state?", "where?model=0", "motion?model=0", "candidates?model=0", "curves?model=0", "study?model=0", "ladder?", "calibration?"})
    EXPECT_TRUE(answers.contains(asked)) << asked;
  EXPECT_EQ(answers["state?"]["models"].size(), 1U);
  EXPECT_EQ(answers["state?"]["job"]["state"], "none");
  EXPECT_EQ(answers["study?model=0"]["editable"], false);
}

TEST_F(Embedded, HasLongListsOnce) {
  MissingForce missing;
  missing.experiment = "e";
  for (int i = 0; i < 500; ++i) missing.t.push_back(0.125 * i);
  missing.quantities = {"a", "[\\\"b"};
  missing.quantity_units = {"m", "m"};
  missing.values = {missing.t, missing.t};
  missing.ports = {"F"};
  missing.port_units = {"N"};
  missing.force = missing.sigma = {missing.t};
  Diagnosis diagnosis;
  diagnosis.missing = {missing};
  std::filesystem::create_directories(folder.path() / "out");
  write_diagnosis(folder.path() / "out", diagnosis);
  const json all = this->all();
  for (const char* asked : {"samples?model=0&experiment=0&quantity=0", "samples?model=0&experiment=0&quantity=1"}) {
    ASSERT_TRUE(all["answers"].contains(asked));
    const json& values = all["answers"][asked]["values"];
    ASSERT_TRUE(values.contains("$")) << values;
    EXPECT_EQ(all["lists"][values["$"].get<std::size_t>()].size(), 500U);
  }
  EXPECT_EQ(all["answers"]["samples?model=0&experiment=0&quantity=0"]["values"],
            all["answers"]["samples?model=0&experiment=0&quantity=1"]["values"]);
  EXPECT_EQ(all["answers"]["where?model=0"]["force"][0]["quantities"][1]["name"], "[\\\"b") << "a bracket in a name begins no list";
}

TEST_F(Embedded, ShowsNoPathOfTheMachine) { EXPECT_THAT(embedded_answers(page, room), Not(HasSubstr(folder.path().string()))); }

TEST_F(Embedded, TakesNamesAsText) {
  const json answers = all()["answers"];
  EXPECT_EQ(answers["state?"]["study"]["name"].get<std::string>(), hostile);
  EXPECT_THAT(answers["study?model=0"]["text"].get<std::string>(), HasSubstr("</script>"));
  EXPECT_THAT(embedded_page(page, room), Not(HasSubstr("alert('x')")));
}

TEST_F(Embedded, IsLeftOutWhereItFindsNoRoomAndItsLastViewsFirst) {
  EXPECT_EQ(embedded_page(page, 100), "");
  EXPECT_LT(embedded_page(page, room).size(), room);
  json answers = all()["answers"];
  for (std::size_t most = 2000; answers.contains("calibration?"); most -= 10) answers = all(most)["answers"];
  EXPECT_TRUE(answers.contains("motion?model=0"));
  EXPECT_TRUE(answers.contains("curves?model=0"));
}

TEST_F(Embedded, KeepsTheLastModelWhereEarlierOnesFindNoRoom) {
  page.places.push_back({folder.path() / "study.toml", folder.path() / "out/rungs/01", 1, "drag"});
  const json answers = all()["answers"];
  ASSERT_TRUE(answers.contains("where?model=0") && answers.contains("where?model=1"));
  json fewer = answers;
  for (std::size_t most = 2000; fewer.contains("where?model=0"); most -= 10) fewer = all(most)["answers"];
  EXPECT_TRUE(fewer.contains("where?model=1"));
  EXPECT_TRUE(fewer.contains("motion?model=1")) << "the page opens with it";
}

TEST_F(Embedded, ListsCandidatesByTheirSignificanceThoseOfUnknownFormIncluded) {
  Discovery d;
  for (const auto& [effect, p, drop] :
       {std::tuple{"lag", 1.0, 12.0}, {"drag", 0.3, 6.0}, {"unknown:F(x)", 1e-9, 60.0}, {"friction", 1e-8, 50.0}}) {
    d.candidates.emplace_back();
    d.candidates.back().rank = static_cast<int>(d.candidates.size());
    d.candidates.back().effect = effect;
    d.candidates.back().p_value = p;
    d.candidates.back().predicted_drop = drop;
  }
  d.candidates.back().accepted = true;
  std::filesystem::create_directories(folder.path() / "out");
  write_discovery(folder.path() / "out", d);
  const json view = json::parse(candidates_view(page.places.front(), {}));
  std::vector<std::string> effects;
  for (const json& row : view["rows"]) {
    effects.push_back(row["effect"]);
    EXPECT_EQ(d.candidates[row["candidate"].get<std::size_t>()].effect, row["effect"].get<std::string>())
        << "by which its force is asked for";
  }
  EXPECT_THAT(effects, testing::ElementsAre("friction", "unknown:F(x)", "drag", "lag"));
  for (const json& block : view["blocks"]) {
    if (block["kind"] != "table") continue;
    EXPECT_EQ(block["rows"][1][1], "unknown:F(x)") << "the table is in the order of the rows";
  }
  EXPECT_EQ(view["figure"]["panels"][0]["marks"][0][1], "friction");
}

/// Of two channels alike, measured at random, with one wild residual.
Fit random_fit(int samples) {
  Fit fit;
  fit.method = "filter_error";
  fit.status = FitStatus::converged;
  ChannelPrediction c;
  c.experiment = "e";
  c.channel = "y";
  c.unit = "m";
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (int k = 0; k < samples; ++k) {
    c.t.push_back(0.001 * k);
    c.predicted.push_back(std::sin(0.01 * k) + 0.01 * normal(random));
    c.measured.push_back(k > 50'000 && k < 60'000 ? std::nan("") : c.predicted.back() + 0.1 * normal(random));
    c.sigma.push_back(0.1);
    c.held_out.push_back(k > 75'000);
  }
  c.measured[123] = c.predicted[123] + 7.0;
  fit.predictions = {c, c};
  fit.predictions[1].channel = "z";
  return fit;
}

TEST_F(Embedded, ThinsLongRecordingsAndKeepsTheirLeastAndLargest) {
  write_fit(folder.path() / "out/fit/filter_error", random_fit(100'000));
  constexpr std::size_t small = 4'000'000;
  const std::string text = embedded_page(page, small);
  EXPECT_FALSE(text.empty());
  EXPECT_LT(text.size(), small);
  const json whole = all(small);
  const json& answers = whole["answers"];
  ASSERT_TRUE(answers.contains("motion?model=0"));
  EXPECT_EQ(answers["state?"]["mostSamples"], 24'000);
  const json panels = answers["motion?model=0"]["channels"][1]["figure"]["panels"];
  const json y = panels[1]["series"][1]["y"], residual = y.contains("$") ? whole["lists"][y["$"].get<std::size_t>()] : y;
  EXPECT_GT(residual.size(), 5'000U);
  EXPECT_LT(residual.size(), 24'100U);
  double largest = 0.0;
  std::size_t gap = 0;
  for (const json& v : residual) {
    if (v.is_number()) largest = std::max(largest, v.get<double>());
    gap += v.is_null() ? 1U : 0U;
  }
  EXPECT_NEAR(largest, 7.0, 1e-6);
  EXPECT_GT(gap, 100U) << "where nothing was measured nothing is shown";
  EXPECT_EQ(all(100'000'000)["answers"]["state?"]["mostSamples"], 0) << "where all find room";
}

TEST_F(Embedded, OfShortRecordingsLeavesViewsOutAndThinsNothing) {
  constexpr int samples = 5'000;
  write_fit(folder.path() / "out/fit/filter_error", random_fit(samples));
  const std::size_t whole = embedded_answers(page, 100'000'000).size();
  const json answers = all(whole - 100)["answers"];
  ASSERT_TRUE(answers.contains("motion?model=0"));
  EXPECT_LT(answers.size(), all(100'000'000)["answers"].size()) << "something is left out";
  EXPECT_EQ(answers["state?"]["mostSamples"], 0);
  EXPECT_EQ(all(whole / 2)["answers"]["state?"]["mostSamples"], 3000) << "else there is no page";
}

TEST_F(Embedded, OpensWithWhatItsVerdictIsAbout) {
  Verdict verdict;
  verdict.sentence = "It is the camera.";
  page.verdict = &verdict;
  EXPECT_EQ(all()["answers"]["state?"]["verdict"]["opens"], "where");
  verdict.kind = VerdictKind::calibration;
  EXPECT_EQ(all()["answers"]["state?"]["verdict"]["opens"], "calibration");
}

TEST_F(Embedded, SaysNothingOfACandidateThatItsColumnOfPSays) {
  Discovery d;
  for (const char* why : {"not significant: family-wise p = 0.33", "not significant: family-wise p = 0.33, and its gain is 0.1"}) {
    d.candidates.emplace_back();
    d.candidates.back().effect = "drag";
    d.candidates.back().why = why;
  }
  std::filesystem::create_directories(folder.path() / "out");
  write_discovery(folder.path() / "out", d);
  const json rows = json::parse(candidates_view(page.places.front(), {}))["rows"];
  EXPECT_TRUE(rows[0]["why"].empty());
  EXPECT_EQ(rows[1]["why"], report::unbroken(d.candidates[1].why)) << "no line ends within p = 0.33";
}

TEST_F(Embedded, HasItsStyleSheetsInATemplateSinceTheBodyMayHaveNone) {
  const std::string text = embedded_page(page, room);
  const std::size_t begin = text.find("<template id=\"explore-styles\">"), end = text.find("</template>", begin);
  ASSERT_NE(begin, std::string::npos);
  EXPECT_GT(text.find("<style"), begin);
  EXPECT_LT(text.rfind("</style>"), end);
  EXPECT_THAT(std::string(embedded_assets().body), Not(HasSubstr("<main"))) << "the document has one";
}

TEST_F(Embedded, HasOneScriptThatImportsNothingAndFetchesNothing) {
  const std::string script(embedded_assets().script);
  for (const char* word : {"\nimport ", "\nexport ", "fetch(", "XMLHttpRequest", "</script", "https:", "http:"})
    EXPECT_THAT(script, Not(HasSubstr(word)));
  for (const char* name : {"module_uPlot", "module_dom", "module_figure", "module_server", "module_editor", "module_page"})
    EXPECT_THAT(script, HasSubstr(std::string("const ") + name + " = "));
}

}  // namespace
}  // namespace misfit::page
