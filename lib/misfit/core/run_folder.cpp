#include "misfit/core/run_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "misfit/core/version.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* run_name = "run.json";
constexpr const char* copy_name = ".run.json";

json to_json(const StageRecord& record) {
  return {{"command", record.command}, {"inputs", record.inputs},   {"outputs", record.outputs},
          {"seconds", record.seconds}, {"version", record.version}, {"commit", record.commit}};
}

/// Throws json::exception where the form is not ours.
StageRecord stage_from(const std::string& stage, const json& entry) {
  StageRecord record;
  record.stage = stage;
  entry.at("command").get_to(record.command);
  entry.at("inputs").get_to(record.inputs);
  entry.at("outputs").get_to(record.outputs);
  entry.at("version").get_to(record.version);
  entry.at("commit").get_to(record.commit);
  if (entry.at("seconds").is_number()) entry.at("seconds").get_to(record.seconds);
  return record;
}

struct Content {
  fs::path study;
  std::map<std::string, StageRecord> stages;
  std::map<std::string, std::string> files;
};

/// Throws json::exception.
Content content_from(const json& run) {
  Content content;
  content.study = run.value("study", std::string());
  for (const auto& [stage, entry] : run.at("stages").items()) content.stages[stage] = stage_from(stage, entry);
  for (const auto& [name, stage] : content.stages) {
    for (const std::string& output : stage.outputs) content.files.emplace(output, "");
  }
  if (run.contains("files")) {
    for (const auto& [name, hash] : run.at("files").items()) content.files[name] = hash.get<std::string>();
  }
  return content;
}

/// nullopt where there is no such file (`why` empty), or it is not as misfit writes it (`why` says so).
std::optional<Content> content_of(const fs::path& path, std::string& why) {
  constexpr std::size_t max_words = 120;
  std::error_code none;
  if (!fs::exists(path, none)) return std::nullopt;
  try {
    return content_from(json::parse(read_file(path)));
  } catch (const json::exception& error) {
    why = "cannot be understood (" + std::string(error.what()).substr(0, max_words) + ")";
  } catch (const InputError& error) {
    why = "cannot be read (" + std::string(error.what()).substr(0, max_words) + ")";
  }
  return std::nullopt;
}

}  // namespace

RunFolder::Made::Made(const fs::path& dir, Access access) {
  if (access == Access::read) return;
  std::error_code error;
  const bool before = fs::exists(dir, error);
  make_writable_folder(dir);
  if (!before) dir_ = dir;
}

RunFolder::Made::~Made() {
  std::error_code error;  // also: not empty
  if (!dir_.empty()) fs::remove(dir_, error);
}

RunFolder::RunFolder(fs::path dir, RunOrigin origin, Access access)
    : dir_(std::move(dir)),
      access_(access),
      made_(dir_, access),
      lock_(access == Access::write ? std::make_unique<FolderLock>(dir_) : nullptr),
      origin_(std::move(origin)) {
  if (!origin_.study.empty()) origin_.study = fs::absolute(origin_.study).lexically_normal();
  if (access == Access::write) PartFolder::sweep(dir_);
  read();
}

void RunFolder::read() {
  const fs::path path = file(run_name);
  std::error_code none;
  if (fs::is_directory(path, none))
    throw InputError(path.string() + ": is a folder where misfit writes a file: move it away, or use --out DIR");
  std::string why;
  auto content = content_of(path, why);
  if (content) {
    study_before_ = std::move(content->study);
    stages_ = std::move(content->stages);
    files_ = std::move(content->files);
    return;
  }
  std::string why_no_copy;
  content = content_of(file(copy_name), why_no_copy);
  if (content) files_ = std::move(content->files);
  if (why.empty() && !content) return;  // nothing was here before
  if (access_ == Access::read) return;
  if (!content && !origin_.rules.force)
    throw InputError(fmt::format("{}: {}: is it a file of yours? --force writes over it, --out DIR writes elsewhere", path.string(), why));
  lost_record_ = fmt::format("{}: {}, so all stages run again", path.string(), why.empty() ? "is gone" : why);
}

std::optional<fs::path> RunFolder::other_study() const {
  if (origin_.study.empty() || study_before_.empty()) return std::nullopt;
  const fs::path before = (fs::absolute(dir_) / study_before_).lexically_normal();
  std::error_code error;
  if (!fs::exists(before, error) || fs::equivalent(before, origin_.study, error)) return std::nullopt;
  return before;
}

bool RunFolder::intact(const std::string& name) const {
  const auto known = files_.find(name);
  if (known == files_.end() || known->second.empty()) return false;
  std::error_code none;
  if (fs::symlink_status(file(name), none).type() != fs::file_type::regular) return false;
  try {
    return hash_file(file(name)) == known->second;
  } catch (const InputError&) {
    return false;
  }
}

std::vector<std::string> RunFolder::damaged(const std::string& stage) const {
  const auto it = stages_.find(stage);
  if (it == stages_.end()) return {};
  std::vector<std::string> names;
  std::copy_if(it->second.outputs.begin(), it->second.outputs.end(), std::back_inserter(names),
               [&](const std::string& name) { return !intact(name); });
  return names;
}

bool RunFolder::up_to_date(const std::string& stage, const StageInputs& inputs) const {
  const auto it = stages_.find(stage);
  if (it == stages_.end()) return false;
  const StageRecord& before = it->second;
  return before.version == version() && before.commit == misfit::commit() && before.inputs == inputs && damaged(stage).empty();
}

void RunFolder::check_places(const std::vector<std::string>& names) const {
  for (const std::string& name : names) check_place(dir_, name, origin_.rules, files_.contains(name));
}

void RunFolder::commit(const PartFolder& part, StageRecord record) {
  const std::vector<std::string> names = part.files();
  check_places(names);
  for (const char* name : {run_name, copy_name}) check_place(dir_, name, origin_.rules, true);  // read() knows them for ours
  const auto before = stages_.find(record.stage);
  if (before != stages_.end()) remove_dropped(before->second, names);
  for (const std::string& name : names) files_[name] = hash_file(part.path() / name);
  record.outputs = names;
  record.version = version();
  record.commit = misfit::commit();
  stages_[record.stage] = std::move(record);
  write();
  part.put_into_place(names);
}

void RunFolder::remove_dropped(const StageRecord& before, const std::vector<std::string>& names) {
  for (const std::string& name : before.outputs) {
    const bool again = std::find(names.begin(), names.end(), name) != names.end();
    const bool of_another = std::any_of(stages_.begin(), stages_.end(), [&](const auto& entry) {
      const auto& outputs = entry.second.outputs;
      return entry.first != before.stage && std::find(outputs.begin(), outputs.end(), name) != outputs.end();
    });
    if (again || of_another) continue;
    std::error_code none;
    if (intact(name)) fs::remove(file(name), none);
    files_.erase(name);
  }
}

void RunFolder::write() const {
  json run = {{"version", version()},
              {"commit", misfit::commit()},
              {"seed", origin_.seed},
              {"command", origin_.command},
              {"stages", json::object()}};
  if (!origin_.study.empty()) run["study"] = origin_.study.lexically_relative(fs::absolute(dir_).lexically_normal()).generic_string();
  for (const auto& [stage, record] : stages_) run["stages"][stage] = to_json(record);
  run["files"] = files_;
  const std::string text = run.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
  const PartFolder part(dir_);
  for (const char* name : {copy_name, run_name}) write_atomically(part.path() / name, text);
  part.put_into_place({copy_name, run_name});
}

}  // namespace misfit
