#include <fmt/format.h>

#include "misfit/core/error.h"
#include "misfit/data/estimators.h"
#include "misfit/diagnose/diagnose.h"
#include "misfit/jobs/interrupt.h"
#include "misfit/workflow/assess/assess.h"

namespace misfit {

namespace fs = std::filesystem;

StageInputs inputs_of_diagnosis(const Session& session) { return session.inputs("diagnose", files_of_filter(session)); }

std::optional<Diagnosis> known_diagnosis(const Session& session) {
  if (!session.folder.up_to_date("diagnose", inputs_of_diagnosis(session))) return std::nullopt;
  return read_diagnosis(session.folder.path());
}

StageInputs inputs_of_discovery(const Session& session) {
  std::vector<fs::path> files = files_of_filter(session);
  if (session.study.has_camera) files.push_back(session.folder.file("camera.json"));
  StageInputs inputs = session.inputs("discover", files);
  if (const auto limit = session.asked_limit()) inputs["time_limit"] = fmt::format("{} s", *limit);
  if (const auto limit = session.round_limit()) inputs["round_limit"] = fmt::format("{} s", *limit);
  return inputs;
}

std::optional<Discovery> known_discovery(const Session& session) {
  if (!session.folder.up_to_date("discover", inputs_of_discovery(session))) return std::nullopt;
  return read_discovery(session.folder.path());
}

std::optional<Diagnosis> diagnose_stage(Session& session) {
  if (filter_declined(session)) return std::nullopt;
  stop_if_interrupted();
  const auto inputs = inputs_of_diagnosis(session);
  session.do_stage("diagnose", inputs, {"diagnosis.json", "missing_force.csv"}, [&](const fs::path& dir) {
    const auto work = filter_work(session);
    write_diagnosis(dir, diagnose(*work->estimate, {session.options.threads, session.progress("diagnose")}));
  });
  return read_diagnosis(session.folder.path());
}

bool lacks_pulses_only(Session& session) {
  if (filter_declined(session)) return false;
  const std::optional<Diagnosis> known = known_diagnosis(session);
  return (known ? *known : diagnose(*filter_work(session)->estimate, {session.options.threads, {}})).pulses.has_value();
}

}  // namespace misfit
