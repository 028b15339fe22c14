#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "misfit/export/exported.h"
#include "misfit/workflow/session/session.h"

namespace misfit {

/// What to export, and how.
struct ExportRequest {
  std::string format;              ///< one of export_formats()
  std::filesystem::path out = {};  ///< the file (of csv: the folder); "-": none, the text alone; empty: in export/ of the run folder
  std::string method = {};         ///< empty: the last of the study that has an estimate
  std::string rung = {};           ///< number or added effect; empty: the last of the ladder
};

/// What was written.
struct ExportReport {
  Exported exported;
  std::vector<std::filesystem::path> files;
  std::string text;                   ///< instead of a file where the path is "-"
  std::vector<std::string> left_out;  ///< effects of the model that a file for JSBSim does not have
  std::string lack;                   ///< why a C or Python file has no right-hand side; empty: it has one, or the format has none
};

/// "json", "csv", "c", "python", "jsbsim".
[[nodiscard]] std::vector<std::string> export_formats();

/// The estimate that lies in the run folder: nothing is fitted. InputError where there is none, where study or data have changed since, or
/// the request names what there is not; RunError where the method declined.
[[nodiscard]] Exported exported_estimate(const SessionOptions& options, const Registry& registry, const ExportRequest& request);
/// The same, and its file.
ExportReport export_stage(const SessionOptions& options, const Registry& registry, const ExportRequest& request);

}  // namespace misfit
