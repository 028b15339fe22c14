#include "misfit/serve/results.h"

#include <fmt/format.h>

#include "misfit/core/files.h"
#include "misfit/core/text.h"
#include "misfit/data/study_reader.h"
#include "misfit/page/read_if.h"
#include "misfit/workflow/assess/assess.h"
#include "misfit/workflow/estimate/estimate.h"
#include "misfit/workflow/ladder.h"
#include "misfit/workflow/stages.h"

namespace misfit::serve {
namespace {

namespace fs = std::filesystem;

/// Those of a study as it is now; itself alone where it has an error.
std::vector<fs::path> files_named_by(const fs::path& study) {
  return page::read_if(study, [&] { return files_of_study(read_study(study)); }).value_or(std::vector<fs::path>{study});
}

}  // namespace

std::string file_stamp(const fs::path& file) {
  std::error_code none;
  const auto time = fs::last_write_time(file, none);
  if (none) return "-";
  return fmt::format("{}:{}", time.time_since_epoch().count(), fs::file_size(file, none));
}

Results::Results(const SessionOptions& options) : study_(study_file(options.study)) {
  const fs::path beside = study_.has_parent_path() ? study_.parent_path() : fs::path(".");
  folder_ = options.out.empty() ? beside / "out" : fs::path(options.out);
}

std::string Results::version() const {
  std::string all;
  for (const fs::path& file : files_named_by(study_)) all += file_stamp(file) + " ";
  for (const page::Place& place : places()) all += file_stamp(place.study) + " " + file_stamp(place.folder / "run.json") + " ";
  return hash_text(all);
}

namespace {

/// Is the stage as the inputs say? Limits of time make no other study: those that were given then hold.
bool is_current(const RunFolder& folder, const std::string& stage, StageInputs inputs) {
  const auto known = folder.stages().find(stage);
  if (known == folder.stages().end()) return false;
  for (const char* limit : {"time_limit", "usual_limit", "round_limit"}) {
    inputs.erase(limit);
    const auto given = known->second.inputs.find(limit);
    if (given != known->second.inputs.end()) inputs.insert(*given);
  }
  return folder.up_to_date(stage, inputs);
}

/// Results of a model that are not of its study as it is now: "the fit by filter_error".
std::vector<std::string> old_results(const Session& session) {
  std::vector<std::string> old;
  const auto look = [&](const std::string& file, const std::string& name, const auto& current) {
    if (!page::read_if(session.folder.file(file), current).value_or(!fs::exists(session.folder.file(file)))) old.push_back(name);
  };
  for (const std::string& method : session.methods()) {
    const std::string stage = "fit/" + method;
    look(stage + "/fit.json", "the fit by " + method, [&] { return is_current(session.folder, stage, inputs_of_fit(session, method)); });
  }
  look("diagnosis.json", "the diagnosis", [&] { return known_diagnosis(session).has_value(); });
  look("discovery.json", "the candidates", [&] { return is_current(session.folder, "discover", inputs_of_discovery(session)); });
  return old;
}

}  // namespace

std::vector<std::string> outdated(const Session& session, const std::vector<page::Place>& places, const Registry& registry) {
  std::vector<std::string> out, of_rungs;
  for (const page::Place& place : places) {
    if (place.id == 0) continue;
    try {
      const Session rung(options_for(session.options, place.study), registry, RunFolder::Access::read);
      for (const std::string& name : old_results(rung)) of_rungs.push_back(fmt::format("{} of rung {}", name, place.id));
    } catch (const std::exception& error) {
      out.push_back(fmt::format("Rung {} of the ladder cannot be read: {}", place.id, error.what()));
    }
  }
  const std::string changed = "The study, its data or this program have changed since these were made: ";
  if (const auto old = old_results(session); !old.empty()) out.push_back(changed + join_words(old) + ". Run makes them again.");
  if (!of_rungs.empty())
    out.push_back(changed + join_words(of_rungs) +
                  ". Discover makes those of the last rung again; for the others, remove their rungs and add them again.");
  const std::optional<Ladder> rungs = known_ladder(session) ? std::nullopt : page::ladder_in(session.folder.path());
  if (rungs && rungs->rungs.size() > 1)
    out.emplace_back("The ladder belongs to an earlier state of the study and is not shown. Add begins a new one.");
  return out;
}

}  // namespace misfit::serve
