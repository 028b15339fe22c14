#include "misfit/fit/regression/linear_guess.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "misfit/fit/regression/linear_windows.h"
#include "misfit/inference/states.h"
#include "misfit/math/statistics.h"

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

/// A model found: which terms (drivers, then the constant), their coefficients, and the mean square it leaves in the windows held out.
struct Found {
  std::vector<Eigen::Index> terms;
  Poles poles;
  double mean_square = 0.0;
};

/// Fits of one target (an output, or its measured rate) over poles on a grid.
class WindowSearch {
 public:
  /// `lengthened`: windows so many times as long as two swings, at most a quarter of the record.
  WindowSearch(const std::vector<double>& t, const std::vector<double>& y, std::vector<GuessDriver> drivers, int lengthened = 1);

  [[nodiscard]] bool possible() const { return record_.windows.size() > 1 && !target_.constant(); }
  /// The best model of that order; `pulled`: with a pull back to rest.
  [[nodiscard]] Found best(int order, bool pulled) const;
  [[nodiscard]] double excess(double mean_square) const { return std::max(mean_square - noise_, least_excess * noise_) + 1e-12; }
  /// Whether what drives the model explains the motion, rather than the initial states of its windows: with it the held-out error is
  /// clearly lower (guess_linear()).
  [[nodiscard]] bool needs_drivers(const Found& found) const;
  /// The same with the inputs that `longer`, over longer windows, has in its model of that kind; not beside another output that drives it.
  [[nodiscard]] Found with_inputs_of(const WindowSearch& longer, Found found) const;
  [[nodiscard]] std::size_t windows() const { return record_.windows.size(); }
  [[nodiscard]] int lengthened() const { return lengthened_; }
  /// Coefficients in the units given: of the drivers, then the constant.
  [[nodiscard]] std::vector<double> coefficients(const Found& found) const;

 private:
  using Fits = std::vector<FittedAndHeldOut>;
  [[nodiscard]] Fits on_grid(int order, bool pulled) const;
  [[nodiscard]] Found best_of(const Fits& fits, const std::vector<Eigen::Index>& terms) const;
  [[nodiscard]] bool is_output(Eigen::Index term) const;
  [[nodiscard]] bool any_output(const std::vector<Eigen::Index>& terms) const;
  [[nodiscard]] double most_with(Eigen::Index term, const std::vector<Eigen::Index>& others) const;
  void add_drivers(const Fits& fits, bool outputs, Found& found) const;
  void drop_drivers(const Fits& fits, Found& found) const;
  void refine(Found& found) const;

  static constexpr double least_excess = 0.3, clearly = 0.8;
  std::vector<GuessDriver> drivers_;
  WindowedRecord record_;
  MeanAndSigma target_;
  int lengthened_ = 1;
  std::size_t length_ = 0;  ///< of a window, in samples
  std::vector<MeanAndSigma> spreads_;
  double noise_ = 0.0;
};

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

std::vector<double> spaced(double from, double to, int count) {
  std::vector<double> out;
  for (int i = 0; i < count; ++i) out.push_back(from * std::pow(to / from, static_cast<double>(i) / (count - 1)));
  return out;
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
  return found;
}

bool WindowSearch::needs_drivers(const Found& found) const {
  const Fits fits = on_grid(found.poles.order, found.poles.pulled());
  return excess(found.mean_square) < clearly * excess(best_of(fits, {std::ssize(drivers_)}).mean_square);
}

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

LinearGuess none_found(const GuessData& data) {
  LinearGuess out;
  const MeanAndSigma spread = mean_and_sigma(data.y);
  out.rest = spread.mean;
  out.tau = 0.1 * (data.t.back() - data.t.front());
  for (const auto& driver : data.drivers) {
    const MeanAndSigma own = mean_and_sigma(driver.values);
    out.gain.push_back(driver.output || own.constant() || spread.constant() ? 0.0 : spread.sigma / own.sigma);
  }
  out.why = "no linear model could be estimated from the data: tau is a tenth of the record";
  return out;
}

/// Of a motion that nothing damps: still positive, so that it may be estimated.
double positive_damping(double damping, const GuessData& data) { return std::max(damping, 1e-2 / (data.t.back() - data.t.front())); }

