// What diagnose, discover and add print: sentences first, then tables.

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "apps/print.h"
#include "misfit/core/display.h"
#include "misfit/core/text.h"
#include "misfit/core/units.h"

namespace misfit {
namespace {

using Cells = std::vector<std::vector<std::string>>;
constexpr std::size_t width = 110;

std::string shown(const Estimate& e) { return in_display_unit(e.value, e.unit, e.sigma); }

std::string number(const std::optional<double>& value, const char* format = "{:.1f}") {
  return value && std::isfinite(*value) ? fmt::format(fmt::runtime(format), *value) : "–";
}

/// With a capital letter and a full stop.
std::string as_sentence(std::string text) {
  if (text.empty()) return text;
  const bool key = text.substr(0, text.find(' ')).find('_') != std::string::npos;  // of an effect: written as a study writes it
  if (!key) text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  return text.ends_with('.') || text.ends_with('!') || text.ends_with('?') ? text : text + ".";
}

std::string sentences_text(const std::vector<std::string>& sentences) {
  std::string out;
  for (const auto& sentence : sentences) out += wrap_text(as_sentence(sentence), width, "  ") + "\n";
  return out;
}

/// The place where a map is largest in its own sigmas.
std::string largest(const ForceMap& map) {
  std::size_t best = map.x.size();
  for (std::size_t i = 0; i < map.x.size(); ++i) {
    if (!(map.sigma[i] > 0.0)) continue;
    if (best == map.x.size() || std::abs(map.amplitude[i] / map.sigma[i]) > std::abs(map.amplitude[best] / map.sigma[best])) best = i;
  }
  if (best == map.x.size()) return "–";
  return fmt::format("{} at {}", shown({map.amplitude[best], map.sigma[best], map.port_unit}),
                     shown({map.x[best], 0.0, map.quantity_unit}));
}

/// The random force in words: one strength where its ports share it.
std::string force_text(const std::map<std::string, Estimate>& force) {
  std::string out;
  for (const auto& [port, e] : force) {
    if (e.unit == "s") continue;
    const std::string text = shown(e);
    if (out.find(text) == std::string::npos) out += (out.empty() ? "" : ", ") + text;
  }
  return out.empty() ? "–" : out;
}

std::string change(double before, double after) {
  return before != 0.0 && std::isfinite(before) && std::isfinite(after) ? fmt::format("{:+.1f} %", 100.0 * (after / before - 1.0)) : "–";
}

void add_channels(const std::map<std::string, Estimate>& before, const std::map<std::string, Estimate>& after, const char* what,
                  Cells& rows) {
  for (const auto& [channel, e] : after) {
    const auto was = before.find(channel);
    const std::string old = was == before.end() ? "–" : shown(was->second);
    rows.push_back({fmt::format("{}, {}", what, channel), old, shown(e), was == before.end() ? "–" : change(was->second.value, e.value)});
  }
  for (const auto& [channel, e] : before) {
    if (!after.contains(channel)) rows.push_back({fmt::format("{}, {}", what, channel), shown(e), "–", "–"});
  }
}

void add_k_step(const Rung& before, const Rung& after, Cells& rows) {
  for (const std::size_t k : {std::size_t{3}, std::size(kLadderSteps) - 1}) {
    const auto at = [k](const Rung& rung) {
      std::map<std::string, Estimate> out;
      for (const auto& [channel, values] : rung.k_step) {
        const auto rms = rung.rms.find(channel);
        if (values.size() > k && rms != rung.rms.end()) out[channel] = {values[k], 0.0, rms->second.unit};
      }
      return out;
    };
    add_channels(at(before), at(after), fmt::format("{} steps ahead", kLadderSteps[k]).c_str(), rows);
  }
}

const Rung* parent_of(const Ladder& ladder, const Rung& rung) {
  for (const auto& other : ladder.rungs) {
    if (other.id == rung.parent) return &other;
  }
  return nullptr;
}

std::string drop_text(const Rung& rung) {
  std::string note = rung.note.empty() ? "" : wrap_text(as_sentence(rung.note), width, "  ") + "\n";
  if (!rung.actual_drop) return note;
  std::string out =
      fmt::format("  drop: {} predicted, {:.1f} actual", rung.predicted_drop ? number(rung.predicted_drop) : "none", *rung.actual_drop);
  out += fmt::format(" for {} parameter{}", rung.parameters.size(), rung.parameters.size() == 1 ? "" : "s");
  out += rung.held_out_gain ? fmt::format("; gain of the held-out log-likelihood {:+.1f}\n", *rung.held_out_gain)
                            : "; no validation data: set validation = \"last 25 %\"\n";
  if (*rung.actual_drop < 1.0) out += "  ! the added effect explains nothing in these data\n";
  return out + note;
}

}  // namespace

std::string diagnosis_text(const Diagnosis& d) {
  std::string out = fmt::format("residual diagnostics of {}  ({:.1f} s)\n", d.method, d.seconds);
  out += sentences_text(d.sentences);
  Cells maps{{"force on", "against", "p (corrected)", "chi2", "dof", "largest"}};
  for (const auto& map : d.maps) {
    maps.push_back({map.port, map.quantity, format_probability(map.p_corrected), fmt::format("{:.1f}", map.chi2), std::to_string(map.dof),
                    largest(map)});
  }
  if (maps.size() > 1) out += "\nunexplained force (for a correct model p is uniform on [0, 1])\n" + align_columns(maps);
  Cells pairs{{"force on", "against", "and", "p (corrected)", "chi2", "dof"}};
  for (const auto& pair : d.pairs) {
    pairs.push_back({pair.port, pair.quantity_x, pair.quantity_y, format_probability(pair.p_corrected), fmt::format("{:.1f}", pair.chi2),
                     std::to_string(pair.dof)});
  }
  if (pairs.size() > 1) out += "\n" + align_columns(pairs);
  Cells white{{"innovations", "Ljung-Box p", "lags", "periodogram p", "largest spectral line", "p of the line"}};
  for (const auto& w : d.whiteness) {
    white.push_back({w.experiment + " " + w.channel, format_probability(w.ljung_box_p), std::to_string(w.lags),
                     format_probability(w.periodogram_p), fmt::format("{:.3f} Hz, {:.1f} times white", w.peak_frequency, w.peak_power),
                     format_probability(w.peak_p)});
  }
  if (white.size() > 1) out += "\nwhiteness of the innovations\n" + align_columns(white);
  for (const auto& n : d.nis)
    out +=
        fmt::format("  {}: {:.1f} % of the windows have normalised innovations outside the 95 % band\n", n.experiment, 100.0 * n.outside);
  return out;
}

std::string discovery_text(const Discovery& d) {
  std::string out = wrap_text(as_sentence(d.verdict), width, "") + "\n" + sentences_text(d.sentences);
  Cells rows{{"rank", "effect", "predicted drop", "actual drop", "held-out gain", "p", "group", "accepted"}};
  constexpr std::size_t most = 15;
  for (const auto& c : d.candidates) {
    if (rows.size() > most) break;
    std::string group;
    for (const auto& name : c.group) group += (group.empty() ? "" : ", ") + name;
    rows.push_back({std::to_string(c.rank), effect_at(c.effect, c.roles), number(c.predicted_drop), number(c.actual_drop),
                    number(c.held_out_gain, "{:+.1f}"), format_probability(c.p_value), group.empty() ? "–" : group,
                    c.accepted ? "yes" : "no"});
  }
  if (rows.size() > 1) out += "\n" + align_columns(rows);
  if (d.candidates.size() > most) out += fmt::format("  and {} more in candidates.json\n", d.candidates.size() - most);
  std::string why;
  for (const auto& c : d.candidates) {
    if (c.rank > 5 || c.why.empty()) continue;
    why += wrap_text(effect_at(c.effect, c.roles) + ": " + c.why, width, "  ") + "\n";
  }
  if (!why.empty()) out += "\n" + why;
  if (!d.force.empty()) out += "\n  random force of this model: " + force_text(d.force) + "\n";
  return out + fmt::format("  {} effect families were tested, see discovery.json  ({:.1f} s)\n", d.tried.size(), d.seconds);
}

std::string rung_text(const Ladder& ladder, const Rung& rung) {
  const Rung* parent = parent_of(ladder, rung);
  const Rung nothing;
  const Rung& before = parent != nullptr ? *parent : nothing;
  std::string out = fmt::format("rung {}: {} added to {}\n\n", rung.id, rung.added, before.system);
  Cells rows{{"", "before", "after", "change"}};
  add_channels(before.rms, rung.rms, "one step ahead", rows);
  add_k_step(before, rung, rows);
  add_channels(before.validation_rms, rung.validation_rms, "held out, one step", rows);
  const auto strength = [](const Rung& r) {
    const auto found = std::find_if(r.force.begin(), r.force.end(), [](const auto& f) { return f.second.unit != "s"; });
    return found == r.force.end() ? std::nan("") : found->second.value;
  };
  rows.push_back({"random force", force_text(before.force), force_text(rung.force), change(strength(before), strength(rung))});
  if (before.trim || rung.trim) rows.push_back({"trim", before.trim ? shown(*before.trim) : "–", rung.trim ? shown(*rung.trim) : "–", ""});
  if (rung.actual_drop) {
    rows.push_back({"log-likelihood", fmt::format("{:.1f}", before.loglik), fmt::format("{:.1f}", rung.loglik), ""});
    if (rung.validation_loglik)
      rows.push_back({"held-out log-likelihood", number(before.validation_loglik), number(rung.validation_loglik), ""});
  }
  out += align_columns(rows) + "\n" + drop_text(rung);
  for (const auto& [name, e] : rung.parameters) out += fmt::format("  {} = {}\n", name, shown(e));
  return out;
}

std::string ladder_text(const Ladder& ladder) {
  Cells rows{{"rung", "added", "system", "drop", "predicted", "held-out gain", "random force", "trim"}};
  for (const auto& r : ladder.rungs) {
    rows.push_back({std::to_string(r.id), r.added.empty() ? "(the study)" : r.added, r.system, number(r.actual_drop),
                    number(r.predicted_drop), number(r.held_out_gain, "{:+.1f}"), force_text(r.force), r.trim ? shown(*r.trim) : "–"});
  }
  std::string notes;
  for (const auto& r : ladder.rungs) {
    if (!r.note.empty()) notes += wrap_text(fmt::format("rung {}: {}", r.id, r.note), width, "  ") + "\n";
  }
  return "the ladder\n" + align_columns(rows) + notes;
}

}  // namespace misfit
