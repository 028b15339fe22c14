#include "misfit/workflow/session/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <thread>
#include <tuple>
#include <utility>

#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "misfit/core/stopwatch.h"
#include "misfit/core/table.h"
#include "misfit/core/text.h"
#include "misfit/core/version.h"
#include "misfit/data/log/log.h"
#include "misfit/data/sweep.h"
#include "misfit/data/track.h"
#include "misfit/jobs/ranks.h"
#include "misfit/model/declared.h"
#include "misfit/model/provisional.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

/// Results of the same commit may differ, too, where the tree was changed: then only the hash of the program tells.
bool of_another_build(const StageRecord& before, const StageInputs& inputs) {
  const auto then = before.inputs.find("program"), now = inputs.find("program");
  const bool same = then == before.inputs.end() || now == inputs.end() || then->second == now->second;
  return before.version != version() || before.commit != commit() || !same;
}

std::string other_build(const StageRecord& before) {
  return fmt::format("another build of misfit ({}, {}; this one is {}, {})", before.version, before.commit, version(), commit());
}

Study open_study(const SessionOptions& options) {
  Study study = read_study(options.study);
  if (options.seed) study.seed = *options.seed;
  return study;
}

fs::path folder_of(const SessionOptions& options, const Study& study) {
  return options.out.empty() ? study.folder / "out" : fs::path(options.out);
}

RunFolder open_folder(const SessionOptions& options, const Study& study, RunFolder::Access access) {
  RunFolder folder(folder_of(options, study), {options.command, study.seed, study.file, {files_of_study(study), options.force}}, access);
  if (const auto other = folder.other_study())
    throw InputError("the run folder " + folder.path().string() + " holds the results of another study, " + other->string() +
                     ": give this one a folder of its own (--out out-" + study.file.stem().string() + ", say), or remove that one");
  return folder;
}

/// How run.json names a file: "out/…" for those of the run folder, else relative to the study. The same however the two were typed.
std::string shown_path(const fs::path& file, const fs::path& study, const fs::path& run) {
  const auto from = [whole = fs::absolute(file).lexically_normal()](const fs::path& folder) {
    return whole.lexically_relative(fs::absolute(folder).lexically_normal());
  };
  const fs::path inside = from(run);
  if (!inside.empty() && *inside.begin() != "..") return ("out" / inside).generic_string();
  const fs::path beside = from(study);
  return beside.empty() ? file.filename().string() : beside.generic_string();
}

/// Inputs of a stage without the place of their files: a rung names the same video by another path.
std::multiset<std::pair<std::string, std::string>> by_file_name(const StageInputs& inputs) {
  std::multiset<std::pair<std::string, std::string>> out;
  for (const auto& [file, hash] : inputs) out.emplace(fs::path(file).filename().string(), hash);
  return out;
}

}  // namespace

const std::string& hash_of_program() {
  static const std::string hash = [] {
    std::error_code error;
    const fs::path self = fs::read_symlink("/proc/self/exe", error);
    return error ? "unknown" : hash_file(self);
  }();
  return hash;
}

namespace {

/// What a long stage would otherwise find out at its end: files that are small, and everything that a video's tracking comes before.
void check_small_files(const Study& study) {
  for (const auto& [curve, file] : study.reference) std::ignore = read_reference(file, curve);
  for (const auto& [name, curve] : study.curves) {
    if (curve.table) std::ignore = read_csv(*curve.table);
  }
  if (std::none_of(study.experiments.begin(), study.experiments.end(), [](const ExperimentStudy& e) { return e.video.has_value(); }))
    return;
  if (study.camera.sweep) std::ignore = read_sweep(*study.camera.sweep);
  if (study.camera.sweep_images) std::ignore = read_sweep_pictures(*study.camera.sweep_images);
  for (const ExperimentStudy& e : study.experiments) {
    if (e.data && is_binary_log(*e.data)) {
      std::ignore = open_log(*e.data);
    } else if (e.data) {
      std::ignore = read_csv(*e.data);
    }
    if (e.track) std::ignore = read_track(*e.track, e.columns);
  }
}

/// The pictures that the table of a sweep names. A table that cannot be read is reported by the stage that needs it.
void add_sweep_pictures(const Study& study, std::vector<fs::path>& files) {
  if (!study.camera.sweep_images) return;
  try {
    for (const SweepPicture& picture : read_sweep_pictures(*study.camera.sweep_images)) files.push_back(picture.file);
  } catch (const InputError&) {
  }
}

}  // namespace

