#include "misfit/uncertainty/profile.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "misfit/core/error.h"
#include "tests/core/temporary_folder.h"

namespace misfit {
namespace {

constexpr double two_sided = 1.959963985;
constexpr double infinite = std::numeric_limits<double>::infinity();

ProfileRequest request(double best, double sigma, double plain_sigma, const std::function<std::optional<double>(double)>& objective) {
  ProfileRequest r{"output_error", "k", "-", best, objective(best).value_or(0.0), sigma, plain_sigma, -infinite, infinite, {}};
  r.from_best = [objective] { return MaximumAtFixedValue(objective); };
  return r;
}

LikelihoodProfile profile(const ProfileRequest& r) { return profile_likelihood({r}, 1).front(); }

TEST(Profile, OfAQuadraticLikelihoodIsTheWaldInterval) {
  const auto quadratic = [](double v) { return std::optional(100.0 - 0.5 * std::pow((v - 3.0) / 0.2, 2)); };
  const LikelihoodProfile p = profile(request(3.0, 0.2, 0.2, quadratic));
  EXPECT_TRUE(p.lower_found && p.upper_found);
  EXPECT_NEAR(p.lower, 3.0 - two_sided * 0.2, 1e-9);
  EXPECT_NEAR(p.upper, 3.0 + two_sided * 0.2, 1e-9);
  EXPECT_TRUE(p.words.empty());
}

TEST(Profile, AWrongSigmaOnlyChangesTheSteps) {
  const auto quadratic = [](double v) { return std::optional(-0.5 * std::pow((v - 3.0) / 0.2, 2)); };
  for (const double sigma : {0.02, 1.0}) {
    const LikelihoodProfile p = profile(request(3.0, sigma, sigma, quadratic));
    EXPECT_NEAR(p.upper, 3.0 + two_sided * 0.2, 1e-6) << sigma;
  }
}

TEST(Profile, DropsOfColouredResidualsAreScaled) {
  // Counted as if white the likelihood is twice as sharp as it should be.
  const auto white = [](double v) { return std::optional(-0.5 * std::pow(v / 0.1, 2)); };
  const LikelihoodProfile p = profile(request(0.0, 0.2, 0.1, white));
  EXPECT_NEAR(p.scale, 4.0, 1e-12);
  EXPECT_NEAR(p.upper, two_sided * 0.2, 1e-9);
  ASSERT_EQ(p.words.size(), 1U);
  EXPECT_THAT(p.words.front(), testing::HasSubstr("autocorrelated residuals"));
}

TEST(Profile, OfALopsidedLikelihoodIsLopsided) {
  // A Poisson mean with 9 counts: 2 (v − 9 − 9 log(v/9)) = 3.84 at 4.375 and 16.217 (by hand with a calculator's root finder).
  const auto poisson = [](double v) { return v > 0.0 ? std::optional(9.0 * std::log(v) - v) : std::nullopt; };
  const LikelihoodProfile p = profile(request(9.0, 3.0, 3.0, poisson));
  const auto drop = [&](double v) { return 2.0 * (9.0 * std::log(9.0) - 9.0 - 9.0 * std::log(v) + v); };
  EXPECT_NEAR(drop(p.lower), 3.8415, 0.01);
  EXPECT_NEAR(drop(p.upper), 3.8415, 0.01);
  EXPECT_GT(p.upper - 9.0, 1.3 * (9.0 - p.lower));
  ASSERT_EQ(p.words.size(), 1U);
  EXPECT_THAT(p.words.front(), testing::HasSubstr("asymmetric"));
}

TEST(Profile, ABoundAFailureAndAFlatSideAreSaid) {
  auto bounded = request(1.0, 1.0, 1.0, [](double v) { return std::optional(-0.5 * (v - 1.0) * (v - 1.0)); });
  bounded.lower = 0.0;
  const LikelihoodProfile at_bound = profile(bounded);
  EXPECT_FALSE(at_bound.lower_found);
  EXPECT_EQ(at_bound.lower, 0.0);
  EXPECT_THAT(at_bound.words, testing::Contains(testing::HasSubstr("bound")));
  const LikelihoodProfile failing =
      profile(request(1.0, 1.0, 1.0, [](double v) { return v > 2.0 ? std::nullopt : std::optional(-0.5 * (v - 1.0) * (v - 1.0)); }));
  EXPECT_FALSE(failing.upper_found);
  EXPECT_THAT(failing.words, testing::Contains(testing::HasSubstr("cannot be estimated")));
  const LikelihoodProfile flat = profile(request(0.0, 1.0, 1.0, [](double v) { return std::optional(v < 0.0 ? -0.5 * v * v : 0.0); }));
  EXPECT_FALSE(flat.upper_found);
  EXPECT_THAT(flat.words, testing::Contains(testing::HasSubstr("flat")));
}

TEST(Profile, WhereASideEndsIsSaidInTheUnitThatIsShown) {
  auto failing = request(0.0, 0.1, 0.1, [](double v) { return v > 0.09 ? std::nullopt : std::optional(-50.0 * v * v); });
  failing.unit = "rad";
  EXPECT_THAT(profile(failing).words, testing::Contains(testing::HasSubstr("at 5.7296 deg the model cannot be estimated")));
}

TEST(Profile, AHigherLikelihoodBesideTheEstimateIsSaid) {
  auto r = request(0.0, 1.0, 1.0, [](double v) { return std::optional(-0.5 * (v - 1.0) * (v - 1.0)); });
  EXPECT_THAT(profile(r).words, testing::Contains(testing::HasSubstr("had not reached its maximum")));
}

/// A rise by 9 on the way up is no crossing: the interval is of values as likely as the estimate, and holds it.
TEST(Profile, ALikelihoodThatRisesBeyondTheLimitHasItsCrossingBehindTheMaximum) {
  const auto away = [](double maximum) {
    return request(0.0, 1.0, 1.0, [maximum](double v) { return std::optional(-0.5 * (v - maximum) * (v - maximum)); });
  };
  const double reach = std::sqrt(9.0 + two_sided * two_sided);
  for (const double maximum : {3.0, -3.0}) {
    const LikelihoodProfile p = profile(away(maximum));
    EXPECT_TRUE(p.lower_found && p.upper_found);
    EXPECT_NEAR(p.lower, maximum - reach, 0.01);
    EXPECT_NEAR(p.upper, maximum + reach, 0.01);
    EXPECT_LE(p.lower, p.best);
    EXPECT_GE(p.upper, p.best);
    EXPECT_THAT(p.words, testing::Contains(testing::HasSubstr("had not reached its maximum")));
  }
}

/// Refits from beside the estimate that end in another maximum: the place of the jump says nothing of the parameter.
TEST(Profile, AJumpIsNoCrossing) {
  const auto jumping = [](double v) { return std::optional(-0.5 * v * v - (v > 0.3 ? 4.0 : 0.0)); };
  const LikelihoodProfile p = profile(request(0.0, 1.0, 1.0, jumping));
  EXPECT_TRUE(p.lower_found);
  EXPECT_FALSE(p.upper_found);
  EXPECT_GE(p.upper, 0.0);
  EXPECT_LE(p.upper, 0.3);
  EXPECT_THAT(p.words, testing::Contains(testing::HasSubstr("the profile is discontinuous")));
}

TEST(Profile, ALikelihoodThatOnlyRisesHasNoEnd) {
  const LikelihoodProfile p = profile(request(0.0, 1.0, 1.0, [](double v) { return std::optional(4.0 * v); }));
  EXPECT_TRUE(p.lower_found);
  EXPECT_LT(p.lower, 0.0);
  EXPECT_FALSE(p.upper_found);
  EXPECT_GT(p.upper, 0.0);
  EXPECT_THAT(p.words, testing::Contains(testing::HasSubstr("no upper end: the likelihood is higher there than at the estimate")));
  EXPECT_THAT(p.words, testing::Not(testing::Contains(testing::HasSubstr("flat"))));
  EXPECT_THAT(p.words, testing::Contains(testing::HasSubstr("had not reached its maximum")));
}

TEST(Profile, TheAnswerDoesNotDependOnTheThreads) {
  std::vector<ProfileRequest> requests;
  for (int k = 1; k <= 5; ++k)
    requests.push_back(
        request(k, 0.1 * k, 0.1 * k, [k](double v) { return std::optional(-std::pow((v - k) / (0.1 * k), 2) - std::pow(v - k, 3)); }));
  const auto one = profile_likelihood(requests, 1), two = profile_likelihood(requests, 2);
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].value, two[i].value);
    EXPECT_EQ(one[i].lower, two[i].lower);
  }
}

