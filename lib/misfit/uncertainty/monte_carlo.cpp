#include "misfit/uncertainty/monte_carlo.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "misfit/core/error.h"
#include "misfit/jobs/ranks.h"

namespace misfit {
namespace {

/// Running mean and sum of squares about it (Welford).
class RunningMoments {
 public:
  void add(double value) {
    ++count_;
    const double before = value - mean_;
    mean_ += before / static_cast<double>(count_);
    squares_ += before * (value - mean_);
  }
  [[nodiscard]] Moments result() const {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    return {count_ > 0 ? mean_ : nan, count_ > 1 ? std::sqrt(squares_ / static_cast<double>(count_ - 1)) : nan, count_};
  }

 private:
  std::size_t count_ = 0;
  double mean_ = 0.0, squares_ = 0.0;
};

class Summary {
 public:
  Summary(const Sampler& sampler, std::size_t shared) : sampler_(sampler), shared_(shared) {}

  void add(std::size_t run, std::string_view bytes) {
    ++result_.runs;
    const ChainResult one = unpack_result(bytes);
    const std::vector<double>& numbers = one.numbers;
    if (numbers.empty()) {
      ++result_.failed;
      count_failure(one.failure, result_.failures);
      return;
    }
    if (moments_.empty()) {
      moments_.resize(numbers.size());
      regressions_.assign(std::min(shared_, numbers.size()), ShareRegression(sampler_));
    }
    if (numbers.size() != moments_.size()) throw RunError("a stored run has another number of results than the others");
    const Draw draw = sampler_.draw(run);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      if (!std::isfinite(numbers[i])) continue;
      moments_[i].add(numbers[i]);
      if (i < regressions_.size()) regressions_[i].add(draw.factors, numbers[i]);
    }
  }

  MonteCarloResult result() {
    for (const auto& m : moments_) result_.numbers.push_back(m.result());
    for (const auto& r : regressions_) result_.shares.push_back(r.shares());
    return std::move(result_);
  }

 private:
  const Sampler& sampler_;
  std::size_t shared_;
  MonteCarloResult result_;
  std::vector<RunningMoments> moments_;
  std::vector<ShareRegression> regressions_;
};

}  // namespace

std::optional<MonteCarloResult> monte_carlo(const Sampler& sampler, const Chain& chain, const MonteCarloOptions& options) {
  const auto job = [&](std::size_t run) { return pack(chain(sampler.draw(run).errors)); };
  const auto results = run_stored_jobs(options.jobs, job, options.progress, options.stop);
  if (!results) return std::nullopt;
  if (!ranks().first()) return MonteCarloResult{};
  Summary summary(sampler, options.shared);
  for (std::size_t run = 0; run < results->size(); ++run) summary.add(run, results->result(run));
  MonteCarloResult out = summary.result();
  if (out.failed < out.runs) return out;
  const std::string& most = most_frequent(out.failures);
  throw RunError("all " + std::to_string(out.runs) + " runs failed, " + std::to_string(out.failures.at(most)) + " of them: " + most);
}

}  // namespace misfit
