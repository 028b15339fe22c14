#include "misfit/fit/regression/window_search.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "misfit/inference/states.h"

namespace misfit {
namespace {

/// Values in sigmas from their mean; constant ones: 0.
std::vector<double> standard(const std::vector<double>& values, const MeanAndSigma& spread) {
  std::vector<double> out;
  out.reserve(values.size());
  for (const double v : values) out.push_back(spread.constant() ? 0.0 * v : (v - spread.mean) / spread.sigma);
  return out;
}

/// The last known value where one is missing, 0 before the first; of a smooth driver the mean over the interval to the next sample.
Eigen::VectorXd known_everywhere(std::vector<double> values, bool smooth) {
  double last = 0.0;
  for (double& v : values) last = v = std::isfinite(v) ? v : last;
  for (std::size_t k = 0; smooth && k + 1 < values.size(); ++k) values[k] = 0.5 * (values[k] + values[k + 1]);
  return Eigen::Map<const Eigen::VectorXd>(values.data(), std::ssize(values));
}

/// Means over `count` rows each.
std::vector<double> thinned(const std::vector<double>& values, std::size_t count) {
  if (count <= 1) return values;
  std::vector<double> out;
  for (std::size_t k = 0; k + count <= values.size(); k += count) {
    double sum = 0.0;
    for (std::size_t i = k; i < k + count; ++i) sum += values[i];
    out.push_back(sum / static_cast<double>(count));
  }
  return out;
}

std::vector<double> spaced(double from, double to, int count) {
  std::vector<double> out;
  for (int i = 0; i < count; ++i) out.push_back(from * std::pow(to / from, static_cast<double>(i) / (count - 1)));
  return out;
}

/// Poles with the least mean square, and their mean square elsewhere.
struct Tried {
  double least = HUGE_VAL, elsewhere = 0.0;
  Poles poles;