std::vector<fs::path> files_of_study(const Study& study) {
  std::vector<fs::path> files{study.file};
  const auto add = [&](const std::optional<fs::path>& file) {
    if (file) files.push_back(*file);
  };
  add(study.system_file);
  add(study.camera.sweep);
  add(study.camera.sweep_images);
  add(study.camera.sweep_marker.picture);
  add(study.video.marker.picture);
  for (const NamedMarker& marker : study.video.markers) add(marker.marker.picture);
  add_sweep_pictures(study, files);
  for (const ExperimentStudy& e : study.experiments) {
    add(e.track);
    add(e.video);
    add(e.data);
  }
  for (const auto& [name, curve] : study.curves) add(curve.table);
  for (const auto& [name, file] : study.reference) add(file);
  return files;
}

RunFolder::Access access_of_rank() { return ranks().first() ? RunFolder::Access::write : RunFolder::Access::read; }

Session::Session(const SessionOptions& o, const Registry& r, RunFolder::Access access)
    : options(o),
      study(open_study(o)),
      declared(study_registry(study, r)),
      registry(*declared),
      model(read_model(study, registry)),
      folder(open_folder(o, study, access)),
      program(hash_of_program()) {
  if (!folder.lost_record().empty()) note(folder.lost_record());
  if (access == RunFolder::Access::read) return;
  for (const char* below_it : {"fit", "figures", "rungs"}) check_folder(folder.file(below_it));
  check_small_files(study);
}

namespace {

double ten_times(const SessionOptions& options, double seconds_before, double least) {
  constexpr double times_before = 10.0;
  const double threads = options.threads > 0 ? options.threads : std::thread::hardware_concurrency();
  return std::max(least, times_before * seconds_before * std::max(threads, 1.0));
}

}  // namespace

double usual_limit(const SessionOptions& options, double seconds_before) {
  constexpr double least = 300.0;
  return ten_times(options, seconds_before, least);
}

double usual_refit_limit(const SessionOptions& options, double seconds_before) {
  constexpr double least = 60.0;
  return ten_times(options, seconds_before, least);
}

StageInputs Session::inputs(const std::string& settings, const std::vector<fs::path>& files) const {
  StageInputs out{{"program", program}, {"settings", hash_text(settings)}};
  for (const auto& file : files) {
    out[shown_path(file, study.folder, folder.path())] = hash_file(file);
  }
  return out;
}

void Session::do_stage(const std::string& stage, const StageInputs& inputs, const std::vector<std::string>& files,
                       const std::function<void(const fs::path&)>& make) {
  if (folder.up_to_date(stage, inputs)) return;
  const auto before = folder.stages().find(stage);
  if (before != folder.stages().end() && of_another_build(before->second, inputs) && !std::exchange(said_program, true))
    note(fmt::format("the results in {} are of {}: what is asked for is made anew", folder.path().lexically_normal().string(),
                     other_build(before->second)));
  const std::vector<std::string> damaged = folder.damaged(stage);
  if (before != folder.stages().end() && before->second.inputs == inputs && !damaged.empty())
    note(fmt::format("{}{}: not as misfit wrote {}: made again", folder.file(damaged.front()).string(),
                     damaged.size() > 1 ? fmt::format(" and {} more", damaged.size() - 1) : "", damaged.size() > 1 ? "them" : "it"));
  redo_stage(stage, inputs, files, make);
}

