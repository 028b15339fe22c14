#include "misfit/show/error_changes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "misfit/core/duration.h"
#include "misfit/core/text.h"
#include "misfit/data/estimators.h"
#include "misfit/math/statistics.h"
#include "misfit/show/rows.h"

namespace misfit {
namespace {

constexpr double clear_change = 20.0;  // [%]

/// "1.1 % of the motion", of several experiments "1.1 to 2.3 % of the motion"; empty where none varies.
std::string share_of_motion(const Fit& fit, const std::string& channel) {
  std::optional<double> least, largest;
  for (const ChannelPrediction& p : fit.predictions) {
    if (p.channel != channel || !p.nrmse) continue;
    least = std::min(*p.nrmse, least.value_or(*p.nrmse));
    largest = std::max(*p.nrmse, largest.value_or(*p.nrmse));
  }
  if (!least) return "";
  const std::string low = share_of_motion_in_words(*least), high = share_of_motion_in_words(*largest);
  return low == high ? low : low.substr(0, low.find(" %")) + " to " + high;
}

/// " 32 samples (0.64 s) ahead"; without the time where the fit has no predictions.
std::string ahead(int samples, const Fit* fit) {
  const std::vector<double>* t = fit == nullptr || fit->predictions.empty() ? nullptr : &fit->predictions.front().t;
  const std::string time = t == nullptr || t->size() < 2 ? "" : " (" + duration_in_words(samples * usual_step(*t)) + ")";
  return fmt::format(" {} samples{} ahead", samples, time);
}

/// Of which data an error is: what was fitted, or what the fit has not seen.
constexpr const char* in_estimation_data = " in the estimation data";
constexpr const char* in_held_out_data = " in the held-out data";
constexpr const char* in_a_free_run = " in a free run";

/// With a random force the model is corrected at each measurement; a trajectory runs on from its initial state.
std::string horizon_of(const Fit& fit) {
  if (!fit.force.empty()) return " one sample ahead";
  return fit.method == trajectory_estimator().name ? in_a_free_run : "";
}

/// Of the errors at `ahead` in both, at the farthest horizon.
ErrorChange change_of(const std::string& of, const std::string& unit, double before, double after) {
  ErrorChange out;
  out.of = of;
  out.before = {before, 0.0, unit};
  out.after = Estimate{after, 0.0, unit};
  return out;
}

/// A rung's errors some samples ahead: channel → horizons.
using KSteps = std::map<std::string, std::vector<double>>;

/// At the farthest horizon, channels that both rungs have.
std::vector<ErrorChange> k_step_changes(const KSteps& first, const KSteps& last, const std::map<std::string, Estimate>& units,
                                        const std::string& of) {
  constexpr std::size_t farthest = std::size(kLadderSteps) - 1;
  std::vector<ErrorChange> out;
  for (const auto& [channel, steps] : first) {
    const auto after = last.find(channel);
    const auto rms = units.find(channel);
    if (after == last.end() || rms == units.end() || steps.size() <= farthest || after->second.size() <= farthest) continue;
    out.push_back(change_of(channel + of, rms->second.unit, steps[farthest], after->second[farthest]));
  }
  return out;
}

/// Channels that both have.
std::vector<ErrorChange> rms_changes(const std::map<std::string, Estimate>& first, const std::map<std::string, Estimate>& last,
                                     const std::string& of) {
  std::vector<ErrorChange> out;
  for (const auto& [channel, rms] : first) {
    if (const auto after = last.find(channel); after != last.end())
      out.push_back(change_of(channel + of, rms.unit, rms.value, after->second.value));
  }
  return out;
}

/// Of what is held out: some samples ahead where both rungs know that, else one.
std::vector<ErrorChange> held_out_changes(const Rung& first, const Rung& last, const std::string& far) {
  std::vector<ErrorChange> out;
  if (first.validation_k_step && last.validation_k_step) {
    out = k_step_changes(*first.validation_k_step, *last.validation_k_step, first.rms, far + in_held_out_data);
    std::erase_if(out, [](const ErrorChange& e) { return !std::isfinite(e.before.value) || !std::isfinite(e.after->value); });
  }
  return !out.empty() ? out : rms_changes(first.validation_rms, last.validation_rms, std::string(" one sample ahead") + in_held_out_data);
}

std::string channel_of(const ErrorChange& e) { return e.kind == ErrorKind::rms_error ? e.of.substr(0, e.of.find(' ')) : ""; }

/// Each behind the error of the same channel in the data that were fitted.
void put_beside(std::vector<ErrorChange> held_out, std::vector<ErrorChange>& errors) {
  for (ErrorChange& e : held_out) {
    const auto same =
        std::find_if(errors.begin(), errors.end(), [&](const ErrorChange& other) { return channel_of(other) == channel_of(e); });
    errors.insert(same == errors.end() ? same : same + 1, std::move(e));
  }
}

/// With what is held out behind it; empty where one of them has none.
std::vector<ErrorChange> free_run_changes(const Rung& first, const Rung& last) {
  if (!first.free_rms || !last.free_rms) return {};
  std::vector<ErrorChange> out = rms_changes(*first.free_rms, *last.free_rms, std::string(in_a_free_run) + in_estimation_data);
  if (first.validation_free_rms && last.validation_free_rms)
    put_beside(rms_changes(*first.validation_free_rms, *last.validation_free_rms, std::string(in_a_free_run) + in_held_out_data), out);
  return out;
}

/// The largest fall first, but a clear one of the error in what was measured before any of the random force, which says less.
void most_telling_first(std::vector<ErrorChange>& errors) {
  const auto rank = [](const ErrorChange& e) {
    const double change = e.within_sigma() ? 0.0 : e.per_cent().value_or(0.0);
    const bool measured = e.kind == ErrorKind::rms_error && change <= -clear_change;
    return measured ? change - 100.0 : change;
  };
  std::stable_sort(errors.begin(), errors.end(), [&](const ErrorChange& a, const ErrorChange& b) { return rank(a) < rank(b); });
}

/// The change is below the digits that are shown.
bool prints_alike(const ErrorChange& e) { return e.after && briefly(e.before) == briefly(*e.after); }

}  // namespace

std::string not_distinguishable(const Estimate& force) { return force.sigma > 0.0 ? "" : "not distinguishable from 0"; }

std::vector<ErrorChange> errors_of(const Fit& fit) {
  std::vector<ErrorChange> out;
  const auto forces = force_strengths(fit.force);
  for (const auto& [channel, rms] : fit.rms) {
    const std::string what = channel + horizon_of(fit);
    out.push_back({ErrorKind::rms_error, what + in_estimation_data, rms, std::nullopt, share_of_motion(fit, channel)});
    if (const auto held_out = fit.validation_rms.find(channel); held_out != fit.validation_rms.end())
      out.push_back({ErrorKind::rms_error, what + in_held_out_data, held_out->second, std::nullopt, ""});
  }
  for (const ForceStrength& f : forces)
    out.push_back({ErrorKind::random_force, forces.size() > 1 ? f.port : "", f.strength, std::nullopt,
                   is_seen(fit, f.strength) ? "" : not_distinguishable({})});
  return out;
}

std::vector<ErrorChange> errors_between(const Rung& first, const Rung& last, const Fit* fit) {
  const std::string far = ahead(kLadderSteps[std::size(kLadderSteps) - 1], fit);
  std::vector<ErrorChange> out = k_step_changes(first.k_step, last.k_step, first.rms, far + in_estimation_data);
  const auto before = force_strengths(first.force), after = force_strengths(last.force);
  for (const ForceStrength& f : before) {
    if (const auto strength = strength_in(after, f.strength.unit))
      out.push_back({ErrorKind::random_force, before.size() > 1 ? f.port : "", f.strength, strength, not_distinguishable(*strength)});
  }
  most_telling_first(out);
  put_beside(held_out_changes(first, last, far), out);
  std::vector<ErrorChange> free = free_run_changes(first, last);
  const bool telling = std::any_of(free.begin(), free.end(), is_telling);
  out.insert(telling ? out.begin() : out.end(), std::make_move_iterator(free.begin()), std::make_move_iterator(free.end()));
  return out;
}

bool explains_no_more_than_chance(const Rung& rung) {
  constexpr double rare = 0.01;
  return rung.actual_drop && chi_square_tail(*rung.actual_drop, std::max(1, parameters_added(rung))) > rare;
}

std::string change_in_words(const ErrorChange& e) {
  if (e.within_sigma())
    return fmt::format("the {} changes by less than its sigma, from {} to {}", e.what(), briefly(e.before), briefly(*e.after));
  const double change = e.per_cent().value_or(0.0);
  if (change == 0.0 || prints_alike(e)) return fmt::format("the {} stays at {}", e.what(), briefly(*e.after));
  return fmt::format("the {} {} from {}", e.what(), change < 0.0 ? "falls" : "rises", shown(e));
}

bool is_telling(const ErrorChange& e) {
  return std::max(e.before.sigma, e.after ? e.after->sigma : 0.0) > 0.0 ? !e.within_sigma() : e.per_cent().value_or(0.0) <= -clear_change;
}

bool clearly_rises(const ErrorChange& e) { return e.after && !e.within_sigma() && e.per_cent().value_or(0.0) >= clear_change; }

std::string shown(const ErrorChange& e) {
  const std::string remark = e.remark.empty() ? "" : " (" + e.remark + ")";
  if (!e.after) return briefly(e.before) + remark;
  if (e.kind == ErrorKind::trim) return briefly(e.before) + " to " + briefly(*e.after) + remark;
  if (e.within_sigma()) return briefly(e.before) + " to " + briefly(*e.after) + " (within its sigma)";
  if (prints_alike(e)) return briefly(*e.after) + " before and after";
  if (e.kind == ErrorKind::random_force && !e.remark.empty()) return briefly(e.before) + " to " + briefly(*e.after) + remark;
  if (e.kind == ErrorKind::random_force && !(e.before.sigma > 0.0))
    return briefly(e.before) + " (" + not_distinguishable(e.before) + ") to " + briefly(*e.after);
  const auto change = e.per_cent();
  return briefly(e.before) + " to " + briefly(*e.after) +
         (change ? fmt::format(" ({:+.{}f} %)", *change, std::abs(*change) < 10.0 || *change < -99.0 ? 1 : 0) : "");
}

}  // namespace misfit
