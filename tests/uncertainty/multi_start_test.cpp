#include "misfit/uncertainty/multi_start.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "misfit/core/error.h"
#include "misfit/math/decompositions.h"
#include "tests/model/requests.h"

namespace misfit {
namespace {

using testing::Contains;
using testing::HasSubstr;

/// A model with two curves and two free numbers, and a fit that says what it is.
struct Fitted {
  Model model;
  Fit fit;

  Fitted() {
    ModelRequest request = testing_models::parachute(false, {testing_models::effect("periodic_forcing")});
    request.parameters["frequency"].free = false;
    model = assemble(request, testing_models::registry());
    fit.method = "output_error";
    for (const char* name : {"cosine", "sine"}) {
      fit.names.emplace_back(name);
      fit.parameters[name] = {0.0, 0.1, "rad/s^2"};
    }
  }
  [[nodiscard]] int at(const char* name) const { return model.find_parameter(name); }
};

/// Two maxima: one at cosine = 0, another at cosine = 3, `higher` above it in log L; with cosine below −1.5 it cannot be run.
SearchFrom two_maxima(const Fitted& f, double higher) {
  return [&f, higher](const RandomStart& start) {
    const std::vector<double>& from = start.values;
    const auto cosine = static_cast<std::size_t>(f.at("cosine"));
    Maximum out{100.0, "", from};
    if (from[cosine] < -1.5) return Maximum{std::nullopt, "a state is no longer a number at t = 3.2 s", {}};
    const bool other = from[cosine] > 1.0;
    out.values[cosine] = other ? 3.0 : 0.0;
    if (other) out.objective = 100.0 + higher;
    return out;
  };
}

MultiStart started(const Fitted& f, double higher, std::size_t runs = 40) {
  const MultiStarts starts({f.fit, f.model, 100.0}, two_maxima(f, higher), {runs, 5});
  std::vector<ChainResult> results;
  for (std::size_t k = 0; k < starts.runs(); ++k) results.push_back(starts.run(k));
  return starts.summary(results);
}

TEST(MultiStarts, ALowerMaximumIsCountedAndNamed) {
  const MultiStart s = started({}, -7.0);
  EXPECT_EQ(s.same + s.lower + s.failed, s.runs);
  EXPECT_GT(s.same, s.lower);
  EXPECT_GT(s.lower, 0U);
  EXPECT_EQ(s.higher, 0U);
  EXPECT_TRUE(std::is_sorted(s.drop.begin(), s.drop.end()));
  EXPECT_EQ(s.drop.back(), 14.0);
  EXPECT_THAT(s.words, Contains(HasSubstr("reach a lower maximum, the nearest by 14 in 2 log L")));
  ASSERT_EQ(s.failures.size(), 1U) << "one reason, whenever it was";
  EXPECT_EQ(s.failures.begin()->first, "a state is no longer a number");
}

TEST(MultiStarts, AHigherMaximumIsSaidWithItsPlace) {
  const MultiStart s = started({}, 7.0);
  EXPECT_GT(s.higher, 0U);
  EXPECT_EQ(s.drop.front(), -14.0);
  ASSERT_EQ(s.numbers.size(), 2U);
  EXPECT_EQ(s.numbers.front().name, "cosine");
  EXPECT_EQ(s.numbers.front().best, 3.0);
  EXPECT_EQ(s.numbers.front().sigma, 0.1);
  EXPECT_THAT(s.words.front(), HasSubstr("not at the global maximum"));
  EXPECT_THAT(s.words.front(), HasSubstr("the best by 14 in 2 log L, at cosine = "));
}

TEST(MultiStarts, AHairsBreadthIsTheSameMaximum) {
  const MultiStart s = started({}, 0.4 * kSameMaximum);
  EXPECT_EQ(s.higher + s.lower, 0U);
  EXPECT_TRUE(s.words.empty());
}

TEST(MultiStarts, DependOnSeedAndNumberAlone) {
  const Fitted f;
  const MultiStarts a({f.fit, f.model, 100.0}, two_maxima(f, 1.0), {40, 5}), b({f.fit, f.model, 100.0}, two_maxima(f, 1.0), {3, 5}),
      other({f.fit, f.model, 100.0}, two_maxima(f, 1.0), {3, 6});
  EXPECT_EQ(a.run(2).numbers, b.run(2).numbers);
  EXPECT_NE(a.run(2).numbers, a.run(1).numbers);
  EXPECT_NE(a.run(2).numbers, other.run(2).numbers);
}

TEST(MultiStarts, ThatAllFailOrCannotDifferAreRefused) {
  Fitted f;
  const SearchFrom nowhere = [](const RandomStart&) { return Maximum{std::nullopt, "it cannot be run", {}}; };
  const MultiStarts starts({f.fit, f.model, 0.0}, nowhere, {2, 1});
  EXPECT_THROW(static_cast<void>(starts.summary({starts.run(0), starts.run(1)})), RunError);
  EXPECT_THROW(MultiStarts({f.fit, f.model, 0.0}, nowhere, {0, 1}), InputError);
  for (auto& p : f.model.parameters) p.free = false;
  EXPECT_THROW(MultiStarts({f.fit, f.model, 0.0}, nowhere, {2, 1}), RunError);
}

TEST(RandomStart, ScattersByTypicalSizesAndPriorsInsideTheBounds) {
  Fitted f;
  Parameter& cosine = f.model.parameters[static_cast<std::size_t>(f.at("cosine"))];
  Parameter& sine = f.model.parameters[static_cast<std::size_t>(f.at("sine"))];
  cosine.lower = -0.5 * cosine.scale;
  sine.prior_mean = 2.0;
  sine.prior_sigma = 0.1;
  std::mt19937_64 random(3);
  double lowest = 0.0, sum = 0.0, squares = 0.0;
  constexpr int draws = 2000;
  for (int k = 0; k < draws; ++k) {
    const std::vector<double> values = random_start(f.model, random).values;
    lowest = std::min(lowest, values[static_cast<std::size_t>(f.at("cosine"))]);
    const double v = values[static_cast<std::size_t>(f.at("sine"))];
    sum += v;
    squares += (v - 2.0) * (v - 2.0);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const Parameter& p = f.model.parameters[i];
      EXPECT_TRUE(p.free || values[i] == p.value) << p.name;
    }
  }
  EXPECT_EQ(lowest, cosine.lower);
  EXPECT_NEAR(sum / draws, 2.0, 0.01);
  EXPECT_NEAR(std::sqrt(squares / draws), 0.1, 0.01);
}

TEST(RandomStart, MovesTheNoiseOfEveryOutputAndOfTheForce) {
  const Fitted f;
  std::mt19937_64 random(6);
  double sum = 0.0, squares = 0.0;
  constexpr int draws = 2000;
  for (int k = 0; k < draws; ++k) {
    const std::vector<double> factors = random_start(f.model, random).noise_factors;
    ASSERT_EQ(factors.size(), static_cast<std::size_t>(f.model.outputs() + 1));
    for (const double factor : factors) {
      sum += std::log(factor);
      squares += std::log(factor) * std::log(factor);
    }
  }
  const double count = draws * (f.model.outputs() + 1.0);
  EXPECT_NEAR(sum / count, 0.0, 0.1);
  EXPECT_NEAR(std::sqrt(squares / count), 1.0, 0.05);
}

TEST(RandomStart, MovesCurvesByStraightLines) {
  const Fitted f;
  std::mt19937_64 random(4);
  const std::vector<double> values = random_start(f.model, random).values;
  ASSERT_EQ(f.model.curves.size(), 2U);
  for (const Curve& curve : f.model.curves) {
    Eigen::VectorXd moved(curve.spline.size());
    for (Eigen::Index i = 0; i < moved.size(); ++i) {
      const auto at = static_cast<std::size_t>(curve.first + i);
      moved[i] = values[at] - f.model.parameters[at].value;
    }
    const Eigen::VectorXd level = curve.spline.line(0.0, 1.0, 0.0), slope = curve.spline.line(0.0, 0.0, 1.0);
    Eigen::MatrixXd lines(moved.size(), 2);
    lines << level, slope;
    const Eigen::VectorXd rest = moved - lines * least_squares(lines, moved);
    EXPECT_GT(moved.norm(), 0.0) << curve.name;
    EXPECT_LT(rest.norm(), 1e-12) << curve.name;
  }
}

}  // namespace
}  // namespace misfit
