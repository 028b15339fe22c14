// The sections on what the model lacks: ladder, diagnosis, candidates.

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "misfit/report/figures_discovery.h"
#include "misfit/report/sections.h"
#include "misfit/show/results.h"

namespace misfit::report {
namespace {

using Put = std::function<void(Figure)>;

constexpr std::size_t part_of_force = 600;  // samples

/// Maps worth a picture: those that stand out, at least three, at most eight. They come sorted.
std::size_t maps_to_draw(const std::vector<ForceMap>& maps) {
  constexpr double significant = 0.01;
  constexpr std::ptrdiff_t least = 3, most = 8;
  const auto found = std::count_if(maps.begin(), maps.end(), [](const ForceMap& map) { return map.p_corrected < significant; });
  return std::min(std::ssize(maps), std::clamp(found, least, most));
}

void draw_maps(const Diagnosis& d, const Put& draw) {
  const std::size_t drawn = maps_to_draw(d.maps);
  for (std::size_t k = 0; k < drawn; ++k) draw(map_figure(d.maps[k]));
  constexpr std::size_t max_pairs = 2;
  for (std::size_t k = 0; k < std::min(max_pairs, d.pairs.size()); ++k) draw(pair_figure(d.pairs[k]));
}

void draw_innovations(const Diagnosis& d, const Put& draw) {
  draw(innovation_figure(d.whiteness));
  draw(periodogram_figure(d.whiteness));
  for (const NisSeries& series : d.nis) draw(nis_figure(series));
}

void draw_force(const Diagnosis& d, const Put& draw) {
  for (const MissingForce& missing : d.missing) {
    draw(missing_force_figure(missing, std::nullopt));
    if (missing.force.empty()) continue;
    if (const auto part = part_to_draw(missing.t, missing.force.front(), part_of_force)) draw(missing_force_figure(missing, part));
    const std::string quantity = d.maps.empty() ? "" : d.maps.front().quantity;
    if (std::find(missing.quantities.begin(), missing.quantities.end(), quantity) != missing.quantities.end())
      draw(missing_force_by_figure(missing, quantity));
  }
}

void show(const Diagnosis& d, const Subject& subject, Page& page, const Draw& draw) {
  const Put put = [&](Figure figure) {
    figure.name = subject.prefix + figure.name;
    draw(figure);
  };
  const auto figures = [&](const std::string& place) {
    if (place == "maps") draw_maps(d, put);
    if (place == "innovations") draw_innovations(d, put);
    if (place == "force") draw_force(d, put);
  };
  page.show(blocks_of(d), figures, subject.note);
}

/// What the accepted candidate adds, beside what is missing.
void draw_added_force(const Discovery& d, const Diagnosis& diagnosis, const Put& draw) {
  const auto accepted = std::find_if(d.candidates.begin(), d.candidates.end(), [](const Candidate& c) { return c.accepted; });
  if (accepted == d.candidates.end()) return;
  for (const AddedForce& added : accepted->added) {
    for (const MissingForce& missing : diagnosis.missing) {
      if (missing.experiment != added.experiment) continue;
      draw(added_force_figure(missing, *accepted, part_to_draw(added.t, added.force.front(), part_of_force)));
    }
  }
}

void show(const Discovery& d, const std::optional<Diagnosis>& diagnosis, const Subject& subject, Page& page, const Draw& draw) {
  const Put put = [&](Figure figure) {
    figure.name = subject.prefix + figure.name;
    draw(figure);
  };
  const auto figures = [&](const std::string&) {
    if (d.candidates.empty()) return;
    put(candidates_figure(d.candidates));
    if (diagnosis) draw_added_force(d, *diagnosis, put);
  };
  page.show(blocks_of(d), figures, subject.note);
}

/// One under the other, the last first and open.
void show_rungs(const Ladder& ladder, Page& page) {
  for (auto rung = ladder.rungs.rbegin(); rung != ladder.rungs.rend(); ++rung) {
    const bool first = rung->added.empty();
    page.choice("rung", fmt::format("Rung {}: {}", rung->id, first ? rung->system + ", the study's own model" : rung->added + " added"),
                rung == ladder.rungs.rbegin());
    page.show(rung_blocks(ladder, *rung));
    page.unfold();
  }
}

}  // namespace

Subject of_rung(int id, const std::string& added) {
  return {fmt::format(": rung {}, {} added", id, added), fmt::format("rung_{:02}_", id)};
}

Subject of_study(const ReportInput& input) {
  return {input.ladder && input.ladder->rungs.size() > 1 ? ": the study's own model (rung 0)" : "", ""};
}

std::vector<ModelResults> models_of(const ReportInput& input) {
  std::vector<ModelResults> out;
  if (input.last_model) {
    const LastModel& last = *input.last_model;
    out.push_back({of_rung(last.id, last.added), &last.fits, &last.comparison});
  }
  out.push_back({of_study(input), &input.fits, input.comparison ? &*input.comparison : nullptr});
  return out;
}

void ladder_section(const ReportInput& input, Page& page, const Draw& draw) {
  if (!input.ladder || input.ladder->rungs.size() < 2) return;
  page.show(blocks_of(*input.ladder), [&](const std::string&) {
    draw(ladder_figure(*input.ladder));
    show_rungs(*input.ladder, page);
    page.fold("All rungs in numbers");
  });
  page.unfold();
}

void diagnosis_section(const ReportInput& input, Page& page, const Draw& draw) {
  if (input.diagnosis) show(*input.diagnosis, of_study(input), page, draw);
  if (input.rung && input.rung->diagnosis) show(*input.rung->diagnosis, of_rung(input.rung->id, input.rung->added), page, draw);
}

void discovery_section(const ReportInput& input, Page& page, const Draw& draw) {
  if (input.discovery) show(*input.discovery, input.diagnosis, of_study(input), page, draw);
  if (input.rung && input.rung->discovery)
    show(*input.rung->discovery, input.rung->diagnosis, of_rung(input.rung->id, input.rung->added), page, draw);
}

}  // namespace misfit::report