TEST(Profile, OnDiskEachSideIsKeptToTheBit) {
  const auto poisson = [](double v) { return v > 0.0 ? std::optional(9.0 * std::log(v) - v) : std::nullopt; };
  std::atomic<int> calls{0};
  std::vector<ProfileRequest> requests{request(9.0, 3.0, 3.0, poisson), request(9.0, 3.0, 3.0, poisson)};
  requests[1].upper = 12.0;
  for (auto& r : requests) {
    r.from_best = [&calls, poisson] {
      ++calls;
      return MaximumAtFixedValue(poisson);
    };
  }
  const TemporaryFolder folder;
  const StoredJobs jobs{folder.path() / "jobs", "digest", 0, 2};
  const auto first = stored_profiles(requests, jobs), second = stored_profiles(requests, jobs);
  EXPECT_EQ(calls, 4) << "one per side, the second time none";
  const auto in_memory = profile_likelihood(requests, 1);
  ASSERT_TRUE(first && second);
  for (std::size_t i = 0; i < 2; ++i) {
    for (const auto& stored : {first->at(i), second->at(i)}) {
      EXPECT_EQ(stored.value, in_memory[i].value);
      EXPECT_EQ(stored.drop, in_memory[i].drop);
      EXPECT_EQ(stored.lower, in_memory[i].lower);
      EXPECT_EQ(stored.upper, in_memory[i].upper);
      EXPECT_EQ(stored.upper_found, in_memory[i].upper_found);
      EXPECT_EQ(stored.words, in_memory[i].words);
    }
  }
}

TEST(Profile, AParameterWithoutSigmaHasNone) {
  const ProfileRequest without = request(0.0, 0.0, 0.0, [](double) { return std::optional(0.0); });
  EXPECT_THROW(static_cast<void>(profile_likelihood({without}, 1)), InputError);
}

}  // namespace
}  // namespace misfit
