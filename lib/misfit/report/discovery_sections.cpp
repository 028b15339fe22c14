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

/// The model that a section is about.
struct Subject {
  std::string note;    ///< for headings: " (rung 2, strut_wake added)"
  std::string prefix;  ///< of the names of its figures
};

Subject of_rung(const RungInput& rung) {
  return {fmt::format(" (rung {}, {} added)", rung.id, rung.added), fmt::format("rung_{:02}_", rung.id)};
}

/// Named only where there is a choice.
Subject of_study(const ReportInput& input) {
  return {input.ladder && input.ladder->rungs.size() > 1 ? " (rung 0, the study's model)" : "", ""};
}

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
  constexpr double part = 10.0;  // [s]
  for (const MissingForce& missing : d.missing) {
    draw(missing_force_figure(missing, std::nullopt));
    if (!missing.t.empty() && missing.t.back() - missing.t.front() > 2.0 * part && !missing.force.empty())
      draw(missing_force_figure(missing, typical_interval(missing.t, missing.force.front(), part)));
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

void show(const Discovery& d, const Subject& subject, Page& page, const Draw& draw) {
  const auto figures = [&](const std::string&) {
    if (d.candidates.empty()) return;
    Figure figure = candidates_figure(d.candidates);
    figure.name = subject.prefix + figure.name;
    draw(figure);
  };
  page.show(blocks_of(d), figures, subject.note);
}

/// One under the other, the last first and open.
void show_rungs(const Ladder& ladder, Page& page) {
  for (auto rung = ladder.rungs.rbegin(); rung != ladder.rungs.rend(); ++rung) {
    const bool first = rung->added.empty();
    page.choice("rung", fmt::format("Rung {}: {}", rung->id, first ? rung->system + ", the study's model" : rung->added + " added"),
                rung == ladder.rungs.rbegin());
    page.show(rung_blocks(ladder, *rung));
    page.unfold();
  }
}

}  // namespace

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
  if (input.rung && input.rung->diagnosis) show(*input.rung->diagnosis, of_rung(*input.rung), page, draw);
}

void discovery_section(const ReportInput& input, Page& page, const Draw& draw) {
  if (input.discovery) show(*input.discovery, of_study(input), page, draw);
  if (input.rung && input.rung->discovery) show(*input.rung->discovery, of_rung(*input.rung), page, draw);
}

}  // namespace misfit::report
