#include "misfit/workflow/ladder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "misfit/core/config.h"
#include "misfit/core/display.h"
#include "misfit/core/error.h"
#include "misfit/core/file_name.h"
#include "misfit/core/files.h"
#include "misfit/core/shown.h"
#include "misfit/core/text.h"
#include "misfit/data/contained_fit.h"
#include "misfit/data/curve_coefficient.h"
#include "misfit/data/estimators.h"
#include "misfit/fit/filter/contained_start.h"
#include "misfit/fit/filter/filter_error.h"
#include "misfit/fit/filter/k_step.h"
#include "misfit/fit/filter/likelihood_drop.h"
#include "misfit/fit/filter/predictive_loglik.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

constexpr const char* ladder_name = "ladder.json";
const char* const method = random_force_estimator().name;
constexpr std::string_view system_prefix = "system:";

/// filter_error's fit and estimate; RunError with its message if it declined.
std::shared_ptr<const FilterWork> fitted(Session& session) {
  if (filter_declined(session)) refuse_declined(session);
  return filter_work(session);
}

void append_note(std::string& note, const std::string& words) {
  if (!words.empty()) note += (note.empty() ? "" : "; ") + words;
}

/// The fit's results, without the parent and the added effect.
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
  if (!rung.validation_rms.empty()) rung.validation_k_step = k_step_errors(*work.estimate, ComparedSamples::held_out).rms;
  rung.trim = work.fit.trim;
  rung.doubts = work.fit.doubts;
  rung.estimates.emplace();
  for (const auto& [name, estimate] : work.fit.parameters) {
    if (!is_curve_coefficient(name)) rung.estimates->emplace(name, estimate);
  }
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

/// Measurements that both models use and neither has rejected: an effect may read inputs with gaps that the other model does not read.
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

/// Of each experiment the steps of the one that needs more: an effect that follows fast is integrated wrongly in those of a model without
/// it.
std::vector<IntegrationPlan> finer_plans(const FilterEstimate& a, const FilterEstimate& b) {
  std::vector<IntegrationPlan> out = plans_of(a);
  const std::vector<IntegrationPlan> other = plans_of(b);
  for (std::size_t e = 0; e < out.size(); ++e) {
    if (other[e].parts.size() > out[e].parts.size()) out[e] = other[e];
  }
  return out;
}

struct Gain {
  double drop = 0.0;
  std::optional<double> held_out;
};

/// likelihood_drop() on the same measurements and with the same weights of roughness, each at its own maximum, priors
/// counted. The child's is looked for from its fit and from the parent's with what is new off, so that it is never below that. The held-out
/// gain, where the study holds something out, is defined as in discovery: predictive, with the parameters uncertain.
Gain gain_of(const FilterWork& child, const FilterWork& parent, int threads) {
  FilterOptions options;
  options.threads = threads;
  options.reference = parent.estimate->reference;
  options.choose_roughness = false;
  options.use = common_use(*parent.estimate, *child.estimate);
  const FilterStart parents{parent.estimate->model, parent.estimate->penalties, parent.estimate->noise};
  const FilterEstimate without = estimate_filter({parents}, parent.prepared.experiments, options);
  // The parent's weights for the curves that both have: the same prior on both sides of the drop.
  const std::vector<Penalty> penalties = with_weights_of(*parent.estimate, child.estimate->model, child.estimate->penalties);
  std::vector<FilterStart> starts = {{child.estimate->model, penalties, child.estimate->noise}};
  const std::vector<FilterStart> off = starts_from(contained_fit(without), child.prepared.model);
  if (!off.empty()) starts.push_back({off.front().model, penalties, off.front().noise});
  options.plans = finer_plans(without, *child.estimate);
  const FilterEstimate with = estimate_filter(starts, child.prepared.experiments, options);
  if (without.out_of_time || with.out_of_time) throw TimeLimitReached(Watch::current()->words());
  Gain gain{likelihood_drop(with, without), std::nullopt};
  if (parent.fit.validation_loglik) gain.held_out = predictive_loglik(with) - predictive_loglik(without, steps_of_one_alone(with, without));
  return gain;
}

