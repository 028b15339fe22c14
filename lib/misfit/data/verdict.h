#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "misfit/data/fit.h"

namespace misfit {

enum class VerdictKind {
  nothing_missing,   ///< no effect is needed
  random_force,      ///< the same; what drives the motion is a random force
  not_searched,      ///< discover has not looked yet which effect is missing, or whether one is
  missing,           ///< one effect is named
  several_possible,  ///< one of several that the data cannot distinguish
  unknown_form,      ///< something is missing that no effect of the library explains
  effect_added,      ///< the ladder has what was missing, and nothing more is
  calibration,       ///< the camera's calibration is to be corrected first
  not_decided,       ///< not tested to the end, or the best candidate was rejected
  no_result          ///< no method could be used
};
inline constexpr std::array<const char*, 10> verdict_names = {"nothing_missing",  "random_force", "not_searched", "missing",
                                                              "several_possible", "unknown_form", "effect_added", "calibration",
                                                              "not_decided",      "no_result"};

/// By which a model is judged.
enum class ErrorKind { rms_error, random_force, trim };
inline constexpr std::array<const char*, 3> error_kind_names = {"RMS error", "random force", "trim"};

/// `after` differs from `before` by less than the larger of their sigmas: no change is seen. False where no sigma is known.
[[nodiscard]] bool within_sigma(const Estimate& before, const Estimate& after);

/// An error of the model before and after an effect is in it.
struct ErrorChange {
  ErrorKind kind = ErrorKind::rms_error;
  std::string of;                 ///< "P_y 32 samples ahead", a random force's port; empty: of the model as a whole
  Estimate before;                ///< SI
  std::optional<Estimate> after;  ///< missing: no effect was added
  std::string remark;             ///< in words: "1.1 % of the motion"

  /// "RMS error of P_y 32 samples ahead".
  [[nodiscard]] std::string what() const;
  /// 100 (after/before − 1); nullopt where either is not there.
  [[nodiscard]] std::optional<double> per_cent() const;
  [[nodiscard]] bool within_sigma() const { return after && misfit::within_sigma(before, *after); }
};

/// What a study has come to: one sentence from calibration, fits, diagnosis, discovery and ladder together.
struct Verdict {
  VerdictKind kind = VerdictKind::no_result;
  std::string sentence;
  std::vector<std::string> notes;   ///< sentences below it: what was tried in vain, what it cannot be told from, why it is not certain
  std::string where;                ///< where the study's own model fails, in a sentence; empty: nowhere that stands out
  std::vector<ErrorChange> errors;  ///< the most telling first
  std::vector<std::string> added;   ///< effects of the ladder with their estimates in its last model, a line each
  std::vector<std::string> doubts;  ///< Fit::doubts of the last model
  std::string parameters;           ///< of the fitted model with sigma and unit, where nothing was added and no named effect is to come
  std::optional<ErrorChange> trim;  ///< before and after, beside the references of the study (remark)
  std::string next;                 ///< what to do: a command; empty: nothing
};

/// verdict.json:
/// {"verdict","sentence","notes":["…"],"where","errors":[{"what","before":{"value","sigma","unit"},"after","change_per_cent","remark"}],"added","doubts","parameters","trim","next"};
/// null for what is not known.
void write_verdict(const std::filesystem::path& path, const Verdict& verdict);

}  // namespace misfit
