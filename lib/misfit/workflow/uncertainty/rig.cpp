#include "misfit/workflow/uncertainty/rig.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "misfit/core/display.h"
#include "misfit/core/error.h"
#include "misfit/core/shown.h"
#include "misfit/core/text.h"
#include "misfit/core/units.h"
#include "misfit/data/study_keys.h"
#include "misfit/workflow/uncertainty/uncertainty.h"

namespace misfit {
namespace {

bool is_camera(const std::string& name) {
  return std::find(camera_parameter_names.begin(), camera_parameter_names.end(), name) != camera_parameter_names.end();
}

bool of_sweep(const std::string& name) { return name == "l_p" || name == "R1" || name == "R2" || name == "R3"; }

/// Some experiment goes from a track through the camera: a film that the outputs read themselves does not.
bool any_attitude(const Session& session) {
  const auto& experiments = session.study.experiments;
  return std::any_of(experiments.begin(), experiments.end(), [&](const ExperimentStudy& e) { return has_attitude(session, e); });
}

/// Sigmas in one of the numbers of the study.
double divisor_of(const std::string& distribution) {
  if (distribution == "3 sigma") return 3.0;
  if (distribution == "2 sigma") return 2.0;
  return distribution == "uniform" ? std::sqrt(3.0) : 1.0;
}

std::string distribution_text(const PerturbStudy& request, const std::string& unit) {
  const std::string size = in_display_unit(request.number.value, unit);
  return request.distribution == "uniform" ? "uniform within ± " + size : "normal, " + request.distribution + " = " + size;
}

void move_rig(RigGeometry& geometry, const std::string& name, double error) {
  for (const RigEntry& entry : rig_entries()) {
    if (name == entry.name) geometry.*entry.field += error;
  }
}

/// Is it estimated, as a number or as a curve?
bool is_free(const Model& model, const std::string& name) {
  if (model.find_curve(name) != nullptr) return true;
  const int i = model.find_parameter(name);
  return i >= 0 && model.parameters[i].free;
}

void require_fixed(const Source& where, const Model& model, const std::string& name) {
  if (!is_free(model, name)) return;
  throw InputError(where, "'" + shown(name) +
                              "' is estimated by this study: only what is fixed can be perturbed (fix it in [parameters], or leave it out "
                              "here)");
}

}  // namespace

Rig::Rig(Session& session, const Model& model) {
  const UncertaintyStudy& uncertainty = *session.study.uncertainty;
  list_known(session, model);
  for (const PerturbStudy& request : uncertainty.perturb) add(request, model);
  if (uncertainty.calibrated_camera) add_calibration(session, model);
  if (perturbations_.names().empty())
    throw InputError(uncertainty.where, "nothing is perturbed: perturb = { R = \"0.1524 m\", … } says what, and how far");
  note_fixed_camera(model);
  const bool from_image = nominal_.calibration.has_value();
  if (uncertainty.recalibrate) {
    if (!from_image || !session.study.camera.from_sweep())
      throw InputError(uncertainty.where, "recalibrate needs a camera that is calibrated from a sweep");
    sweep_ = read_sweep(sweep_stage(session));
    calibrate_.model = nominal_.calibration->model;
    calibrate_.candidates.clear();
    calibrate_.test_others = false;
    calibrate_.force = session.study.camera.free;
    for (const CameraTest& test : nominal_.calibration->tests) {
      if (test.selected) calibrate_.force.push_back(test.name);
    }
  }
}

/// Where the system predicts the image, the calibrated camera is estimated by the study's own fits.
void Rig::note_fixed_camera(const Model& model) {
  for (const std::string& name : perturbations_.names()) {
    if (!is_camera(name) || model.find_parameter(name) < 0) continue;
    notes_.emplace_back(
        "Camera parameters that are perturbed are fixed in every run, and in the nominal fit here, instead of being estimated with their "
        "calibration as prior.");
    return;
  }
}

void Rig::list_known(Session& session, const Model& model) {
  nominal_.geometry = session.model.rig;
  for (const Parameter& p : model.parameters) {
    if (p.curve < 0) known_[p.name] = {p.unit, p.value};
    if (p.curve < 0) nominal_.constants[p.name] = p.value;
  }
  if (!any_attitude(session)) return;
  nominal_.calibration = calibrate_stage(session);
  for (const RigEntry& entry : rig_entries()) {
    const bool used = !of_sweep(entry.name) || session.study.uncertainty->recalibrate;
    if (used && nominal_.geometry.*entry.field > 0.0)
      known_[entry.name] = {config::group_of(study_keys(), "geometry").key(entry.name).unit, nominal_.geometry.*entry.field};
  }
  known_["P_y"] = known_["P_z"] = {"px", 0.0};
  if (!nominal_.calibration) return;
  for (std::size_t i = 0; i < camera_parameter_names.size(); ++i)
    known_[camera_parameter_names[i]] = {camera_parameter_units[i], nominal_.calibration->value(camera_parameter_names[i])};
}

void Rig::add(const PerturbStudy& request, const Model& model) {
  const Source& where = request.number.where;
  if (of_sweep(request.name) && !known_.contains(request.name))
    throw InputError(where, request.name + " acts through the calibration alone: recalibrate = true calibrates again in every run");
  require_fixed(where, model, request.name);
  const auto known = known_.find(request.name);
  if (known == known_.end()) {
    std::vector<std::string> valid;
    for (const auto& [name, entry] : known_) {
      if (!is_free(model, name)) valid.push_back(name);
    }
    throw InputError(where, "nothing that is fixed in this study is called '" + shown(request.name) + "'" + suggest(request.name, valid));
  }
  const auto& [unit, value] = known->second;
  if (!request.number.unit.empty() && !parse_unit(request.number.unit).same_dimension(parse_unit(unit)))
    throw InputError(where, request.name + " needs [" + unit + "], not [" + request.number.unit + "]");
  const double sigma = request.number.value / divisor_of(request.distribution);
  perturbations_.single.push_back({request.name, unit, sigma, request.distribution == "uniform"});
  described_.push_back(
      {.name = request.name, .unit = unit, .value = value, .sigma = sigma, .distribution = distribution_text(request, unit), .group = ""});
}

void Rig::add_calibration(const Session& session, const Model& model) {
  const Source& where = session.study.uncertainty->where_camera;
  if (!nominal_.calibration || nominal_.calibration->names.empty())
    throw InputError(where, "camera = \"calibration\" needs a calibrated camera, or one given with sigmas, and a track");
  const Calibration& calibration = *nominal_.calibration;
  CorrelatedPerturbation group{"calibration", calibration.names, {}, calibration.covariance};
  for (const std::string& name : calibration.names) {
    require_fixed(where, model, name);
    const auto& single = perturbations_.single;
    if (std::any_of(single.begin(), single.end(), [&](const Perturbation& p) { return p.name == name; }))
      throw InputError(where, "'" + shown(name) + "' is in perturb as well: give it one of the two");
    group.units.push_back(known_.at(name).unit);
    described_.push_back({name, group.units.back(), calibration.value(name), calibration.sigma(name),
                          "normal, with the covariance of the calibration", group.label});
  }
  group.source = session.folder.file("camera.json").string() + ", covariance";
  perturbations_.groups.push_back(std::move(group));
}

void Rig::set(PerturbedRig& rig, const std::string& name, double error) const {
  move_rig(rig.geometry, name, error);
  if (name == "P_y") rig.offset_y += error;
  if (name == "P_z") rig.offset_z += error;
  if (const auto constant = rig.constants.find(name); constant != rig.constants.end()) constant->second += error;
  if (!rig.calibration || !is_camera(name)) return;
  const auto entries = camera_entries(rig.calibration->camera);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (name == camera_parameter_names[i]) *entries[i] += error;
  }
}

