#include "misfit/uncertainty/bootstrap.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "misfit/core/error.h"
#include "misfit/data/curve_coefficient.h"

namespace misfit {
namespace {

constexpr double not_computed = std::numeric_limits<double>::quiet_NaN();

/// Value of a curve at x by linear interpolation, NaN outside its grid.
double value_at(const CurveEstimate& curve, double x) {
  const auto next = std::lower_bound(curve.x.begin(), curve.x.end(), x);
  if (next == curve.x.end()) return not_computed;
  const std::size_t i = next - curve.x.begin();
  if (curve.x[i] == x) return curve.value[i];
  if (i == 0) return not_computed;
  const double share = (x - curve.x[i - 1]) / (curve.x[i] - curve.x[i - 1]);
  return curve.value[i - 1] + share * (curve.value[i] - curve.value[i - 1]);
}

struct Spread {
  double mean = not_computed, sigma = not_computed, lower = not_computed, upper = not_computed;
  std::size_t runs = 0;
};

/// Order statistics at (n + 1) p, interpolated and kept inside.
double percentile(const std::vector<double>& sorted, double p) {
  const double place = std::clamp((static_cast<double>(sorted.size()) + 1.0) * p - 1.0, 0.0, static_cast<double>(sorted.size() - 1));
  const auto low = static_cast<std::size_t>(place);
  const std::size_t high = std::min(low + 1, sorted.size() - 1);
  return sorted[low] + (place - static_cast<double>(low)) * (sorted[high] - sorted[low]);
}

Spread spread_of(const std::vector<ChainResult>& results, std::size_t number) {
  std::vector<double> values;
  for (const auto& result : results) {
    if (!result.numbers.empty() && std::isfinite(result.numbers[number])) values.push_back(result.numbers[number]);
  }
  Spread out;
  out.runs = values.size();
  if (values.size() < 2) return out;
  double sum = 0.0, squares = 0.0;
  for (double v : values) sum += v;
  const auto n = static_cast<double>(values.size());
  out.mean = sum / n;
  for (double v : values) squares += (v - out.mean) * (v - out.mean);
  out.sigma = std::sqrt(squares / (n - 1.0));
  std::sort(values.begin(), values.end());
  constexpr double tail = 0.025;
  out.lower = percentile(values, tail);
  out.upper = percentile(values, 1.0 - tail);
  return out;
}

}  // namespace

BlockBootstrap::BlockBootstrap(const Fit& fit, const std::vector<Signals>& experiments, Resampled what, FitReplica refit,
                               const BootstrapOptions& options)
    : fit_(fit), options_(options), what_(what), refit_(std::move(refit)), resampler_(what, fit, experiments, options.block) {
  if (options.runs < 2) throw InputError("bootstrap: " + std::to_string(options.runs) + " runs; at least 2 are needed for a scatter");
  for (const auto& [name, estimate] : fit.parameters) {
    if (!is_curve_coefficient(name)) names_.push_back(name);
  }
  size_ = names_.size() + 1;
  for (const auto& curve : fit.curves) size_ += curve.x.size();
}

std::vector<double> BlockBootstrap::numbers_of(const Fit& fit) const {
  std::vector<double> out;
  out.reserve(size_);
  for (const auto& name : names_) {
    const auto found = fit.parameters.find(name);
    out.push_back(found == fit.parameters.end() ? not_computed : found->second.value);
  }
  out.push_back(fit.trim ? fit.trim->value : not_computed);
  for (const auto& nominal : fit_.curves) {
    const auto found = std::find_if(fit.curves.begin(), fit.curves.end(), [&](const auto& c) { return c.name == nominal.name; });
    for (double x : nominal.x) out.push_back(found == fit.curves.end() ? not_computed : value_at(*found, x));
  }
  return out;
}

ChainResult BlockBootstrap::run(std::size_t k) const {
  std::seed_seq seeds{static_cast<std::uint32_t>(options_.seed), static_cast<std::uint32_t>(options_.seed >> 32U),
                      static_cast<std::uint32_t>(k)};
  std::mt19937_64 random(seeds);
  try {
    const Fit fit = refit_(resampler_.draw(random));
    if (fit.status != FitStatus::converged) return {{}, to_string(fit.status) + ": " + fit.message};
    return {numbers_of(fit), ""};
  } catch (const RunError& error) {
    return {{}, error.what()};
  }
}

Bootstrap BlockBootstrap::summary(const std::vector<ChainResult>& results) const {
  Bootstrap out;
  out.method = fit_.method;
  out.block = resampler_.block();
  out.how = what_ == Resampled::residuals ? "residuals in blocks on the predicted motion" : "blocks of the measured samples";
  out.runs = results.size();
  out.seed = options_.seed;
  if (!resampler_.note().empty()) out.notes.push_back(resampler_.note());
  for (const auto& result : results) {
    if (!result.numbers.empty()) continue;
    ++out.failed;
    count_failure(result.failure, out.failures);
  }
  if (2 * out.failed > out.runs)
    throw RunError("bootstrap of " + out.method + ": " + std::to_string(out.failed) + " of " + std::to_string(out.runs) +
                   " runs gave no fit, most of them: " + most_frequent(out.failures) + "; these replicas say nothing of its scatter");
  std::size_t number = 0;
  const auto add = [&](const std::string& name, const Estimate& e) {
    const Spread s = spread_of(results, number++);
    out.numbers.push_back({.name = name,
                           .unit = e.unit,
                           .value = e.value,
                           .fit_sigma = e.sigma,
                           .mean = s.mean,
                           .sigma = s.sigma,
                           .lower = s.lower,
                           .upper = s.upper,
                           .runs = s.runs});
  };
  for (const auto& name : names_) add(name, fit_.parameters.at(name));
  if (fit_.trim) add("trim", *fit_.trim);
  number = names_.size() + 1;
  for (const auto& curve : fit_.curves) {
    BootstrapCurve c{curve.name, curve.of, curve.of_unit, curve.unit, curve.x, curve.value, curve.sigma, {}, {}, {}, {}, curve.count};
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      const Spread s = spread_of(results, number++);
      c.mean.push_back(s.mean);
      c.sigma.push_back(s.sigma);
      c.lower.push_back(s.lower);
      c.upper.push_back(s.upper);
    }
    out.curves.push_back(std::move(c));
  }
  return out;
}

Bootstrap block_bootstrap(const BlockBootstrap& bootstrap, int threads, const ProgressFn& progress, const std::atomic<bool>* stop) {
  std::vector<ChainResult> results(bootstrap.runs());
  if (!run_jobs(
          results.size(), threads, [&](std::size_t k) { results[k] = bootstrap.run(k); }, progress, stop))
    throw RunError("bootstrap: stopped before all runs were done");
  return bootstrap.summary(results);
}

}  // namespace misfit
