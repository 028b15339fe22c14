// What the model lacks: diagnosis, candidates, ladder.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "misfit/core/display.h"
#include "misfit/core/text.h"
#include "misfit/data/verdict.h"
#include "misfit/show/error_changes.h"
#include "misfit/show/results.h"
#include "misfit/show/rows.h"

namespace misfit {
namespace {

/// The place where a map is largest in its own sigmas.
std::string largest(const ForceMap& map) {
  std::size_t best = map.x.size();
  for (std::size_t i = 0; i < map.x.size(); ++i) {
    if (!(map.sigma[i] > 0.0)) continue;
    if (best == map.x.size() || std::abs(map.amplitude[i] / map.sigma[i]) > std::abs(map.amplitude[best] / map.sigma[best])) best = i;
  }
  if (best == map.x.size()) return kMissing;
  return fmt::format("{} at {}", shown({map.amplitude[best], map.sigma[best], map.port_unit}),
                     in_level_unit(map.x[best], map.quantity_unit));
}

TableBlock map_table(const Diagnosis& d) {
  TableBlock table{columns("force on|against|>p (corrected)|>p (this map)|>chi²|>dof|most significant value")};
  const auto add = [&](const auto& map, const std::string& against, const std::string& value) {
    table.rows.push_back({map.port, against, format_probability(map.p_corrected), format_probability(map.p_value),
                          fmt::format("{:.1f}", map.chi2), std::to_string(map.dof), value});
  };
  for (const ForceMap& map : d.maps) add(map, map.quantity, largest(map));
  for (const PairMap& map : d.pairs) add(map, map.quantity_x + " and " + map.quantity_y, kMissing);
  return table;
}

TableBlock whiteness_table(const Diagnosis& d) {
  TableBlock table{columns("innovations of|>Ljung-Box p|>lags|>periodogram p|largest spectral line|>p of the line")};
  for (const WhitenessReport& w : d.whiteness) {
    table.rows.push_back({w.experiment + " " + w.channel, format_probability(w.ljung_box_p), std::to_string(w.lags),
                          format_probability(w.periodogram_p), fmt::format("{:.4g} Hz, {:.1f} times white", w.peak_frequency, w.peak_power),
                          format_probability(w.peak_p)});
  }
  return table;
}

std::string force_text(const std::map<std::string, Estimate>& force) {
  const auto forces = force_strengths(force);
  return forces.empty() ? kMissing : in_words(forces);
}

std::string values_text(const std::map<std::string, Estimate>& estimates) {
  std::string text;
  for (const auto& [name, e] : estimates) text += (text.empty() ? "" : "; ") + name + " = " + shown(e);
  return text;
}

TableBlock candidate_table(const Discovery& d) {
  TableBlock table{
      columns(">rank|effect|>predicted drop|>actual drop|>held-out gain|>p|indistinguishable from|accepted"), {}, {15, "candidates.json"}};
  for (const Candidate& c : d.candidates) {
    std::vector<std::string> others = c.group;
    std::erase(others, effect_at(c.effect, c.roles));
    table.rows.push_back({std::to_string(c.rank), effect_at(c.effect, c.roles), shown_drop(c.predicted_drop), shown_drop(c.actual_drop),
                          shown_gain(c.held_out_gain), format_probability(c.p_value),
                          others.empty() ? kMissing : fmt::format("{}", fmt::join(others, ", ")), c.accepted ? "yes" : "no"});
  }
  return table;
}

/// Why each candidate was accepted or not; those that were not significant in one line.
Blocks reasons_of(const Discovery& d) {
  std::vector<std::string> why, others;
  const Candidate* nearest = nullptr;
  for (const Candidate& c : d.candidates) {
    if (c.why.empty()) continue;
    const std::string name = effect_at(c.effect, c.roles);
    if (!is_only_not_significant(c)) {
      why.push_back(name + ": " + c.why);
      continue;
    }
    others.push_back(name + ": " + p_equals(c.p_value));
    if (nearest == nullptr || c.p_value < nearest->p_value) nearest = &c;
  }
  Blocks out;
  if (why.empty() && others.empty()) return out;
  out.subheading("Reasons");
  out.list({why, Tone::plain, {5, "candidates.json"}});
  if (nearest == nullptr) return out;
  const std::string count = counted(others.size(), why.empty() ? "candidate" : "other", why.empty() ? "candidates" : "others");
  List folded{others};
  folded.folded =
      fmt::format("{}: not significant, smallest {} ({})", count, p_equals(nearest->p_value), effect_at(nearest->effect, nearest->roles));
  out.list(std::move(folded));
  return out;
}

const Rung* parent_of(const Ladder& ladder, const Rung& rung) {
  const auto found = std::find_if(ladder.rungs.begin(), ladder.rungs.end(), [&](const Rung& other) { return other.id == rung.parent; });
  return found == ladder.rungs.end() ? nullptr : &*found;
}

std::string change(double before, double after) {
  return before != 0.0 && std::isfinite(before) && std::isfinite(after) ? fmt::format("{:+.1f} %", 100.0 * (after / before - 1.0))
                                                                        : kMissing;
}

/// The table of a rung against its parent.
class BeforeAndAfter {
 public:
  BeforeAndAfter(const Rung& before, const Rung& after) {
    add_channels("one sample ahead", before.rms, after.rms);
    add_steps(before, after);
    add_channels("held out, one sample ahead", before.validation_rms, after.validation_rms);
    add_force(force_strengths(before.force), force_strengths(after.force));
    if (before.trim || after.trim) add("trim", shown(before.trim), shown(after.trim));
    if (!after.actual_drop) return;
    add("log-likelihood", shown_drop(before.loglik), shown_drop(after.loglik));
    if (after.validation_loglik) add("log-likelihood, held out", shown_drop(before.validation_loglik), shown_drop(after.validation_loglik));
  }

