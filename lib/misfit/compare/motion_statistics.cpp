#include "misfit/compare/motion_statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "misfit/core/display.h"
#include "misfit/core/text.h"
#include "misfit/core/units.h"

namespace misfit {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr std::array<double, 13> shares{0.01, 0.025, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 0.8, 0.9, 0.95, 0.975, 0.99};
constexpr std::size_t min_samples = 20;  // samples that a statistic needs

std::vector<double> finite_sorted(const std::vector<double>& values) {
  std::vector<double> out;
  for (double v : values) {
    if (std::isfinite(v)) out.push_back(v);
  }
  std::sort(out.begin(), out.end());
  return out;
}

/// Linear between order statistics; NaN if there is none.
double quantile(const std::vector<double>& sorted, double share) {
  if (sorted.empty()) return nan;
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto low = static_cast<std::size_t>(place);
  const std::size_t high = std::min(low + 1, sorted.size() - 1);
  return sorted[low] + (place - static_cast<double>(low)) * (sorted[high] - sorted[low]);
}

struct Moments {
  double mean = nan, sd = nan;
};
Moments moments(const std::vector<double>& values) {
  if (values.empty()) return {};
  double sum = 0.0, squares = 0.0;
  for (double v : values) sum += v;
  const double n = static_cast<double>(values.size()), mean = sum / n;
  for (double v : values) squares += (v - mean) * (v - mean);
  return {mean, std::sqrt(squares / n)};
}

/// Autocovariance at lags 0 … `most`, mean removed; NaN where no pair of samples is that far apart.
std::vector<double> autocovariance(std::vector<double> x, std::size_t most) {
  const double mean = moments(finite_sorted(x)).mean;
  std::vector<double> known(x.size(), 0.0);
  for (std::size_t i = 0; i < x.size(); ++i) {
    known[i] = std::isfinite(x[i]) ? 1.0 : 0.0;
    x[i] = known[i] > 0.0 ? x[i] - mean : 0.0;
  }
  std::vector<double> out;
  for (std::size_t lag = 0; lag <= most && lag < x.size(); ++lag) {
    double sum = 0.0, pairs = 0.0;
    for (std::size_t i = 0; i + lag < x.size(); ++i) {
      sum += x[i] * x[i + lag];
      pairs += known[i] * known[i + lag];
    }
    out.push_back(pairs > 0.0 ? sum / pairs : nan);
  }
  return out;
}

double parzen(double share) {
  return share <= 0.5 ? 1.0 - 6.0 * share * share * (1.0 - share) : 2.0 * (1.0 - share) * (1.0 - share) * (1.0 - share);
}

std::vector<double> spectrum(const std::vector<double>& covariance, const MotionScales& scales) {
  std::vector<double> out;
  for (double f : scales.frequencies) {
    double sum = covariance.front();
    for (std::size_t k = 1; k < covariance.size(); ++k) {
      if (!std::isfinite(covariance[k])) continue;
      const double share = static_cast<double>(k) / static_cast<double>(covariance.size());
      sum += 2.0 * parzen(share) * covariance[k] * std::cos(2.0 * std::numbers::pi * f * scales.step * static_cast<double>(k));
    }
    out.push_back(sum > 0.0 ? 10.0 * std::log10(sum * scales.step) : nan);
  }
  return out;
}

std::vector<double> distribution(const std::vector<double>& values) {
  const std::vector<double> sorted = finite_sorted(values);
  const Moments m = moments(sorted);
  std::vector<double> out{m.mean, m.sd};
  for (double share : shares) out.push_back(sorted.size() < min_samples ? nan : quantile(sorted, share));
  return out;
}

std::vector<double> amplitude(const std::vector<double>& values, std::size_t window) {
  std::vector<double> halves;
  for (std::size_t from = 0; from + window <= values.size(); from += window) {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    double low = infinite, high = -infinite;
    std::size_t known = 0;
    for (std::size_t i = from; i < from + window; ++i) {
      if (!std::isfinite(values[i])) continue;
      low = std::min(low, values[i]);
      high = std::max(high, values[i]);
      ++known;
    }
    if (2 * known >= window && known > 1) halves.push_back(0.5 * (high - low));
  }
  std::sort(halves.begin(), halves.end());
  return {moments(halves).mean, quantile(halves, 0.1), quantile(halves, 0.9)};
}

std::string name_of_share(double share) { return fmt::format("{:g} % quantile", 100.0 * share); }

/// The groups with names and places, without numbers.
std::vector<MotionGroup> empty_groups(const MotionPath& path, const MotionScales& scales) {
  std::vector<MotionGroup> out{{"distribution", path.unit, {{"mean", nan}, {"standard deviation", nan}}}};
  for (double share : shares) out.back().numbers.push_back({name_of_share(share), share});
  if (scales.spread_only) return out;
  out.push_back({"amplitude", path.unit, {{"mean", nan}, {"10 % quantile", 0.1}, {"90 % quantile", 0.9}}});
  out.push_back({"autocorrelation", "-", {}});
  for (std::size_t lag : scales.lags) out.back().numbers.push_back({"lag", scales.step * static_cast<double>(lag)});
  out.push_back({"spectrum", "dB", {}});  // of the two-sided density in unit²/Hz
  for (double f : scales.frequencies) out.back().numbers.push_back({"power", f});
  return out;
}

/// Adds to each motion's distance what one number says; motions without the number are passed over.
void add_distances(const std::vector<double>& values, std::vector<double>& distances) {
  const Moments all = moments(finite_sorted(values));
  double n = 0.0, sum = 0.0, squares = 0.0;  // about the mean of all
  for (double v : values) {
    if (!std::isfinite(v)) continue;
    n += 1.0;
    sum += v - all.mean;
    squares += (v - all.mean) * (v - all.mean);
  }
  if (n < 3.0) return;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) continue;
    const double own = values[i] - all.mean, mean = (sum - own) / (n - 1.0);
    const double variance = (squares - own * own) / (n - 1.0) - mean * mean;
    if (variance > 0.0) distances[i] += (own - mean) * (own - mean) / variance;
  }
}

