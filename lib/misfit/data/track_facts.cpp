#include "misfit/data/track_facts.h"

#include <fmt/format.h>

#include "misfit/data/json_fields.h"

namespace misfit {

template <class Archive>
void fields(Archive& json, MaybeConst<PlaneFacts> auto& p) {
  json("from", p.from), json("points", p.points), json("frames", p.frames), json("rms_px", p.rms);
  json("homography", p.homography), json("k1", p.k1), json("middle_column_px", p.column), json("middle_row_px", p.row);
  json("radius_px", p.radius), json("scale_m_per_px", p.scale), json("sigma_m", Sigma(p.sigma));
  json("warnings", p.warnings);
}

template <class Archive>
void fields(Archive& json, MaybeConst<TrackFacts> auto& f) {
  json("video", f.video), json("width", f.width), json("height", f.height), json("frames_per_second", f.rate);
  json("variable_rate", f.variable);
  json.group("frames", [&](auto& frames) {
    frames("declared", f.declared), frames("decoded", f.decoded), frames("missing", f.missing);
    frames("repeated", f.repeated);
  });
  json.group("fields", [&](auto& fields_read) {
    fields_read("used", f.fields), fields_read("shown", f.fields_shown), fields_read("evidence", f.fields_evidence);
  });
  json.group("marker", [&](auto& marker) {
    marker("kind", f.marker), marker("chosen", f.chosen), marker("outer_px", f.outer), marker("inner_px", f.inner);
  });
  json("samples", f.samples), json("ok", f.ok), json("lost", f.lost), json("sigma_px", f.sigma);
  json("warnings", f.warnings), json("plane", f.plane);
}

void write_track_facts(const std::filesystem::path& path, const TrackFacts& facts) { write_json(path, facts); }

TrackFacts read_track_facts(const std::filesystem::path& path) { return read_json<TrackFacts>(path); }

namespace {

/// What the user is told of the map from pixels to metres.
std::string sentence(const PlaneFacts& p) {
  const std::string frames = p.frames > 0 ? fmt::format(" in {} frames", p.frames) : "";
  const std::string lens = p.k1 != 0.0 ? fmt::format(", lens k1 = {:.3f}", p.k1) : "";
  const std::string known = p.sigma > 0.0 ? fmt::format(", known to {:.2g} m", p.sigma)
                                          : ", which four points give exactly: nothing is left that could show an error";
  return fmt::format("metres from {}: {} places{}, {:.3f} px RMS from where the map has them{}; {:.4g} m/px where the track is{}",
                     p.from == "aruco"        ? "the tag"
                     : p.from == "chessboard" ? "the chessboard"
                                              : "known points",
                     p.points, frames, p.rms, lens, p.scale, known);
}

}  // namespace

std::vector<std::string> sentences(const TrackFacts& f) {
  std::vector<std::string> out;
  const std::string declared = f.declared > 0 ? fmt::format(" of {} declared", f.declared) : ", the file does not say how many it has";
  out.push_back(fmt::format("{}: {} x {} pixels at {:.6g} frames/s{}; {} frames decoded{}", f.video, f.width, f.height, f.rate,
                            f.variable ? " (variable)" : "", f.decoded, declared));
  out.push_back(
      fmt::format("read as {}{}: {}", f.fields, f.fields == "progressive" ? "" : fmt::format(", {} fields", f.samples), f.fields_evidence));
  const std::string what = f.marker == "moving" ? "an object that moves, by its outline" : f.marker;
  const std::string choice = f.chosen.empty() ? "" : " (chosen: " + f.chosen + ")";
  const std::string middle = f.inner > 0.0 ? fmt::format(", its middle {:.1f} px", 2.0 * f.inner) : "";
  out.push_back("marker: " + what + (f.outer > 0.0 ? fmt::format(", {:.1f} px across{}", 2.0 * f.outer, middle) : "") + choice);
  if (f.plane) out.push_back(sentence(*f.plane));
  std::string lost;
  for (const auto& [why, count] : f.lost) lost += fmt::format("{}{} {}", lost.empty() ? ": " : ", ", count, why);
  out.push_back(fmt::format("{} of {} samples ok, median sigma {:.3f} px; {} lost{}", f.ok, f.samples, f.sigma, f.samples - f.ok, lost));
  return out;
}

}  // namespace misfit
