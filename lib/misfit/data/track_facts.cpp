#include "misfit/data/track_facts.h"

#include <fmt/format.h>

#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "misfit/data/json_number.h"

namespace misfit {

void write_track_facts(const std::filesystem::path& path, const TrackFacts& f) {
  Json lost = Json::object();
  for (const auto& [why, count] : f.lost) lost[why] = count;
  const Json root = {{"video", f.video},
                     {"width", f.width},
                     {"height", f.height},
                     {"frames_per_second", f.rate},
                     {"frames", {{"declared", f.declared}, {"decoded", f.decoded}, {"missing", f.missing}, {"repeated", f.repeated}}},
                     {"fields", {{"used", f.fields}, {"shown", f.fields_shown}, {"evidence", f.fields_evidence}}},
                     {"marker", {{"kind", f.marker}, {"outer_px", f.outer}, {"inner_px", f.inner}}},
                     {"samples", f.samples},
                     {"ok", f.ok},
                     {"lost", lost},
                     {"sigma_px", number_or_null(f.sigma)},
                     {"warnings", f.warnings}};
  write_atomically(path, root.dump(1) + "\n");
}

TrackFacts read_track_facts(const std::filesystem::path& path) {
  TrackFacts f;
  try {
    const Json root = Json::parse(read_file(path));
    f.video = root.at("video");
    f.width = root.at("width");
    f.height = root.at("height");
    f.rate = root.at("frames_per_second");
    const Json& frames = root.at("frames");
    f.declared = frames.at("declared");
    f.decoded = frames.at("decoded");
    f.missing = frames.at("missing");
    f.repeated = frames.at("repeated");
    const Json& fields = root.at("fields");
    f.fields = fields.at("used");
    f.fields_shown = fields.at("shown");
    f.fields_evidence = fields.at("evidence");
    f.marker = root.at("marker").at("kind");
    f.outer = root.at("marker").at("outer_px");
    f.inner = root.at("marker").at("inner_px");
    f.samples = root.at("samples");
    f.ok = root.at("ok");
    for (const auto& [why, count] : root.at("lost").items()) f.lost[why] = count;
    f.sigma = number_or_nan(root, "sigma_px");
    for (const auto& warning : root.at("warnings")) f.warnings.push_back(warning);
  } catch (const nlohmann::json::exception& error) {
    throw InputError({path.string(), 0, 0}, std::string("no track.json of misfit: ") + error.what());
  }
  return f;
}

std::vector<std::string> sentences(const TrackFacts& f) {
  std::vector<std::string> out;
  const std::string declared = f.declared > 0 ? fmt::format(" of {} declared", f.declared) : ", the file does not say how many it has";
  out.push_back(
      fmt::format("{}: {} x {} pixels at {:.6g} frames/s; {} frames decoded{}", f.video, f.width, f.height, f.rate, f.decoded, declared));
  out.push_back(
      fmt::format("read as {}{}: {}", f.fields, f.fields == "progressive" ? "" : fmt::format(", {} fields", f.samples), f.fields_evidence));
  out.push_back(f.outer > 0.0 ? fmt::format("marker: {}, {:.1f} px across{}", f.marker, 2.0 * f.outer,
                                            f.inner > 0.0 ? fmt::format(", its middle {:.1f} px", 2.0 * f.inner) : "")
                              : "marker: " + f.marker);
  std::string lost;
  for (const auto& [why, count] : f.lost) lost += fmt::format("{}{} {}", lost.empty() ? ": " : ", ", count, why);
  out.push_back(fmt::format("{} of {} samples ok, median sigma {:.3f} px; {} lost{}", f.ok, f.samples, f.sigma, f.samples - f.ok, lost));
  return out;
}

}  // namespace misfit
