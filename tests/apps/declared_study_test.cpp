// Studies of systems given as text, through the program.

#include "tests/apps/program.h"

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
  EXPECT_LT(fit["rms"]["y"]["value"].get<double>(), 0.5);
  EXPECT_TRUE(fit["parameters"].contains("level"));
}

}  // namespace