/// Share of motions at least as far as the first.
double rank_p_value(const std::vector<double>& distances) {
  const auto as_far = std::count_if(distances.begin(), distances.end(), [&](double d) { return d >= distances.front(); });
  return static_cast<double>(as_far) / static_cast<double>(distances.size());
}

/// The number that is furthest outside its band, in words.
std::string worst_of(const MotionGroup& group) {
  const MotionNumber* worst = nullptr;
  double most = 0.0;
  for (const MotionNumber& n : group.numbers) {
    const double away = std::abs(n.measured - n.median) / std::max(n.high - n.low, 1e-300);
    if (!n.outside || !(away > most)) continue;
    most = away;
    worst = &n;
  }
  if (worst == nullptr) return "no single number lies outside its band";
  std::string name = "its " + worst->name;
  if (worst->name == "lag") name = fmt::format("at a lag of {:.2g} s it", worst->at);
  if (worst->name == "power") name = fmt::format("the power at {:.2g} Hz", worst->at);
  const bool level = is_level(group, *worst);
  const auto displayed = [&](double value) { return level ? display_level(value, group.unit) : display_value(value, group.unit); };
  const double step = 0.01 * (displayed(worst->high) - displayed(worst->low));
  const auto shown = [&](double value) {
    const std::string number = step > 0.0 ? format_to_step(displayed(value), step) : format_value(displayed(value));
    return level ? with_level_unit(number, group.unit) : with_display_unit(number, group.unit);
  };
  return name + " is " + shown(worst->measured) + ", simulated between " + shown(worst->low) + " and " + shown(worst->high);
}

}  // namespace

MotionScales scales_of(const MotionPath& measured, double step) {
  MotionScales out;
  out.step = step;
  out.spread_only = measured.spread_only;
  const std::size_t samples = measured.values.size(), longest = std::max<std::size_t>(samples / 6, 2);
  const std::vector<double> r = autocovariance(measured.values, longest);
  const auto crossing = std::find_if(r.begin(), r.end(), [](double v) { return v <= 0.0; });
  const auto quarter = std::max<std::size_t>(crossing - r.begin(), 1);
  out.period = std::max<std::size_t>(4 * quarter, 2);
  const std::size_t most = std::clamp<std::size_t>(3 * out.period, 2, longest);
  constexpr std::size_t points = 30;
  for (std::size_t k = 1; k <= points; ++k) {
    const std::size_t lag = std::max<std::size_t>(1, most * k / points);
    if (out.lags.empty() || lag > out.lags.back()) out.lags.push_back(lag);
  }
  const double rate = 1.0 / step, main = rate / static_cast<double>(out.period);
  const double highest = std::min(10.0 * main, 0.45 * rate);
  for (std::size_t k = 1; k <= points; ++k) out.frequencies.push_back(highest * static_cast<double>(k) / static_cast<double>(points));
  return out;
}

