// Studies that misfit writes say what the one they come from says.

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <utility>

#include "misfit/model/declared.h"
#include "misfit/model/request.h"
#include "misfit/workflow/estimate/estimate.h"
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

TEST(ResolvedText, KeepsTheKnotsOfACurveOverARate) {
  for (const char* knots : {"[-180, 0, 33.3, 180]", "[\"-3.1 rad/s\", \"0 rad/s\", \"0.7 rad/s\", \"3.1 rad/s\"]"}) {
    const auto [model, again] = models(drag + std::string("[curves]\nc = { of = \"omega\", knots = ") + knots + " }");
    EXPECT_EQ(again.curves.front().spline.breakpoints(), model.curves.front().spline.breakpoints()) << knots;
    EXPECT_NEAR(model.curves.front().spline.breakpoints().back(), 3.1, 0.05) << knots;
  }
}

}  // namespace
