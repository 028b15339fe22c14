#include "misfit/workflow/study_chain.h"

#include <algorithm>

#include "misfit/attitude/attitude.h"
#include "misfit/core/error.h"
#include "misfit/fit/filter/filter_error.h"
#include "misfit/fit/shooting/output_error.h"
#include "misfit/inference/gaps.h"
#include "misfit/model/experiment.h"

namespace misfit {
namespace {

bool usable(const Fit& fit) { return fit.status == FitStatus::converged || fit.status == FitStatus::not_converged; }

Track shifted(Track track, double y, double z) {
  for (double& v : track.P_y) v += y;
  for (double& v : track.P_z) v += z;
  return track;
}

bool predicts_pixels(const Model& model) {
  const auto& outputs = model.system->spec().outputs;
  return std::any_of(outputs.begin(), outputs.end(), [](const OutputSpec& o) { return o.name == "P_y" || o.name == "P_z"; });
}

}  // namespace

/// One experiment: as the nominal fit sees it, and the track it came from, where there is one.
struct StudyChain::Recording {
  Signals nominal;
  std::optional<Track> track;
  ExperimentStudy study;  ///< without the map of its file's columns
};

StudyChain::~StudyChain() = default;

StudyChain::StudyChain(Session& session, const std::string& method) : method_(method) {
  hold_perturbed_camera(session);
  prepare_method(session, method);
  if (!usable(nominal_)) throw RunError(method + " " + to_string(nominal_.status) + ": " + nominal_.message);
  read_recordings(session);
  rig_.emplace(session, prepared_.model);
  const PerturbedRig as_it_is = rig_->at(std::vector<double>(rig_->perturbations().names().size(), 0.0));
  numbers_.emplace(nominal_, fit(start_, signals(as_it_is, start_)), prepared_.model.system->spec().static_curve);
}

void StudyChain::prepare_method(Session& session, const std::string& method) {
  Methods methods(session);
  if (method == "sliding_bin") {
    nominal_ = methods.run(method);
    std::vector<std::string> left_out;
    auto form = prepare_regression(session, left_out);
    if (!form) return;
    form->experiments.resize(1);  // the only one that it uses
    prepared_ = std::move(*form);
    start_ = prepared_.model;
    bins_ = bin_options(session);
    bins_.curves_only = true;
    return;
  }
  prepared_ = methods.prepared();
  start_ = prepared_.model;
  if (method == "equation_error") nominal_ = methods.regression().fit;
  if (method == "output_error") {
    FittedModel fitted = methods.run_output_error();
    nominal_ = std::move(fitted.fit);
    start_ = std::move(fitted.model);
    penalties_ = std::move(fitted.penalties);
  }
  if (method == "filter_error") {
    const auto work = methods.run_filter_error();
    nominal_ = work->fit;
    if (!work->estimate) return;
    start_ = work->estimate->model;
    penalties_ = work->estimate->penalties;
    noise_ = work->estimate->noise;
  }
}

void StudyChain::read_recordings(Session& session) {
  pixels_ = predicts_pixels(prepared_.model);
  std::size_t e = 0;
  for (const Signals& part : prepared_.experiments) {
    while (!is_part_of(part, session.study.experiments.at(e).name)) ++e;
    Recording recording{part, {}, session.study.experiments[e]};
    if (has_track(recording.study)) recording.track = read_track(track_files(session, e).track, recording.study.columns);
    if (recording.track) recording.study.columns = {};  // the map was for the track's columns
    recordings_.push_back(std::move(recording));
  }
}

Model StudyChain::perturbed(const PerturbedRig& rig) const {
  Model model = start_;
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
  if (method_ == "sliding_bin") return sliding_bin(model, experiments.front(), bins_);
  if (method_ == "equation_error") return equation_error(model, experiments).fit;
  if (method_ == "output_error") {
    OutputErrorStart warm;
    warm.keep_roughness = true;
    warm.coloured = false;
    FittedModel start{{}, model, penalties_, {}};
    start.fit.noise = nominal_.noise;
    return output_error(start, experiments, warm).fit;
  }
  FilterOptions warm;
  warm.threads = 1;
  warm.noise = noise_;
  warm.choose_roughness = false;
  warm.verify = false;
  return filter_fit(estimate_filter(model, penalties_, experiments, warm));
}

ChainResult StudyChain::run(const std::vector<double>& errors) const {
  try {
    const PerturbedRig rig = rig_->at(errors);
    const Model model = perturbed(rig);
    const Fit result = fit(model, signals(rig, model));
    if (!usable(result)) return {{}, to_string(result.status) + ": " + result.message};
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
