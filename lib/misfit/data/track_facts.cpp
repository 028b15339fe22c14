#include "misfit/data/track_facts.h"

#include <fmt/format.h>

#include "misfit/data/json_fields.h"

namespace misfit {

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
  json("warnings", f.warnings);
}

void write_track_facts(const std::filesystem::path& path, const TrackFacts& facts) { write_json(path, facts); }

TrackFacts read_track_facts(const std::filesystem::path& path) { return read_json<TrackFacts>(path); }

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
  std::string lost;
  for (const auto& [why, count] : f.lost) lost += fmt::format("{}{} {}", lost.empty() ? ": " : ", ", count, why);
  out.push_back(fmt::format("{} of {} samples ok, median sigma {:.3f} px; {} lost{}", f.ok, f.samples, f.sigma, f.samples - f.ok, lost));
  return out;
}

}  // namespace misfit