/// What the child's model brings.
void compare_with_parent(const FilterWork& child, const FilterWork& parent, int threads, Rung& rung) {
  rung.parameters = new_parameters(child, parent);
  rung.new_parameters = static_cast<int>(std::count_if(child.fit.names.begin(), child.fit.names.end(), [&](const std::string& name) {
    return std::find(parent.fit.names.begin(), parent.fit.names.end(), name) == parent.fit.names.end();
  }));
  if (!same_channels(child.estimate->model, parent.estimate->model)) return;
  try {
    const Gain gain = gain_of(child, parent, threads);
    rung.actual_drop = gain.drop;
    rung.held_out_gain = gain.held_out;
  } catch (const TimeLimitReached& spent) {
    append_note(rung.note, std::string("no actual drop: ") + spent.what());
  } catch (const RunError& error) {  // the rung's own fit is valid without the comparison
    append_note(rung.note, std::string("no actual drop: ") + error.what());
  }
}

/// What the effect's file keeps fixed and no search looks for: discovery has not found it.
bool is_as_declared(const EffectSpec& effect, const std::string& name, double value) {
  return std::any_of(effect.coefficients.begin(), effect.coefficients.end(), [&](const CoefficientSpec& c) {
    const bool same = name == c.name || name.ends_with("." + std::string(c.name));
    return same && c.fixed && !c.scan.is_scanned() && value == c.value;
  });
}

/// "width is fixed at 0.5 rad/s": values that discovery found and the study of the rung fixes; they stand in no table of estimates.
std::string not_estimated_in_words(const Candidate& from, const EffectSpec& effect, const Fit& fit) {
  std::vector<std::string> out;
  for (const auto& [name, e] : from.parameters) {
    if (is_as_declared(effect, name, e.value)) continue;
    const bool estimated = std::any_of(fit.parameters.begin(), fit.parameters.end(), [&, own = name](const auto& p) {
      const std::string known = p.first.substr(0, p.first.find('['));  // of a curve, whose coefficients are estimated
      return known == own || known.ends_with("." + own);
    });
    if (!estimated) out.push_back(name + " is fixed at " + in_display_unit(e.value, e.unit));
  }
  return join_words(out);
}

/// "c is fixed at 0.5 1/s: the curve takes over what it does".
std::string taken_over_in_words(const std::map<std::string, Estimate>& held) {
  std::string out;
  for (const auto& [name, e] : held)
    out += (out.empty() ? "" : "; ") + name + " is fixed at " + in_display_unit(e.value, e.unit) + ": the curve takes over what it does";
  return out;
}

StageInputs inputs_of_ladder(const Session& session) {
  Study study = session.study;
  study.reference.clear();  // no rung depends on them
  const std::vector<fs::path> named = files_of_study(study);
  std::set<fs::path> files(named.begin(), named.end());  // many pictures of a sweep are in one video
  files.erase(study.file);
  auto out = session.inputs(config::content_of(study.text), {files.begin(), files.end()});
  out.erase("program");  // a new build refits the rungs; it does not start a new ladder
  return out;
}

ContainedFit begin_with(const FilterWork& parent, const std::optional<Candidate>& from) {
  ContainedFit out = contained_fit(*parent.estimate);
  if (!from) return out;
  out.refit_values = from->refit_values;
  out.refit_log_noise = from->refit_log_noise;
  return out;
}

/// Why discovery could not say beforehand what an effect would bring.
std::string not_predicted(const Effect& effect, const std::optional<Candidate>& from) {
  const auto& coefficients = effect.spec().coefficients;
  const bool strength = std::any_of(coefficients.begin(), coefficients.end(),
                                    [](const CoefficientSpec& c) { return c.kind == CoefficientKind::strength && !c.shared; });
  const std::string name = effect.spec().key;
  if (!strength) return "no drop is predicted for " + name + ": it has no coefficient that switches it off, so no score test exists";
  if (!from)
    return "no drop is predicted for " + name +
           ": it is driven by noise, a more specific effect replaces it, or it is no candidate at that place";
  return "no drop is predicted for " + name + ": " + (from->why.empty() ? "its score is 0" : from->why);
}

}  // namespace

