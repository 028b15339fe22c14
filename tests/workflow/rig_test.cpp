// What [uncertainty] perturbs: the camera as the study calibrates it, and only what acts.
#include "misfit/workflow/uncertainty/rig.h"

#include <gmock/gmock.h>
#include <misfit_models_registry.h>

#include <filesystem>
#include <regex>
#include <sstream>

#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "misfit/model/model.h"
#include "misfit/workflow/estimate/estimate.h"
#include "tests/core/temporary_folder.h"
#include "tests/paths.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

/// Four seconds of configs/mpf_f111 from its track.
class RigStudy : public testing::Test {
 protected:
  RigStudy() {
    misfit_models_register(registry_);
    const fs::path from = paths::source() / "configs/mpf_f111";
    for (const auto& entry : fs::directory_iterator(from)) {
      if (entry.path().extension() == ".csv") fs::copy_file(entry.path(), folder_.path() / entry.path().filename());
    }
    std::istringstream track(read_file(from / "track.csv"));
    std::string rows, line;
    for (int row = 0; row < 240 && std::getline(track, line); ++row) rows += line + "\n";
    folder_.write("track.csv", rows);
    text_ = read_file(from / "study.toml");
    change("\nvideo = .*", "\ntrack = \"track.csv\"");
  }
  void change(const std::string& pattern, const std::string& by) {
    const std::string before = text_;
    text_ = std::regex_replace(before, std::regex(pattern), by, std::regex_constants::format_first_only);
    EXPECT_NE(before, text_) << pattern;
  }
  [[nodiscard]] Session session() const {
    const fs::path study = folder_.write("study.toml", text_);
    return Session({.study = study.string(), .out = (folder_.path() / "out").string()}, registry_);
  }
  static Rig rig_of(Session& session) {
    fix_perturbed_camera(session);
    return Rig(session, prepare(session).model);
  }

  TemporaryFolder folder_;
  Registry registry_;
  std::string text_;
};

TEST_F(RigStudy, CalibratingAgainFreesWhatTheStudyFrees) {
  change("sweep = \"static_sweep.csv\"", "sweep = \"static_sweep.csv\"\nfree = [\"camera_roll\"]");
  change("perturb = .*", "perturb = { R1 = \"1 cm\" }\nrecalibrate = true");
  Session opened = session();
  const Rig rig = rig_of(opened);
  const Calibration nominal = *calibrate_stage(opened), again = *rig.at({0.0}).calibration;
  ASSERT_THAT(nominal.names, testing::Contains("camera_roll"));
  EXPECT_EQ(again.names, nominal.names);
  EXPECT_NEAR(again.value("camera_roll"), nominal.value("camera_roll"), 1e-9);
  EXPECT_NEAR(again.value("K"), nominal.value("K"), 1e-6 * nominal.value("K"));
  EXPECT_NE(rig.at({0.01}).calibration->value("camera_roll"), nominal.value("camera_roll"));
}

std::string refusal(Session session) {
  try {
    fix_perturbed_camera(session);
    static_cast<void>(Rig(session, prepare(session).model));
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST_F(RigStudy, OfACalibratedCameraWhoseParameterTheStudyFreesIsRefused) {
  change("parachute_planar", "parachute_spherical");
  change("perturb = .*", "camera = \"calibration\"");
  EXPECT_EQ(refusal(session()), "no error");
  text_ += "\n[parameters.K]\nfree = true\n";
  EXPECT_THAT(refusal(session()), AllOf(HasSubstr("study.toml:"), HasSubstr("'K' is estimated by this study")));
}

TEST(RigOfAFilm, ThatTheOutputsReadThemselvesHasNoImageOffset) {
  const TemporaryFolder folder;
  Registry registry;
  misfit_models_register(registry);
  folder.write("system.toml", R"toml(
[system]
doc = "pendulum on film"
source = "textbook"
[states]
theta = { unit = "rad", scale = 0.1 }
omega = { unit = "rad/s", scale = 0.4 }
[equations]
theta = "omega"
omega = "-w^2*sin(theta)"
[parameters]
w = { unit = "rad/s", value = 2.0 }
arm = { unit = "px", value = 400.0 }
[outputs]
x_px = { unit = "px", formula = "arm*sin(theta)", noise = 0.3 }
)toml");
  const fs::path study =
      folder.write("study.toml",
                   "[study]\nname = \"film\"\nmethods = [\"output_error\"]\n[system]\nfile = \"system.toml\"\n"
                   "[[experiment]]\nvideo = \"" +
                       (paths::source() / "configs/mpf_f111/flight.mkv").string() + "\"\n[uncertainty]\nperturb = { P_y = \"3 px\" }\n");
  Session session({.study = study.string(), .out = (folder.path() / "out").string()}, registry);
  try {
    static_cast<void>(Rig(session, assemble(session.model.request, session.registry)));
    FAIL() << "P_y acts on nothing";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("nothing that is fixed in this study is called 'P_y'"));
  }
}

}  // namespace
}  // namespace misfit
