// A fit that the limit cut off which holds where nobody gives one.
#include <gmock/gmock.h>

#include <cmath>
#include <string>

#include "tests/workflow/text_study.h"

namespace {

using namespace misfit;

constexpr const char* decay = R"([system]
doc = "a decay"
[states]
y = { unit = "m", initial = "free" }
[parameters]
k = { unit = "1/s", value = 1.0, bounds = [0.01, 100.0], free = true }
[equations]
y = "-k*y"
[outputs]
y = { unit = "m", noise = 0.01 }
)";

std::string recording() {
  std::string text = "t[s],y[m]\n";
  for (int i = 0; i < 100; ++i)
    text += std::to_string(0.05 * i) + "," + std::to_string(std::exp(-0.025 * i) + 0.01 * std::sin(9.0 * i)) + "\n";
  return text;
}

TEST(AFitThatTheUsualLimitCutOff, IsMadeAgainWhereThereIsMoreTime) {
  const testing_text_study::TextStudy study(decay, recording());
  Identification identification = study.identification("output_error", "");
  Session& session = identification.session();
  const auto fit = [&](double limit) {
    session.usual_limit = limit;
    return fit_stage(session).front();
  };
  EXPECT_NE(fit(1e-9).status, FitStatus::converged);
  EXPECT_NE(fit(1e-10).status, FitStatus::converged) << "no more time than it had";
  EXPECT_EQ(session.folder.stages().at("fit/output_error").inputs.at("usual_limit"), "1e-09 s") << "it was not made again";
  EXPECT_EQ(fit(0.0).status, FitStatus::converged) << "as long as it takes";
  EXPECT_EQ(fit(1e-9).status, FitStatus::converged) << "no limit has cut it off: it stays";
}

}  // namespace