  TableBlock table{columns("|before|after|>change")};

 private:
  void add(const std::string& what, const std::string& before, const std::string& after, const std::string& by = "") {
    table.rows.push_back({what, before, after, by});
  }
  void add_channels(const std::string& what, const std::map<std::string, Estimate>& before, const std::map<std::string, Estimate>& after) {
    for (const auto& [channel, e] : after) {
      const auto was = before.find(channel);
      const bool known = was != before.end();
      add("RMS of " + channel + ", " + what, known ? shown(was->second) : kMissing, shown(e),
          known ? change(was->second.value, e.value) : kMissing);
    }
    for (const auto& [channel, e] : before) {
      if (!after.contains(channel)) add("RMS of " + channel + ", " + what, shown(e), kMissing, kMissing);
    }
  }
  void add_steps(const Rung& before, const Rung& after) {
    for (const std::size_t k : {std::size_t{3}, std::size(kLadderSteps) - 1}) {
      const auto at = [k](const Rung& rung) {
        std::map<std::string, Estimate> out;
        for (const auto& [channel, values] : rung.k_step) {
          const auto rms = rung.rms.find(channel);
          if (values.size() > k && rms != rung.rms.end()) out[channel] = {values[k], 0.0, rms->second.unit};
        }
        return out;
      };
      add_channels(fmt::format("{} samples ahead", kLadderSteps[k]), at(before), at(after));
    }
  }
  /// A row for each unit of the ports, those of before first.
  void add_force(const std::vector<ForceStrength>& before, const std::vector<ForceStrength>& after) {
    std::vector<ForceStrength> all = before;
    for (const ForceStrength& f : after) {
      if (!strength_in(before, f.strength.unit)) all.push_back(f);
    }
    if (all.empty()) add("random force", kMissing, kMissing, kMissing);
    for (const ForceStrength& f : all) {
      const auto was = strength_in(before, f.strength.unit), is = strength_in(after, f.strength.unit);
      add(all.size() > 1 ? "random force on " + f.port : "random force", shown(was), shown(is),
          !was || !is               ? kMissing
          : within_sigma(*was, *is) ? "within its sigma"
                                    : change(was->value, is->value));
    }
  }
};

std::string drop_sentence(const Rung& rung) {
  std::string out = fmt::format("Drop: {} predicted, {:.1f} actual for {}", rung.predicted_drop ? shown_drop(rung.predicted_drop) : "none",
                                *rung.actual_drop, counted(static_cast<std::size_t>(parameters_added(rung)), "parameter", "parameters"));
  if (!rung.held_out_gain && rung.gain_of_search)
    return out + "; gain of the log-likelihood of the last quarter, without which discovery fitted: " + shown_gain(rung.gain_of_search) +
           ".";
  return out + (rung.held_out_gain ? "; gain of the held-out log-likelihood: " + shown_gain(rung.held_out_gain) + "."
                                   : "; no held-out gain: the study holds nothing out (validation = \"last 25 %\").");
}

/// In parentheses where it is of the search.
std::string gain_in_table(const Rung& rung) {
  return !rung.held_out_gain && rung.gain_of_search ? "(" + shown_gain(rung.gain_of_search) + ")" : shown_gain(rung.held_out_gain);
}

/// Per channel, of all rungs.
TableBlock error_table(const Ladder& ladder) {
  std::vector<Subject> rungs;
  for (const Rung& r : ladder.rungs) {
    rungs.push_back({fmt::format("rung {}", r.id), {}});
    add_rows(rungs.back().rows, "", r.rms);
    add_rows(rungs.back().rows, "", r.validation_rms, ", held out");
  }
  return subjects_table("RMS, one sample ahead", rungs);
}

}  // namespace

bool is_only_not_significant(const Candidate& c) {
  const std::string only_p = "not significant: family-wise p = ";
  return c.why.starts_with(only_p) && c.why.find_first_not_of("0123456789.e+-", only_p.size()) == std::string::npos;
}

Blocks blocks_of(const Diagnosis& d) {
  Blocks out;
  out.heading("Where it fails (residuals of " + d.method + ")");
  out.list({as_sentences(d.sentences)});
  out.figures("maps");
  if (!d.maps.empty()) {
    out.subheading("Unexplained force");
    out.paragraph("For a correct model, p (this map) is uniform on [0, 1]; p (corrected) also allows for the number of maps.");
    out.table(map_table(d));
  }
  if (!d.whiteness.empty()) {
    out.subheading("Whiteness of the innovations");
    out.table(whiteness_table(d));
    out.figures("innovations");
  }
  std::vector<std::string> outside;
  for (const NisSeries& n : d.nis) {
    outside.push_back(fmt::format("{}: the normalised innovations squared of {:.1f} % of the windows are outside their 95 % band.",
                                  n.experiment, 100.0 * n.outside));
  }
  out.list({outside});
  if (!d.missing.empty()) out.figures("force");
  return out;
}

Blocks blocks_of(const Discovery& d) {
  Blocks out;
  out.heading("What could be missing");
  out.paragraph(as_sentence(d.verdict), Tone::lead);
  const bool accepted = std::any_of(d.candidates.begin(), d.candidates.end(), [](const Candidate& c) { return c.accepted; });
  if (accepted) {
    out.paragraph(
        "Estimates of a candidate are those of the search, which refits this model with it; the rung that adds it is fitted by itself, "
        "and its estimates may differ.");
  }
  out.list({as_sentences(d.sentences)});
  out.figures("candidates");
  out.table(candidate_table(d));
  if (!d.force.empty()) out.paragraph("Random force of this model: " + force_text(d.force) + ".");
  out.append(reasons_of(d));
  if (!d.tried.empty()) out.subheading("Effect families tested");
  out.list({d.tried, Tone::plain, {0, "discovery.json"}});
  if (!d.not_tried.empty()) out.subheading("Effects that could not be tried");
  out.list({not_tried_in_words(d)});
  return out;
}

Blocks rung_blocks(const Ladder& ladder, const Rung& rung) {
  const Rung* parent = parent_of(ladder, rung);
  Blocks out;
  TableBlock table = BeforeAndAfter(parent != nullptr ? *parent : Rung{}, rung).table;
  if (parent == nullptr) {
    table.columns = columns("|value");
    for (auto& row : table.rows) row = {row[0], row[2]};
  }
  out.table(std::move(table));
  if (rung.actual_drop) out.paragraph(drop_sentence(rung));
  if (explains_no_more_than_chance(rung)) out.paragraph("The added effect explains no more than chance does.", Tone::warning);
  if (!rung.note.empty()) out.paragraph(as_sentence(rung.note));
  std::vector<std::string> parameters;
  for (const auto& [name, e] : rung.parameters) parameters.push_back(name + " = " + shown(e));
  out.list({parameters});
  return out;
}

Blocks blocks_of(const Ladder& ladder, const Rung& rung, const Fit& fit) {
  const Rung* parent = parent_of(ladder, rung);
  Blocks out;
  out.heading(fmt::format("Rung {}: {} added to {}", rung.id, added_in_words(rung), parent != nullptr ? parent->system : ""));
  out.append(rung_blocks(ladder, rung));
  out.warnings(fit.warnings);
  return out;
}

Blocks blocks_of(const Ladder& ladder) {
  Blocks out;
  out.heading("Ladder");
  out.figures("ladder");
  const bool trims = std::any_of(ladder.rungs.begin(), ladder.rungs.end(), [](const Rung& r) { return r.trim.has_value(); });
  TableBlock table{
      columns(std::string(">rung|added|system|>predicted drop|>actual drop|>held-out gain|random force") + (trims ? "|trim" : ""))};
  std::vector<std::string> remarks;
  for (const Rung& r : ladder.rungs) {
    table.rows.push_back({std::to_string(r.id), r.added.empty() ? "(the study)" : added_in_words(r), r.system, shown_drop(r.predicted_drop),
                          shown_drop(r.actual_drop), gain_in_table(r), force_text(r.force)});
    if (trims) table.rows.back().push_back(shown(r.trim));
    if (!r.parameters.empty()) remarks.push_back(fmt::format("Rung {}, {}: {}.", r.id, added_in_words(r), values_text(r.parameters)));
    if (!r.note.empty()) remarks.push_back(as_sentence(fmt::format("Rung {}: {}", r.id, r.note)));
  }
  out.table(std::move(table));
  const bool of_search =
      std::any_of(ladder.rungs.begin(), ladder.rungs.end(), [](const Rung& r) { return !r.held_out_gain && r.gain_of_search; });
  if (of_search) {
    out.paragraph(
        "Gains in parentheses are of the search: the study holds nothing out, so discovery fitted both models again without the last "
        "quarter "
        "of each experiment.");
  }
  out.table(error_table(ladder));
  out.list({remarks});
  return out;
}

}  // namespace misfit
