#include "misfit/fit/regression/linear_guess.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "misfit/math/statistics.h"

namespace misfit {
namespace {

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
  constexpr double clearly = 16.0;  // per cent: then it is overdamped, or it would have been taken
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

/// 0 without a pull back to rest.
double damping_ratio(const Poles& poles) { return poles.stiffness > 0.0 ? 0.5 * poles.damping / std::sqrt(poles.stiffness) : 0.0; }

/// No lag or delay of a first order looks like that. Hardly damped at all it may be any slow swing that two initial values per window
/// follow.
bool rings(double damping_ratio) {
  constexpr double least = 0.05, most = 0.5;
  return damping_ratio > least && damping_ratio < most;
}

/// The best models of either order, and which of the two it is to be. A second order that is overdamped is two first ones, and what its
/// fast one stands for is for the search to name (a lag, a delay). But what a first order follows with a time constant longer than the
/// record moves without a pull back (an axis under a motor): there a second order without one is enough if it is a little better, for a lag
/// that a search would find beside the first order is no more than that.
struct Choice {
  Found first, second;
  double lower = 0.0;  ///< the error of the second order, below that of the first [%]
  bool oscillates = false;

  Choice(const WindowSearch& search, const GuessData& data) : first(simplest(search, 1)), second(simplest(search, 2)) {
    const double seconds = data.t.back() - data.t.front();
    constexpr double clearly = 0.7, rings_clearly = 0.9;  // of the mean square: an error lower by a sixth, by a twentieth
    constexpr double most_damped = 0.9;
    const auto leaves_at_most = [&](double share, const Found& found) {
      return search.excess(found.mean_square) < share * search.excess(first.mean_square);
    };
    const double damping = damping_ratio(second.poles);
    oscillates = damping < most_damped && leaves_at_most(rings(damping) ? rings_clearly : clearly, second);
    if (data.without_inertia) {
      if (second.poles.stiffness == 0.0) oscillates = false;
    } else if (const Found free = search.best(2, false);
               !oscillates && first.poles.damping * seconds < 1.0 && leaves_at_most(clearly, free)) {
      second = free;
      oscillates = true;
    }
    lower = percent_lower(search, second, first);
  }
  [[nodiscard]] const Found& found() const { return oscillates ? second : first; }
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
  const Searched usual{search, Choice(search, data)};
  if (!has_inputs(data)) return usual;
  Searched out = usual;
  for (int lengthened = 2; !out.search.needs_drivers(out.choice.found()); lengthened *= 2) {
    const WindowSearch longer(data.t, data.y, data.drivers, lengthened);
    if (longer.windows() < Searched::least_windows) {
      out = usual;
      break;
    }
    out = {longer, Choice(longer, data)};
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
    constexpr double half = 0.5;  // of the mean square
    const double least = choice.oscillates ? search.excess(choice.second.mean_square) : half * search.excess(choice.first.mean_square);
    const char* fits =
        choice.oscillates ? "it fits no worse than a second order without a pull back to a rest" : "its held-out error is less than half";
    if (const auto drifting = drifting_first_order(data, search.lengthened(), least, fits)) out = *drifting;
  }
  out.undriven = search.excess(choice.found().undriven) / search.excess(choice.found().mean_square);
  const bool numbers = std::isfinite(out.rest + out.tau + out.damping + out.stiffness) &&
                       std::all_of(out.gain.begin(), out.gain.end(), [](double g) { return std::isfinite(g); });
  return numbers ? out : none_found(data);
}

}  // namespace misfit
