#include "misfit/discover/frequency_scan.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "misfit/math/chirp.h"
#include "misfit/math/statistics.h"

namespace misfit {
namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

double length_of(const std::vector<double>& t) { return t.empty() ? 0.0 : t.back() - t.front(); }

/// From the first sample of any experiment to the last of any.
double span_of(const SampleTimes& times) {
  double first = std::numeric_limits<double>::infinity(), last = -first;
  for (const auto& t : times) {
    if (t.empty()) continue;
    first = std::min(first, t.front());
    last = std::max(last, t.back());
  }
  return last - first;
}

double even_length(const SampleTimes& times) {
  double count = 0.0, sum = 0.0, squares = 0.0;
  for (const auto& t : times) {
    for (const double now : t) sum += now;
    count += static_cast<double>(t.size());
  }
  for (const auto& t : times) {
    for (const double now : t) squares += std::pow(now - sum / count, 2);
  }
  return std::sqrt(12.0 * squares / count);
}

/// Places of an experiment's samples among equal steps.
struct Even {
  double step = 0.0;  ///< [s]
  std::vector<Eigen::Index> place;
};

/// No places: it is not evenly sampled, or has so many gaps that the transform would be mostly zeros.
Even even_places(const std::vector<double>& t, double highest) {
  constexpr double largest_phase_error = 0.01;  // [rad]: a line loses at most its square of its power
  constexpr double max_grid_steps_per_sample = 8.0;
  Even out;
  if (t.size() < 3) return out;
  std::vector<double> steps;
  for (std::size_t k = 1; k < t.size(); ++k) steps.push_back(t[k] - t[k - 1]);
  const double usual = median(steps);
  Eigen::Index last = 0;
  std::vector<Eigen::Index> place = {0};
  for (const double h : steps) {
    last += std::llround(std::min(h / usual, 1e9));
    if (last == place.back() || static_cast<double>(last) > max_grid_steps_per_sample * static_cast<double>(steps.size())) return out;
    place.push_back(last);
  }
  const double step = length_of(t) / static_cast<double>(last);
  for (std::size_t k = 0; k < t.size(); ++k) {
    const double off = t[k] - t.front() - step * static_cast<double>(place[k]);
    if (two_pi * highest * std::abs(off) > largest_phase_error) return out;
  }
  out.step = step;
  out.place = std::move(place);
  return out;
}

using Series = Eigen::Ref<const Eigen::VectorXd>;

void add_by_transform(const Series& lambda, double start, const Even& even, const FrequencyGrid& grid, Eigen::VectorXcd& sum) {
  Eigen::VectorXd series = Eigen::VectorXd::Zero(even.place.back() + 1);
  for (Eigen::Index k = 0; k < lambda.size(); ++k) series[even.place[k]] = lambda[k];
  const Eigen::VectorXcd line = chirp_transform(series, grid.first * even.step, grid.step * even.step, sum.size());
  for (std::size_t f = 0; f < grid.count; ++f) {
    const Eigen::Index i = f;
    sum[i] += line[i] * std::polar(1.0, two_pi * grid.at(f) * start);
  }
}

/// Sample by sample: the rotation goes on from one to the next, with its cosine only where the step changes.
std::complex<double> direct_sum(const Series& lambda, const std::vector<double>& t, double omega) {
  constexpr std::size_t samples_between_exact_phases = 512;  // from time to time: the rotation gathers rounding
  std::complex<double> sum, at, turn;
  double last = -1.0;
  for (std::size_t k = 0; k < t.size(); ++k) {
    const double h = k == 0 ? 0.0 : t[k] - t[k - 1];
    if (h != last) turn = std::polar(1.0, omega * h);
    last = h;
    at = k % samples_between_exact_phases == 0 ? std::polar(1.0, omega * t[k]) : at * turn;
    sum += lambda[k] * at;
  }
  return sum;
}

}  // namespace

FrequencyGrid frequency_grid(const SampleTimes& times, double from, double to, std::size_t series) {
  FrequencyGrid grid;
  const auto longest =
      std::max_element(times.begin(), times.end(), [](const auto& a, const auto& b) { return length_of(a) < length_of(b); });
  if (longest == times.end() || !(length_of(*longest) > 0.0)) return grid;
  constexpr double furthest_apart = 64.0;  // lengths of the longest: clocks that differ by more than that share no phase
  const double span = std::min(span_of(times), furthest_apart * length_of(*longest));
  grid.step = 1.0 / (4.0 * span);
  grid.even_length = std::min(even_length(times), std::sqrt(3.0) * span);  // two short ones at both ends have that
  grid.first = std::max(from, 0.5 / length_of(*longest));                  // half a period in the record is no line but a drift
  grid.wanted = std::min(to, 0.45 * static_cast<double>(longest->size()) / length_of(*longest));
  std::size_t uneven = 0;
  for (const auto& t : times) {
    if (even_places(t, grid.wanted).place.empty()) uneven += t.size();
  }
  constexpr double max_rotations = 4e9;  // some 10 s of work
  const double affordable = max_rotations / static_cast<double>(std::max<std::size_t>(uneven * series, 1));
  grid.count = static_cast<std::size_t>(std::clamp((grid.wanted - grid.first) / grid.step, 0.0, affordable));
  return grid;
}

std::vector<double> periodogram(const Eigen::VectorXd& lambda, const SampleTimes& times, const FrequencyGrid& grid) {
  Eigen::VectorXcd sum = Eigen::VectorXcd::Zero(grid.count);
  Eigen::Index from = 0;
  for (const auto& t : times) {
    const auto own = lambda.segment(from, t.size());
    from += own.size();
    const Even even = even_places(t, grid.wanted);
    if (!even.place.empty()) {
      add_by_transform(own, t.front(), even, grid, sum);
      continue;
    }
    for (std::size_t f = 0; f < grid.count; ++f) sum[f] += direct_sum(own, t, two_pi * grid.at(f));
  }
  std::vector<double> out(grid.count);
  for (std::size_t f = 0; f < grid.count; ++f) out[f] = std::norm(sum[f]);
  return out;
}

void add_over_background(const std::vector<double>& line, std::vector<double>& power) {
  const std::size_t count = line.size(), reach = std::max<std::size_t>(40, count / 40);
  const std::size_t stride = std::max<std::size_t>(reach / 40, 1);  // the median changes slowly: straight lines between
  const auto background = [&](std::size_t f) {
    const std::ptrdiff_t from = f > reach ? f - reach : 0;
    const std::ptrdiff_t to = std::min(count, f + reach);
    return std::max(median({line.begin() + from, line.begin() + to}), 1e-300);
  };
  for (std::size_t from = 0; from < count; from += stride) {
    const std::size_t to = std::min(from + stride, count - 1);
    const double low = background(from), high = to > from ? background(to) : low;
    for (std::size_t f = from; f < std::min(from + stride, count); ++f) {
      const double share = to > from ? static_cast<double>(f - from) / static_cast<double>(to - from) : 0.0;
      power[f] += line[f] / (low + share * (high - low));
    }
  }
}

std::vector<std::size_t> strongest_lines(const std::vector<double>& power, std::size_t most) {
  std::vector<std::size_t> out;
  for (std::size_t f = 0; f < power.size(); ++f) {
    const bool rises = f == 0 || power[f] > power[f - 1], falls = f + 1 == power.size() || power[f] >= power[f + 1];
    if (rises && falls) out.push_back(f);
  }
  std::stable_sort(out.begin(), out.end(), [&](std::size_t a, std::size_t b) { return power[a] > power[b]; });
  out.resize(std::min(out.size(), most));
  return out;
}

}  // namespace misfit
