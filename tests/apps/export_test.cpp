// misfit export: the estimate in the run folder, in files.
#include <gmock/gmock.h>

#include "tests/apps/oscillator_study.h"

namespace {

using namespace program;
using testing::HasSubstr;

/// Fitted, and with a rung.
class Exporting : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    study = new OscillatorStudy();
    before = ask({"--to", "json"});
    folder_before = fs::exists(study->path("out"));
    fitted = run({"fit", where(), "--method", "output_error", "--method", "filter_error"});
    unchanged = ask({"--to", "json"});
    added = run({"add", where(), "coulomb_friction"});
  }
  static void TearDownTestSuite() { delete study; }

  static std::string where() { return study->path("study.toml").string(); }
  static Outcome ask(const std::vector<std::string>& options) {
    std::vector<std::string> words{"export", where()};
    words.insert(words.end(), options.begin(), options.end());
    return run(words);
  }
  static json exported(const std::vector<std::string>& more) {
    std::vector<std::string> words{"--to", "json", "--out", study->path("made/e.json").string(), "--force"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = ask(words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return json::parse(content(study->path("made/e.json")));
  }

  static inline OscillatorStudy* study = nullptr;
  static inline Outcome before, fitted, unchanged, added;
  static inline bool folder_before = false;
};

TEST_F(Exporting, BeforeTheFirstRunThereIsNothingAndNoFolderIsMade) {
  EXPECT_EQ(before.status, 2);
  EXPECT_THAT(before.err, HasSubstr("there is no estimate to export yet; misfit run"));
  EXPECT_FALSE(folder_before);
}

TEST_F(Exporting, OfAFitIsTheFit) {
  ASSERT_EQ(fitted.status, 0) << fitted.err;
  EXPECT_EQ(unchanged.status, 0) << unchanged.err;
  EXPECT_THAT(unchanged.err, HasSubstr("exporting the estimate by filter_error"));
  for (const char* method : {"output_error", "filter_error"}) {
    const json all = exported({"--method", method, "--rung", "0"});
    const json fit = json::parse(content(study->path(std::string("out/fit/") + method + "/fit.json")));
    EXPECT_EQ(all["method"], method);
    for (const char* name : {"k", "c", "g"}) {
      EXPECT_EQ(all["parameters"][name]["value"], fit["parameters"][name]["value"]) << name;
      EXPECT_EQ(all["parameters"][name]["sigma"], fit["parameters"][name]["sigma"]) << name;
    }
    EXPECT_EQ(all["covariance"]["matrix"], fit["covariance"]);
  }
}

TEST_F(Exporting, WithoutAFormatNamesThem) {
  const Outcome without = ask({});
  EXPECT_EQ(without.status, 2);
  EXPECT_THAT(without.err, HasSubstr("--to is required; --to takes json, csv, c, python, jsbsim"));
}

TEST_F(Exporting, IsTheLastRungUnlessAnotherIsAskedFor) {
  ASSERT_EQ(added.status, 0) << added.err;
  const json last = exported({});
  EXPECT_EQ(last["rung"], "rung 1, coulomb_friction added");
  EXPECT_TRUE(last["parameters"].contains("friction"));
  EXPECT_EQ(exported({"--rung", "coulomb_friction"}), last);
  EXPECT_FALSE(exported({"--rung", "0"})["parameters"].contains("friction"));
  const Outcome wrong = ask({"--to", "json", "--rung", "coulomb_fricton"});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_THAT(wrong.err, HasSubstr("did you mean 'coulomb_friction'?"));
}

TEST_F(Exporting, GoesToStandardOutputWhereItsPathIsADash) {
  const Outcome outcome = ask({"--to", "json", "--out", "-"});
  EXPECT_EQ(json::parse(outcome.out), exported({}));
  EXPECT_EQ(ask({"--to", "csv", "--out", "-"}).status, 2);
}

TEST_F(Exporting, CodeRunsAsItIs) {
  const fs::path c = study->path("made/m.c"), python = study->path("made/m.py");
  ASSERT_EQ(ask({"--to", "c", "--out", c.string()}).status, 0);
  ASSERT_EQ(ask({"--to", "python", "--out", python.string()}).status, 0);
  EXPECT_THAT(content(c), HasSubstr("p_friction"));
  const std::string cc = "cc -std=c99 -Wall -Wextra -Werror -c " + c.string() + " -o " + study->path("made/m.o").string();
  EXPECT_EQ(std::system(cc.c_str()), 0);  // NOLINT(cert-env33-c)
  const std::string py = "cd " + c.parent_path().string() + " && python3 -c 'import m; assert len(m.rates([0.1, 0.2], [1.0], 0.0)) == 2'";
  EXPECT_EQ(std::system(py.c_str()), 0);  // NOLINT(cert-env33-c)
}

TEST_F(Exporting, WritesOverNothingThatItDidNotMake) {
  const std::string file = study->path("made/mine.json").string();
  fs::create_directories(study->path("made"));
  study->write("made/mine.json", "mine");
  EXPECT_EQ(ask({"--to", "json", "--out", file}).status, 2);
  EXPECT_EQ(content(file), "mine");
  EXPECT_EQ(ask({"--to", "json", "--out", study->path("d.csv").string(), "--force"}).status, 2) << "data are never written over";
  for (const char* name : {"c", "python", "json", "csv"}) {
    EXPECT_EQ(ask({"--to", name}).status, 0) << name;
    EXPECT_EQ(ask({"--to", name}).status, 0) << name << ", again";
  }
  EXPECT_TRUE(fs::exists(study->path("out/rungs/01_coulomb_friction/out/export/parameters.csv")));
}

TEST_F(Exporting, RefusesAnEstimateOfAnotherStateOfTheStudy) {
  const std::string text = content(study->path("m.toml"));
  study->write("m.toml", std::regex_replace(text, std::regex("value = 3.0"), "value = 2.0"));
  const Outcome outcome = ask({"--to", "json", "--rung", "0"});
  study->write("m.toml", text);
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("is of another state of the study"));
  EXPECT_EQ(ask({"--to", "jsbsim"}).status, 2) << "no pitching moment";
}

}  // namespace
