#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include "misfit/page/places.h"
#include "misfit/workflow/session/session.h"

namespace misfit::serve {

/// Another text whenever the file may have changed.
[[nodiscard]] std::string file_stamp(const std::filesystem::path& file);

/// The study whose page is shown, and its run folder.
class Results {
 public:
  explicit Results(const SessionOptions& options);

  [[nodiscard]] const std::filesystem::path& study() const { return study_; }
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  /// Another text whenever a file that the study names, or one of its results or of its ladder, may have changed.
  [[nodiscard]] std::string version() const;
  /// The models: those of the ladder where it is that of the study as it is now.
  [[nodiscard]] std::vector<page::Place> places() const { return page::places_of(study_, folder_, ladder_is_current_); }
  /// Whether the ladder in the run folder is, as known_ladder() says of an opened session.
  void know_ladder(bool current) const { ladder_is_current_ = current; }

 private:
  std::filesystem::path study_, folder_;
  mutable std::atomic<bool> ladder_is_current_ = true;
};

/// What of the results does not belong to the study as it is now, in sentences: of its own model and of the rungs among `places`.
/// `session`: the study, opened to read; `registry`: of the program.
[[nodiscard]] std::vector<std::string> outdated(const Session& session, const std::vector<page::Place>& places, const Registry& registry);

}  // namespace misfit::serve
