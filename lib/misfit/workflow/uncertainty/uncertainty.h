#pragma once

#include <optional>
#include <string>
#include <vector>

#include "misfit/data/intervals.h"
#include "misfit/data/uncertainty.h"
#include "misfit/workflow/estimate/estimate.h"

namespace misfit {

// [uncertainty] of a study.

/// uncertainty.json, uncertainty.csv and their figures: the Monte-Carlo of [uncertainty]. On ranks other than the first the result is
/// empty. InputError if the study has no such section.
[[nodiscard]] Uncertainty uncertainty_stage(Session& session);
/// What a stored job of `what` depends on but its number, `more` left out too: not what the study is called, nor which methods it asks
/// for.
[[nodiscard]] StageInputs inputs_of_jobs(const Session& session, const std::string& what, std::vector<std::string> more);
/// What it left on disk, where it still belongs to the study and its data.
[[nodiscard]] std::optional<Uncertainty> known_uncertainty(const Session& session);

/// Whether [uncertainty] has `bootstrap` or `profile`.
[[nodiscard]] bool asks_for_resampling(const Study& study);
/// InputError at its line if a name in `profile` is none of which a profile can be taken: to be called before anything is computed.
void check_profile_names(Session& session);
/// bootstrap.json, bootstrap.csv, profile.json, resampling.json and their figures: block bootstrap and profiles of every method asked for
/// that can be fitted again. A method that declines or fails is a note. On ranks other than the first the result is empty. RunError: none
/// could be resampled.
[[nodiscard]] Resampling resampling_stage(Session& session);
/// What it left on disk, where it still belongs to the study and its data.
[[nodiscard]] std::optional<Resampling> known_resampling(const Session& session);

}  // namespace misfit
