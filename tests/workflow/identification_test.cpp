// misfit/misfit.h against the verbs of the program: the same work, the same files, nothing on the terminal.
#include <gmock/gmock.h>
#include <misfit_models_registry.h>

#include "misfit/misfit.h"
#include "tests/apps/oscillator_study.h"

namespace {

using namespace misfit;
namespace fs = std::filesystem;
using program::OscillatorStudy;
using testing::HasSubstr;
using testing::IsEmpty;

class IdentificationOfAnOscillator : public testing::Test {
 protected:
  IdentificationOfAnOscillator() { misfit_models_register(registry_); }

  [[nodiscard]] std::string study() const { return study_.path("study.toml").string(); }
  [[nodiscard]] std::string out(const std::string& name) const { return study_.path(name).string(); }
  /// "discover --auto" as a loop of one's own; without comparisons of free runs.
  static void extend_by_hand(Identification& identification) {
    for (auto next = identification.accepted(identification.discover()); next; next = identification.accepted(identification.discover()))
      identification.add(*next);
  }

  OscillatorStudy study_;
  Registry registry_;
};

TEST_F(IdentificationOfAnOscillator, LeavesWhatTheVerbsLeaveAndPrintsNothing) {
  const auto by_verbs = program::run({"discover", study(), "--auto", "--out", out("verbs")});
  ASSERT_EQ(by_verbs.status, 0) << by_verbs.err;
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  {
    Identification identification({.study = study(), .out = out("library")}, registry_);
    identification.extend();
    EXPECT_TRUE(fs::exists(identification.report()));
    ASSERT_EQ(identification.ladder().rungs.size(), 2U);
    EXPECT_EQ(identification.ladder().rungs.back().added, "coulomb_friction");
    Identification by_hand({.study = study(), .out = out("by_hand")}, registry_);
    extend_by_hand(by_hand);
    ASSERT_EQ(by_hand.ladder().rungs.size(), 2U);
    EXPECT_EQ(by_hand.ladder().rungs.back().loglik, identification.ladder().rungs.back().loglik);
  }
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  const auto verbs = program::results_in(out("verbs")), library = program::results_in(out("library"));
  EXPECT_GT(verbs.size(), 20U);
  EXPECT_THAT(program::differences(verbs, library), IsEmpty());
}

TEST_F(IdentificationOfAnOscillator, FitsTheModelOfTheLastRung) {
  Identification identification({.study = study(), .out = out("out"), .methods = {"filter_error"}}, registry_);
  const Fit before = identification.fit("filter_error");
  EXPECT_FALSE(before.parameters.contains("torque"));
  const std::size_t notes_before = before.parameters.size();
  const Rung& rung = identification.add("coulomb_friction");
  EXPECT_GT(rung.actual_drop.value_or(0.0), 20.0);
  ASSERT_TRUE(rung.predicted_drop) << "discovery is asked before the effect is added";
  const std::vector<Fit> after = identification.fit();
  ASSERT_EQ(after.size(), 1U);
  EXPECT_GT(after.front().parameters.size(), notes_before);
}

TEST_F(IdentificationOfAnOscillator, ListenerHearsTheNotesAndTheProgress) {
  std::vector<std::string> notes, works;
  std::size_t calls = 0;
  SessionOptions options{.study = study(), .out = out("out"), .methods = {"output_error"}};
  options.listener.note = [&](const std::string& line) { notes.push_back(line); };
  options.listener.progress = [&](const std::string& name) -> ProgressFn {
    works.push_back(name);
    return [&](std::size_t, std::size_t) { ++calls; };
  };
  static_cast<void>(Identification(options, registry_).fit());
  EXPECT_THAT(works, testing::Contains("fit"));
  EXPECT_GT(calls, 0U);
  EXPECT_THAT(notes, IsEmpty());
  fs::resize_file(out("out/fit/output_error/prediction.csv"), 3);
  static_cast<void>(Identification(options, registry_).fit());
  EXPECT_THAT(notes, testing::ElementsAre(HasSubstr("not as misfit wrote it: made again")));
}

TEST_F(IdentificationOfAnOscillator, UnknownNamesAreRefusedWithTheNearest) {
  Identification identification({.study = study(), .out = out("out")}, registry_);
  try {
    identification.add("coulomb_fricton");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("did you mean 'coulomb_friction'"));
  }
}

TEST(CurveOfAFit, IsFoundByNameOrRefusedWithTheNearest) {
  Fit fit;
  fit.method = "output_error";
  fit.curves.emplace_back();
  fit.curves.back().name = "C_m";
  fit.curves.back().value = {2.0};
  EXPECT_EQ(curve(fit, "C_m").value.front(), 2.0);
  try {
    static_cast<void>(curve(fit, "C_n"));
    FAIL() << "found";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("has no curve 'C_n'"));
  }
}

}  // namespace
