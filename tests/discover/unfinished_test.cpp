#include "misfit/discover/unfinished.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "misfit/core/watch.h"
#include "misfit/discover/discover.h"
#include "misfit/discover/refit_jobs.h"
#include "tests/fit/flight.h"

namespace misfit {
namespace {

using namespace testing_flight;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

/// With a friction that the model lacks.
class UnfinishedDiscovery : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    signals = new std::vector<Signals>{fly(14.0, 32, {effect("coulomb_friction")}, {{"friction", 25.0}})};
    request = new ModelRequest(request_for(*signals));
    estimate = new FilterEstimate(fitted(*request, *signals));
  }
  static void TearDownTestSuite() {
    delete estimate;
    delete request;
    delete signals;
  }
  static Discovery discover(const DiscoverOptions& options) {
    return misfit::discover({*estimate, *request, registry(), *signals}, options);
  }

  inline static std::vector<Signals>* signals = nullptr;
  inline static ModelRequest* request = nullptr;
  inline static FilterEstimate* estimate = nullptr;
};

TEST_F(UnfinishedDiscovery, ARefitWithoutTimeSaysNothingAgainstItsEffect) {
  DiscoverOptions options;
  options.refit_limit = 1e-6;
  const Discovery found = discover(options);
  EXPECT_EQ(found.outcome, SearchOutcome::not_decided);
  EXPECT_THAT(found.verdict, StartsWith("Not decided: the refit"));
  EXPECT_THAT(found.verdict, AllOf(HasSubstr("coulomb_friction"), HasSubstr("not finished within the time limit")));
  const auto friction =
      std::find_if(found.candidates.begin(), found.candidates.end(), [](const Candidate& c) { return c.effect == "coulomb_friction"; });
  ASSERT_NE(friction, found.candidates.end()) << "it stays named";
  EXPECT_FALSE(friction->accepted);
  EXPECT_FALSE(friction->actual_drop);
  EXPECT_LT(friction->p_value, 0.01) << "what the screening says of it stays";
  EXPECT_THAT(friction->why,
              StartsWith("its refit was not finished: the time limit of 1e-06 s for the refit of coulomb_friction was spent"));
}

TEST_F(UnfinishedDiscovery, ARoundWithoutTimeEndsInWords) {
  DiscoverOptions options;
  options.round_limit = 1e-6;
  const Discovery found = discover(options);
  EXPECT_EQ(found.outcome, SearchOutcome::not_finished);
  EXPECT_THAT(found.verdict, StartsWith("Not finished: the time limit of 1e-06 s for this round of discover was spent before"));
  for (const Candidate& c : found.candidates) EXPECT_FALSE(c.accepted);
}

TEST(Unfinished, IsTestedAgainWhereAnotherIsAccepted) {
  Discovery found;
  found.verdict = "Missing: lag.";
  found.candidates.resize(2);
  found.candidates[0].accepted = true;
  say_unfinished({"overflow", "delay"}, found);
  EXPECT_EQ(found.verdict, "Missing: lag.");
  ASSERT_EQ(found.sentences.size(), 1U);
  EXPECT_THAT(found.sentences[0], HasSubstr("the refits of overflow and delay were not finished"));
}

TEST(Unfinished, AnAcceptedEffectStaysWhereOnlyItsGroupIsNotFinished) {
  Discovery found;
  found.verdict = "Missing: lag.";
  found.candidates.resize(1);
  found.candidates[0].accepted = true;
  say_cut_off("the time limit of 5 s for this round of discover was spent", true, found);
  EXPECT_EQ(found.verdict, "Missing: lag.");
  EXPECT_THAT(found.sentences.at(0), StartsWith("the time limit of 5 s for this round of discover was spent: the test for effects"));
}

TEST(Unfinished, SaysNothingWhereAllWereFinished) {
  Discovery found;
  found.verdict = "No missing effect detected.";
  say_unfinished({}, found);
  EXPECT_EQ(found.verdict, "No missing effect detected.");
  EXPECT_TRUE(found.sentences.empty());
}

}  // namespace
}  // namespace misfit
