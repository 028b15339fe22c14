#include "misfit/uncertainty/multi_start.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "misfit/core/display.h"
#include "misfit/core/error.h"
#include "misfit/core/text.h"

namespace misfit {
namespace {

double inside(const Parameter& p, double value) { return std::clamp(value, p.lower, p.upper); }

/// What the counts say, a higher maximum first.
std::vector<std::string> words_of(const MultiStart& s) {
  std::vector<std::string> words;
  if (s.higher > 0) {
    std::string there;
    for (const auto& n : s.numbers) there += (there.empty() ? "" : ", ") + n.name + " = " + in_display_unit(n.best, n.unit, 0.0);
    words.push_back(
        fmt::format("the fit is not at the global maximum: {} of {} starts reach a higher one, the best by {} in 2 log L{}. Start from "
                    "these values in [parameters]",
                    s.higher, s.runs, format_value(-s.drop.front()), there.empty() ? "" : ", at " + there));
  }
  if (s.lower > 0) {
    const double nearest = s.drop[s.drop.size() - s.lower];
    words.push_back(fmt::format("{} of {} starts reach a lower maximum, the nearest by {} in 2 log L: a fit started there would stay there",
                                s.lower, s.runs, format_value(nearest)));
  }
  if (s.same == 0) words.emplace_back("no random start reaches the reported maximum");
  return words;
}

}  // namespace

RandomStart random_start(const Model& model, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  std::vector<double> values = model.values();
  for (const Curve& curve : model.curves) {
    const double middle = 0.5 * (curve.spline.lowest() + curve.spline.highest()), half = curve.spline.highest() - middle;
    const double level = curve.scale * normal(random), rise = curve.scale * normal(random);
    const Eigen::VectorXd line = curve.spline.line(middle, level, rise / half);
    for (Eigen::Index i = 0; i < line.size(); ++i) {
      const Eigen::Index at = curve.first + i;
      if (model.parameters[at].free) values[at] = inside(model.parameters[at], values[at] + line[i]);
    }
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Parameter& p = model.parameters[i];
    if (!p.free || p.curve >= 0) continue;
    values[i] = inside(p, p.prior_sigma ? p.prior_mean + *p.prior_sigma * normal(random) : p.value + p.scale * normal(random));
  }
  std::vector<double> noise_factors;
  for (int i = 0; i <= model.outputs(); ++i) noise_factors.push_back(std::exp(normal(random)));
  return {std::move(values), std::move(noise_factors)};
}

MultiStarts::MultiStarts(const FoundMaximum& found, SearchFrom search, const MultiStartOptions& options)
    : fit_(found.fit), best_(found.model), objective_(found.objective), search_(std::move(search)), options_(options) {
  if (options.runs == 0) throw InputError("starts: 0 of them; at least 1 is needed");
  const std::vector<int> free = best_.free_parameters();
  if (free.empty()) throw RunError("starts: every parameter is fixed, so every start is the same");
  std::copy_if(free.begin(), free.end(), std::back_inserter(shown_), [&](int i) { return best_.parameters[i].curve < 0; });
}

ChainResult MultiStarts::run(std::size_t k) const {
  std::seed_seq seeds{static_cast<std::uint32_t>(options_.seed), static_cast<std::uint32_t>(options_.seed >> 32U),
                      static_cast<std::uint32_t>(k)};
  std::mt19937_64 random(seeds);
  const Maximum end = search_(random_start(best_, random));
  if (!end.objective || !std::isfinite(*end.objective))  // when it ended is each start's own
    return {{}, end.why.empty() ? "its likelihood is not finite" : end.why.substr(0, end.why.find(" at t ="))};
  ChainResult out{{2.0 * (objective_ - *end.objective)}, ""};
  for (const int i : shown_) out.numbers.push_back(end.values[i]);
  return out;
}

MultiStart MultiStarts::summary(const std::vector<ChainResult>& results) const {
  MultiStart out;
  out.method = fit_.method;
  out.runs = results.size();
  out.seed = options_.seed;
  const ChainResult* best = nullptr;
  for (const auto& result : results) {
    if (result.numbers.empty()) {
      ++out.failed;
      count_failure(result.failure, out.failures);
      continue;
    }
    out.drop.push_back(result.numbers.front());
    if (best == nullptr || result.numbers.front() < best->numbers.front()) best = &result;
  }
  if (best == nullptr) throw RunError(fmt::format("starts: none of {} gave a fit; most often: {}", out.runs, most_frequent(out.failures)));
  std::sort(out.drop.begin(), out.drop.end());
  for (const double drop : out.drop) ++(drop < -kSameMaximum ? out.higher : drop > kSameMaximum ? out.lower : out.same);
  for (std::size_t i = 0; i < shown_.size(); ++i) {
    const Parameter& p = best_.parameters[shown_[i]];
    const auto known = fit_.parameters.find(p.name);
    out.numbers.push_back({p.name, p.unit, p.value, known == fit_.parameters.end() ? 0.0 : known->second.sigma, best->numbers[i + 1]});
  }
  out.words = words_of(out);
  return out;
}

}  // namespace misfit
