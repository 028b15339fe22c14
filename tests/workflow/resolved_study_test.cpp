// Studies that misfit writes say what the one they come from says: resolved.toml, and a rung that holds a parameter.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

#include "misfit/model/declared.h"
#include "misfit/model/request.h"
#include "misfit/workflow/estimate/estimate.h"
#include "misfit/workflow/ladder.h"
#include "tests/workflow/text_study.h"

namespace {

using namespace misfit;
using testing_text_study::TextStudy;

constexpr const char* pendulum = R"toml([states]
theta = { unit = "rad", initial = 0.1 }
omega = { unit = "rad/s", rate_of = "theta", initial = 0.0 }
[inputs]
u = { unit = "rad/s^2" }
[parameters]
k = { unit = "1/s^2", value = 4.0, free = true }
[equations]
omega = "u - k*theta"
[outputs]
theta = { unit = "rad" }
)toml";

constexpr const char* late = "late = { kind = \"input_lag\", input = \"u\", port = \"domega/dt\"";
constexpr const char* drag = "drag = { formula = \"-c*omega\", port = \"domega/dt\", parameters = { c = { unit = \"1/s\" } } }\n";

std::string recording() {
  std::string text = "t[s],u[rad/s^2],theta[rad]\n";
  for (int i = 0; i < 60; ++i) text += std::to_string(0.1 * i) + "," + std::to_string(i % 7) + "," + std::to_string(0.1 * (i % 5)) + "\n";
  return text;
}

/// The model of the study with these lines under [effects], and that of its resolved.toml.
std::pair<Model, Model> models(const std::string& effects) {
  const TextStudy text(pendulum, recording());
  Identification identification = text.identification("output_error", effects);
  Session& session = identification.session();
  const Prepared prepared = prepare(session);
  const std::filesystem::path folder = session.folder.path();
  std::filesystem::create_directories(folder);
  write_resolved(session, prepared, folder);
  const Study study = read_study(folder / "resolved.toml");
  Registry known;
  misfit_models_register(known);
  const auto registry = study_registry(study, known);
  return {prepared.model, assemble(read_model(study, *registry).request, *registry)};
}

void expect_same(const std::pair<Model, Model>& both) {
  const auto& [model, again] = both;
  ASSERT_EQ(again.parameters.size(), model.parameters.size());
  for (std::size_t i = 0; i < model.parameters.size(); ++i) {
    const Parameter &a = model.parameters[i], &b = again.parameters[i];
    EXPECT_EQ(b.name, a.name);
    EXPECT_EQ(b.value, a.value) << a.name;
    EXPECT_EQ(b.lower, a.lower) << a.name;
    EXPECT_EQ(b.free, a.free) << a.name;
  }
}

TEST(ResolvedText, OfAnEffectsLineWithStartFreeAndFixedIsAStudyAgain) {
  const auto both = models(late + std::string(", start = { input_tau = 0.3 }, fixed = [\"lagged_gain\"] }"));
  expect_same(both);
  EXPECT_EQ(both.second.parameters[both.second.find_parameter("input_tau")].value, 0.3);
  EXPECT_FALSE(both.second.parameters[both.second.find_parameter("lagged_gain")].free);
}

TEST(ResolvedText, OfAParameterUnderItsOtherNameIsAStudyAgain) {
  for (const char* name : {"\"late.input_tau\"", "late.input_tau"}) {
    const auto both = models(late + std::string(" }\n[parameters]\n") + name + " = { value = 0.3, bounds = [0.1, 1.0] }");
    expect_same(both);
    EXPECT_EQ(both.second.parameters[both.second.find_parameter("input_tau")].upper, 1.0) << name;
  }
}

TEST(ResolvedText, KeepsAPriorWhereItIsAndAStartBesideIt) {
  const auto both = models(
      "drag = { formula = \"-c*omega\", port = \"domega/dt\", start = { c = 3 }, parameters = { c = { unit = \"1/s\", value "
      "= 2, sigma = 0.5 } } }");
  expect_same(both);
  const Parameter& c = both.second.parameters[both.second.find_parameter("c")];
  EXPECT_EQ(c.value, 3.0);
  EXPECT_EQ(c.prior_mean, 2.0);
  EXPECT_EQ(c.prior_sigma, 0.5);
}

TEST(ResolvedText, KeepsTheKnotsOfACurveOverARate) {
  for (const char* knots : {"[-180, 0, 33.3, 180]", "[\"-3.1 rad/s\", \"0 rad/s\", \"0.7 rad/s\", \"3.1 rad/s\"]"}) {
    const auto [model, again] = models(drag + std::string("[curves]\nc = { of = \"omega\", knots = ") + knots + " }");
    EXPECT_EQ(again.curves.front().spline.breakpoints(), model.curves.front().spline.breakpoints()) << knots;
    EXPECT_NEAR(model.curves.front().spline.breakpoints().back(), 3.1, 0.05) << knots;
  }
}

TEST(StudyOfARung, HoldsAParameterWhereTheStudyWritesIt) {
  Candidate bias;
  bias.effect = "bias";
  bias.roles = {{"output", "theta"}};
  bias.fixed_in_model["input_tau"] = {0.2, 0.0, "s"};
  for (const char* name : {"\"late.input_tau\"", "late.input_tau", "input_tau"}) {
    const TextStudy text(pendulum, recording());
    Identification identification = text.identification(
        "output_error", late + std::string(", start = { input_tau = 0.4 } }\n[parameters]\n") + name + " = { bounds = [0.1, 1.0] }");
    const std::filesystem::path folder = identification.session().folder.path().parent_path();
    std::ofstream(folder / "rung.toml") << study_with_effect(identification.session(), "bias", bias, folder);
    const Study study = read_study(folder / "rung.toml");
    Registry known;
    misfit_models_register(known);
    const auto registry = study_registry(study, known);
    const Model model = assemble(read_model(study, *registry).request, *registry);
    const Parameter& tau = model.parameters[model.find_parameter("input_tau")];
    EXPECT_EQ(tau.value, 0.2) << name;
    EXPECT_EQ(tau.upper, 1.0) << name;
    EXPECT_FALSE(tau.free) << name;
  }
}

}  // namespace
