// `free` and `fixed` of an effect's line.

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

bool is_free(const Model& model, const std::string& parameter) {
  const auto found = std::find_if(model.parameters.begin(), model.parameters.end(), [&](const auto& p) { return p.name == parameter; });
  if (found == model.parameters.end()) throw std::logic_error("no parameter '" + parameter + "'");
  return found->free;
}

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

TEST(FreeAndFixed, OneParameterCannotBeBoth) {
  const std::string message =
      message_of<InputError>([] { model_with(late + std::string(", free = [\"input_tau\"], fixed = [\"input_tau\"] }")); });
  expect_parts(message, {"study.toml:7", "input_tau stands in free and in fixed"});
}

}  // namespace
}  // namespace misfit
