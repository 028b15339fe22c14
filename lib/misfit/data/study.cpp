#include "misfit/data/study.h"

#include "misfit/core/files.h"
#include "misfit/data/estimators.h"
#include "misfit/data/study_parts.h"
#include "misfit/data/study_reader.h"

namespace misfit {

std::vector<std::string> VideoStudy::marker_names() const {
  std::vector<std::string> out;
  for (const NamedMarker& one : markers) out.push_back(one.name);
  return out;
}

namespace {

namespace fs = std::filesystem;
using config::DescribedSection;
using config::Section;

void read_head(const Section& root, Study& study) {
  const DescribedSection head = study_parts::described(root, "study");
  study.name = head.text("name").value_or(fs::absolute(study.file).parent_path().filename().string());
  study.question = *head.text("question");
  study.seed = *head.integer("seed");
  study.methods = *head.texts("methods");
  if (study.methods.empty()) head.fail("methods", "at least one method is needed; leave the key out for the default ones");
  head.finish();
}

/// A flag, or a number kept with the unit as written: what it must be is known to the model only.
void read_system_option(const Section& system, const std::string& key, Study& study) {
  if (system.is_flag(key)) {
    study.system_flags[key] = *system.flag(key);
  } else if (system.is_number(key)) {
    study.system_numbers[key] = *system.number(key, "");
  } else if (system.is_text(key)) {
    study.system_numbers[key] = study_parts::number_as_written(system, key);
  } else {
    system.fail(key, "true, false or a number, as 0.5 or \"0.5 m\", is expected" + suggest(key, {"kind", "file", "hold"}));
  }
}

void read_hold(const Section& system, Study& study) {
  if (!system.has("hold")) return;
  const DescribedSection hold = study_parts::described(system, "hold", "system.hold");
  for (const std::string& input : hold.keys()) study.system_hold[input] = {*hold.choice(input), hold.where(input)};
  hold.finish();
}

/// A key that is nearly one of the two by which a system is named.
void refuse_mistyped_name(const DescribedSection& system) {
  const std::vector<std::string> names = {"kind", "file"};
  for (const std::string& key : system.keys()) {
    if (!nearest_name(key, names).empty())
      throw InputError(system.where(key), "unknown key '" + key + "' in [system]" + suggest(key, names));
  }
}

void read_system(const Section& root, Study& study) {
  if (!root.has("system"))
    throw InputError({study.file.string(), 0, 0}, "the section [system] is missing: it names the model, as kind = \"parachute_spherical\"");
  const DescribedSection system = study_parts::described(root, "system");
  read_hold(system, study);
  if (!system.has("kind") && !system.has("file")) refuse_mistyped_name(system);
  if (system.has("kind") == system.has("file")) system.fail("", "exactly one of kind and file is needed");
  study.system_kind = system.text("kind").value_or("");
  study.system_file = study_parts::existing_file(system, "file", study.folder);
  for (const std::string& key : system.keys()) {
    study.system_where[key] = system.where(key);
    if (key != "kind" && key != "file" && key != "hold") read_system_option(system, key, study);
  }
  if (!study.system_hold.empty() && !study.system_file) system.fail("hold", "it is for the inputs of a declared system (file)");
  system.finish();
}

void read_sliding_bin(const Section& root, Study& study) {
  if (!root.has(estimators::sliding_bin.name)) return;
  const DescribedSection section = study_parts::described(root, estimators::sliding_bin.name);
  study.bin_width = *section.value("width");
  study.bin_step = *section.value("step");
  section.finish();
}

std::optional<double> read_time_limit(const Section& root, const char* group) {
  if (!root.has(group)) return std::nullopt;
  const DescribedSection section = study_parts::described(root, group);
  const std::optional<double> limit = section.value("time_limit");
  section.finish();
  return limit;
}

}  // namespace

fs::path study_file(const fs::path& path) {
  std::error_code none;  // what cannot be looked at cannot be read either, which read_file() says
  return fs::is_directory(path, none) ? path / "study.toml" : path;
}

Study read_study(const fs::path& path) { return read_study_text(study_file(path), read_file(study_file(path))); }

Study read_study_text(const fs::path& file, std::string text) {
  Study study;
  study.file = file;
  study.folder = study.file.has_parent_path() ? study.file.parent_path() : fs::path(".");
  study.text = std::move(text);
  const Section root = Section::parse(study.text, study.file.string());
  read_head(root, study);
  read_system(root, study);
  study.geometry = root.table("geometry");
  study_parts::read_video(root, study);
  study_parts::read_camera(root, study);
  study_parts::read_experiments(root, study);
  study_parts::read_effects(root, study);
  study_parts::read_parameters(root, study);
  study_parts::read_initial(root, study);
  study_parts::read_noise(root, study);
  study_parts::read_force(root, study);
  study_parts::read_curves(root, study);
  study_parts::read_reference(root, study);
  study_parts::read_uncertainty(root, study);
  read_sliding_bin(root, study);
  study.fit_time_limit = read_time_limit(root, "fit");
  study.discover_time_limit = read_time_limit(root, "discover");
  study_parts::read_simulate(root, study);
  root.finish(config::sections_of(study_keys()));
  return study;
}

}  // namespace misfit
