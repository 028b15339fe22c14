#include "misfit/workflow/uncertainty/study_chain.h"

#include <algorithm>

#include "misfit/attitude/attitude.h"
#include "misfit/core/error.h"
#include "misfit/inference/gaps.h"
#include "misfit/model/experiment.h"

namespace misfit {
namespace {

Track shifted(Track track, double y, double z) {
  for (double& v : track.P_y) v += y;
  for (double& v : track.P_z) v += z;
  return track;
}

}  // namespace

/// One experiment: as the nominal fit sees it, and the track it came from, where there is one.
struct StudyChain::Recording {
  Signals nominal;
  std::optional<Track> track;
  ExperimentStudy study;  ///< without the map of its file's columns
};

StudyChain::~StudyChain() = default;

StudyChain::StudyChain(Session& session, const std::string& method) {
  fix_perturbed_camera(session);
  make_nominal(session, method);
  if (!nominal_.usable()) throw RunError(method + " " + to_string(nominal_.status) + ": " + nominal_.message);
  read_recordings(session);
  rig_.emplace(session, prepared_.model);
  const PerturbedRig as_it_is = rig_->at(std::vector<double>(rig_->perturbations().names().size(), 0.0));
  numbers_.emplace(nominal_, fit(from_.fitted.model, signals(as_it_is, from_.fitted.model)), prepared_.model.system->spec().static_curve);
}

/// A regression is solved anew in every run; the others start at the nominal estimates and keep roughness and noise.
void StudyChain::make_nominal(Session& session, const std::string& method) {
  Methods methods(session);
  const EstimatorInfo& info = estimator(method).info;
  from_ = methods.run(method).at;
  nominal_ = std::move(from_.fitted.fit);
  if (info.regression_form) {
    std::vector<std::string> left_out;
    auto form = prepare_regression(session, left_out);
    if (!form) return;
    form->experiments.resize(1);  // the only one that it uses
    prepared_ = std::move(*form);
    from_.bins.curves_only = true;
  } else {
    prepared_ = methods.prepared();
  }
  if (!info.has_likelihood) from_.fitted = {{}, prepared_.model, {}, {}};
  from_.fitted.fit = {};
  from_.fitted.fit.noise = nominal_.noise;
  from_.fitted.initial_states.clear();
  from_.reference.reset();
}

void StudyChain::read_recordings(Session& session) {
  pixels_ = predicts_pixels(prepared_.model.system->spec());
  std::size_t e = 0;
  for (const Signals& part : prepared_.experiments) {
    while (!is_part_of(part, session.study.experiments.at(e).name)) ++e;
    Recording recording{part, {}, session.study.experiments[e]};
    if (has_attitude(session, recording.study)) recording.track = read_track(track_files(session, e).track, recording.study.columns);
    if (recording.track) recording.study.columns = {};  // the map was for the track's columns
    recordings_.push_back(std::move(recording));
  }
}

Model StudyChain::perturbed(const PerturbedRig& rig) const {
  Model model = from_.fitted.model;
  for (Parameter& p : model.parameters) {
    if (p.free || p.curve >= 0) continue;
    if (const auto found = rig.constants.find(p.name); found != rig.constants.end()) p.value = found->second;
  }
  return model;
}

std::vector<Signals> StudyChain::signals(const PerturbedRig& rig, const Model& model) const {
  std::vector<Signals> out;
  AttitudeOptions values_only;
  values_only.sigmas = false;
  for (const Recording& recording : recordings_) {
    if (recording.track && !pixels_) {
      const Track track = shifted(*recording.track, rig.offset_y, rig.offset_z);
      const Attitude angles = attitude(track, *rig.calibration, rig.geometry, values_only);
      out.push_back(signals_from(attitude_table(angles), model, recording.study));
      continue;
    }
    out.push_back(recording.nominal);
    for (Signal& channel : out.back().measured) {
      const double offset = channel.name == "P_y" ? rig.offset_y : channel.name == "P_z" ? rig.offset_z : 0.0;
      if (!recording.track || offset == 0.0) continue;
      for (double& v : channel.values) v += offset;
    }
  }
  return out;
}

Fit StudyChain::fit(const Model& model, const std::vector<Signals>& experiments) const {
  FittedMethod from = from_;
  from.fitted.model = model;
  return refit_in_time(from, experiments);
}

ChainResult StudyChain::run(const std::vector<double>& errors) const {
  try {
    const PerturbedRig rig = rig_->at(errors);
    const Model model = perturbed(rig);
    const Fit result = fit(model, signals(rig, model));
    if (!result.usable()) return {{}, to_string(result.status) + ": " + result.message};
    return {numbers_->evaluate(result), ""};
  } catch (const InputError& error) {  // an impossible rig, as a camera in front of the apex
    return {{}, error.what()};
  } catch (const RunError& error) {
    return {{}, error.what()};
  }
}

std::unique_ptr<StudyChain> chain_of(Session& session) {
  const std::vector<std::string> methods = session.methods();
  std::string why;
  for (const std::string& method : methods) {
    try {
      return std::make_unique<StudyChain>(session, method);
    } catch (const RunError& error) {
      why += std::string(why.empty() ? "" : "; ") + error.what();
    }
  }
  throw RunError("no method of the study gives a result to perturb: " + why);
}

}  // namespace misfit
