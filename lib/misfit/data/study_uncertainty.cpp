// [uncertainty] of a study.

#include <algorithm>

#include "misfit/core/shown.h"
#include "misfit/data/study_parts.h"

namespace misfit::study_parts {
namespace {

using config::Section;

const std::vector<std::string>& known_readings() {
  static const std::vector<std::string> names{"3 sigma", "2 sigma", "sigma", "uniform"};
  return names;
}

PerturbStudy read_one(const Section& perturb, const std::string& name) {
  PerturbStudy out;
  out.name = name;
  if (!perturb.is_text(name) && !perturb.is_number(name)) perturb.fail(name, "a number is expected that says how far, as \"0.1 kg\"");
  out.number = perturb.is_text(name) ? number_as_written(perturb, name) : *perturb.number(name, "");
  if (perturb.is_number(name)) out.number.unit.clear();
  if (!(out.number.value > 0.0)) perturb.fail(name, "must be above 0; what is not to be perturbed is left out");
  return out;
}

/// One reading for all, or a table of those that differ from "3 sigma".
void read_readings(const Section& section, UncertaintyStudy& study) {
  if (!section.has("readings")) return;
  if (!section.is_table("readings")) {
    const std::string reading = section.choice("readings", known_readings()).value_or("3 sigma");
    for (PerturbStudy& p : study.perturb) p.reading = reading;
    return;
  }
  const Section table = *section.table("readings");
  std::vector<std::string> names;
  for (const PerturbStudy& p : study.perturb) names.push_back(p.name);
  for (const std::string& name : table.keys()) {
    const auto found = std::find_if(study.perturb.begin(), study.perturb.end(), [&](const PerturbStudy& p) { return p.name == name; });
    if (found == study.perturb.end()) table.fail(name, "'" + shown(name) + "' is not in perturb" + suggest(name, names));
    found->reading = *table.choice(name, known_readings());
  }
  table.finish();
}

}  // namespace

void read_uncertainty(const Section& root, Study& study) {
  const auto section = root.table("uncertainty");
  if (!section) return;
  constexpr long most_runs = 100'000'000;
  UncertaintyStudy out;
  out.where = section->where();
  out.where_camera = section->where("camera");
  out.where_profile = section->where("profile");
  out.runs = section->integer("runs", 1, most_runs).value_or(out.runs);
  if (const auto perturb = section->table("perturb")) {
    for (const std::string& name : perturb->keys()) out.perturb.push_back(read_one(*perturb, name));
    perturb->finish();
  }
  read_readings(*section, out);
  out.calibrated_camera = section->choice("camera", {"calibration"}).has_value();
  out.recalibrate = section->flag("recalibrate").value_or(false);
  constexpr long most_block = 10'000'000;
  out.bootstrap = section->integer("bootstrap", 2, most_runs).value_or(0);
  out.block = section->integer("block", 1, most_block).value_or(0);
  out.starts = section->integer("starts", 1, most_runs).value_or(0);
  out.profile = section->texts("profile").value_or(std::vector<std::string>{});
  section->finish();
  study.uncertainty = std::move(out);
}

}  // namespace misfit::study_parts
