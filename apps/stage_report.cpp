#include <chrono>

#include "apps/stages.h"
#include "misfit/compare/compare.h"
#include "misfit/core/files.h"
#include "misfit/core/version.h"
#include "misfit/report/report.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> lines_of(const fs::path& path) {
  std::vector<std::string> lines;
  if (!fs::exists(path)) return lines;
  const std::string text = read_file(path);
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t to = std::min(text.find('\n', from), text.size());
    if (to > from) lines.push_back(text.substr(from, to - from));
    from = to + 1;
  }
  return lines;
}

std::vector<report::ExperimentInput> experiments_of(Session& session) {
  std::vector<report::ExperimentInput> out;
  std::vector<std::optional<Attitude>> attitudes = attitude_stage(session);
  for (std::size_t e = 0; e < session.study.experiments.size(); ++e) {
    const ExperimentStudy& study = session.study.experiments[e];
    report::ExperimentInput input;
    input.name = study.name;
    if (study.track) input.track = read_track(*study.track, study.columns);
    input.attitude = std::move(attitudes[e]);
    if (input.attitude && input.attitude->notes.empty()) {
      input.attitude->notes = lines_of(session.folder.file(e == 0 ? "attitude.notes.txt" : "attitude_" + study.name + ".notes.txt"));
    }
    out.push_back(std::move(input));
  }
  return out;
}

report::RunFacts facts_of(const Session& session) {
  report::RunFacts facts;
  facts.version = version();
  facts.commit = commit();
  facts.command = session.options.command;
  facts.seed = session.study.seed;
  for (const auto& [name, stage] : session.folder.stages()) {
    facts.stages.emplace_back(name, stage.seconds);
    for (const auto& [input, hash] : stage.inputs) {
      if (input != "settings") facts.hashes[input] = hash;
    }
  }
  facts.hashes[session.study.file.filename().string()] = hash_text(session.study.text);
  return facts;
}

}  // namespace

std::vector<Reference> references(const Session& session) {
  std::vector<Reference> out;
  for (const auto& [curve, file] : session.study.reference) out.push_back(read_reference(file, curve));
  return out;
}

Comparison compare_stage(Session& session, const std::vector<Fit>& fits) {
  stop_if_interrupted();
  const auto begin = std::chrono::steady_clock::now();
  Comparison comparison = compare(fits, references(session));
  write_comparison(session.folder.file("compare.json"), comparison);
  std::vector<fs::path> files;
  for (const auto& fit : fits) files.push_back(session.folder.file("fit/" + fit.method + "/fit.json"));
  for (const auto& [curve, file] : session.study.reference) files.push_back(file);
  session.folder.record({"compare",
                         session.options.command,
                         session.inputs("", files),
                         {"compare.json"},
                         std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(),
                         "",
                         ""});
  return comparison;
}

fs::path report_stage(Session& session, const std::vector<Fit>& fits) {
  stop_if_interrupted();
  const auto begin = std::chrono::steady_clock::now();
  report::ReportInput input;
  input.study = session.study.name;
  input.question = session.study.question;
  input.fits = fits;
  input.experiments = experiments_of(session);
  input.calibration = calibrate_stage(session);
  input.comparison = compare_stage(session, fits);
  input.references = references(session);
  input.run = facts_of(session);
  fs::path page = report::write_report(session.folder.path(), input);
  session.folder.record({"report",
                         session.options.command,
                         session.inputs("", {session.folder.file("compare.json")}),
                         {"report.html"},
                         std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(),
                         "",
                         ""});
  return page;
}

}  // namespace misfit
