#include "misfit/discover/wave_scan.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

namespace misfit {
namespace {

constexpr double pi = std::numbers::pi;

double sinc(double half_turns) {
  const double angle = pi * half_turns;
  constexpr double flat = 1e-4;  // below: 1 to 2e-9
  return std::abs(angle) < flat ? 1.0 : std::sin(angle) / angle;
}

/// Of the steps that move, a tenth moves by less.
double moved_in_slow_steps(const Course& course) {
  constexpr std::size_t part = 10;
  std::vector<double> moved;
  for (const double by : course.moved) {
    if (by != 0.0) moved.push_back(std::abs(by));
  }
  if (moved.empty()) return std::numeric_limits<double>::infinity();
  const auto tenth = moved.begin() + static_cast<std::ptrdiff_t>(moved.size() / part);
  std::nth_element(moved.begin(), tenth, moved.end());
  return *tenth;
}

}  // namespace

Course course_of(const FilterEstimate& estimate, const ForceSensitivity& force, int quantity, bool integrated) {
  const Eigen::VectorXd start = force.quantities().col(quantity), end = force.quantities_ahead().col(quantity);
  Course out{Eigen::VectorXd::Zero(start.size()), Eigen::VectorXd::Zero(start.size())};
  Eigen::Index from = 0;
  for (std::size_t e = 0; e < estimate.traces.size(); ++e) {
    const Eigen::Index last = from + static_cast<Eigen::Index>(estimate.traces[e].samples) - 1;
    const Eigen::Index first = from + static_cast<Eigen::Index>(estimate.data[e].first);
    double way = 0.0;
    for (Eigen::Index k = first; k < last; ++k) {
      const double middle = 0.5 * (start[k] + end[k]), step = force.times()[k + 1] - force.times()[k];
      out.moved[k] = integrated ? step * middle : end[k] - start[k];
      out.middle[k] = integrated ? way + 0.5 * out.moved[k] : middle;
      way += out.moved[k];
    }
    if (first < last) {  // no steps: there the score is 0
      out.middle.segment(from, first - from).setConstant(out.middle[first]);
      out.middle[last] = out.middle[last - 1];
    }
    from = last + 1;
  }
  return out;
}

FrequencyGrid wave_grid(const Course& course, double least, double most, std::size_t series) {
  FrequencyGrid grid;
  const double way = course.middle.size() > 0 ? course.middle.maxCoeff() - course.middle.minCoeff() : 0.0;
  if (!(way > 0.0) || !std::isfinite(way)) return grid;
  constexpr double most_of_a_wave = 0.45;
  const double slow = moved_in_slow_steps(course);
  grid.step = 1.0 / (4.0 * way);
  grid.first = least / way;
  grid.wanted = std::min(most / way, most_of_a_wave / slow);
  const double variance = (course.middle.array() - course.middle.mean()).square().mean();
  grid.even_length = std::sqrt(12.0 * variance);
  constexpr double max_terms = 1e8;  // some 5 s of work
  const double affordable =
      max_terms / static_cast<double>(static_cast<std::size_t>(course.moved.size()) * std::max<std::size_t>(series, 1));
  grid.count = static_cast<std::size_t>(std::clamp((grid.wanted - grid.first) / grid.step, 0.0, affordable));
  return grid;
}

std::vector<double> wave_power(const Eigen::VectorXd& lambda, const Course& course, const FrequencyGrid& grid) {
  std::vector<double> out(grid.count);
  for (std::size_t f = 0; f < grid.count; ++f) {
    const double waves = grid.at(f);
    std::complex<double> sum;
    for (Eigen::Index k = 0; k < lambda.size(); ++k)
      sum += lambda[k] * sinc(waves * course.moved[k]) * std::polar(1.0, 2.0 * pi * waves * course.middle[k]);
    out[f] = std::norm(sum);
  }
  return out;
}

}  // namespace misfit