/// Static gains and rest, where the model is pulled back.
void divide(double by, LinearGuess& out) {
  for (double& gain : out.gain) gain /= by;
  out.rest /= by;
}

std::string words_of_oscillator(double stiffness, double damping) {
  const double omega = std::sqrt(stiffness);
  return fmt::format("natural frequency about {:.3g} Hz, damping ratio {:.3g}", omega / (2.0 * std::numbers::pi), 0.5 * damping / omega);
}

/// How much lower the error of `a` is than that of `b`, in per cent.
double percent_lower(const WindowSearch& search, const Found& a, const Found& b) {
  return 100.0 * (1.0 - std::sqrt(search.excess(a.mean_square) / search.excess(b.mean_square)));
}

std::string compared(double percent) {
  constexpr double clearly = 30.0;  // per cent: then it is overdamped, or it would have been taken
  if (percent < 1.0) return "does not lower the held-out error";
  if (percent < clearly) return fmt::format("lowers the held-out error by only {:.0f} %", percent);
  return fmt::format("lowers the held-out error by {:.0f} % and does not swing: misfit discover tests what that is", percent);
}

/// With or without a pull back to rest: without, if the error is hardly higher.
Found simplest(const WindowSearch& search, int order) {
  const Found pulled = search.best(order, true), free = search.best(order, false);
  constexpr double higher = 1.005;
  return free.mean_square < higher * pulled.mean_square ? free : pulled;
}

/// Its rate is measured: y'' from the rate's own equation, in which y stands as a driver.
std::optional<LinearGuess> with_measured_rate(const GuessData& data) {
  GuessData of_rate = data;
  of_rate.drivers.push_back({data.y, true, true});
  const WindowSearch search(data.t, data.rate, of_rate.drivers);
  if (!search.possible()) return std::nullopt;
  const Found found = simplest(search, 1);
  LinearGuess out;
  out.order = 2;
  out.gain = search.coefficients(found);
  out.rest = out.gain.back();
  out.gain.pop_back();
  out.stiffness = -out.gain.back();
  out.gain.pop_back();
  out.damping = positive_damping(found.poles.damping, data);
  out.integrates = !(out.stiffness > 0.0);
  const std::string measured = "second order, its rate is measured: ";
  if (out.integrates) {
    out.stiffness = 0.0;
    out.why = measured + fmt::format("no pull back to a rest; time constant of the rate about {:.3g} s", 1.0 / out.damping);
    return out;
  }
  divide(out.stiffness, out);
  out.why = measured + words_of_oscillator(out.stiffness, out.damping);
  return out;
}

LinearGuess first_order(const WindowSearch& search, const Found& found, double lower) {
  LinearGuess out;
  out.gain = search.coefficients(found);
  out.rest = out.gain.back();
  out.gain.pop_back();
  out.integrates = found.poles.damping == 0.0;
  if (out.integrates) {
    out.why = "first order without a pull back to a rest (it integrates): a second order " + compared(lower);
    return out;
  }
  out.tau = 1.0 / found.poles.damping;
  divide(found.poles.damping, out);
  out.why = fmt::format("first order, time constant about {:.3g} s: a second order {}", out.tau, compared(lower));
  return out;
}

LinearGuess second_order(const GuessData& data, const WindowSearch& search, const Found& found, double lower) {
  LinearGuess out;
  out.order = 2;
  out.gain = search.coefficients(found);
  out.rest = out.gain.back();
  out.gain.pop_back();
  out.integrates = found.poles.stiffness == 0.0;
  out.damping = positive_damping(found.poles.damping, data);
  out.stiffness = found.poles.stiffness;
  const std::string reason = fmt::format("; its held-out error is {:.0f} % below that of a first order", lower);
  if (out.integrates) {
    out.why = "second order without a pull back to a rest" + reason;
    return out;
  }
  divide(out.stiffness, out);
  out.why = "second order, " + words_of_oscillator(out.stiffness, out.damping) + reason;
  return out;
}

