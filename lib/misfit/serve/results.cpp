#include "misfit/serve/results.h"

#include <fmt/format.h>

#include <algorithm>

#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "misfit/core/text.h"
#include "misfit/data/estimators.h"
#include "misfit/data/study_reader.h"
#include "misfit/workflow/assess/assess.h"
#include "misfit/workflow/estimate/estimate.h"

namespace misfit::serve {
namespace {

namespace fs = std::filesystem;

std::string stamp(const fs::path& file) {
  std::error_code none;
  const auto time = fs::last_write_time(file, none);
  if (none) return "-";
  return fmt::format("{}:{}", time.time_since_epoch().count(), fs::file_size(file, none));
}

/// nullopt where `read` finds no file of the right form.
template <class Read>
auto read_if(const fs::path& file, const Read& read) -> std::optional<decltype(read())> {
  std::error_code none;
  if (!fs::is_regular_file(file, none)) return std::nullopt;
  try {
    return read();
  } catch (const InputError&) {
    return std::nullopt;
  } catch (const RunError&) {
    return std::nullopt;
  }
}

/// A rung's study lies in the run folder, whatever ladder.json says.
bool is_inside(const fs::path& relative) {
  return relative.is_relative() && std::none_of(relative.begin(), relative.end(), [](const fs::path& part) { return part == ".."; });
}

}  // namespace

Results::Results(const SessionOptions& options) : study_(study_file(options.study)) {
  const fs::path beside = study_.has_parent_path() ? study_.parent_path() : fs::path(".");
  folder_ = options.out.empty() ? beside / "out" : fs::path(options.out);
}

std::string Results::version() const {
  std::string all = stamp(study_);
  for (const Place& place : places()) all += " " + stamp(place.folder / "run.json");
  return hash_text(all);
}

std::optional<Ladder> Results::ladder() const {
  const fs::path file = folder_ / "ladder.json";
  return read_if(file, [&] { return read_ladder(file); });
}

std::vector<Place> Results::places() const {
  std::vector<Place> out{{study_, folder_, 0, ""}};
  const std::optional<Ladder> known = ladder();
  for (const Rung& rung : known ? known->rungs : std::vector<Rung>{}) {
    if (rung.parent < 0 || !is_inside(rung.study)) continue;
    const fs::path study = folder_ / rung.study;
    out.push_back({study, study.parent_path() / "out", rung.id, rung.added});
  }
  return out;
}

std::vector<Fit> fits_of(const Place& place) {
  std::vector<Fit> out;
  for (const std::string& method : estimator_names()) {
    const fs::path folder = place.folder / "fit" / method;
    if (auto fit = read_if(folder / "fit.json", [&] { return read_fit(folder); })) out.push_back(std::move(*fit));
  }
  return out;
}

std::optional<Diagnosis> diagnosis_of(const Place& place) {
  return read_if(place.folder / "diagnosis.json", [&] { return read_diagnosis(place.folder); });
}

std::optional<Discovery> discovery_of(const Place& place) {
  return read_if(place.folder / "discovery.json", [&] { return read_discovery(place.folder); });
}

std::optional<Comparison> comparison_of(const Place& place) {
  const fs::path file = place.folder / "compare.json";
  return read_if(file, [&] { return read_comparison(file); });
}

std::optional<Calibration> calibration_of(const Place& place) {
  const fs::path file = place.folder / "camera.json";
  return read_if(file, [&] { return read_calibration(file); });
}

std::vector<std::string> outdated(const Session& session) {
  std::vector<std::string> old;
  const auto look = [&](const std::string& file, const std::string& name, const auto& current) {
    if (!read_if(session.folder.file(file), current).value_or(!fs::exists(session.folder.file(file)))) old.push_back(name);
  };
  for (const std::string& method : session.methods()) {
    const std::string stage = "fit/" + method;
    look(stage + "/fit.json", "the fit by " + method, [&] { return session.folder.up_to_date(stage, inputs_of_fit(session, method)); });
  }
  look("diagnosis.json", "the diagnosis", [&] { return known_diagnosis(session).has_value(); });
  look("discovery.json", "the candidates", [&] { return known_discovery(session).has_value(); });
  if (old.empty()) return {};
  return {"The study, its data or this program have changed since these were made: " + join_words(old) + ". Run makes them again."};
}

}  // namespace misfit::serve
