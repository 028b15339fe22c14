#include "apps/ladder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "misfit/core/error.h"
#include "misfit/core/file_name.h"
#include "misfit/core/files.h"
#include "misfit/data/curve_coefficient.h"
#include "misfit/fit/filter/filter_error.h"
#include "misfit/fit/filter/k_step.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

constexpr const char* ladder_name = "ladder.json";
constexpr const char* method = "filter_error";
constexpr const char* system_prefix = "system:";

/// filter_error's fit and estimate; RunError in its words if it declined.
std::shared_ptr<const FilterWork> fitted(Session& session) {
  const Fit fit = fit_stage(session, {method}).front();
  if (fit.status == FitStatus::declined || fit.status == FitStatus::failed) refuse_declined(session);
  return filter_work(session);
}

void append_note(std::string& note, const std::string& words) {
  if (!words.empty()) note += (note.empty() ? "" : "; ") + words;
}

/// What the fit says of the model, without what made it.
Rung rung_of(const Session& session, const FilterWork& work) {
  Rung rung;
  rung.system = session.model.request.system;
  rung.method = method;
  rung.loglik = work.estimate->loglik;
  rung.validation_loglik = work.fit.validation_loglik;
  rung.force = work.fit.force;
  rung.rms = work.fit.rms;
  rung.validation_rms = work.fit.validation_rms;
  KStepErrors free_runs = k_step_errors(*work.estimate);
  rung.k_step = std::move(free_runs.rms);
  rung.note = std::move(free_runs.words);
  rung.trim = work.fit.trim;
  return rung;
}

/// Estimates of the child that the parent does not have.
std::map<std::string, Estimate> new_parameters(const FilterWork& child, const FilterWork& parent) {
  std::map<std::string, Estimate> out;
  for (const auto& [name, estimate] : child.fit.parameters) {
    if (!parent.fit.parameters.contains(name) && !is_curve_coefficient(name)) out[name] = estimate;
  }
  return out;
}

bool same_channels(const Model& a, const Model& b) {
  const auto& x = a.system->spec();
  const auto& y = b.system->spec();
  return x.key == y.key && std::equal(x.outputs.begin(), x.outputs.end(), y.outputs.begin(), y.outputs.end(),
                                      [](const OutputSpec& p, const OutputSpec& q) { return p.name == q.name; });
}

/// The child's penalties with the parent's weights for the curves that both have: the same prior on both sides of a drop.
std::vector<Penalty> shared_penalties(const FilterEstimate& child, const FilterEstimate& parent) {
  std::vector<Penalty> penalties = child.penalties;
  for (auto& own : penalties) {
    const std::string& name = child.model.curves[static_cast<std::size_t>(own.curve)].name;
    for (const auto& other : parent.penalties) {
      if (parent.model.curves[static_cast<std::size_t>(other.curve)].name == name) own.lambda = other.lambda;
    }
  }
  return penalties;
}

/// Measurements that both models use and neither has rejected: an effect may need inputs that are missing where the other model goes on.
std::vector<std::vector<SampleRole>> common_use(const FilterEstimate& a, const FilterEstimate& b) {
  std::vector<std::vector<SampleRole>> use;
  for (std::size_t e = 0; e < a.data.size(); ++e) {
    use.push_back(a.data[e].use);
    for (std::size_t i = 0; i < use.back().size(); ++i) {
      if (b.data[e].use[i] == SampleRole::none) use.back()[i] = SampleRole::none;
    }
  }
  return use;
}

struct Gain {
  double drop = 0.0;
  std::optional<double> held_out;
};

/// 2 [log L(with) − log L(without)] on the same measurements and with the same weights of roughness, each at its own maximum, priors
/// counted.
Gain gain_of(const FilterWork& child, const FilterWork& parent, int threads) {
  FilterOptions options;
  options.threads = threads;
  options.around = parent.estimate->around;
  options.choose_roughness = false;
  options.use = common_use(*parent.estimate, *child.estimate);
  const auto again = [&](const FilterWork& work, std::vector<Penalty> penalties) {
    options.noise = work.estimate->noise;
    return estimate_filter(work.estimate->model, std::move(penalties), work.prepared.experiments, options);
  };
  const FilterEstimate without = again(parent, parent.estimate->penalties);
  const FilterEstimate with = again(child, shared_penalties(*child.estimate, *parent.estimate));
  Gain gain{2.0 * (with.objective - without.objective), std::nullopt};
  if (parent.fit.validation_loglik) gain.held_out = with.validation_loglik - without.validation_loglik;
  return gain;
}

std::map<std::string, std::string> inputs_of_ladder(const Session& session) {
  std::vector<fs::path> files;
  for (const auto& experiment : session.study.experiments) {
    for (const auto& file : {experiment.track, experiment.video, experiment.data}) {
      if (file) files.push_back(*file);
    }
  }
  for (const auto& file : {session.study.camera.sweep, session.study.camera.sweep_images}) {
    if (file) files.push_back(*file);
  }
  if (session.study.system_file) files.push_back(*session.study.system_file);
  auto out = session.inputs(session.study.text, files);
  out.erase("program");  // another build refits the rungs, it does not take them down
  return out;
}

