#include "apps/ladder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "misfit/core/error.h"
#include "misfit/core/file_name.h"
#include "misfit/core/files.h"
#include "misfit/data/curve_coefficient.h"
#include "misfit/fit/filter_error.h"
#include "misfit/fit/k_step.h"

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

void also(std::string& note, const std::string& words) {
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
std::vector<std::vector<Use>> common_use(const FilterEstimate& a, const FilterEstimate& b) {
  std::vector<std::vector<Use>> use;
  for (std::size_t e = 0; e < a.data.size(); ++e) {
    use.push_back(a.data[e].use);
    for (std::size_t i = 0; i < use.back().size(); ++i) {
      if (b.data[e].use[i] == Use::none) use.back()[i] = Use::none;
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
                                    [](const CoefficientSpec& c) { return c.kind == CoefficientKind::strength && !c.borrowed; });
  const std::string name = effect.spec().key;
  if (!strength) return "no drop is predicted for " + name + ": it has no strength that could be 0, it is in the model or not";
  if (!from) return "no drop is predicted for " + name + ": it is driven by noise, or another effect stands for it";
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

Climb::Climb(const Options& options, const Registry& registry) : options_(options), registry_(registry), original_(options, registry) {
  if (auto known = known_ladder(original_)) {
    ladder_ = std::move(*known);
  } else if (fs::exists(original_.folder.file(ladder_name))) {
    original_.say("the study, its data or " + original_.folder.file(ladder_name).string() +
                  " have changed since the ladder was climbed: it is begun anew");
  }
}

Session& Climb::top() {
  if (ladder_.rungs.size() < 2) return original_;
  if (!top_) {
    const Rung& last = ladder_.rungs.back();
    const fs::path study = original_.folder.file(last.study);
    if (!fs::exists(study))
      throw RunError("rung " + std::to_string(last.id) + " of the ladder is gone: " + study.string() + " — remove " +
                     original_.folder.file(ladder_name).string() + " to begin anew");
    original_.say(fmt::format("going on from rung {} of the ladder, {}", last.id, study.parent_path().lexically_normal().string()));
    top_ = std::make_unique<Session>(options_for(options_, study), registry_);
  }
  return *top_;
}

const Rung& Climb::top_rung() {
  if (ladder_.rungs.empty()) {
    const auto work = fitted(original_);
    Rung first = rung_of(original_, *work);
    first.study = relative_study(original_);
    append(std::move(first));
  }
  return ladder_.rungs.back();
}

const Fit& Climb::top_fit() { return filter_work(top())->fit; }

std::string Climb::relative_study(const Session& session) const {
  const fs::path from = fs::absolute(original_.folder.path()).lexically_normal();
  return fs::absolute(session.study.file).lexically_normal().lexically_relative(from).generic_string();
}

void Climb::append(Rung rung) {
  ladder_.rungs.push_back(std::move(rung));
  original_.redo_stage("ladder", inputs_of_ladder(original_), {ladder_name},
                       [&](const fs::path& dir) { write_ladder(dir / ladder_name, ladder_); });
  ladder_ = read_ladder(original_.folder.file(ladder_name));
}

const Rung& Climb::add(const std::string& effect, const std::optional<Candidate>& from) {
  Session& below = top();
  const int id = static_cast<int>(std::max<std::size_t>(ladder_.rungs.size(), 1));
  const bool system = effect.starts_with(system_prefix);
  const std::string name = system ? effect.substr(std::string(system_prefix).size()) : effect;
  const std::string place = fmt::format("rungs/{:02}_{}", id, file_name_for(name));
  const fs::path folder = original_.folder.file(place);
  std::vector<std::string> left_out;
  const std::string text = system ? study_with_system(below, name, folder, left_out) : study_with_effect(below, effect, from, folder);
  const Rung parent = top_rung();  // a study that cannot be climbed is refused by now: fit what is below
  const auto below_work = fitted(below);
  original_.do_stage("rung/" + std::to_string(id), {{"settings", hash_text(text)}}, {place + "/study.toml"}, [&](const fs::path& dir) {
    make_writable_folder(dir / place);
    write_atomically(dir / place / "study.toml", text);
  });
  auto above = std::make_unique<Session>(options_for(options_, folder / "study.toml"), registry_);
  above->below = below.folder.path();
  const auto work = fitted(*above);
  Rung rung = rung_of(*above, *work);
  rung.id = id;
  rung.parent = parent.id;
  rung.study = relative_study(*above);
  rung.added = effect;
  if (system) {
    also(rung.note, "a change of system has no drop: its channels and states are others; compare k-step errors and the force");
    for (const auto& left : left_out) also(rung.note, "effect '" + left + "' is left out: it does not suit " + name);
  } else {
    rung.parameters = new_parameters(*work, *below_work);
    if (from && from->predicted_drop > 0.0) rung.predicted_drop = from->predicted_drop;
    if (!rung.predicted_drop) also(rung.note, not_predicted(registry_.effect(effect), from));
    if (same_channels(work->estimate->model, below_work->estimate->model)) {
      const Gain gain = gain_of(*work, *below_work, options_.threads);
      rung.actual_drop = gain.drop;
      rung.held_out_gain = gain.held_out;
    }
  }
  append(std::move(rung));
  top_ = std::move(above);
  return ladder_.rungs.back();
}

void report_ladder(Climb& climb) {
  Session& session = climb.original();
  try {
    session.say("report: " + report_stage(session, fit_stage(session)).lexically_normal().string());
  } catch (const RunError& error) {
    session.say(std::string("no report: ") + error.what());  // the rung stands without it
  }
}

}  // namespace misfit
