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

std::string stamp(const fs::path& file) {
  std::error_code none;
  const auto time = fs::last_write_time(file, none);
  if (none) return "-";
  return fmt::format("{}:{}", time.time_since_epoch().count(), fs::file_size(file, none));
}

}  // namespace

Results::Results(const SessionOptions& options) : study_(study_file(options.study)) {
  const fs::path beside = study_.has_parent_path() ? study_.parent_path() : fs::path(".");
  folder_ = options.out.empty() ? beside / "out" : fs::path(options.out);
}

std::string Results::version() const {
  std::string all = stamp(study_);
  for (const page::Place& place : places()) all += " " + stamp(place.folder / "run.json");
  return hash_text(all);
}

std::vector<std::string> outdated(const Session& session) {
  std::vector<std::string> old;
  const auto look = [&](const std::string& file, const std::string& name, const auto& current) {
    if (!page::read_if(session.folder.file(file), current).value_or(!fs::exists(session.folder.file(file)))) old.push_back(name);
  };
  for (const std::string& method : session.methods()) {
    const std::string stage = "fit/" + method;
    look(stage + "/fit.json", "the fit by " + method, [&] { return session.folder.up_to_date(stage, inputs_of_fit(session, method)); });
  }
  look("diagnosis.json", "the diagnosis", [&] { return known_diagnosis(session).has_value(); });
  look("discovery.json", "the candidates", [&] { return known_discovery(session).has_value(); });
  std::vector<std::string> out;
  if (!old.empty())
    out.push_back("The study, its data or this program have changed since these were made: " + join_words(old) + ". Run makes them again.");
  const std::optional<Ladder> rungs = known_ladder(session) ? std::nullopt : page::ladder_in(session.folder.path());
  if (rungs && rungs->rungs.size() > 1)
    out.emplace_back("The ladder that was made is of the study as it was before, and is not shown: Add begins a new one.");
  return out;
}

}  // namespace misfit::serve