SessionOptions options_for(const SessionOptions& options, const fs::path& study) {
  SessionOptions other = options;
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

ModelLadder::ModelLadder(const SessionOptions& options, const Registry& registry)
    : options_(options), registry_(registry), root_(options, registry) {
  if (auto known = known_ladder(root_)) {
    ladder_ = std::move(*known);
  } else if (fs::exists(root_.folder.file(ladder_name))) {
    root_.note("the study, its data or " + root_.folder.file(ladder_name).string() +
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
    root_.note(fmt::format("continuing from rung {} of the ladder, {}", rung.id, study.parent_path().lexically_normal().string()));
    last_ = std::make_unique<Session>(options_for(options_, study), registry_);
    if (limits_fits_) last_->usual_limit = usual_limit(options_, seconds_of_fit(ladder_.rungs[ladder_.rungs.size() - 2]));
  }
  return *last_;
}

double ModelLadder::seconds_of_fit(const Rung& rung) const {
  const fs::path results = rung.parent < 0 ? root_.folder.path() : root_.folder.file(rung.study).parent_path() / "out";
  const fs::path fit = results / "fit" / method;
  return fs::exists(fit / "fit.json") ? read_fit(fit).seconds : 0.0;
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

void ModelLadder::gained_too_little(const std::string& effect, const std::string& why) {
  if (ladder_.rungs.empty()) return;
  std::optional<std::vector<std::string>>& known = ladder_.rungs.back().gained_too_little;
  if (!known) known.emplace();
  known->push_back(effect);
  std::optional<std::map<std::string, std::string>>& reasons = ladder_.rungs.back().why_too_little;
  if (!reasons) reasons.emplace();
  (*reasons)[effect] = why;
  store();
}

void ModelLadder::append(Rung rung) {
  ladder_.rungs.push_back(std::move(rung));
  store();
}

void ModelLadder::store() {
  root_.redo_stage("ladder", inputs_of_ladder(root_), {ladder_name},
                   [&](const fs::path& dir) { write_ladder(dir / ladder_name, ladder_); });
  ladder_ = read_ladder(root_.folder.file(ladder_name));
}

ModelLadder::NewStudy ModelLadder::new_study(const std::string& effect, const std::optional<Candidate>& from) {
  NewStudy out;
  out.id = ladder_.rungs.empty() ? 1 : ladder_.rungs.back().id + 1;
  out.system = effect.starts_with(system_prefix);
  out.name = out.system ? effect.substr(system_prefix.size()) : effect;
  out.from = from;
  out.place = fmt::format("rungs/{:02}_{}", out.id, file_name_for(out.name));
  const fs::path folder = root_.folder.file(out.place);
  out.text = out.system ? study_with_system(last(), out.name, folder, out.left_out) : study_with_effect(last(), effect, from, folder);
  return out;
}

std::unique_ptr<Session> ModelLadder::open(const NewStudy& study, const Session& parent, const FilterWork& parent_work) {
  std::vector<std::string> files = {study.place + "/study.toml"};
  if (!study.system) files.push_back(study.place + "/" + kContainedFitFile);
  StageInputs inputs = {{"settings", hash_text(study.text)}};
  root_.redo_stage("rung/" + std::to_string(study.id), inputs, files, [&](const fs::path& dir) {
    make_writable_folder(dir / study.place);
    write_atomically(dir / files.front(), study.text);
    if (!study.system) write_contained_fit(dir / files.back(), begin_with(parent_work, study.from));
  });
  auto child = std::make_unique<Session>(options_for(options_, root_.folder.file(study.place) / "study.toml"), registry_);
  child->parent = parent.folder.path();
  if (limits_fits_) child->usual_limit = usual_limit(options_, parent_work.fit.seconds);
  return child;
}

const Rung& ModelLadder::add(const std::string& effect, const std::optional<Candidate>& from) {
  Session& parent_session = last();
  const NewStudy study = new_study(effect, from);
  const Rung parent = last_rung();  // new_study() has refused what cannot be added: only now is the parent fitted
  const auto parent_work = fitted(parent_session);
  auto child = open(study, parent_session, *parent_work);
  const auto work = fitted(*child);
  Rung rung = rung_of(*child, *work);
  rung.id = study.id;
  rung.parent = parent.id;
  rung.study = relative_study(*child);
  rung.added = effect;
  if (study.system) {
    append_note(
        rung.note,
        "no likelihood compares two systems: their channels and states differ; compare the errors some samples ahead and the random force");
    for (const auto& left : study.left_out) append_note(rung.note, "effect '" + left + "' is left out: it does not suit " + study.name);
  } else {
    if (from && from->predicted_drop > 0.0) rung.predicted_drop = from->predicted_drop;
    if (!rung.predicted_drop) append_note(rung.note, not_predicted(registry_.effect(effect), from));
    if (from) append_note(rung.note, taken_over_in_words(from->fixed_in_model));
    if (from) describe_added(*from, rung);
    if (const std::string kept = from ? not_estimated_in_words(*from, registry_.effect(effect).spec(), work->fit) : ""; !kept.empty()) {
      rung.kept = kept;
      append_note(rung.note, kept);
    }
    const Watch watch("the comparison with rung " + std::to_string(parent.id), child->fit_limit(), options_.listener.progress_of("add"));
    compare_with_parent(*work, *parent_work, options_.threads, rung);
    if (from && !rung.validation_loglik) rung.gain_of_search = from->held_out_gain;
  }
  append(std::move(rung));
  last_ = std::move(child);
  return ladder_.rungs.back();
}

std::vector<fs::path> ModelLadder::remove(const std::string& asked) {
  if (ladder_.rungs.size() < 2) throw InputError("rung " + shown(asked) + ": nothing has been added to this study");
  if (asked == std::to_string(ladder_.rungs.front().id)) throw InputError("rung " + shown(asked) + " is the study's own model: it stays");
  const std::span<const Rung> added = std::span<const Rung>(ladder_.rungs).subspan(1);
  const std::size_t first = 1 + (&find_rung(added, asked, "rung ") - added.data());
  last_.reset();
  std::vector<fs::path> kept;
  for (; ladder_.rungs.size() > first; store()) {  // from the last on, so that an end on the way leaves a ladder that can be gone on with
    if (auto folder = kept_aside(ladder_.rungs.back())) kept.insert(kept.begin(), std::move(*folder));
    ladder_.rungs.pop_back();
  }
  return kept;
}

std::optional<fs::path> ModelLadder::kept_aside(const Rung& rung) const {
  const fs::path folder = root_.folder.file(rung.study).parent_path().lexically_normal();
  if (!rung.study.starts_with("rungs/") || !fs::exists(folder)) return std::nullopt;
  fs::path to = folder.parent_path() / ("removed_" + folder.filename().string());
  for (int again = 2; fs::exists(to); ++again) to = folder.parent_path() / fmt::format("removed_{}_{}", folder.filename().string(), again);
  std::error_code error;
  fs::rename(folder, to, error);
  if (error) throw WriteError(folder.string() + ": cannot be renamed to " + to.filename().string() + ": " + error.message());
  return to;
}

void diagnose_rungs(ModelLadder& ladder) {
  std::ignore = diagnose_stage(ladder.root());
  if (ladder.ladder().rungs.size() > 1) std::ignore = diagnose_stage(ladder.last());
}

std::filesystem::path write_report(ModelLadder& ladder) {
  diagnose_rungs(ladder);
  return report_stage(ladder.root(), fit_stage(ladder.root()));
}

void report_ladder(ModelLadder& ladder) {
  Session& session = ladder.root();
  try {
    session.note("report: " + write_report(ladder).lexically_normal().string());
  } catch (const RunError& error) {
    session.note(std::string("no report: ") + error.what());  // the rung is valid without a report
  }
}

const Rung& find_rung(std::span<const Rung> rungs, const std::string& number_or_effect, const std::string& asked_by) {
  std::vector<std::string> names;
  for (const Rung& rung : rungs) {
    if (number_or_effect == std::to_string(rung.id) || (!rung.added.empty() && number_or_effect == rung.added)) return rung;
    names.push_back(std::to_string(rung.id));
    if (!rung.added.empty()) names.push_back(rung.added);
  }
  throw InputError(asked_by + shown(number_or_effect) + ": the ladder has no such rung" + suggest(number_or_effect, names));
}

std::optional<Candidate> prediction_for(ModelLadder& ladder, const std::string& effect, const AskedPlace& place) {
  if (effect.starts_with(system_prefix)) {
    if (!place.any()) throw InputError("--at: a change of system has no place");
    return std::nullopt;
  }
  Session& session = ladder.last();
  std::ignore = session.registry.effect(effect);  // InputError with the nearest name
  if (!place.any()) {
    auto there = predict_effect(session, effect, place);
    if (!there && !place.roles.empty()) {
      throw InputError(
          "--at: " + effect +
          ": discovery lists no place of it that is free; a line of the study may put it anywhere (misfit help study: [effects])");
    }
    return there;
  }
  try {
    std::ignore = study_with_effect(session, effect, std::nullopt, session.folder.path());  // refuses what cannot be added
  } catch (const InputError&) {
    // Not where it would go by default, or it is there already: discovery may know another place.
    auto elsewhere = predict_effect(session, effect);
    if (!elsewhere || elsewhere->roles.empty()) throw;
    return elsewhere;
  }
  return predict_effect(session, effect);
}

}  // namespace misfit
