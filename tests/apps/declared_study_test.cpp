// Studies of systems given as text, through the program.

#include "tests/apps/program.h"
#include "tests/paths.h"

namespace {

using namespace program;

TEST(CascadedTanks, AreFittedFromTheShippedStudy) {
  const StudyCopy study("cascaded_tanks");
  const Outcome outcome = study.run();
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json fit = json::parse(content(study.out("fit/output_error/fit.json")));
  EXPECT_NEAR(fit["rms"]["y"]["value"].get<double>(), 0.60, 0.03) << "Bernoulli's law alone, free run over the estimation record";
  for (const char* k : {"k1", "k3", "k4"}) EXPECT_GT(fit["parameters"][k]["sigma"].get<double>(), 0.0) << k;
  EXPECT_EQ(fit["parameters"]["k1"]["unit"], "V^0.5/s");
  EXPECT_NE(outcome.out.find("V^0.5/s"), std::string::npos) << outcome.out;
}

TEST(CascadedTanks, TakeAnEffectDeclaredInTheStudyAndResolvedCanBeRunAgain) {
  const StudyCopy study("cascaded_tanks");
  study.append(
      "[effects.spill]\nport = \"dx2/dt\"\nformula = \"c*max(x1 - level, 0)\"\n"
      "parameters = { c = { unit = \"1/s\", value = 0.002, bounds = [0, 1] }, level = { unit = \"V\", value = 5.0, bounds = [0, 20] } }\n");
  const Outcome outcome = study.run();
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json fit = json::parse(content(study.out("fit/output_error/fit.json")));
  EXPECT_NEAR(fit["rms"]["y"]["value"].get<double>(), 0.576, 0.01) << "from any start; 0.60 without";
  EXPECT_TRUE(fit["parameters"].contains("level"));
}

TEST(CascadedTanks, AreFittedAgainWhenTheFileOfTheirSystemChanges) {
  const StudyCopy study("cascaded_tanks");
  std::string text = content(paths::source() / "models" / "cascaded_tanks.toml");
  study.write("tanks.toml", text);
  study.change("kind = \"cascaded_tanks\"", "file = \"tanks.toml\"");
  ASSERT_EQ(study.run("fit").status, 0);
  const double k4 = study.fit("output_error")["parameters"]["k4"]["value"].get<double>();
  const auto at = text.find("value = 0.05, bounds = [0.0, 10.0], doc");  // of k2, which sets the scale of the upper level
  ASSERT_NE(at, std::string::npos);
  study.write("tanks.toml", text.replace(at, 12, "value = 0.06"));
  ASSERT_EQ(study.run("fit").status, 0);
  EXPECT_NEAR(study.fit("output_error")["parameters"]["k4"]["value"].get<double>() / k4, std::pow(0.05 / 0.06, 2), 0.01);
}

/// A recording of its own, held out by its name: as an experiment all of which is held out; without shared states its own is read from it.
TEST(CascadedTanks, AnotherFileIsHeldOutByItsName) {
  const StudyCopy listed("cascaded_tanks"), named("cascaded_tanks");
  const std::string text = content(named.path("study.toml"));
  const auto test = text.find("[[experiment]]\nname = \"test\""), initial = text.find("[initial]");
  ASSERT_LT(test, initial);
  std::string one = text.substr(0, test) + text.substr(initial);
  one.insert(one.find("exclude = 5\n") + 12, "validation = \"test.csv\"\n");
  named.write("study.toml", one);
  ASSERT_EQ(listed.run("fit").status, 0);
  ASSERT_EQ(named.run("fit").status, 0);
  EXPECT_EQ(named.fit("output_error")["parameters"], listed.fit("output_error")["parameters"]);
  EXPECT_EQ(named.fit("output_error")["validation_rms"], listed.fit("output_error")["validation_rms"]);
  named.write("study.toml", one.substr(0, one.find("[initial]")));
  ASSERT_EQ(named.run("fit").status, 0);
  const json own = named.fit("output_error");
  EXPECT_EQ(own["status"], "converged");
  EXPECT_GT(own["validation_rms"]["y"]["value"].get<double>(), 0.3);
  EXPECT_LT(own["validation_rms"]["y"]["value"].get<double>(), 1.0);
}

TEST(CascadedTanks, WithFourFreeParametersAreToldThatThreeActTogether) {
  const StudyCopy study("cascaded_tanks");
  study.append("[parameters]\nk2 = { free = true }\n");
  const Outcome outcome = study.run("fit");
  EXPECT_NE(outcome.out.find("do not determine k1, k2 and k4 separately"), std::string::npos) << outcome.out;
}

TEST(CascadedTanks, WithAWrongFormulaAreRefusedAtItsPlace) {
  const StudyCopy study("cascaded_tanks");
  study.append(
      "[effects]\nspill = { port = \"dx2/dt\", formula = \"c*max(x1 - levl, 0)\", parameters = { c = { unit = \"1/s\" }, level = { unit = "
      "\"V\" } } }\n");
  const Outcome outcome = study.run("fit");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_TRUE(std::regex_search(outcome.err, std::regex(R"(study\.toml:\d+:\d+: effect spill, 'levl')"))) << outcome.err;
  EXPECT_NE(outcome.err.find("did you mean 'level'"), std::string::npos) << outcome.err;
}

}  // namespace
