#include "misfit/show/verdict.h"

#include "misfit/workflow/stages.h"

namespace misfit {

Verdict verdict_of(Session& session, const std::vector<Fit>& fits) {
  const std::optional<Calibration> calibration = calibrate_stage(session);
  const std::optional<Ladder> ladder = known_ladder(session);
  const Findings own = findings_of(session);
  const bool effects_added = ladder && ladder->rungs.size() > 1;
  const auto above = effects_added ? findings_of_last_rung(session, *ladder) : std::nullopt;
  const bool of_last_rung = above && above->rung == ladder->rungs.back().id;
  const auto pointer = [](const auto& result) { return result ? &*result : nullptr; };
  VerdictInput input{session.options.study, session.options.out, &fits};
  const Comparison comparison = compare_stage(session, fits);
  input.calibration = pointer(calibration);
  input.comparison = &comparison;
  input.diagnosis = pointer(own.diagnosis);
  input.discovery = !effects_added ? pointer(own.discovery) : of_last_rung ? pointer(above->findings.discovery) : nullptr;
  if (of_last_rung) input.rung_diagnosis = pointer(above->findings.diagnosis);
  input.ladder = pointer(ladder);
  input.left_out = !effects_added ? own.left_out : above ? above->findings.left_out : "";
  input.anew = command_for_all(session);
  return verdict_of(input);
}

}  // namespace misfit
