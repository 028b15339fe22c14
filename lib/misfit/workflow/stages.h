#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "misfit/data/ladder.h"
#include "misfit/data/verdict.h"
#include "misfit/workflow/assess/assess.h"
#include "misfit/workflow/uncertainty/uncertainty.h"

namespace misfit {

// Each stage reads what it needs from the session and the run folder, skips its work when nothing it depends on has changed since
// (run.json), and leaves its result on disk. They are run in the order of these headers; each calls the ones it needs.

/// figures/ and report.html; returns the page.
std::filesystem::path report_stage(Session& session, const std::vector<Fit>& fits);

/// What the study has come to, from what is on disk and still belongs to these fits: the sentence that a run ends with. The report's
/// stage writes it to verdict.json.
[[nodiscard]] Verdict verdict_of(Session& session, const std::vector<Fit>& fits);

/// What makes everything of the study anew that its last runs have made.
[[nodiscard]] std::string command_for_all(const Session& session);

/// Both, and the files they are in.
struct Findings {
  std::optional<Diagnosis> diagnosis;
  std::optional<Discovery> discovery;
  std::vector<std::filesystem::path> files;
  std::string left_out;  ///< what is on disk of them but outdated, and why: a clause; empty: nothing is
};
[[nodiscard]] Findings findings_of(const Session& session);
/// Of the last rung that has any; `left_out` of the last one that has that.
struct RungFindings {
  int rung = 0;
  std::string added;
  Findings findings;
};
[[nodiscard]] std::optional<RungFindings> findings_of_last_rung(const Session& session, const Ladder& ladder);
/// ladder.json where it still belongs to the study and its data (workflow/ladder.h).
[[nodiscard]] std::optional<Ladder> known_ladder(const Session& session);

}  // namespace misfit
