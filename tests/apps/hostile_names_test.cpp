// Names that nobody should give: every result has a file of its own in the run folder, and resolved.toml says them back.
#include <algorithm>
#include <set>

#include "misfit/core/config.h"
#include "misfit/core/toml_text.h"
#include "tests/apps/program.h"

namespace {

using namespace program;
using misfit::toml_string;
using misfit::config::Section;

constexpr const char* model =
    "[system]\ndoc = \"first order\"\n[states]\nx = { unit = \"V\" }\n[inputs]\nu = { unit = \"V\", hold = \"zero_order\" }\n[parameters]\n"
    "a = { unit = \"1/s\", value = 0.5, bounds = [0.0, 100.0], free = true, doc = DOC }\n[equations]\nx = \"a*(u - x)\"\n"
    "[outputs]\ny = { unit = \"V\", formula = \"x\", noise = 0.01 }\n";

std::string steps() {
  std::string text = "t[s],u[V],y[V]\n";
  double x = 0.5;
  for (int k = 0; k < 120; ++k) {
    const double u = k / 20 % 2;
    text += std::to_string(0.1 * k) + "," + std::to_string(u) + "," + std::to_string(x + 0.01 * (k * 7 % 5 - 2)) + "\n";
    x += 0.1 * (u - x);
  }
  return text;
}

class Study {
 public:
  Study(const std::string& name, const std::vector<std::string>& experiments, const std::string& more = "") {
    std::string doc = model;
    doc.replace(doc.find("DOC"), 3, toml_string(name));
    folder_.write("m.toml", doc);
    folder_.write("d.csv", steps());
    std::string text = "[study]\nname = " + toml_string(name) + "\nquestion = " + toml_string(name) +
                       "\nmethods = [\"output_error\"]\n[system]\nfile = \"m.toml\"\n";
    for (const auto& experiment : experiments) text += "[[experiment]]\nname = " + toml_string(experiment) + "\ndata = \"d.csv\"\n";
    folder_.write("study.toml", text + more);
  }
  [[nodiscard]] Outcome run(const std::string& verb) const { return program::run({verb, (folder_.path() / "study.toml").string()}); }
  [[nodiscard]] fs::path out(const std::string& file) const { return folder_.path() / "out" / file; }
  [[nodiscard]] fs::path path() const { return folder_.path(); }

 private:
  TemporaryFolder folder_;
};

TEST(ExperimentsWithNamesThatDifferInOddLettersOnly, HaveFilesOfTheirOwn) {
  const std::vector<std::string> names{"试验一", "试验二", "a b", "a_b", "a.b"};
  const Study study("names", names);
  const Outcome outcome = study.run("run");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  std::set<std::string> motions, predictions;
  for (const auto& entry : fs::directory_iterator(study.out("figures"))) {
    const std::string file = entry.path().filename().string();
    if (file.starts_with("motion_") && file.ends_with("_y.svg")) motions.insert(file);
  }
  for (const auto& entry : fs::directory_iterator(study.out("fit/output_error"))) {
    if (entry.path().extension() == ".csv") predictions.insert(entry.path().filename().string());
  }
  EXPECT_EQ(motions.size(), names.size());
  EXPECT_EQ(predictions.size(), names.size());
  EXPECT_TRUE(motions.contains("motion_output_error_a_b_y.svg")) << "a name that needs no change";
  EXPECT_TRUE(predictions.contains("prediction_a_b.csv"));
  const std::string page = content(study.out("report.html"));
  for (const auto& file : motions) EXPECT_NE(page.find("figures/" + file.substr(0, file.size() - 4) + ".svg"), std::string::npos) << file;
}

class OddName : public testing::TestWithParam<std::string> {};

/// Experiments' names are parts of file names: no control characters, at most 150 bytes (data/study_experiment.cpp).
bool may_name_an_experiment(const std::string& name) {
  const auto control = [](unsigned char c) { return c < 0x20U || c == 0x7FU; };
  return name.size() < 150 && std::none_of(name.begin(), name.end(), control);
}

TEST_P(OddName, StandsInResolvedAsItIsAndNowhereElse) {
  const std::string effect = toml_string("k" + GetParam());
  const std::string experiment = may_name_an_experiment(GetParam()) ? "e" + GetParam() : "e";
  const Study study(
      GetParam(), {experiment},
      "[effects]\n" + effect +
          " = { formula = \"-c*x*abs(x)\", port = \"dx/dt\", parameters = { c = { unit = \"1/V/s\", value = 0.01, bounds = [-1, "
          "1], free = false } } }\n");
  const Outcome outcome = study.run("fit");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const Section resolved = Section::load(study.out("resolved.toml"));
  EXPECT_EQ(resolved.table("study")->text("name"), GetParam());
  EXPECT_EQ(resolved.table("study")->text("question"), GetParam());
  ASSERT_EQ(resolved.tables("experiment").size(), 1U);
  EXPECT_EQ(resolved.tables("experiment").front().text("name"), experiment);
  EXPECT_EQ(resolved.table("effects")->keys(), std::vector<std::string>{"k" + GetParam()});
  EXPECT_EQ(resolved.table("parameters")->keys(), (std::vector<std::string>{"a", "c"}));
  for (const std::string& key : resolved.keys())
    EXPECT_TRUE((std::set<std::string>{"study", "system", "experiment", "effects", "parameters", "curves"}).contains(key)) << key;
  const Outcome again = program::run({"fit", study.out("resolved.toml").string(), "--out", (study.path() / "again").string()});
  EXPECT_EQ(again.status, 0) << again.err;
}

INSTANTIATE_TEST_SUITE_P(Each, OddName,
                         testing::Values("a\nb", "\n[effects]\nx = {}\n", "\" }\n[q]\n", "a\x1b[31m", "a\x7f", "'''", "\"\"\"", "# x",
                                         "a\tb\r", "\xE2\x80\xA8", std::string(300, 'n'), "试验", "{}%s%n", "x = 1"),
                         [](const auto& i) { return std::to_string(i.index); });

}  // namespace