/// The camera that the sweep gives when the rig is as these errors make it.
void Rig::calibrate_again(const std::vector<std::string>& names, const std::vector<double>& errors, PerturbedRig& rig) const {
  RigGeometry geometry = nominal_.geometry;
  for (std::size_t i = 0; i < names.size(); ++i) move_rig(geometry, names[i], errors[i]);
  rig.calibration = calibrate(*sweep_, geometry, calibrate_);
  for (const char* name : camera_parameter_names) {
    const auto constant = rig.constants.find(name);
    if (constant != rig.constants.end()) constant->second = rig.calibration->value(name);
  }
}

PerturbedRig Rig::at(const std::vector<double>& errors) const {
  PerturbedRig out = nominal_;
  const std::vector<std::string> names = perturbations_.names();
  if (sweep_) calibrate_again(names, errors, out);
  for (std::size_t i = 0; i < names.size(); ++i) set(out, names[i], errors[i]);
  return out;
}

void fix_perturbed_camera(Session& session) {
  const UncertaintyStudy& uncertainty = *session.study.uncertainty;
  const auto hold = [&](const std::string& name) {
    auto& parameters = session.model.request.parameters;
    if (is_camera(name) && !parameters.contains(name)) parameters[name].free = false;
  };
  const SystemType& type = session.registry.system(session.model.request.system, session.model.request.system_where);
  const auto system = type.make(session.model.request.options);
  for (const ConstantSpec& constant : system->spec().constants) {
    const bool named =
        std::any_of(uncertainty.perturb.begin(), uncertainty.perturb.end(), [&](const auto& p) { return p.name == constant.name; });
    if (named || uncertainty.calibrated_camera || uncertainty.recalibrate) hold(constant.name);
  }
}

}  // namespace misfit
