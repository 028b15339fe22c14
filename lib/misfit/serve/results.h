#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "misfit/page/places.h"
#include "misfit/workflow/session/session.h"

namespace misfit::serve {

/// The study whose page is shown, and its run folder.
class Results {
 public:
  explicit Results(const SessionOptions& options);

  [[nodiscard]] const std::filesystem::path& study() const { return study_; }
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  /// Another text whenever a file of the study or of its ladder may have changed.
  [[nodiscard]] std::string version() const;
  [[nodiscard]] std::vector<page::Place> places() const { return page::places_of(study_, folder_); }

 private:
  std::filesystem::path study_, folder_;
};

/// What of the results does not belong to the study as it is now, in sentences. `session`: opened to read.
[[nodiscard]] std::vector<std::string> outdated(const Session& session);

}  // namespace misfit::serve
