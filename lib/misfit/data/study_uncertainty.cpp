// [uncertainty] of a study.

#include <algorithm>

#include "misfit/core/shown.h"
#include "misfit/data/study_parts.h"

namespace misfit::study_parts {
namespace {

using config::DescribedSection;
using config::Section;

PerturbStudy read_one(const Section& perturb, const std::string& name) {
  PerturbStudy out;
  out.name = name;
  if (!perturb.is_text(name) && !perturb.is_number(name)) perturb.fail(name, "a number is expected that says how far, as \"0.1 kg\"");
  out.number = number_as_written(perturb, name);
  if (!(out.number.value > 0.0)) perturb.fail(name, "must be above 0; what is not to be perturbed is left out");
  return out;
}

/// One distribution for all numbers of perturb, or a table of those that differ from "3 sigma".
void read_distributions(const DescribedSection& section, UncertaintyStudy& study) {
  if (!section.has("distribution")) return;
  if (!section.is_table("distribution")) {
    const std::string distribution = *section.choice("distribution");
    for (PerturbStudy& p : study.perturb) p.distribution = distribution;
    return;
  }
  const DescribedSection table = described(section, "distribution", "uncertainty.distribution");
  std::vector<std::string> names;
  for (const PerturbStudy& p : study.perturb) names.push_back(p.name);
  for (const std::string& name : table.keys()) {
    const auto found = std::find_if(study.perturb.begin(), study.perturb.end(), [&](const PerturbStudy& p) { return p.name == name; });
    if (found == study.perturb.end()) table.fail(name, "'" + shown(name) + "' is not in perturb" + suggest(name, names));
    found->distribution = *table.choice(name);
  }
  table.finish();
}

}  // namespace

void read_uncertainty(const Section& root, Study& study) {
  if (!root.has("uncertainty")) return;
  const DescribedSection section = described(root, "uncertainty");
  UncertaintyStudy out;
  out.where = section.where();
  out.where_camera = section.where("camera");
  out.where_profile = section.where("profile");
  out.runs = *section.integer("runs");
  const DescribedSection perturb = described(section, "perturb", "uncertainty.perturb");
  for (const std::string& name : perturb.keys()) out.perturb.push_back(read_one(perturb, name));
  perturb.finish();
  read_distributions(section, out);
  out.calibrated_camera = section.choice("camera").has_value();
  out.recalibrate = *section.flag("recalibrate");
  out.bootstrap = section.integer("bootstrap").value_or(0);
  out.block = section.integer("block").value_or(0);
  out.starts = section.integer("starts").value_or(0);
  out.profile = section.texts("profile").value_or(std::vector<std::string>{});
  section.finish();
  study.uncertainty = std::move(out);
}

}  // namespace misfit::study_parts
