#include "misfit/page/places.h"

#include <algorithm>

#include "misfit/data/estimators.h"
#include "misfit/page/read_if.h"
#include "misfit/page/thinned.h"

namespace misfit::page {
namespace {

namespace fs = std::filesystem;

/// A rung's study lies in the run folder, whatever ladder.json says.
bool is_inside(const fs::path& relative) {
  return relative.is_relative() && std::none_of(relative.begin(), relative.end(), [](const fs::path& part) { return part == ".."; });
}

template <class Result>
std::optional<Result> as_shown(const Place& place, std::optional<Result> result) {
  if (result && place.most_samples > 0) thin(*result, place.most_samples);
  return result;
}

}  // namespace

std::optional<Ladder> ladder_in(const fs::path& folder) {
  const fs::path file = folder / "ladder.json";
  return read_if(file, [&] { return read_ladder(file); });
}

std::vector<Place> places_of(const fs::path& study, const fs::path& folder, bool with_rungs) {
  std::vector<Place> out{{study, folder, 0, ""}};
  const std::optional<Ladder> known = with_rungs ? ladder_in(folder) : std::nullopt;
  for (const Rung& rung : known ? known->rungs : std::vector<Rung>{}) {
    if (rung.parent < 0 || !is_inside(rung.study)) continue;
    const fs::path its_study = folder / rung.study;
    out.push_back({its_study, its_study.parent_path() / "out", rung.id, rung.added});
  }
  return out;
}

std::optional<Fit> fit_of(const Place& place, const std::string& method) {
  const fs::path folder = place.folder / "fit" / method;
  return as_shown(place, read_if(folder / "fit.json", [&] { return read_fit(folder); }));
}

std::vector<std::string> fitted_methods(const Place& place) {
  std::vector<std::string> out;
  for (const std::string& method : place.methods.empty() ? estimator_names() : place.methods) {
    std::error_code none;
    if (fs::is_regular_file(place.folder / "fit" / method / "fit.json", none)) out.push_back(method);
  }
  return out;
}

std::vector<Fit> fits_of(const Place& place) {
  std::vector<Fit> out;
  for (const std::string& method : fitted_methods(place)) {
    if (auto fit = fit_of(place, method)) out.push_back(std::move(*fit));
  }
  return out;
}

std::optional<Diagnosis> diagnosis_of(const Place& place) {
  if (!place.diagnosed) return std::nullopt;
  return as_shown(place, read_if(place.folder / "diagnosis.json", [&] { return read_diagnosis(place.folder); }));
}

std::optional<Discovery> discovery_of(const Place& place) {
  if (!place.asked) return std::nullopt;
  return as_shown(place, read_if(place.folder / "discovery.json", [&] { return read_discovery(place.folder); }));
}

std::optional<Comparison> comparison_of(const Place& place) {
  const fs::path file = place.folder / "compare.json";
  return read_if(file, [&] { return read_comparison(file); });
}

std::optional<Calibration> calibration_of(const Place& place) {
  const fs::path file = place.folder / "camera.json";
  return read_if(file, [&] { return read_calibration(file); });
}

std::vector<fs::path> files_of(const Place& place) {
  std::vector<fs::path> out;
  const auto add = [&](const fs::path& file) {
    std::error_code none;
    if (fs::is_regular_file(place.folder / file, none)) out.push_back(place.folder / file);
  };
  for (const std::string& method : estimator_names()) add(fs::path("fit") / method / "fit.json");
  for (const char* file : {"diagnosis.json", "discovery.json", "compare.json", "camera.json"}) add(file);
  return out;
}

}  // namespace misfit::page
