#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "misfit/attitude/attitude.h"
#include "misfit/core/error.h"
#include "misfit/inference/curves.h"
#include "misfit/inference/gaps.h"
#include "misfit/math/statistics.h"
#include "misfit/model/curve_table.h"
#include "misfit/model/experiment.h"
#include "misfit/model/provisional.h"
#include "misfit/workflow/estimate/estimate.h"
#include "misfit/workflow/measure/film_channels.h"

namespace misfit {
namespace {

constexpr int default_intervals = 16;  // per curve: enough for any bend the data can show; roughness does the rest

std::vector<double> where_ok(std::vector<double> values, const std::vector<bool>& ok) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!ok[i]) values[i] = std::nan("");
  }
  return values;
}

/// Median of the sigmas of what was found [px]; 0: not known.
double usual_sigma(const Track& track) {
  std::vector<double> known;
  for (std::size_t i = 0; i < track.sigma.size(); ++i) {
    if (track.ok[i] && std::isfinite(track.sigma[i])) known.push_back(track.sigma[i]);
  }
  return known.empty() ? 0.0 : median(known);
}

/// What a user must know of a marker's track, and of the map that made metres of it.
std::vector<std::string> notes_of(const TrackFacts& facts, bool in_metres) {
  std::vector<std::string> out = facts.warnings;
  if (!facts.plane) return out;
  out.insert(out.end(), facts.plane->warnings.begin(), facts.plane->warnings.end());
  if (in_metres && facts.plane->sigma > 0.0) {
    out.push_back(fmt::format(
        "the map from pixels to metres is known to {:.2g} m where the track is; that is common to all samples, and no sigma of a fit "
        "contains it",
        facts.plane->sigma));
  }
  return out;
}

/// The film as the outputs of a system that says where something is in it.
Signals film_signals(const Session& session, std::size_t e, const Model& model) {
  const ExperimentStudy& experiment = session.study.experiments[e];
  const std::vector<TrackFiles> files = files_of_tracks(session, e);
  const VideoStudy& video = session.study.video;
  std::vector<FilmTrack> tracks;
  for (std::size_t m = 0; m < files.size(); ++m)
    tracks.push_back({video.markers.empty() ? "" : video.markers[m].name, read_track(files[m].track), read_track_facts(files[m].facts)});
  Signals signals = signals_from(film_table(tracks, video), model, experiment);
  for (auto& channel : signals.measured) {
    const std::string header = channel_of(channel.name, experiment);
    for (const FilmTrack& followed : tracks) {
      const std::vector<std::string> own = film_channels({followed.name});
      if (followed.name.empty() || std::count(own.begin(), own.end(), header) > 0) channel.sigma = film_sigma(followed, header, video);
    }
  }
  const bool in_metres = std::any_of(signals.measured.begin(), signals.measured.end(), [](const auto& c) { return c.unit == "m"; });
  for (const auto& [name, track, facts] : tracks) {
    for (const std::string& warning : notes_of(facts, in_metres)) signals.notes.push_back(name.empty() ? warning : name + ": " + warning);
  }
  return signals;
}

/// The track as the channels P_y and P_z, with its sigma where it gives one.
Signals pixels_of(const ExperimentStudy& experiment, const std::filesystem::path& file, const Model& model) {
  const Track track = read_track(file, experiment.columns);
  Table table;
  table.source = file.string();
  table.add("t", "s", track.t);
  table.add("P_y", "px", where_ok(track.P_y, track.ok));
  table.add("P_z", "px", where_ok(track.P_z, track.ok));
  ExperimentStudy plain = experiment;
  plain.columns = {};  // the map was for the track's columns
  Signals signals = signals_from(table, model, plain);
  for (auto& channel : signals.measured) channel.sigma = usual_sigma(track);
  signals.notes.insert(signals.notes.begin(), track.notes.begin(), track.notes.end());
  return signals;
}

/// Does the method run the model, so that a recording is cut where it cannot be run across? A regression takes no derivative across a gap.
enum class Gaps { cut, left };

