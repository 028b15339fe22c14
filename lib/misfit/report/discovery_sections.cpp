// The sections on what the model lacks: ladder, diagnosis, candidates.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "misfit/core/display.h"
#include "misfit/core/text.h"
#include "misfit/core/units.h"
#include "misfit/report/figures_discovery.h"
#include "misfit/report/rows.h"
#include "misfit/report/sections.h"

namespace misfit::report {
namespace {

using Cells = std::vector<std::vector<std::string>>;
using Put = std::function<void(Figure)>;

/// Draws figures of a rung under names of their own.
Put put_for(const Draw& draw, const std::string& prefix) {
  return [&draw, prefix](Figure figure) {
    figure.name = prefix + figure.name;
    draw(figure);
  };
}

/// "rung 2, strut_wake added": which model a section is about.
std::string name_of(const RungInput& rung) { return fmt::format("rung {}, {} added", rung.id, rung.added); }
std::string prefix_of(const RungInput& rung) { return fmt::format("rung_{:02}_", rung.id); }

/// Said only where there is a choice.
void say_which(const ReportInput& input, const std::string& of, Page& page) {
  if (input.ladder && input.ladder->rungs.size() > 1) page.paragraph("Of " + of + ".");
}
constexpr const char* own_model = "the study's own model, before anything was added (rung 0)";

std::string shown(const Estimate& e) { return in_display_unit(e.value, e.unit, e.sigma); }

std::string number(const std::optional<double>& value) { return value && std::isfinite(*value) ? fmt::format("{:.1f}", *value) : "–"; }

std::string all(const std::map<std::string, Estimate>& estimates) {
  std::string text;
  for (const auto& [name, e] : estimates) text += (text.empty() ? "" : "; ") + name + " " + shown(e);
  return text.empty() ? "–" : text;
}

/// One strength where the ports share it, without the correlation time.
std::string force_of(const Rung& rung) {
  for (const auto& [port, e] : rung.force) {
    if (e.unit != "s") return shown(e);
  }
  return "–";
}

void ladder_table(const Ladder& ladder, Page& page) {
  Cells rows{{"rung", "added", "system", "predicted drop", "actual drop", "held-out gain", "random force", "RMS, one step", "RMS, held out",
              "trim"}};
  for (const Rung& r : ladder.rungs) {
    rows.push_back({std::to_string(r.id), r.added.empty() ? "–" : r.added, r.system, number(r.predicted_drop), number(r.actual_drop),
                    number(r.held_out_gain), force_of(r), all(r.rms), all(r.validation_rms), r.trim ? shown(*r.trim) : "–"});
  }
  page.table(rows);
}

/// Maps worth a picture: those that stand out, at least three, at most eight. They come sorted.
std::size_t maps_to_draw(const std::vector<ForceMap>& maps) {
  constexpr double stands_out = 0.01;
  constexpr std::size_t least = 3, most = 8;
  const auto found =
      static_cast<std::size_t>(std::count_if(maps.begin(), maps.end(), [](const ForceMap& map) { return map.p_corrected < stands_out; }));
  return std::min(maps.size(), std::clamp(found, least, most));
}

void maps_table(const Diagnosis& d, Page& page) {
  Cells rows{{"force on", "against", "p, corrected for all maps", "p, this map alone", "chi²", "dof"}};
  for (const ForceMap& m : d.maps) {
    rows.push_back({m.port, m.quantity, format_probability(m.p_corrected), format_probability(m.p_value), fmt::format("{:.1f}", m.chi2),
                    std::to_string(m.dof)});
  }
  for (const PairMap& m : d.pairs) {
    rows.push_back({m.port, m.quantity_x + " and " + m.quantity_y, format_probability(m.p_corrected), format_probability(m.p_value),
                    fmt::format("{:.1f}", m.chi2), std::to_string(m.dof)});
  }
  page.table(rows);
}

void force_figures(const Diagnosis& d, const Put& draw) {
  constexpr double part = 10.0;
  for (const MissingForce& missing : d.missing) {
    draw(missing_force_figure(missing, std::nullopt));
    if (!missing.t.empty() && missing.t.back() - missing.t.front() > 2.0 * part && !missing.force.empty())
      draw(missing_force_figure(missing, typical_interval(missing.t, missing.force.front(), part)));
    const std::string quantity = d.maps.empty() ? "" : d.maps.front().quantity;
    if (std::find(missing.quantities.begin(), missing.quantities.end(), quantity) != missing.quantities.end())
      draw(missing_force_by_figure(missing, quantity));
  }
}

}  // namespace

void ladder_section(const ReportInput& input, Page& page, const Draw& draw) {
  if (!input.ladder || input.ladder->rungs.size() < 2) return;
  page.section("The ladder");
  draw(ladder_figure(*input.ladder));
  ladder_table(*input.ladder, page);
  std::vector<std::string> remarks;
  for (const Rung& rung : input.ladder->rungs) {
    if (!rung.parameters.empty()) remarks.push_back(fmt::format("rung {}, {}: {}", rung.id, rung.added, all(rung.parameters)));
    if (!rung.note.empty()) remarks.push_back(fmt::format("rung {}: {}", rung.id, rung.note));
  }
  page.list(remarks);
}

namespace {

void show_diagnosis(const Diagnosis& d, Page& page, const Put& draw) {
  for (const auto& sentence : d.sentences) page.paragraph(sentence);
  const std::size_t drawn = maps_to_draw(d.maps);
  for (std::size_t k = 0; k < drawn; ++k) draw(map_figure(d.maps[k]));
  constexpr std::size_t most_pairs = 2;
  for (std::size_t k = 0; k < std::min(most_pairs, d.pairs.size()); ++k) draw(pair_figure(d.pairs[k]));
  page.subsection("All maps");
  maps_table(d, page);
  page.subsection("Innovations");
  if (!d.whiteness.empty()) {
    draw(innovation_figure(d.whiteness));
    draw(periodogram_figure(d.whiteness));
  }
  for (const NisSeries& series : d.nis) draw(nis_figure(series));
  if (!d.missing.empty()) page.subsection("The missing force");
  force_figures(d, draw);
}

void show_discovery(const Discovery& d, Page& page, const Put& draw) {
  page.paragraph(d.verdict, "question");
  for (const auto& sentence : d.sentences) page.paragraph(sentence);
  if (d.candidates.empty()) return;
  draw(candidates_figure(d.candidates));
  Cells rows{{"rank", "effect", "predicted drop", "actual drop", "held-out gain", "p", "indistinguishable from", "accepted", "why"}};
  for (const Candidate& c : d.candidates) {
    std::string group;
    for (const auto& name : c.group) {
      if (name != effect_at(c.effect, c.roles)) group += (group.empty() ? "" : ", ") + name;
    }
    rows.push_back({std::to_string(c.rank), effect_at(c.effect, c.roles), number(c.predicted_drop), number(c.actual_drop),
                    number(c.held_out_gain), format_probability(c.p_value), group.empty() ? "–" : group, c.accepted ? "yes" : "no", c.why});
  }
  page.table(rows);
  if (!d.tried.empty()) page.subsection("Effect families tested");
  page.list(d.tried);
}

}  // namespace

void diagnosis_section(const ReportInput& input, Page& page, const Draw& draw) {
  if (input.diagnosis) {
    page.section("Residual diagnostics");
    say_which(input, own_model, page);
    show_diagnosis(*input.diagnosis, page, put_for(draw, ""));
  }
  if (!input.rung || !input.rung->diagnosis) return;
  page.section("Residual diagnostics of " + name_of(*input.rung));
  show_diagnosis(*input.rung->diagnosis, page, put_for(draw, prefix_of(*input.rung)));
}

void discovery_section(const ReportInput& input, Page& page, const Draw& draw) {
  if (input.discovery) {
    page.section("Candidate effects");
    say_which(input, own_model, page);
    show_discovery(*input.discovery, page, put_for(draw, ""));
  }
  if (!input.rung || !input.rung->discovery) return;
  page.section("Candidate effects after " + name_of(*input.rung));
  show_discovery(*input.rung->discovery, page, put_for(draw, prefix_of(*input.rung)));
}

}  // namespace misfit::report
