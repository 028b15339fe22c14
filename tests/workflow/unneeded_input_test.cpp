// An input that a system declares and no equation needs, as `misfit init` leaves it beside a model that the data want without it.
#include <gtest/gtest.h>

#include "misfit/workflow/assess/assess.h"
#include "tests/workflow/swing.h"
#include "tests/workflow/text_study.h"

namespace {

using namespace misfit;
using testing_text_study::TextStudy;

constexpr const char* valve = "valve = { unit = \"V\", hold = \"zero_order\" }\n";

TEST(AnInputThatNoEquationNeeds, ChangesNoEstimate) {
  const std::string recording = testing_swing::recording(7);
  TextStudy with(testing_swing::system(valve), recording), without(testing_swing::system(), recording);
  for (const char* method : {"equation_error", "output_error", "filter_error"}) {
    const Fit a = with.fit(method, ""), b = without.fit(method, "");
    ASSERT_EQ(a.status, FitStatus::converged) << method << ": " << a.message;
    for (const char* name : {"k", "d", "b"}) EXPECT_EQ(a.parameters.at(name).value, b.parameters.at(name).value) << method << ", " << name;
  }
}

TEST(AnInputThatNoEquationNeeds, DoesNotHinderAComparisonFromALaterSampleOn) {
  TextStudy study(testing_swing::system(valve), testing_swing::recording(7));
  Identification identification = study.identification("filter_error", "", "exclude = 7\n");
  EXPECT_TRUE(compare_stage(identification.session(), identification.fit()).motion);
}

}  // namespace
