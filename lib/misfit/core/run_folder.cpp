#include "misfit/core/run_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "misfit/core/ranks.h"
#include "misfit/core/version.h"

namespace misfit {
namespace {

using nlohmann::json;

json to_json(const StageRecord& record) {
  return {{"command", record.command}, {"inputs", record.inputs},   {"outputs", record.outputs},
          {"seconds", record.seconds}, {"version", record.version}, {"commit", record.commit}};
}

/// Throws json::exception where the form is not ours.
StageRecord from_json(const std::string& stage, const json& entry) {
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

std::map<std::string, StageRecord> read_stages(const std::filesystem::path& path, std::filesystem::path& study) {
  std::map<std::string, StageRecord> stages;
  if (!std::filesystem::exists(path)) return stages;
  try {
    const json run = json::parse(read_file(path));
    study = run.value("study", std::string());
    for (const auto& [stage, entry] : run.at("stages").items()) stages[stage] = from_json(stage, entry);
  } catch (const json::exception& error) {
    fmt::print(stderr, "{}: cannot be understood, all stages will run again ({})\n", path.string(), error.what());
    return {};
  } catch (const InputError& error) {
    fmt::print(stderr, "{}; all stages will run again\n", error.what());
    return {};
  }
  return stages;
}

}  // namespace

RunFolder::Made::Made(const std::filesystem::path& dir) {
  std::error_code error;
  const bool before = std::filesystem::exists(dir, error);
  make_writable_folder(dir);
  if (!before && ranks().first()) dir_ = dir;
}

RunFolder::Made::~Made() {
  std::error_code error;  // also: not empty
  if (!dir_.empty()) std::filesystem::remove(dir_, error);
}

RunFolder::RunFolder(std::filesystem::path dir, std::string command, unsigned long seed, std::filesystem::path study)
    : dir_(std::move(dir)),
      made_(dir_),
      command_(std::move(command)),
      seed_(seed),
      study_(study.empty() ? std::move(study) : std::filesystem::absolute(study).lexically_normal()) {
  stages_ = read_stages(file("run.json"), study_before_);
}

std::optional<std::filesystem::path> RunFolder::other_study() const {
  if (study_.empty() || study_before_.empty()) return std::nullopt;
  const std::filesystem::path before = (std::filesystem::absolute(dir_) / study_before_).lexically_normal();
  std::error_code error;
  if (!std::filesystem::exists(before, error) || std::filesystem::equivalent(before, study_, error)) return std::nullopt;
  return before;
}

bool RunFolder::up_to_date(const std::string& stage, const std::map<std::string, std::string>& inputs) const {
  const auto it = stages_.find(stage);
  if (it == stages_.end()) return false;
  const StageRecord& before = it->second;
  if (before.version != version() || before.commit != commit() || before.inputs != inputs) return false;
  return std::all_of(before.outputs.begin(), before.outputs.end(),
                     [&](const std::string& name) { return std::filesystem::exists(file(name)); });
}

void RunFolder::record(const StageRecord& record) {
  StageRecord& entry = stages_[record.stage] = record;
  entry.version = version();
  entry.commit = commit();
  write();
}

void RunFolder::write() const {
  json run = {{"version", version()}, {"commit", commit()}, {"seed", seed_}, {"command", command_}, {"stages", json::object()}};
  if (!study_.empty()) run["study"] = study_.lexically_relative(std::filesystem::absolute(dir_).lexically_normal()).generic_string();
  for (const auto& [stage, record] : stages_) run["stages"][stage] = to_json(record);
  write_atomically(file("run.json"), run.dump(2, ' ', false, json::error_handler_t::replace) + "\n");
}

}  // namespace misfit
