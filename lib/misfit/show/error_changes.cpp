#include "misfit/show/error_changes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "misfit/core/duration.h"
#include "misfit/core/text.h"
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

std::vector<ErrorChange> errors_of(const Fit& fit) {
  std::vector<ErrorChange> out;
  const auto forces = force_strengths(fit.force);
  for (const auto& [channel, rms] : fit.rms)
    out.push_back(
        {ErrorKind::rms_error, channel + (forces.empty() ? "" : " one sample ahead"), rms, std::nullopt, share_of_motion(fit, channel)});
  for (const ForceStrength& f : forces)
    out.push_back({ErrorKind::random_force, forces.size() > 1 ? f.port : "", f.strength, std::nullopt,
                   is_seen(fit, f.strength) ? "" : "not distinguishable from 0"});
  return out;
}

std::vector<ErrorChange> errors_between(const Rung& first, const Rung& last, const Fit* fit) {
  std::vector<ErrorChange> out;
  constexpr std::size_t farthest = std::size(kLadderSteps) - 1;
  for (const auto& [channel, steps] : first.k_step) {
    const auto after = last.k_step.find(channel);
    const auto rms = first.rms.find(channel);
    if (after == last.k_step.end() || rms == first.rms.end() || steps.size() <= farthest || after->second.size() <= farthest) continue;
    ErrorChange change;
    change.of = channel + ahead(kLadderSteps[farthest], fit);
    change.before.value = steps[farthest];
    change.before.unit = rms->second.unit;
    change.after = change.before;
    change.after->value = after->second[farthest];
    out.push_back(std::move(change));
  }
  const auto before = force_strengths(first.force), after = force_strengths(last.force);
  for (const ForceStrength& f : before) {
    if (const auto strength = strength_in(after, f.strength.unit))
      out.push_back({ErrorKind::random_force, before.size() > 1 ? f.port : "", f.strength, strength, ""});
  }
  most_telling_first(out);
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
  const auto change = e.per_cent();
  return briefly(e.before) + " to " + briefly(*e.after) +
         (change ? fmt::format(" ({:+.{}f} %)", *change, std::abs(*change) < 10.0 || *change < -99.0 ? 1 : 0) : "");
}

}  // namespace misfit
