#include "misfit/discover/refit_waves.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "misfit/core/error.h"
#include "misfit/core/lists.h"
#include "misfit/core/text.h"
#include "misfit/discover/candidate.h"
#include "misfit/discover/conditional.h"
#include "misfit/discover/free_run.h"
#include "misfit/discover/operating_range.h"
#include "misfit/discover/size_reading.h"
#include "misfit/discover/verdict.h"
#include "misfit/fit/filter/slow_force.h"
#include "misfit/fit/regression/lost_sign.h"
#include "misfit/math/statistics.h"
#include "misfit/model/whole_steps.h"

namespace misfit {

RefitWaves::RefitWaves(const SearchContext& context, const ScoreTest& score, const std::vector<CandidateModel>& models,
                       std::vector<RankedCandidate>& ranked, ProgressFn progress)
    : context_(context), score_(score), models_(models), ranked_(ranked), progress_(std::move(progress)) {}

/// An effect that promises so much may be worth `most_more` times as much. From far below their maximum lags and delays of inputs and
/// sensors promise little, and there they are alike: beside one of them 30 times. `most`: nullptr, where nothing is explained yet.
bool RefitWaves::may_explain_as(const RankedCandidate* most, const RankedCandidate& e, double promised, double most_more) {
  constexpr double of_lags = 30.0;
  if (most == nullptr) return promised > 0.0;
  const bool both_lag = most->screening->candidate_model->lags && e.screening->candidate_model->lags;
  return (both_lag ? of_lags : most_more) * promised > most->refit->drop;
}

std::optional<FilterEstimate> RefitWaves::higher() {
  std::vector<PredictedRefit> refits;
  for (RankedCandidate& e : ranked_) {
    if (!e.refit || !(e.refit->drop > tied_drops) || e.no_higher_at == e.refit->drop) continue;
    e.no_higher_at = e.refit->drop;
    refits.push_back({&*e.refit, e.candidate.predicted_drop});
  }
  return higher_without(work_from(context_.estimate, context_), refits);
}

void RefitWaves::refit_alone(const RankedCandidate& candidate) {
  const ScreeningResult* asked = candidate.screening;
  refit_wave({.begin = [&](const RankedCandidate& e) { return e.screening == asked ? asked : nullptr; }});
}

/// The largest predicted drop of those that may be significant; infinity: there is none.
double RefitWaves::best_predicted() const {
  double best = 0.0;
  for (const auto& e : ranked_) {
    if (may_be_significant(e, context_.options.p_accept)) best = std::max(best, e.candidate.predicted_drop);
  }
  return best > 0.0 ? best : std::numeric_limits<double>::infinity();
}
bool RefitWaves::significant(const RankedCandidate& e) const { return is_significant(e, context_.options.p_accept); }

namespace {

/// The widths over which corners of a sensor are rounded (ScanSpec::smooths) as narrow as the filter resolves there, and its noise hides.
void narrow_corners(ScreeningResult& screening, const FilterEstimate& there) {
  const CandidateModel& candidate_model = *screening.candidate_model;
  const BoundEffect& bound = candidate_model.model.effects.back();
  const OperatingRange resolved(there);
  for (std::size_t c = 0; c < bound.coefficients.size(); ++c) {
    const int shape = place_of(candidate_model.shapes, bound.coefficients[c].parameter);
    if (shape < 0 || !bound.effect->spec().coefficients[c].scan.smooths) continue;
    double& width = screening.cell[shape];
    width = std::min(width, std::max(resolved.lower_bound(bound, c), there.noise.channels[bound.ports.front()].white));
  }
}

/// With the other sign of an output throughout, which sizes do not tell from the one, but the model may.
std::vector<Signals> turned(std::vector<Signals> experiments, const std::string& output) {
  for (Signals& signals : experiments) {
    for (Signal& s : signals.measured) {
      for (double& value : s.values) value = s.name == output ? -value : value;
    }
  }
  return experiments;
}

/// The first, where the second is not clearly higher.
std::optional<FilterEstimate> higher_of(std::optional<FilterEstimate> first, std::optional<FilterEstimate> second) {
  constexpr double clearly = 1.0;  // of the log-likelihood
  const bool first_stays = first && (!second || second->objective < first->objective + clearly);
  return first_stays ? std::move(first) : std::move(second);
}

}  // namespace

void RefitWaves::refit_where_signs_are_lost() {
  std::vector<const ScreeningResult*> screened;
  for (const RankedCandidate& e : ranked_) screened.push_back(e.screening);
  for (const ScreeningResult* s : screened) {
    const std::optional<SizeReading> reading = reads_size_alone(*s->candidate_model);
    const auto record = reading ? with_signs(context_.experiments, reading->output) : std::nullopt;
    if (!record) continue;
    const std::vector<Signals> other_signs = turned(record->experiments, reading->output);
    const std::optional<FilterEstimate> rest = higher_of(fitted_to(record->experiments), fitted_to(other_signs));
    if (!rest) continue;
    ScreeningResult whole = *s;
    whole.result.amplitude = reading->strengths;
    narrow_corners(whole, *rest);
    refit_wave({.begin = [&](const RankedCandidate& e) { return e.screening == s ? &whole : nullptr; }, .name = "_signs", .rest = &*rest});
  }
}

bool RefitWaves::reads_coarse_steps(const RankedCandidate& e) const {
  if (step_of_measurements(e.screening->candidate_model->model.effects.back()) < 0) return false;
  const Model model = start_model(context_.estimate, *e.screening, context_.registry);
  return on_whole_steps(model, context_.experiments) && are_coarse_steps(model, context_.estimate);
}

bool RefitWaves::refit_where_steps_are_coarse() {
  refit_wave({.begin = [&](const RankedCandidate& e) { return reads_coarse_steps(e) ? e.screening : nullptr; }, .name = "_steps"});
  return std::any_of(ranked_.begin(), ranked_.end(), [&](const RankedCandidate& e) {
    return e.refit && e.refit->ok && e.refit->partial.empty() && significant(e) && reads_coarse_steps(e);
  });
}

/// The model without any effect fitted to other measurements, to which the estimate points; nullopt: it cannot be.
std::optional<FilterEstimate> RefitWaves::fitted_to(const std::vector<Signals>& experiments) const {
  const FilterEstimate& estimate = context_.estimate;
  FilterOptions options = options_like(estimate, context_.options.threads);
  options.verify = false;
  options.noise.reset();  // that of sizes is far off
  options.reference.reset();
  const FilterStart start{estimate.model, estimate.penalties};
  FilterStart freely = start;
  freely.freely = true;
  try {
    return estimate_filter({start, freely}, experiments, options);
  } catch (const RunError&) {
    return std::nullopt;
  }
}

void RefitWaves::refit_the_best() {
  const double half = 0.5 * best_predicted();
  refit_wave({.begin = [&](const RankedCandidate& e) {
    return may_be_significant(e, context_.options.p_accept) && e.candidate.predicted_drop >= half ? e.screening : nullptr;
  }});
}

void RefitWaves::refit_the_significant_beyond_a_step() {
  constexpr double most_more = 10.0;
  const RankedCandidate* first = with_largest_drop(ranked_, context_.options.p_accept);
  const auto begins = [&](const RankedCandidate& e) {
    return significant(e) && is_far_from_linear(e) && may_explain_as(first, e, e.candidate.predicted_drop, most_more);
  };
  refit_wave({.begin = [&](const RankedCandidate& e) { return begins(e) ? e.screening : nullptr; }, .name = "_shapes"});
}

void RefitWaves::refit_what_the_free_run_shows() {
  calm_ = free_run(context_.estimate, {context_.experiments, context_.options.threads});
  if (!calm_) return;
  calm_score_.emplace(*calm_);
  const ForceSensitivity force = sensitivity_of_forces_and_parameters(*calm_);
  calm_screening_ = screen({*calm_, *calm_score_, force, context_.options.threads}, models_);
  nominated_ = forces_shown_by(*calm_, calm_screening_);
  const auto known = std::find_if(nominated_.begin(), nominated_.end(), [this](const ScreeningResult* s) {
    return std::any_of(ranked_.begin(), ranked_.end(), [&](const RankedCandidate& e) {
      return e.screening->candidate_model == s->candidate_model && e.refit && significant(e);
    });
  });
  refit_nominated({nominated_.begin(), known}, "_free_run");
}

bool RefitWaves::refit_the_other_nominated() { return calm_ && refit_nominated(nominated_, "_free_run_others"); }

bool RefitWaves::refit_nominated(const std::vector<const ScreeningResult*>& nominated, const char* name) {
  const auto begin = [&](const RankedCandidate& e) -> const ScreeningResult* {
    const auto found = std::find_if(nominated.begin(), nominated.end(), [&](const auto* s) {
      return s->candidate_model == e.screening->candidate_model && !e.candidate.absorbed;
    });
    return found == nominated.end() ? nullptr : *found;
  };
  if (!refit_wave({.begin = begin, .name = name, .screened = &*calm_, .score = &*calm_score_})) return false;
  for (RankedCandidate& e : ranked_) {
    e.candidate.group.clear();
    if (begin(e) != nullptr && e.refit && !significant_in_screening(e)) require_of_free_run(e);
  }
  sort_by_evidence(ranked_);
  return true;
}

/// What the free run alone nominated must explain there what it promised: else its refit went elsewhere, and is not counted.
void RefitWaves::require_of_free_run(RankedCandidate& e) {
  const std::optional<FilterEstimate> after = free_run(e.refit->estimate, {context_.experiments, context_.options.threads});
  if (after && !is_explained(*calm_, *after))
    forget_refit(e, "its refit does not explain the free run");  // none: nothing is left to the random force
}

/// As it was screened.
void RefitWaves::forget_refit(RankedCandidate& e, const char* why) const {
  e.refit.reset();
  e.log_p = e.screening->log_p;
  e.candidate = named_candidate(*e.screening, context_.families);
  e.candidate.why = "not significant: family-wise " + p_equals(e.candidate.p_value) + "; " + why;
}

bool RefitWaves::significant_in_screening(const RankedCandidate& e) const {
  return sidak(e.screening->p_value, context_.families) < context_.options.p_accept;
}

bool RefitWaves::refit_the_other_significant_ones() {
  for (RankedCandidate& e : ranked_) e.candidate.group.clear();
  return refit_wave({.begin = [this](const RankedCandidate& e) { return significant(e) ? e.screening : nullptr; }, .name = "_others"});
}

void RefitWaves::refit_what_fell_short() {
  const RankedCandidate* most = with_largest_drop(ranked_, context_.options.p_accept);
  const auto fell_short = [&](const RankedCandidate& e) {
    if (!e.refit_begun || e.candidate.absorbed || !significant_in_screening(e)) return false;
    if (!may_explain_as(most, e, e.screening->result.chi2, 2.0)) return false;
    return e.refit ? e.refit->drop < least_of_score * e.screening->result.chi2 : !was_cut_off(e);
  };
  refit_again({.wanted = fell_short, .name = "_short"});
}

void RefitWaves::refit_beside_an_edge_not_visited() {
  std::vector<std::vector<std::string>> ports;
  for (const RankedCandidate& e : ranked_) {
    if (e.refit && edge_not_visited(e.refit->estimate)) ports.push_back(e.screening->candidate_model->port_names);
  }
  const auto begins = [&](const RankedCandidate& e) {
    return significant(e) && is_far_from_linear(e) &&
           std::find(ports.begin(), ports.end(), e.screening->candidate_model->port_names) != ports.end();
  };
  if (!ports.empty()) refit_wave({.begin = [&](const RankedCandidate& e) { return begins(e) ? e.screening : nullptr; }, .name = "_edges"});
}

void RefitWaves::refit_what_promises_little() {
  constexpr double most_more = 10.0;
  const double p_accept = context_.options.p_accept;
  const RankedCandidate* most = with_largest_drop(ranked_, p_accept);
  if (most == nullptr) return;
  const bool lags = most->screening->candidate_model->lags;
  const double least = most->refit->drop - (lags ? 2.0 : 1.0) * tied_drops;
  std::vector<const ScreeningResult*> insignificant;
  const auto begin = [&](const RankedCandidate& e) -> const ScreeningResult* {
    const bool both_lag = lags && e.screening->candidate_model->lags;
    const bool nearly = may_be_significant(e, p_accept) && is_far_from_linear(e);
    if (!(both_lag || nearly) || !may_explain_as(most, e, e.candidate.predicted_drop, most_more)) return nullptr;
    if (!significant(e)) insignificant.push_back(e.screening);
    return e.screening;
  };
  refit_wave({.begin = begin, .name = "_little"});
  for (RankedCandidate& e : ranked_) {
    if (e.refit && e.refit->drop < least && std::find(insignificant.begin(), insignificant.end(), e.screening) != insignificant.end())
      forget_refit(e, "its refit explains less than a significant one");
  }
  sort_by_evidence(ranked_);
}

bool RefitWaves::refit_what_a_slow_force_hides() {
  const double p_accept = context_.options.p_accept;
  if (warning_of_slow_force(context_.estimate).empty()) return false;
  const auto begin = [&](const RankedCandidate& e) { return e.screening->p_value < p_accept ? e.screening : nullptr; };
  return refit_wave({.begin = begin, .name = "_slow_force"});
}

bool RefitWaves::was_cut_off(const RankedCandidate& e) const {
  return std::find(unfinished_.begin(), unfinished_.end(), effect_at(e.candidate.effect, e.candidate.roles)) != unfinished_.end();
}

bool RefitWaves::went_elsewhere(const RankedCandidate& e) const {
  return e.refit_begun && !e.refit && !e.candidate.absorbed && !was_cut_off(e) && is_nominated(e);
}

bool RefitWaves::is_nominated(const RankedCandidate& e) const {
  return std::any_of(nominated_.begin(), nominated_.end(),
                     [&](const auto* s) { return s->candidate_model == e.screening->candidate_model; });
}

bool RefitWaves::refit_afresh() {
  const auto wanted = [this](const RankedCandidate& e) { return e.refit ? significant(e) : went_elsewhere(e); };
  if (!refit_again({.wanted = wanted, .as_refitted = true, .name = "_afresh"})) return false;
  for (RankedCandidate& e : ranked_) {
    if (e.refit && is_nominated(e) && !significant_in_screening(e)) require_of_free_run(e);
  }
  sort_by_evidence(ranked_);
  return true;
}

/// Of the first few that are wanted. False: none gains.
bool RefitWaves::refit_again(const Again& again) {
  constexpr std::size_t most = 3;
  std::vector<RankedCandidate*> chosen;
  std::vector<ScreeningResult> begin;
  for (auto& e : ranked_) {
    if (chosen.size() == most || !again.wanted(e)) continue;
    chosen.push_back(&e);
    begin.push_back(again.as_refitted && e.refit ? as_refitted(*e.screening, e.refit->estimate.model) : *e.screening);
  }
  if (chosen.empty()) return false;
  RefitWork work = work_from(context_.estimate, context_);
  work.afresh = true;
  std::vector<const ScreeningResult*> effects;
  for (const ScreeningResult& b : begin) effects.push_back(&b);
  std::vector<SteppedRefit> refits = refitted(work, score_, effects, again.name);
  bool gained = false;
  for (std::size_t k = 0; k < refits.size(); ++k) {
    Refit& refit = refits[k].refit;
    const double before = chosen[k]->refit ? chosen[k]->refit->drop : 0.0;
    if (!refit.ok || !(refit.drop > before + tied_drops)) continue;
    chosen[k]->refit = std::move(refit);
    chosen[k]->candidate.why.clear();
    store_refit(*chosen[k]);
    gained = true;
  }
  if (!gained) return false;
  for (RankedCandidate& e : ranked_) e.candidate.group.clear();
  sort_by_evidence(ranked_);
  return true;
}

/// `name`: of the stored jobs.
std::vector<SteppedRefit> RefitWaves::refitted(const RefitWork& work, const ScoreTest& score,
                                               const std::vector<const ScreeningResult*>& effects, const char* name) {
  std::optional<StoredJobs> stored = context_.options.refits;
  if (stored) stored->digest += name;
  auto refits = refit_all(work, score, effects, {stored, progress_, context_.options.stop});
  if (!refits) throw RunError("discover: stopped before all refits were done");
  return std::move(*refits);
}

/// False: no candidate is in it.
bool RefitWaves::refit_wave(const Wave& wave) {
  std::vector<RankedCandidate*> chosen;
  std::vector<const ScreeningResult*> effects;
  for (auto& e : ranked_) {
    if (std::ssize(chosen) >= context_.options.max_refits) break;
    const ScreeningResult* begin = e.refit_begun || !e.candidate.why.empty() ? nullptr : wave.begin(e);
    if (begin == nullptr) continue;
    e.refit_begun = true;
    chosen.push_back(&e);
    effects.push_back(begin);
  }
  if (chosen.empty()) return false;
  RefitWork work = work_from(context_.estimate, context_);
  work.screened = wave.screened;
  work.rest = wave.rest;
  std::vector<SteppedRefit> refits = refitted(work, wave.score == nullptr ? score_ : *wave.score, effects, wave.name);
  for (std::size_t k = 0; k < refits.size(); ++k) {
    if (wave.screened == nullptr) chosen[k]->candidate.predicted_drop = refits[k].predicted_drop;
    chosen[k]->refit = std::move(refits[k].refit);
    store_refit(*chosen[k]);
  }
  sort_by_evidence(ranked_);
  return true;
}

void RefitWaves::store_refit(RankedCandidate& e) {
  Candidate& c = e.candidate;
  if (!e.refit->ok) {
    c.why = e.refit->why;
    if (e.refit->out_of_time) unfinished_.push_back(effect_at(c.effect, c.roles));
    e.refit.reset();
    return;
  }
  describe_refit(e, context_.families);
}

}  // namespace misfit
