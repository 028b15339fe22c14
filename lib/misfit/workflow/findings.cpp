// What diagnose and discover have left on disk, for the study's own model and for the rungs of its ladder.

#include <fmt/format.h>

#include "misfit/core/shell_word.h"
#include "misfit/workflow/ladder.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

/// On disk but of another fit: a note, since a section would otherwise be missing without a word.
void note_stale(const Session& session, const char* file, const char* verb, std::vector<std::string>& notes) {
  if (!fs::exists(session.folder.file(file))) return;
  notes.push_back(fmt::format("{} belongs to an earlier fit and is left out; {} makes it again.",
                              session.folder.file(file).lexically_normal().string(),
                              misfit_command(verb, session.study.file.lexically_normal().string(), "", session.options.out)));
}

}  // namespace

Findings findings_of(const Session& session, std::vector<std::string>& notes) {
  Findings out;
  out.diagnosis = known_diagnosis(session);
  out.discovery = known_discovery(session);
  if (!out.diagnosis) note_stale(session, "diagnosis.json", "diagnose", notes);
  if (!out.discovery) note_stale(session, "discovery.json", "discover", notes);
  if (out.diagnosis) out.files.insert(out.files.end(), {session.folder.file("diagnosis.json"), session.folder.file("missing_force.csv")});
  if (out.discovery) out.files.insert(out.files.end(), {session.folder.file("candidates.json"), session.folder.file("discovery.json")});
  return out;
}

std::optional<RungFindings> findings_of_last_rung(const Session& session, const Ladder& ladder, std::vector<std::string>& notes) {
  for (auto rung = ladder.rungs.rbegin(); rung != ladder.rungs.rend() && rung->parent >= 0; ++rung) {
    const fs::path study = session.folder.file(rung->study);
    if (!fs::exists(study)) continue;
    const Session above(options_for(session.options, study), session.registry, RunFolder::Access::read);
    RungFindings out{rung->id, rung->added, findings_of(above, notes)};
    if (out.findings.diagnosis || out.findings.discovery) return out;
  }
  return std::nullopt;
}

}  // namespace misfit
