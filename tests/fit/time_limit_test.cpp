// Fits that a limit of time cuts off. Whoever hears of the search cuts it off, after a given number of iterations: the tests do not depend
// on how fast the machine is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <tuple>

#include "misfit/core/watch.h"
#include "misfit/fit/filter/filter_error.h"
#include "misfit/fit/methods.h"
#include "misfit/fit/shooting/output_error.h"
#include "tests/fit/decay.h"
#include "tests/fit/flight.h"

namespace misfit {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

constexpr const char* limit_of_20_s = "the time limit of 20 s for this search was spent";

/// Cuts off what is searched for while it lives, as soon as `iterations` have been heard of; 0: at once.
class CutOff {
 public:
  explicit CutOff(int iterations)
      : iterations_(iterations), watch_("this search", iterations > 0 ? 0.0 : 1e-9, [this](const SearchState& state) { hear(state); }) {}
  [[nodiscard]] int heard() const { return heard_; }
  [[nodiscard]] double value() const { return value_; }

 private:
  void hear(const SearchState& state) {
    value_ = state.value;
    if (++heard_ >= iterations_) throw TimeLimitReached(limit_of_20_s);
  }

  int iterations_, heard_ = 0;
  double value_ = 0.0;
  Watch watch_;
};

/// A flight with its model.
struct Flight {
  std::vector<Signals> signals;
  Model model;
  explicit Flight(double seconds)
      : signals{testing_flight::fly(seconds, 3)}, model(assemble(testing_flight::request_for(signals), testing_flight::registry())) {}
  [[nodiscard]] FilterErrorFit fit() const {
    FilterOptions options;
    options.threads = 1;
    return filter_error(std::vector<FilterStart>{{model, curve_penalties(model)}}, signals, options);
  }
};

TEST(TimeLimit, FilterErrorEndsWithItsBestPoint) {
  const Flight flight(8.0);
  const FilterErrorFit whole = flight.fit();
  ASSERT_EQ(whole.fit.status, FitStatus::converged) << whole.fit.message;
  double before = -std::numeric_limits<double>::infinity();
  for (const int iterations : {1, 4}) {
    std::optional<CutOff> cut(std::in_place, iterations);
    const FilterErrorFit fit = flight.fit();
    EXPECT_EQ(cut->heard(), iterations) << "it went on";
    const double heard = cut->value();
    cut.reset();
    ASSERT_TRUE(fit.estimate);
    EXPECT_TRUE(fit.estimate->out_of_time);
    EXPECT_EQ(fit.fit.status, FitStatus::not_converged);
    EXPECT_THAT(fit.fit.message, StartsWith(std::string(limit_of_20_s) + " at a log-likelihood of "));
    EXPECT_THAT(fit.fit.message, HasSubstr("--time-limit"));
    EXPECT_NEAR(fit.fit.loglik.value(), heard, 1e-6 * std::abs(heard)) << "it is the point that was heard of last";
    EXPECT_LT(*fit.fit.loglik, *whole.fit.loglik);
    EXPECT_GT(*fit.fit.loglik, before);
    EXPECT_FALSE(fit.fit.predictions.empty());
    EXPECT_TRUE(fit.fit.trim.has_value());
    before = *fit.fit.loglik;
  }
}

TEST(TimeLimit, AFilterThatWasNeverRunFails) {
  const Flight flight(8.0);
  const CutOff cut(0);
  const FilterErrorFit fit = flight.fit();
  EXPECT_FALSE(fit.estimate);
  EXPECT_EQ(fit.fit.status, FitStatus::failed);
  EXPECT_THAT(fit.fit.message, HasSubstr("before there was any result"));
}

TEST(TimeLimit, WithoutOneTheFitIsTheSameToTheBit) {
  const Flight flight(4.0);
  const Fit alone = flight.fit().fit;
  const Watch watch("this search", 1e6, [](const SearchState&) {});
  const Fit watched = flight.fit().fit;
  EXPECT_EQ(alone.loglik, watched.loglik);
  for (const auto& [name, estimate] : alone.parameters) EXPECT_EQ(estimate.value, watched.parameters.at(name).value) << name;
}

/// A decay begun far from its rate.
struct Decay {
  std::vector<Signals> signals{testing_decay::decay(200, 5)};
  std::shared_ptr<Registry> known = testing_models::registry_with(testing_decay::decay_text);
  Model model = assemble(testing_models::request_of("text"), *known);
  Decay() { model.parameters[static_cast<std::size_t>(model.find_parameter("a"))].value = 30.0; }
  [[nodiscard]] FittedModel fit() const {
    OutputErrorStart start;
    start.from_regression = false;
    return output_error({{}, model, curve_penalties(model), {}}, signals, start);
  }
};

TEST(TimeLimit, OutputErrorEndsWithItsBestPoint) {
  const Decay decay;
  const Fit whole = decay.fit().fit;
  ASSERT_EQ(whole.status, FitStatus::converged) << whole.message;
  EXPECT_THAT(whole.facts.at("integration"), HasSubstr("no estimate would move by more than"));
  for (const int iterations : {1, 2, 5}) {
    const CutOff cut(iterations);
    const Fit fit = decay.fit().fit;
    EXPECT_EQ(cut.heard(), iterations) << "it went on";
    EXPECT_EQ(fit.status, FitStatus::not_converged) << fit.message;
    EXPECT_THAT(fit.message, StartsWith(std::string(limit_of_20_s) + " at a sum of squares of "));
    EXPECT_TRUE(fit.parameters.contains("a"));
    EXPECT_FALSE(fit.predictions.empty());
    EXPECT_THAT(fit.facts.at("integration"), HasSubstr("not checked at the estimate"));
  }
}

TEST(TimeLimit, OutputErrorThatWasNeverRunKeepsItsStart) {
  const Decay decay;
  const CutOff cut(0);
  const Fit fit = decay.fit().fit;
  EXPECT_NE(fit.status, FitStatus::converged);
  EXPECT_THAT(fit.message, StartsWith("the time limit of 1e-09 s for this search was spent"));
}

TEST(TimeLimit, AnInterruptEndsAFitWithoutAResult) {
  const Decay decay;
  const Watch watch("this search", 0.0, [](const SearchState& state) { interrupted() = state.iteration == 2; });
  EXPECT_THROW(std::ignore = decay.fit(), Interrupted);
  interrupted() = false;
}

TEST(TimeLimit, ARefitThatIsCutOffIsAFailureInWords) {
  const Decay decay;
  FittedMethod from{estimators::output_error.name, decay.fit(), {}, {}, {}};
  EXPECT_EQ(fit_again(from, decay.signals).status, FitStatus::converged);
  from.time_limit = 1e-9;
  const Fit cut = fit_again(from, decay.signals);
  EXPECT_EQ(cut.status, FitStatus::failed);
  EXPECT_EQ(cut.message, "the time limit of 1e-09 s for a refit by output_error was spent");
  const Maximisation maximum = maximise_near(from, decay.signals);
  EXPECT_FALSE(maximum.objective);
  EXPECT_EQ(maximum.why, "the time limit of 1e-09 s for a search by output_error was spent");
}

}  // namespace
}  // namespace misfit
