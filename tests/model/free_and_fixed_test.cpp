// `start`, `free` and `fixed` of an effect's line.

#include <gtest/gtest.h>

#include <algorithm>

#include "misfit/data/study.h"
#include "misfit/model/declared.h"
#include "misfit/model/request.h"
#include "tests/core/temporary_folder.h"
#include "tests/model/requests.h"

namespace misfit {
namespace {

Model model_with(const std::string& line) {
  const TemporaryFolder folder;
  folder.write("tank.toml",
               "[system]\ndoc = \"a tank\"\n[states]\nx = { unit = \"V\" }\n[inputs]\nu = { unit = \"V\" }\n"
               "[parameters]\nk = { unit = \"1/s\", value = 1 }\n[equations]\nx = \"k*(u - x)\"\n"
               "[outputs]\ny = { formula = \"x\", unit = \"V\" }\n");
  folder.write("d.csv", "t[s],u[V],level[V]\n0,1,2\n");
  const Study study = read_study(
      folder.write("study.toml",
                   "[system]\nfile = \"tank.toml\"\n[[experiment]]\ndata = \"d.csv\"\ncolumns = { t = \"t\", y = \"level\" }\n[effects]\n" +
                       line + "\n"));
  const auto known = study_registry(study, testing_models::registry());
  return assemble(read_model(study, *known).request, *known);
}

const Parameter& parameter_of(const Model& model, const std::string& parameter) {
  const auto found = std::find_if(model.parameters.begin(), model.parameters.end(), [&](const auto& p) { return p.name == parameter; });
  if (found == model.parameters.end()) throw std::logic_error("no parameter '" + parameter + "'");
  return *found;
}

bool is_free(const Model& model, const std::string& parameter) { return parameter_of(model, parameter).free; }

constexpr const char* late = "late = { kind = \"input_lag\", input = \"u\", port = \"dx/dt\"";

TEST(FreeAndFixed, AreSaidInTheEffectsLine) {
  const Model model = model_with(late + std::string(", free = [\"lagged_gain\"], fixed = [\"input_tau\"] }"));
  EXPECT_FALSE(is_free(model, "input_tau"));
  EXPECT_TRUE(is_free(model, "lagged_gain"));
}

TEST(FreeAndFixed, AreOtherwiseAsTheEffectSays) {
  const Model model = model_with(late + std::string(" }"));
  EXPECT_TRUE(is_free(model, "input_tau"));
  EXPECT_TRUE(is_free(model, "lagged_gain"));
}

TEST(FreeAndFixed, AParameterThatTheEffectDoesNotHaveIsNamedWithTheNearest) {
  const std::string message = message_of<InputError>([] { model_with(late + std::string(", free = [\"input_tua\"] }")); });
  expect_parts(message, {"study.toml:7", "input_tua", "input_tau"});
}

TEST(FreeAndFixed, AndTheStartStandBesideWhatParametersSayUnderAnyNameOfTheParameter) {
  for (const char* name : {"input_tau", "late.input_tau"}) {
    const Model model = model_with(late + std::string(", start = { input_tau = 0.3 }, fixed = [\"input_tau\"] }\n[parameters]\n\"") + name +
                                   "\" = { bounds = [0.1, 1.0], free = true }");
    const Parameter& tau = parameter_of(model, "input_tau");
    EXPECT_EQ(tau.value, 0.3) << name;
    EXPECT_EQ(tau.lower, 0.1) << name;
    EXPECT_EQ(tau.upper, 1.0) << name;
    EXPECT_TRUE(tau.free) << name << ": [parameters] comes first";
  }
}

TEST(FreeAndFixed, AndTheStartAreOfTheEffectsOwnParameterWhereTwoHaveOneOfTheName) {
  const Model model =
      model_with(late + std::string(", start = { input_tau = 0.3 } }\nlater = { kind = \"input_lag\", input = \"u\", port = "
                                    "\"dx/dt\", fixed = [\"input_tau\"] }\n[parameters]\ninput_tau.bounds = [0.1, 1.0]"));
  EXPECT_EQ(parameter_of(model, "late.input_tau").value, 0.3);
  EXPECT_EQ(parameter_of(model, "late.input_tau").lower, 0.1);
  EXPECT_FALSE(is_free(model, "later.input_tau"));
}

TEST(FreeAndFixed, AParameterUnderTwoNamesIsRefused) {
  const std::string message = message_of<InputError>(
      [] { model_with(late + std::string(" }\n[parameters]\ninput_tau.free = false\n\"late.input_tau\" = { value = 0.3 }")); });
  expect_parts(message, {"study.toml:10", "late.input_tau", "stands there under another name, too", "input_tau"});
}

TEST(FreeAndFixed, OneParameterCannotBeBoth) {
  const std::string message =
      message_of<InputError>([] { model_with(late + std::string(", free = [\"input_tau\"], fixed = [\"input_tau\"] }")); });
  expect_parts(message, {"study.toml:7", "input_tau stands in free and in fixed"});
}

}  // namespace
}  // namespace misfit