void Session::redo_stage(const std::string& stage, const StageInputs& inputs, const std::vector<std::string>& files,
                         const std::function<void(const fs::path&)>& make) {
  if (folder.access() == RunFolder::Access::read) throw std::logic_error("stage '" + stage + "' is to be done by the first rank");
  folder.check_places(files);
  const Stopwatch clock;
  const PartFolder part(folder.path());
  const auto in_place = [&](std::string message) {
    const std::string made = part.path().string();
    for (std::size_t at = message.find(made); at != std::string::npos; at = message.find(made))
      message.replace(at, made.size(), folder.path().string());
    return message;
  };
  try {
    make(part.path());
  } catch (const WriteError& error) {
    throw WriteError(in_place(error.what()));
  } catch (const MachineError& error) {
    throw MachineError(in_place(error.what()));
  } catch (const RunError& error) {
    throw RunError(in_place(error.what()));
  }
  folder.commit(part, {stage, options.command, inputs, {}, clock.seconds()});
}

std::string Session::why_outdated(const std::string& stage, const StageInputs& inputs) const {
  const auto before = folder.stages().find(stage);
  if (before == folder.stages().end() || folder.up_to_date(stage, inputs)) return "";
  if (of_another_build(before->second, inputs)) return "they are of " + other_build(before->second);
  std::vector<std::string> changed;
  for (const auto& [name, hash] : inputs) {
    const auto known = before->second.inputs.find(name);
    if (known != before->second.inputs.end() && known->second == hash) continue;
    const std::string words = name == "settings" ? "the study" : name.starts_with("out/fit/") ? "the fit" : name;
    if (std::find(changed.begin(), changed.end(), words) == changed.end()) changed.push_back(words);
  }
  if (!changed.empty()) return join_words(changed) + (changed.size() == 1 ? " has changed since" : " have changed since");
  const std::vector<std::string> damaged = folder.damaged(stage);
  return damaged.empty() ? "the study has changed since" : damaged.front() + " is not as misfit wrote it";
}

std::vector<fs::path> Session::files_of_stage(const std::string& stage) const {
  std::vector<fs::path> files;
  const auto done = folder.stages().find(stage);
  if (done == folder.stages().end()) return files;
  for (const std::string& name : done->second.outputs) files.push_back(folder.file(name));
  return files;
}

bool Session::copied_from_parent(const std::string& stage, const StageInputs& inputs) {
  if (parent.empty()) return false;
  const RunFolder from(parent, {options.command, study.seed}, RunFolder::Access::read);
  const auto known = from.stages().find(stage);
  if (known == from.stages().end() || !from.up_to_date(stage, known->second.inputs) ||
      by_file_name(known->second.inputs) != by_file_name(inputs))
    return false;
  StageRecord record{stage, options.command + "  # copied from " + parent.lexically_normal().string(), inputs};
  const PartFolder part(folder.path());
  for (const auto& output : known->second.outputs) {
    make_writable_folder((part.path() / output).parent_path());
    write_atomically(part.path() / output, read_file(from.file(output)));
    record.command += ", " + output + " " + hash_file(from.file(output));
  }
  folder.commit(part, std::move(record));
  return true;
}

void Listener::hear(const std::string& line) const {
  if (note) note(line);
}

ProgressFn Listener::begin(const std::string& name) const {
  if (progress) return progress(name);
  return [](std::size_t, std::size_t) {};
}

void Session::note(const std::string& line) const { options.listener.hear(line); }

ProgressFn Session::progress(const std::string& name) const { return options.listener.begin(name); }

std::string digest_of(const StageInputs& inputs) {
  std::string text;
  for (const auto& [name, hash] : inputs) text += name + " " + hash + "\n";
  return hash_text(text);
}

std::vector<Reference> references(const Session& session) {
  std::vector<Reference> out;
  const ModelRequest& request = session.model.request;
  const SystemSpec spec = session.registry.system(request.system).make(request.options)->spec();
  for (const auto& [curve, file] : session.study.reference)
    out.push_back(read_reference(file, curve, spec.static_curve, spec.folded_angle));
  return out;
}

std::map<std::string, std::string> default_place(const Session& session, const std::string& effect) {
  const EffectSpec& spec = session.registry.effect(effect).spec();
  const Model model = provisional_model(session.model.request, session.registry);
  std::map<std::string, std::string> out;
  for (const auto* list : {&spec.quantities, &spec.ports}) {
    for (const Role& role : *list) {
      const auto found = model.system->spec().roles.find(role.name);
      if (found != model.system->spec().roles.end()) out[role.name] = found->second;
    }
  }
  return out;
}

}  // namespace misfit