MotionNumbers motion_numbers(const MotionPath& path, const MotionScales& scales) {
  MotionNumbers out{distribution(path.values)};
  if (scales.spread_only) return out;
  out.push_back(amplitude(path.values, scales.period));
  const std::vector<double> r = autocovariance(path.values, scales.lags.back());
  std::vector<double> correlation;
  for (std::size_t lag : scales.lags) correlation.push_back(lag < r.size() && r.front() > 0.0 ? r[lag] / r.front() : nan);
  out.push_back(std::move(correlation));
  out.push_back(spectrum(r, scales));
  return out;
}

MotionSeries compare_motion(const MotionPath& measured, const MotionScales& scales, const std::vector<MotionNumbers>& simulated,
                            MotionDistances& distances) {
  const MotionNumbers numbers = motion_numbers(measured, scales);
  MotionSeries out{"", measured.name, measured.unit, {}};
  constexpr double edge = 0.025;
  std::vector<MotionGroup> groups = empty_groups(measured, scales);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    MotionGroup& group = groups[g];
    std::vector<double> of_group(simulated.size() + 1, 0.0);
    for (std::size_t j = 0; j < group.numbers.size(); ++j) {
      MotionNumber& n = group.numbers[j];
      std::vector<double> motions{numbers[g][j]};
      for (const auto& run : simulated) motions.push_back(run[g][j]);
      if (std::isfinite(motions.front())) add_distances(motions, of_group);
      const std::vector<double> runs = finite_sorted({motions.begin() + 1, motions.end()});
      n.measured = motions.front();
      n.low = quantile(runs, edge);
      n.median = quantile(runs, 0.5);
      n.high = quantile(runs, 1.0 - edge);
      n.outside = n.measured < n.low || n.measured > n.high;
    }
    if (std::none_of(group.numbers.begin(), group.numbers.end(), is_known)) continue;
    group.p_value = rank_p_value(of_group);
    out.groups.push_back(std::move(group));
    distances.push_back(std::move(of_group));
  }
  return out;
}

double overall_p_value(const MotionDistances& distances) {
  if (distances.empty()) return 1.0;
  std::vector<double> largest(distances.front().size(), -std::numeric_limits<double>::infinity());
  for (const auto& group : distances) {
    std::vector<double> logs;
    for (double d : group) logs.push_back(std::log(std::max(d, 1e-12)));
    const Moments m = moments(logs);
    for (std::size_t i = 0; i < logs.size(); ++i) largest[i] = std::max(largest[i], m.sd > 0.0 ? (logs[i] - m.mean) / m.sd : 0.0);
  }
  return rank_p_value(largest);
}

void conclude_motion(SimulatedMotion& motion) {
  constexpr double significant = 0.01 + 1e-9;
  std::size_t groups = 0, numbers = 0, outside = 0;
  std::vector<std::string> departing;
  for (const MotionSeries& s : motion.series) {
    for (const MotionGroup& g : s.groups) {
      ++groups;
      numbers += std::count_if(g.numbers.begin(), g.numbers.end(), is_known);
      outside += std::count_if(g.numbers.begin(), g.numbers.end(), [](const MotionNumber& n) { return n.outside; });
      if (g.p_value <= significant)
        departing.push_back(fmt::format("the {} of {} ({}): {}; {}", g.name, s.name, s.experiment, p_equals(g.p_value), worst_of(g)));
    }
  }
  if (groups == 0) return;
  if (motion.p_value <= significant) {
    motion.sentences.push_back(
        fmt::format("the fitted model does not reproduce the statistics of the measured motion: {} over {} groups of statistics of {} "
                    "simulated motions",
                    p_in_words(motion), groups, motion.runs));
    motion.sentences.insert(motion.sentences.end(), departing.begin(), departing.end());
  } else {
    motion.sentences.push_back(fmt::format(
        "no difference between the statistics of the measured and the simulated motion is significant at 1 %: {} over {} groups "
        "of statistics",
        p_in_words(motion), groups));
  }
  motion.sentences.push_back(
      fmt::format("{} of {} statistics lie outside the 95 % band of the simulated motions; about {:.0f} would by chance", outside, numbers,
                  0.05 * static_cast<double>(numbers)));
}

}  // namespace misfit