  void take(const Poles& tried, const SquaresForm& fitted, const SquaresForm& held_out, const std::vector<Eigen::Index>& terms) {
    const Eigen::VectorXd solved = fitted.solve(terms);
    const double own = fitted.mean_square(solved);
    if (!(own < least)) return;
    *this = {own, held_out.mean_square(solved), tried};
  }
};

}  // namespace

WindowSearch::WindowSearch(const std::vector<double>& t, const std::vector<double>& y, std::vector<GuessDriver> drivers, int lengthened)
    : drivers_(std::move(drivers)), target_(mean_and_sigma(y)), lengthened_(lengthened) {
  constexpr std::size_t longest = 4000;
  if (target_.constant() || y.size() < 3) return;
  const std::size_t together = window_length(standard(y, target_)) / longest + 1;
  record_.t = thinned(t, together);
  record_.y = thinned(standard(y, target_), together);
  record_.drivers.resize(std::ssize(record_.t), std::ssize(drivers_));
  for (std::size_t i = 0; i < drivers_.size(); ++i) {
    const MeanAndSigma spread = mean_and_sigma(drivers_[i].values);
    const Eigen::VectorXd all = known_everywhere(standard(drivers_[i].values, spread), drivers_[i].smooth);
    const std::vector<double> mean = thinned({all.begin(), all.end()}, together);
    record_.drivers.col(static_cast<Eigen::Index>(i)) = Eigen::Map<const Eigen::VectorXd>(mean.data(), record_.drivers.rows());
    spreads_.push_back(spread);
  }
  std::vector<double> steps;
  for (std::size_t k = 1; k < record_.t.size(); ++k) steps.push_back(record_.t[k] - record_.t[k - 1]);
  record_.step = median(steps);
  length_ = static_cast<std::size_t>(lengthened) * window_length(record_.y);
  record_.windows = windows_of(record_.t, record_.step, length_);
  const double sigma = measurement_noise(record_.y);
  noise_ = std::isfinite(sigma) ? sigma * sigma : 0.0;
}

WindowSearch::Fits WindowSearch::on_grid(int order, bool pulled) const {
  const double window = record_.step * static_cast<double>(length_);
  const std::vector<double> rates = spaced(0.05 / window, 1.5 / record_.step, 28);
  Fits out;
  if (order == 1) {
    if (!pulled) out.push_back(squares_of(record_, {1, 0.0, 0.0}));
    for (const double rate : rates) {
      if (pulled) out.push_back(squares_of(record_, {1, 0.0, rate}));
    }
    return out;
  }
  if (!pulled) {
    out.push_back(squares_of(record_, {2, 0.0, 0.0}));
    for (const double rate : rates) out.push_back(squares_of(record_, {2, 0.0, rate}));
    return out;
  }
  const double swing = 4.0 * std::numbers::pi / (record_.step * static_cast<double>(window_length(record_.y)));
  for (const double omega : spaced(0.25 * swing, std::min(8.0 * swing, 1.0 / record_.step), 15)) {
    for (const double zeta : {0.01, 0.05, 0.15, 0.35, 0.7, 1.1, 2.0, 4.0})
      out.push_back(squares_of(record_, {2, omega * omega, 2.0 * zeta * omega}));
  }
  return out;
}

/// The poles by all windows; the error over either half of them with what the other half gives, poles included.
Found WindowSearch::best_of(const Fits& fits, const std::vector<Eigen::Index>& terms) const {
  Tried one, other, all;
  for (const FittedAndHeldOut& fit : fits) {
    one.take(fit.poles, fit.fitted, fit.held_out, terms);
    other.take(fit.poles, fit.held_out, fit.fitted, terms);
    SquaresForm both = fit.fitted;
    both += fit.held_out;
    all.take(fit.poles, both, both, terms);
  }
  return {terms, all.poles, 0.5 * (one.elsewhere + other.elsewhere)};
}

bool WindowSearch::is_output(Eigen::Index term) const { return term < std::ssize(drivers_) && drivers_[term].output; }

bool WindowSearch::any_output(const std::vector<Eigen::Index>& terms) const {
  return std::any_of(terms.begin(), terms.end(), [this](Eigen::Index term) { return is_output(term); });
}

/// The share of the error without it that a driver which is in the model leaves at most. An input beside another output that drives the
/// model makes up for the noise of that one.
double WindowSearch::most_with(Eigen::Index term, const std::vector<Eigen::Index>& others) const {
  if (is_output(term)) return 0.5;
  return any_output(others) ? clearly : 0.95;
}

void WindowSearch::add_drivers(const Fits& fits, bool outputs, Found& found) const {
  for (;;) {
    std::optional<Found> best;
    for (std::size_t i = 0; i < drivers_.size(); ++i) {
      const Eigen::Index term = i;
      if (spreads_[i].constant()) continue;
      if (drivers_[i].output != outputs || std::find(found.terms.begin(), found.terms.end(), term) != found.terms.end()) continue;
      std::vector<Eigen::Index> terms = found.terms;
      terms.push_back(term);
      const Found with = best_of(fits, terms);
      if (!best || with.mean_square < best->mean_square) best = with;
    }
    if (!best) return;
    const bool first = !outputs && found.terms.size() == 1;
    if (!first && !(excess(best->mean_square) < most_with(best->terms.back(), found.terms) * excess(found.mean_square))) return;
    found = *best;
  }
}

/// What is not needed any more once another driver is there.
void WindowSearch::drop_drivers(const Fits& fits, Found& found) const {
  for (std::size_t i = 1; i < found.terms.size() && found.terms.size() > 2;) {
    if (drivers_[found.terms[i]].named) {
      ++i;
      continue;
    }
    std::vector<Eigen::Index> terms = found.terms;
    terms.erase(terms.begin() + i);
    const Found without = best_of(fits, terms);
    if (excess(found.mean_square) < most_with(found.terms[i], terms) * excess(without.mean_square)) {
      ++i;
    } else {
      found = without;
    }
  }
}

/// Finer poles about the best ones.
void WindowSearch::refine(Found& found) const {
  for (double factor = 1.15; factor > 1.01; factor = std::sqrt(factor)) {
    Fits around;
    for (const double s : {1.0 / (factor * factor), 1.0, factor * factor}) {
      for (const double d : {1.0 / factor, 1.0, factor})
        around.push_back(squares_of(record_, {found.poles.order, s * found.poles.stiffness, d * found.poles.damping}));
    }
    const Found finer = best_of(around, found.terms);
    found.poles = finer.poles;
    found.mean_square = finer.mean_square;
  }
}

Found WindowSearch::best(int order, bool pulled) const {
  const Fits fits = on_grid(order, pulled);
  std::vector<Eigen::Index> terms{std::ssize(drivers_)};
  for (std::size_t i = 0; i < drivers_.size(); ++i) {
    if (drivers_[i].named && !spreads_[i].constant()) terms.push_back(static_cast<Eigen::Index>(i));
  }
  Found found = best_of(fits, terms);
  add_drivers(fits, false, found);
  add_drivers(fits, true, found);
  drop_drivers(fits, found);
  refine(found);
  found.undriven = best_of(fits, {std::ssize(drivers_)}).mean_square;
  return found;
}

bool WindowSearch::needs_drivers(const Found& found) const { return excess(found.mean_square) < clearly * excess(found.undriven); }

Found WindowSearch::with_inputs_of(const WindowSearch& longer, Found found) const {
  const std::size_t before = found.terms.size();
  if (any_output(found.terms)) return found;
  for (const Eigen::Index term : longer.best(found.poles.order, found.poles.pulled()).terms) {
    const bool known = std::find(found.terms.begin(), found.terms.end(), term) != found.terms.end();
    if (!known && !is_output(term)) found.terms.push_back(term);
  }
  if (found.terms.size() == before) return found;
  found = best_of(on_grid(found.poles.order, found.poles.pulled()), found.terms);
  refine(found);
  return found;
}

std::vector<double> WindowSearch::coefficients(const Found& found) const {
  FittedAndHeldOut fit = squares_of(record_, found.poles);
  fit.fitted += fit.held_out;
  const Eigen::VectorXd solved = fit.fitted.solve(found.terms);
  std::vector<double> out(drivers_.size() + 1, 0.0);
  const double pull = found.poles.order == 1 ? found.poles.damping : found.poles.stiffness;
  out.back() = target_.sigma * solved[solved.size() - 1] + pull * target_.mean;
  for (std::size_t i = 0; i < drivers_.size(); ++i) {
    if (spreads_[i].constant()) continue;
    out[i] = solved[i] * target_.sigma / spreads_[i].sigma;
    out.back() -= out[i] * spreads_[i].mean;
  }
  return out;
}

}  // namespace misfit
