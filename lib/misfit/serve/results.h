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
#include "misfit/workflow/session/session.h"

namespace misfit::serve {

/// A model of the study: its own, or that of a rung of its ladder.
struct Place {
  std::filesystem::path study, folder;  ///< study.toml, run folder
  int id = 0;
  std::string added;  ///< "" for the study's own
};

/// What lies in the run folder of a study, looked at and never changed. Files that are not there or cannot be read are left out: another
/// process may be writing them.
class Results {
 public:
  explicit Results(const SessionOptions& options);

  [[nodiscard]] const std::filesystem::path& study() const { return study_; }
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  /// Another text whenever a file of the study or of its ladder may have changed.
  [[nodiscard]] std::string version() const;

  [[nodiscard]] std::optional<Ladder> ladder() const;
  /// The study's own, then the rungs.
  [[nodiscard]] std::vector<Place> places() const;

 private:
  std::filesystem::path study_, folder_;
};

[[nodiscard]] std::vector<Fit> fits_of(const Place& place);
[[nodiscard]] std::optional<Diagnosis> diagnosis_of(const Place& place);
[[nodiscard]] std::optional<Discovery> discovery_of(const Place& place);
[[nodiscard]] std::optional<Comparison> comparison_of(const Place& place);
[[nodiscard]] std::optional<Calibration> calibration_of(const Place& place);

/// What of these does not belong to the study as it is now, in sentences. `session`: opened to read.
[[nodiscard]] std::vector<std::string> outdated(const Session& session);

}  // namespace misfit::serve