/// A first order whose rest drifts in time, if it leaves no more than `excess`: a second order without a pull back to rest follows a drift,
/// too, with gains that mean nothing, and a first order takes it for a time constant longer than the record. The model is the one without
/// the drift, which is for the search to name. `fits`: what is said of it with the drift.
std::optional<LinearGuess> drifting_first_order(const GuessData& data, int lengthened, double excess, const char* fits) {
  std::vector<GuessDriver> drivers = data.drivers;
  drivers.push_back({data.t, true, false});
  const WindowSearch search(data.t, data.y, drivers, lengthened);
  const Found found = search.best(1, true);
  if (!(found.poles.damping > 0.0) || search.excess(found.mean_square) > excess) return std::nullopt;
  LinearGuess out = first_order(search, found, 0.0);
  out.rest += out.gain.back() * mean_and_sigma(data.t).mean;
  out.gain.pop_back();
  out.why = fmt::format("first order, time constant about {:.3g} s: with a drift in time beside it, {}; misfit discover tests what drifts",
                        out.tau, fits);
  return out;
}

/// The best models of either order, and which of the two it is to be.
struct Choice {
  Found first, second;
  double lower = 0.0;  ///< the error of the second order, below that of the first [%]
  bool oscillates = false;

  explicit Choice(const WindowSearch& search) : first(simplest(search, 1)), second(simplest(search, 2)) {
    constexpr double most_damped = 0.9;  // damping ratio
    const bool swings = second.poles.damping < 2.0 * most_damped * std::sqrt(second.poles.stiffness) || second.poles.stiffness == 0.0;
    lower = percent_lower(search, second, first);
    oscillates = swings && search.excess(second.mean_square) < half * search.excess(first.mean_square);
  }
  [[nodiscard]] const Found& found() const { return oscillates ? second : first; }

  static constexpr double half = 0.5;  ///< of the mean square
};

bool has_inputs(const GuessData& data) {
  return std::any_of(data.drivers.begin(), data.drivers.end(), [](const GuessDriver& d) { return !d.output; });
}

struct Searched {
  WindowSearch search;
  Choice choice;

  /// Inputs whose effect is slow are seen over longer windows alone.
  void take_slow_inputs(const GuessData& data) {
    constexpr int further = 2;
    const WindowSearch longer(data.t, data.y, data.drivers, further * search.lengthened());
    if (longer.windows() < least_windows) return;
    Found& found = choice.oscillates ? choice.second : choice.first;
    found = search.with_inputs_of(longer, found);
  }

  static constexpr std::size_t least_windows = 4;
};

/// Over longer windows where, over those of two swings, their own initial states explain the motion as well as what drives it; over the
/// same ones if the drivers explain no more over longer ones.
std::optional<Searched> search_of(const GuessData& data) {
  const WindowSearch search(data.t, data.y, data.drivers);
  if (!search.possible()) return std::nullopt;
  Searched out{search, Choice(search)};
  if (!has_inputs(data)) return out;
  for (int lengthened = 2; !out.search.needs_drivers(out.choice.found()); lengthened *= 2) {
    const WindowSearch longer(data.t, data.y, data.drivers, lengthened);
    if (longer.windows() < Searched::least_windows) {
      out = {search, Choice(search)};
      break;
    }
    out = {longer, Choice(longer)};
  }
  out.take_slow_inputs(data);
  return out;
}

}  // namespace

LinearGuess guess_linear(const GuessData& data) {
  if (!data.rate.empty()) {
    if (const auto known = with_measured_rate(data)) return *known;
  }
  const std::optional<Searched> searched = search_of(data);
  if (!searched) return none_found(data);
  const auto& [search, choice] = *searched;
  LinearGuess out =
      choice.oscillates ? second_order(data, search, choice.second, choice.lower) : first_order(search, choice.first, choice.lower);
  if (has_inputs(data) && (!choice.oscillates || choice.second.poles.stiffness == 0.0)) {
    const double least =
        choice.oscillates ? search.excess(choice.second.mean_square) : Choice::half * search.excess(choice.first.mean_square);
    const char* fits =
        choice.oscillates ? "it fits no worse than a second order without a pull back to a rest" : "its held-out error is less than half";
    if (const auto drifting = drifting_first_order(data, search.lengthened(), least, fits)) out = *drifting;
  }
  const bool numbers = std::isfinite(out.rest + out.tau + out.damping + out.stiffness) &&
                       std::all_of(out.gain.begin(), out.gain.end(), [](double g) { return std::isfinite(g); });
  return numbers ? out : none_found(data);
}

}  // namespace misfit
