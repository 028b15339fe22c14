#include <algorithm>
#include <chrono>

#include "apps/stages.h"
#include "misfit/core/error.h"
#include "misfit/core/file_name.h"
#include "misfit/core/progress.h"
#include "misfit/diagnose/diagnose.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

constexpr const char* method = "filter_error";

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void record(Session& session, const std::string& stage, const std::map<std::string, std::string>& inputs,
            const std::vector<std::string>& outputs, double seconds) {
  session.folder.record({stage, session.options.command, inputs, outputs, seconds, "", ""});
}

std::vector<std::string> files_of(const Diagnosis& diagnosis) {
  std::vector<std::string> files{"diagnosis.json"};
  for (std::size_t k = 0; k < diagnosis.missing.size(); ++k)
    files.push_back(k == 0 ? "missing_force.csv" : "missing_force_" + file_name_for(diagnosis.missing[k].experiment) + ".csv");
  return files;
}

}  // namespace

std::vector<fs::path> files_of_filter(const Session& session) {
  std::vector<fs::path> files;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(session.folder.file(std::string("fit/") + method), none)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

bool filter_declined(Session& session) {
  const Fit fit = fit_stage(session, {method}).front();
  return fit.status == FitStatus::declined || fit.status == FitStatus::failed;
}

void refuse_declined(Session& session) {
  const Fit fit = fit_stage(session, {method}).front();
  throw RunError(fit.method + " " + to_string(fit.status) + ", so there are no innovations to look at: " + fit.message);
}

std::optional<Diagnosis> known_diagnosis(const Session& session) {
  const auto inputs = session.inputs("diagnose", files_of_filter(session));
  if (!session.folder.up_to_date("diagnose", inputs)) return std::nullopt;
  return read_diagnosis(session.folder.path());
}

std::map<std::string, std::string> inputs_of_discovery(const Session& session) {
  std::vector<fs::path> files = files_of_filter(session);
  if (session.study.has_camera) files.push_back(session.folder.file("camera.json"));
  return session.inputs("discover", files);
}

std::optional<Discovery> known_discovery(const Session& session) {
  if (!session.folder.up_to_date("discover", inputs_of_discovery(session))) return std::nullopt;
  return read_discovery(session.folder.path());
}

std::optional<Diagnosis> diagnose_stage(Session& session) {
  if (filter_declined(session)) return std::nullopt;
  stop_if_interrupted();
  if (auto known = known_diagnosis(session)) return known;
  const auto inputs = session.inputs("diagnose", files_of_filter(session));
  const auto work = filter_work(session);
  const auto begin = std::chrono::steady_clock::now();
  Diagnosis diagnosis;
  {
    Progress progress("diagnose", session.options.quiet);
    diagnosis =
        diagnose(*work->estimate, {session.options.threads, [&](std::size_t done, std::size_t total) { progress.update(done, total); }});
  }
  write_diagnosis(session.folder.path(), diagnosis);
  record(session, "diagnose", inputs, files_of(diagnosis), seconds_since(begin));
  return diagnosis;
}

}  // namespace misfit
