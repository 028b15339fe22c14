// What diagnose and discover have left on disk, for the study's own model and for the rungs of its ladder.

#include <fmt/format.h>

#include "misfit/core/shell_word.h"
#include "misfit/core/text.h"
#include "misfit/workflow/ladder.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

/// "earlier results in out (diagnosis.json and discovery.json) are left out: they are of another build of misfit (…)". Empty: nothing is
/// there that is not current.
std::string left_out(const Session& session, const Findings& known) {
  std::vector<std::string> files;
  std::string why;
  const auto look = [&](bool current, const char* file, const char* stage, const StageInputs& inputs) {
    if (current || !fs::exists(session.folder.file(file))) return;
    files.emplace_back(file);
    if (why.empty()) why = session.why_outdated(stage, inputs);
  };
  look(known.diagnosis.has_value(), "diagnosis.json", "diagnose", inputs_of_diagnosis(session));
  look(known.discovery.has_value(), "discovery.json", "discover", inputs_of_discovery(session));
  if (files.empty()) return "";
  return fmt::format("earlier results in {} ({}) are left out: {}", session.folder.path().lexically_normal().string(), join_words(files),
                     why.empty() ? "the fit has changed since" : why);
}

}  // namespace

std::string command_for_all(const Session& session) {
  const std::optional<Ladder> ladder = known_ladder(session);
  return misfit_command("run", session.options.study, ladder && ladder->rungs.size() > 1 ? "--auto" : "", session.options.out);
}

Findings findings_of(const Session& session) {
  Findings out;
  out.diagnosis = known_diagnosis(session);
  out.discovery = known_discovery(session);
  out.left_out = left_out(session, out);
  if (out.diagnosis) out.files.insert(out.files.end(), {session.folder.file("diagnosis.json"), session.folder.file("missing_force.csv")});
  if (out.discovery) out.files.insert(out.files.end(), {session.folder.file("candidates.json"), session.folder.file("discovery.json")});
  return out;
}

std::optional<RungFindings> findings_of_last_rung(const Session& session, const Ladder& ladder) {
  std::optional<RungFindings> out;
  for (auto rung = ladder.rungs.rbegin(); rung != ladder.rungs.rend() && rung->parent >= 0; ++rung) {
    const fs::path study = session.folder.file(rung->study);
    if (!fs::exists(study)) continue;
    const Session above(options_for(session.options, study), session.registry, RunFolder::Access::read);
    RungFindings own{rung->id, rung->added, findings_of(above)};
    const bool any = own.findings.diagnosis || own.findings.discovery;
    if (any && out) own.findings.left_out = out->findings.left_out;
    if (any || (!out && !own.findings.left_out.empty())) out = std::move(own);
    if (any) break;
  }
  return out;
}

}  // namespace misfit
