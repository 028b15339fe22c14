#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <utility>

#include "misfit/compare/compare.h"
#include "misfit/core/files.h"
#include "misfit/core/shell_word.h"
#include "misfit/core/version.h"
#include "misfit/jobs/interrupt.h"
#include "misfit/page/embedded_page.h"
#include "misfit/report/report.h"
#include "misfit/show/blocks.h"
#include "misfit/workflow/stages.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

std::vector<report::ExperimentInput> experiments_of(Session& session) {
  std::vector<report::ExperimentInput> out;
  const std::vector<TrackedMarker> tracked = track_stage(session);
  std::vector<std::optional<Attitude>> attitudes = attitude_stage(session);
  for (std::size_t e = 0; e < session.study.experiments.size(); ++e) {
    const ExperimentStudy& study = session.study.experiments[e];
    report::ExperimentInput input;
    input.name = study.name;
    if (study.track) input.track = read_track(track_files(session, e).track, study.columns);
    input.attitude = std::move(attitudes[e]);
    bool first = true;
    for (const TrackedMarker& marker : tracked) {
      if (marker.experiment != e) continue;
      if (!first) out.push_back(std::exchange(input, {}));
      first = false;
      input.name = marker.name;
      input.track = read_track(marker.files.track);
      input.video = marker.facts;
      input.contact_sheet = read_file(marker.files.sheet);
    }
    out.push_back(std::move(input));
  }
  return out;
}

report::RunFacts facts_of(const Session& session) {
  report::RunFacts facts;
  facts.version = version();
  facts.commit = commit();
  facts.date = fmt::format("{:%Y-%m-%d}", fmt::localtime(std::time(nullptr)));
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

std::vector<fs::path> files_of_report(const Session& session, const std::vector<Fit>& fits) {
  std::vector<fs::path> files = files_of_fits(session, fits);
  files.push_back(session.folder.file("compare.json"));
  if (fs::exists(session.folder.file("ladder.json"))) files.push_back(session.folder.file("ladder.json"));
  for (const auto& [curve, file] : session.study.reference) files.push_back(file);
  const std::vector<fs::path> angles = files_of_attitude(session);
  files.insert(files.end(), angles.begin(), angles.end());
  return files;
}

/// Outdated results are named, since a section would otherwise be missing without a word, and once: those of the last rung before those of
/// the study's own model, which one command makes anew with it; and not where the verdict, which has no search of its model then, says it.
void note_left_out(const Session& session, const Findings& own, const std::optional<RungFindings>& above, report::ReportInput& input) {
  const bool effects_added = input.ladder && input.ladder->rungs.size() > 1;
  const bool of_rung = above && !above->findings.left_out.empty();
  const Findings& outdated = of_rung ? above->findings : own;
  const bool searched = outdated.discovery && (!of_rung || above->rung == input.ladder->rungs.back().id);
  const bool in_verdict = (of_rung || !effects_added) && !searched;
  if (in_verdict || outdated.left_out.empty()) return;
  const std::string all = command_for_all(session) + " make";
  // A search goes on from the last rung: those below it are asked again only once they are the last.
  const std::string first =
      effects_added && !of_rung
          ? misfit_command("remove", session.options.study, std::to_string(input.ladder->rungs[1].id), session.options.out) + " and " + all
          : all + "s";
  input.notes.push_back(as_sentence(outdated.left_out) + " " + first + " everything anew.");
}

/// What diagnose and discover found of the study's own model and of the last rung that was asked.
void add_findings(const Session& session, report::ReportInput& input, std::vector<fs::path>& files) {
  Findings own = findings_of(session);
  auto above = input.ladder ? findings_of_last_rung(session, *input.ladder) : std::nullopt;
  note_left_out(session, own, above, input);
  input.diagnosis = std::move(own.diagnosis);
  input.discovery = std::move(own.discovery);
  files.insert(files.end(), own.files.begin(), own.files.end());
  if (!above) return;
  if (!above->findings.diagnosis && !above->findings.discovery) return;
  files.insert(files.end(), above->findings.files.begin(), above->findings.files.end());
  input.rung = report::RungInput{above->rung, above->added, std::move(above->findings.diagnosis), std::move(above->findings.discovery)};
}

/// The fits of the ladder's last rung, in the out/ beside its study, and the files they are in.
void add_last_model(Session& session, report::ReportInput& input, std::vector<fs::path>& files) {
  if (!input.ladder || input.ladder->rungs.size() < 2) return;
  const Rung& last = input.ladder->rungs.back();
  const fs::path fit = session.folder.file(last.study).parent_path() / "out" / "fit" / last.method;
  if (!fs::exists(fit / "fit.json")) return;
  report::LastModel model{last.id, last.added, {read_fit(fit)}, {}};
  model.comparison = compare(model.fits, references(session));
  input.last_model = std::move(model);
  for (const fs::directory_entry& file : fs::directory_iterator(fit)) files.push_back(file.path());
}

/// The study's own model and its rungs; what the document omits of them is omitted here, too.
std::vector<page::Place> shown_places(const Session& session, const std::vector<Fit>& fits, const report::ReportInput& input) {
  std::vector<page::Place> places = page::places_of(session.study.file, session.folder.path(), known_ladder(session).has_value());
  for (const Fit& fit : fits) places.front().methods.push_back(fit.method);
  places.front().diagnosed = input.diagnosis.has_value();
  places.front().asked = input.discovery.has_value();
  for (page::Place& place : places) {
    if (place.id == 0 || !input.rung || place.id != input.rung->id) continue;
    place.diagnosed = input.rung->diagnosis.has_value();
    place.asked = input.rung->discovery.has_value();
  }
  return places;
}

}  // namespace

fs::path report_stage(Session& session, const std::vector<Fit>& fits) {
  stop_if_interrupted();
  report::ReportInput input;
  input.comparison = compare_stage(session, fits);
  input.experiments = experiments_of(session);
  input.calibration = calibrate_stage(session);
  input.ladder = known_ladder(session);
  std::vector<fs::path> files = files_of_report(session, fits);
  add_findings(session, input, files);
  add_last_model(session, input, files);
  input.uncertainty = known_uncertainty(session);
  if (input.uncertainty) files.push_back(session.folder.file("uncertainty.json"));
  input.resampling = known_resampling(session);
  for (const char* file : {"resampling.json", "bootstrap.json", "profile.json"}) {
    if (input.resampling && fs::exists(session.folder.file(file))) files.push_back(session.folder.file(file));
  }
  input.verdict = verdict_of(session, fits);
  const std::vector<page::Place> places = shown_places(session, fits, input);
  for (const page::Place& place : places) {
    const std::vector<fs::path> shown = page::files_of(place);
    files.insert(files.end(), shown.begin(), shown.end());
  }
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());  // each is hashed
  const auto inputs = session.inputs(session.study.text + fmt::format("{}", fmt::join(input.notes, "\n")), files);
  session.do_stage("report", inputs, {"report.html", "verdict.json"}, [&](const fs::path& dir) {
    input.study = session.study.name;
    input.question = session.study.question;
    input.fits = fits;
    input.references = references(session);
    input.run = facts_of(session);
    const page::EmbeddedPage embedded{input.study, input.question, &*input.verdict, places, input.references, input.notes};
    input.explorer = [&](std::size_t room) { return page::embedded_page(embedded, room); };
    report::write_report(dir, input);
    write_verdict(dir / "verdict.json", *input.verdict);
  });
  return session.folder.file("report.html");
}

}  // namespace misfit