std::vector<Signals> read_experiments(Session& session, const Model& model, Gaps gaps) {
  std::vector<Signals> out;
  const std::vector<std::optional<Attitude>> attitudes = attitude_stage(session);
  const bool pixels = predicts_pixels(model.system->spec());
  for (std::size_t e = 0; e < session.study.experiments.size(); ++e) {
    const ExperimentStudy& experiment = session.study.experiments[e];
    if (attitudes[e] && pixels) {
      out.push_back(pixels_of(experiment, track_files(session, e).track, model));
    } else if (attitudes[e]) {
      ExperimentStudy plain = experiment;
      plain.columns = {};
      out.push_back(signals_from(attitude_table(*attitudes[e]), model, plain));
    } else {
      std::vector<std::string> notes;
      Signals whole = has_track(experiment) ? film_signals(session, e, model)
                                            : signals_from(read_recording(experiment, model, notes), model, experiment);
      whole.notes.insert(whole.notes.begin(), notes.begin(), notes.end());
      std::vector<Signals> parts = gaps == Gaps::cut ? split_at_gaps(model, std::move(whole)) : std::vector<Signals>{std::move(whole)};
      std::move(parts.begin(), parts.end(), std::back_inserter(out));
    }
  }
  return out;
}

Prepared prepare_request(Session& session, ModelRequest request, Gaps gaps) {
  if (session.study.experiments.empty())
    throw InputError({session.study.file.string(), 0, 0}, "the study has no [[experiment]]: there is nothing to fit");
  add_camera(session, request);
  Prepared out;
  out.experiments = read_experiments(session, provisional_model(request, session.registry), gaps);
  choose_all_knots(request, session.registry, out.experiments, default_intervals);
  out.model = assemble(request, session.registry);
  out.request = std::move(request);
  set_curves_from_tables(session, out.request, out.model);
  return out;
}

}  // namespace

void set_curves_from_tables(const Session& session, const ModelRequest& request, Model& model) {
  const auto names = parameter_names(request, session.registry);
  for (const auto& [name, curve] : session.study.curves) {
    const auto known = names.find(name);
    const Curve* target = known == names.end() ? nullptr : model.find_curve(known->second);
    if (!curve.table || target == nullptr) continue;
    const Table table = read_csv(*curve.table);
    set_curve(model, target->name, table.values(curve.of, target->of_unit), table.values(name, target->unit));
  }
}

bool predicts_pixels(const SystemSpec& spec) {
  return std::any_of(spec.outputs.begin(), spec.outputs.end(), [](const OutputSpec& o) { return o.name == "P_y" || o.name == "P_z"; });
}

void add_camera(Session& session, ModelRequest& request) {
  const SystemType& type = session.registry.system(request.system, request.system_where);
  if (!predicts_pixels(type.make(request.options)->spec())) return;
  if (const std::optional<Calibration> calibration = calibrate_stage(session)) add_camera(*calibration, session.registry, request);
}

void add_camera(const Calibration& calibration, const Registry& registry, ModelRequest& request) {
  const SystemType& type = registry.system(request.system, request.system_where);
  const SystemSpec spec = type.make(request.options)->spec();
  if (!predicts_pixels(spec)) return;
  const auto has_flag = std::find(type.flags.begin(), type.flags.end(), "plane_by_plane") != type.flags.end();
  if (has_flag) request.options.flags.emplace("plane_by_plane", calibration.model == CameraModel::plane_by_plane);
  for (const char* name : camera_parameter_names) {
    const bool known = std::any_of(spec.constants.begin(), spec.constants.end(), [&](const ConstantSpec& c) { return c.name == name; });
    if (!known || request.constants.contains(name)) continue;
    request.constants[name] = calibration.value(name);
    if (!(calibration.sigma(name) > 0.0)) continue;
    request.constant_sigmas[name] = calibration.sigma(name);
    // Free, with the calibration as its prior: so its uncertainty is in every interval (marginal sigmas; their correlations are left out,
    // which makes intervals a little wider). A study can fix it again.
    if (!request.parameters.contains(name)) request.parameters[name].free = true;
  }
}

Prepared prepare(Session& session) { return prepare_request(session, session.model.request, Gaps::cut); }

std::optional<Prepared> prepare_regression(Session& session, std::vector<std::string>& left_out) {
  auto request = regression_form(session.model.request, session.registry, left_out);
  if (!request) return std::nullopt;
  return prepare_request(session, std::move(*request), Gaps::left);
}

bool averaged_by_attitude(const Session& session) { return has_attitude(session, session.study.experiments.front()); }

}  // namespace misfit