/// Why discovery could not say beforehand what an effect would bring.
std::string not_predicted(const Effect& effect, const std::optional<Candidate>& from) {
  const auto& coefficients = effect.spec().coefficients;
  const bool strength = std::any_of(coefficients.begin(), coefficients.end(),
                                    [](const CoefficientSpec& c) { return c.kind == CoefficientKind::strength && !c.shared; });
  const std::string name = effect.spec().key;
  if (!strength) return "no drop is predicted for " + name + ": it has no coefficient that switches it off, so no score test exists";
  if (!from) return "no drop is predicted for " + name + ": it is driven by noise, or a more specific effect replaces it";
  return "no drop is predicted for " + name + ": " + (from->why.empty() ? "its score is 0" : from->why);
}

}  // namespace

Options options_for(const Options& options, const fs::path& study) {
  Options other = options;
  other.study = study.string();
  other.out.clear();
  return other;
}

std::optional<Ladder> known_ladder(const Session& session) {
  const auto& stages = session.folder.stages();
  const auto recorded = stages.find("ladder");
  if (recorded == stages.end() || recorded->second.inputs != inputs_of_ladder(session) || !session.folder.intact(ladder_name))
    return std::nullopt;
  return read_ladder(session.folder.file(ladder_name));
}

ModelLadder::ModelLadder(const Options& options, const Registry& registry)
    : options_(options), registry_(registry), root_(options, registry) {
  if (auto known = known_ladder(root_)) {
    ladder_ = std::move(*known);
  } else if (fs::exists(root_.folder.file(ladder_name))) {
    root_.say("the study, its data or " + root_.folder.file(ladder_name).string() +
              " have changed since the ladder was made: starting a new one");
  }
}

Session& ModelLadder::last() {
  if (ladder_.rungs.size() < 2) return root_;
  if (!last_) {
    const Rung& rung = ladder_.rungs.back();
    const fs::path study = root_.folder.file(rung.study);
    if (!fs::exists(study))
      throw RunError("rung " + std::to_string(rung.id) + " of the ladder is missing: " + study.string() + " — remove " +
                     root_.folder.file(ladder_name).string() + " to start a new one");
    root_.say(fmt::format("continuing from rung {} of the ladder, {}", rung.id, study.parent_path().lexically_normal().string()));
    last_ = std::make_unique<Session>(options_for(options_, study), registry_);
  }
  return *last_;
}

const Rung& ModelLadder::last_rung() {
  if (ladder_.rungs.empty()) {
    const auto work = fitted(root_);
    Rung first = rung_of(root_, *work);
    first.study = relative_study(root_);
    append(std::move(first));
  }
  return ladder_.rungs.back();
}

const Fit& ModelLadder::last_fit() { return filter_work(last())->fit; }

std::string ModelLadder::relative_study(const Session& session) const {
  const fs::path from = fs::absolute(root_.folder.path()).lexically_normal();
  return fs::absolute(session.study.file).lexically_normal().lexically_relative(from).generic_string();
}

void ModelLadder::append(Rung rung) {
  ladder_.rungs.push_back(std::move(rung));
  root_.redo_stage("ladder", inputs_of_ladder(root_), {ladder_name},
                   [&](const fs::path& dir) { write_ladder(dir / ladder_name, ladder_); });
  ladder_ = read_ladder(root_.folder.file(ladder_name));
}

const Rung& ModelLadder::add(const std::string& effect, const std::optional<Candidate>& from) {
  Session& parent_session = last();
  const int id = static_cast<int>(std::max<std::size_t>(ladder_.rungs.size(), 1));
  const bool system = effect.starts_with(system_prefix);
  const std::string name = system ? effect.substr(std::string(system_prefix).size()) : effect;
  const std::string place = fmt::format("rungs/{:02}_{}", id, file_name_for(name));
  const fs::path folder = root_.folder.file(place);
  std::vector<std::string> left_out;
  const std::string text =
      system ? study_with_system(parent_session, name, folder, left_out) : study_with_effect(parent_session, effect, from, folder);
  const Rung parent = last_rung();  // a study that no rung can be added to is refused by now: fit the parent
  const auto parent_work = fitted(parent_session);
  root_.do_stage("rung/" + std::to_string(id), {{"settings", hash_text(text)}}, {place + "/study.toml"}, [&](const fs::path& dir) {
    make_writable_folder(dir / place);
    write_atomically(dir / place / "study.toml", text);
  });
  auto child = std::make_unique<Session>(options_for(options_, folder / "study.toml"), registry_);
  child->parent = parent_session.folder.path();
  const auto work = fitted(*child);
  Rung rung = rung_of(*child, *work);
  rung.id = id;
  rung.parent = parent.id;
  rung.study = relative_study(*child);
  rung.added = effect;
  if (system) {
    append_note(rung.note, "a change of system has no drop: its channels and states are others; compare k-step errors and the force");
    for (const auto& left : left_out) append_note(rung.note, "effect '" + left + "' is left out: it does not suit " + name);
  } else {
    rung.parameters = new_parameters(*work, *parent_work);
    if (from && from->predicted_drop > 0.0) rung.predicted_drop = from->predicted_drop;
    if (!rung.predicted_drop) append_note(rung.note, not_predicted(registry_.effect(effect), from));
    if (same_channels(work->estimate->model, parent_work->estimate->model)) {
      const Gain gain = gain_of(*work, *parent_work, options_.threads);
      rung.actual_drop = gain.drop;
      rung.held_out_gain = gain.held_out;
    }
  }
  append(std::move(rung));
  last_ = std::move(child);
  return ladder_.rungs.back();
}

void report_ladder(ModelLadder& ladder) {
  Session& session = ladder.root();
  try {
    session.say("report: " + report_stage(session, fit_stage(session)).lexically_normal().string());
  } catch (const RunError& error) {
    session.say(std::string("no report: ") + error.what());  // the rung stands without it
  }
}

}  // namespace misfit
