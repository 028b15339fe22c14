#include "misfit/show/lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "misfit/core/display.h"
#include "misfit/core/text.h"
#include "misfit/data/curve_coefficient.h"
#include "misfit/show/rows.h"

namespace misfit {
namespace {

constexpr std::size_t most_named = 4;

std::string joined(const std::vector<std::string>& parts, const char* between) {
  std::string out;
  for (const std::string& part : parts) out += (out.empty() ? "" : between) + part;
  return out;
}

/// "P_y 1.78 px, 1.1 % of the motion"; of several experiments: "P_y in 'flight_2' 1.78 px, …".
std::vector<std::string> residuals(const Fit& fit) {
  std::vector<std::string> out;
  const bool several = std::any_of(fit.predictions.begin(), fit.predictions.end(),
                                   [&](const auto& p) { return p.experiment != fit.predictions.front().experiment; });
  for (const ChannelPrediction& p : fit.predictions) {
    if (!p.rms || out.size() == most_named) continue;
    out.push_back(p.channel + (several ? " in '" + p.experiment + "' " : " ") + in_display_unit(*p.rms, p.unit) +
                  (p.nrmse ? ", " + share_of_motion_in_words(*p.nrmse) : ""));
  }
  return out;
}

/// The first `most`, how many more there are, and where.
std::vector<std::string> first_of(std::vector<std::string> all, std::size_t most, const char* where = "") {
  if (all.size() <= most) return all;
  const std::size_t more = all.size() - most;
  all.resize(most);
  all.push_back(fmt::format("and {} more{}", more, where));
  return all;
}

std::vector<std::string> scalars(const Fit& fit) {
  std::vector<std::string> out;
  for (const auto& [name, e] : fit.parameters) {
    if (!is_curve_coefficient(name)) out.push_back(name + " " + shown(e));
  }
  return first_of(std::move(out), most_named);
}

/// "C_m_alpha_rate not informative: driven motion".
std::string not_informative(const CurveEstimate& curve) {
  const std::string why = curve.why.substr(0, curve.why.find(": "));
  return curve.name + " not informative" + (why.empty() ? "" : ": " + why);
}

/// What fit prints in full, without the numbers and consequences behind it.
std::vector<std::string> warnings(const Fit& fit) {
  constexpr std::size_t most = 2;
  std::vector<std::string> out;
  for (std::string warning : fit.warnings) {
    if (const std::size_t end = warning.find("': "); warning.starts_with("experiment '") && end != std::string::npos)
      warning.erase(0, end + 3);  // of which experiment: in full
    out.push_back(warning.substr(0, std::min(warning.find(": "), warning.find(" ("))));
  }
  return first_of(std::move(out), most, " (--verbose)");
}

/// Without those that cannot be distinguished from 0, where others can.
std::string force_in_words(const Fit& fit, std::vector<ForceStrength> forces) {
  std::erase_if(forces, [&](const ForceStrength& f) { return !is_seen(fit, f.strength); });
  return forces.empty() ? "random force not distinguishable from 0" : "random force " + in_words(forces);
}

}  // namespace

std::string line_of(const TrackFacts& facts) {
  const std::vector<std::string> all = sentences(facts);
  const std::string metres = facts.plane ? fmt::format("; metres from {}, {:.3f} px RMS", facts.plane->from, facts.plane->rms) : "";
  return all.empty() ? "" : all.back() + metres;
}

std::string line_of(const Calibration& c) {
  std::vector<std::string> parts;
  for (const std::string& name : c.names) {
    const auto found = std::find(camera_parameter_names.begin(), camera_parameter_names.end(), name);
    if (found == camera_parameter_names.end()) continue;
    parts.push_back(name + " " +
                    shown(Estimate{c.value(name), c.sigma(name), camera_parameter_units[found - camera_parameter_names.begin()]}));
  }
  std::string out = joined(parts, ", ");
  if (!c.residuals.empty()) out += fmt::format("; residuals {} RMS", briefly({c.rms_px, 0.0, "px"}));
  return out;
}

std::string line_of(const Attitude& a) {
  std::vector<double> known;
  std::copy_if(a.alpha_T.begin(), a.alpha_T.end(), std::back_inserter(known), [](double v) { return std::isfinite(v); });
  if (known.empty()) return "no sample could be read";
  const auto [least, most] = std::minmax_element(known.begin(), known.end());
  return fmt::format("{} of {} samples read, alpha_T from {} to {}", samples_read(a), a.t.size(), briefly({*least, 0.0, "rad"}),
                     briefly({*most, 0.0, "rad"}));
}

std::string line_of(const Fit& fit) {
  if (!fit.usable())
    return to_string(fit.status) + ": " + fit.message.substr(0, std::min(fit.message.find(": "), fit.message.find(", so ")));
  std::vector<std::string> parts;
  if (fit.trim) parts.push_back("trim " + shown(*fit.trim));
  if (!fit.trim) parts.push_back(joined(scalars(fit), ", "));
  const std::vector<std::string> errors = residuals(fit);
  const auto forces = force_strengths(fit.force);
  if (!errors.empty() && forces.empty()) parts.push_back("RMS error of " + joined(errors, ", of "));
  if (!forces.empty()) parts.push_back(force_in_words(fit, forces));
  if (fit.status == FitStatus::not_converged) parts.push_back("not converged: " + fit.message);
  std::erase(parts, "");
  for (const CurveEstimate& curve : fit.curves) {
    if (!curve.informative) parts.push_back(not_informative(curve));
  }
  const std::vector<std::string> warned = warnings(fit);
  if (!warned.empty()) parts.push_back("! " + joined(warned, "; "));
  return joined(parts, "; ");
}

std::string line_of(const Comparison& c) {
  if (c.motion && !c.motion->sentences.empty()) return c.motion->sentences.front().substr(0, c.motion->sentences.front().find(" over "));
  return c.trims.empty() ? "" : c.trims.front().sentence;
}

std::string line_of(const Diagnosis& d) {
  if (d.pulses) return d.pulses->front().sentence;
  if (d.maps.empty()) return "no map could be made";
  const ForceMap& first = d.maps.front();
  if (!first.sentence.empty()) return first.sentence;
  return fmt::format("no map of the missing force is significant ({})", p_equals(first.p_corrected));
}

std::string line_of(const Discovery& d) {
  if (d.candidates.empty()) return d.verdict;
  const auto nearer = [](const Candidate& a, const Candidate& b) { return a.p_value < b.p_value; };
  const bool accepted = d.candidates.front().accepted;
  const Candidate& best = accepted ? d.candidates.front() : *std::min_element(d.candidates.begin(), d.candidates.end(), nearer);
  const std::string name = effect_at(best.effect, best.roles);
  if (accepted) return fmt::format("missing: {} (drop {}, {})", name, shown_drop(best.actual_drop), p_equals(best.p_value));
  const std::string tested = tested_in_words(d) + " tested, none accepted";
  if (!d.unexplained_port.empty())
    return fmt::format("{}: {} that depends on {} is of unknown form", tested, unexplained_place(d), d.unexplained_quantity);
  constexpr double significant = 0.01;
  const bool decided = d.outcome != SearchOutcome::not_decided && d.outcome != SearchOutcome::not_finished;
  const bool rejected = decided && best.p_value < significant && best.actual_drop && !best.why.empty();
  const std::string why = rejected ? ", rejected: " + best.why.substr(0, best.why.find(": ")) : "";
  return fmt::format("{}; smallest p: {} ({}){}", tested, name, p_equals(best.p_value), why);
}

std::string line_of(const Ladder& ladder) {
  std::string out;
  for (const Rung& rung : ladder.rungs) out += rung.added.empty() ? rung.system : " → " + rung.added;
  return ladder.rungs.size() < 2 ? "" : out;
}

std::string line_of(const std::vector<Fit>& fits) { return fits.empty() ? "" : line_of(fits.front()); }

std::string line_of(const Rung& rung) {
  std::vector<std::string> parts;
  constexpr std::size_t most_parameters = 2;
  for (const auto& [name, e] : rung.parameters) {
    if (parts.size() < most_parameters) parts.push_back(name + " " + shown(e));
  }
  if (const auto forces = force_strengths(rung.force); !forces.empty()) parts.push_back("random force " + in_words(forces));
  return joined(parts, ", ");
}

}  // namespace misfit
