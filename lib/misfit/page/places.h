#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "misfit/data/calibration.h"
#include "misfit/data/candidates.h"
#include "misfit/data/comparison.h"
#include "misfit/data/diagnosis.h"
#include "misfit/data/fit.h"
#include "misfit/data/ladder.h"

namespace misfit::page {

/// A model of the study: its own, or that of a rung of its ladder.
struct Place {
  std::filesystem::path study, folder;  ///< study.toml, run folder
  int id = 0;
  std::string added;                      ///< "" for the study's own
  std::vector<std::string> methods = {};  ///< whose fits are shown; empty: all that are there
  bool diagnosed = true, asked = true;    ///< false: what diagnose, or discover, left there is of another fit and not shown
  std::size_t most_samples = 0;           ///< of a recording: longer ones are thinned (thinned.h); 0: shown whole
};

// What lies in a run folder, looked at and never changed. Files that are not there or cannot be read are left out: another process may be
// writing them.

[[nodiscard]] std::optional<Ladder> ladder_in(const std::filesystem::path& folder);
/// The study's own, then the rungs of the ladder in its run folder; false: that ladder is of the study as it was, and none of them is
/// shown.
[[nodiscard]] std::vector<Place> places_of(const std::filesystem::path& study, const std::filesystem::path& folder, bool with_rungs = true);

[[nodiscard]] std::vector<Fit> fits_of(const Place& place);
/// Those that there is a fit of.
[[nodiscard]] std::vector<std::string> fitted_methods(const Place& place);
[[nodiscard]] std::optional<Fit> fit_of(const Place& place, const std::string& method);
[[nodiscard]] std::optional<Diagnosis> diagnosis_of(const Place& place);
[[nodiscard]] std::optional<Discovery> discovery_of(const Place& place);
[[nodiscard]] std::optional<Comparison> comparison_of(const Place& place);
[[nodiscard]] std::optional<Calibration> calibration_of(const Place& place);
/// Of these the main files: that of each fit, and the others; those that are there.
[[nodiscard]] std::vector<std::filesystem::path> files_of(const Place& place);

}  // namespace misfit::page
