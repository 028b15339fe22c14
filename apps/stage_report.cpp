#include <algorithm>
#include <chrono>

#include "apps/stages.h"
#include "misfit/compare/compare.h"
#include "misfit/core/files.h"
#include "misfit/core/version.h"
#include "misfit/report/report.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

std::vector<report::ExperimentInput> experiments_of(Session& session) {
  std::vector<report::ExperimentInput> out;
  std::vector<std::optional<TrackFacts>> videos = track_stage(session);
  std::vector<std::optional<Attitude>> attitudes = attitude_stage(session);
  for (std::size_t e = 0; e < session.study.experiments.size(); ++e) {
    const ExperimentStudy& study = session.study.experiments[e];
    report::ExperimentInput input;
    input.name = study.name;
    if (has_track(study)) input.track = read_track(track_files(session, e).track, study.columns);
    if (videos[e]) {
      input.video = std::move(videos[e]);
      input.contact_sheet = read_file(track_files(session, e).sheet);
    }
    input.attitude = std::move(attitudes[e]);
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

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// FOLDER/FILE for every file of the folder, sorted; none if it does not exist.
std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) names.push_back((folder.filename() / entry.path().filename()).string());
  std::sort(names.begin(), names.end());
  return names;
}

/// What an earlier report drew; contact sheets belong to the track stage.
void remove_figures(const fs::path& folder) {
  std::error_code none;
  for (const std::string& name : names_in(folder)) {
    const fs::path file = folder.parent_path() / name;
    if (file.extension() != ".png") fs::remove_all(file, none);
  }
}

/// Everything the fits left on disk.
std::vector<fs::path> files_of(const Session& session, const std::vector<Fit>& fits) {
  std::vector<fs::path> files;
  for (const auto& fit : fits) {
    for (const auto& entry : fs::directory_iterator(session.folder.file("fit/" + fit.method))) files.push_back(entry.path());
  }
  return files;
}

std::vector<fs::path> files_of_report(const Session& session, const std::vector<Fit>& fits) {
  std::vector<fs::path> files = files_of(session, fits);
  files.push_back(session.folder.file("compare.json"));
  for (const char* name : {"diagnosis.json", "missing_force.csv", "candidates.json", "discovery.json", "ladder.json"}) {
    if (fs::exists(session.folder.file(name))) files.push_back(session.folder.file(name));
  }
  for (const auto& [curve, file] : session.study.reference) files.push_back(file);
  if (session.study.has_camera) files.push_back(session.folder.file("camera.json"));
  for (std::size_t e = 0; e < session.study.experiments.size(); ++e) {
    const ExperimentStudy& experiment = session.study.experiments[e];
    if (!has_track(experiment)) continue;
    files.push_back(track_files(session, e).track);
    files.push_back(session.folder.file(e == 0 ? "attitude.csv" : "attitude_" + experiment.name + ".csv"));
  }
  return files;
}

}  // namespace

std::vector<Reference> references(const Session& session) {
  std::vector<Reference> out;
  for (const auto& [curve, file] : session.study.reference) out.push_back(read_reference(file, curve));
  return out;
}

Comparison compare_stage(Session& session, const std::vector<Fit>& fits) {
  stop_if_interrupted();
  const fs::path file = session.folder.file("compare.json");
  std::vector<fs::path> files = files_of(session, fits);
  for (const auto& [curve, reference] : session.study.reference) files.push_back(reference);
  const auto inputs = session.inputs("", files);
  if (session.folder.up_to_date("compare", inputs)) return read_comparison(file);
  const auto begin = std::chrono::steady_clock::now();
  Comparison comparison = compare(fits, references(session));
  write_comparison(file, comparison);
  session.folder.record({"compare", session.options.command, inputs, {"compare.json"}, seconds_since(begin), "", ""});
  return comparison;
}

fs::path report_stage(Session& session, const std::vector<Fit>& fits) {
  stop_if_interrupted();
  report::ReportInput input;
  input.comparison = compare_stage(session, fits);
  input.experiments = experiments_of(session);
  input.calibration = calibrate_stage(session);
  const auto inputs = session.inputs(session.study.text, files_of_report(session, fits));
  if (session.folder.up_to_date("report", inputs)) return session.folder.file("report.html");
  const auto begin = std::chrono::steady_clock::now();
  input.study = session.study.name;
  input.question = session.study.question;
  input.fits = fits;
  input.references = references(session);
  input.diagnosis = known_diagnosis(session);
  input.discovery = known_discovery(session);
  input.ladder = known_ladder(session);
  input.run = facts_of(session);
  remove_figures(session.folder.file("figures"));
  fs::path page = report::write_report(session.folder.path(), input);
  std::vector<std::string> outputs = names_in(session.folder.file("figures"));
  outputs.emplace_back("report.html");
  session.folder.record({"report", session.options.command, inputs, outputs, seconds_since(begin), "", ""});
  return page;
}

}  // namespace misfit
