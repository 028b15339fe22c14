#pragma once

#include <map>
#include <optional>
#include <string>

#include "misfit/data/contained_fit.h"
#include "misfit/workflow/estimate/estimate.h"

namespace misfit {

/// A prepared study whose effects begin where a scan of their shapes has found most.
struct ScannedStudy {
  Model model;                               ///< as prepared, but for the values of these effects
  std::optional<ContainedFit> contained;     ///< of the model without them, where the model has its parameters first
  std::map<std::string, std::string> facts;  ///< of the fit: "start of EFFECT", in words
};

/// Effects with a free shape that discovery would scan (ScanSpec: a frequency, a sector, a delay, an edge, a time constant) and for which
/// the study gives no start: filter_error fits the model without them, and each begins where the score of its cells, refitted, is highest
/// (discover/scanned_start.h). nullopt: there is no such effect, or the model without them cannot be fitted.
[[nodiscard]] std::optional<ScannedStudy> scanned_study(Session& session, const Prepared& prepared);

}  // namespace misfit
