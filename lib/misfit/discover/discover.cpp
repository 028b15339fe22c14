#include "misfit/discover/discover.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "misfit/core/error.h"
#include "misfit/core/stopwatch.h"
#include "misfit/core/text.h"
#include "misfit/core/units.h"
#include "misfit/core/watch.h"
#include "misfit/diagnose/distinct_ports.h"
#include "misfit/discover/accept.h"
#include "misfit/discover/added_force.h"
#include "misfit/discover/candidate.h"
#include "misfit/discover/conditional.h"
#include "misfit/discover/fixed_parameters.h"
#include "misfit/discover/free_run.h"
#include "misfit/discover/lack_of_fit.h"
#include "misfit/discover/refit_jobs.h"
#include "misfit/discover/unfinished.h"
#include "misfit/discover/unknown_curves.h"
#include "misfit/discover/unknown_form.h"
#include "misfit/discover/verdict.h"
#include "misfit/jobs/ranks.h"
#include "misfit/math/statistics.h"

namespace misfit {
namespace {

class Search {
 public:
  Search(const FittedStudy& fitted, const DiscoverOptions& options)
      : estimate_(fitted.estimate),
        experiments_(fitted.experiments),
        registry_(fitted.registry),
        options_(options),
        candidates_(list_candidates(fitted.estimate, fitted.request, fitted.registry, options.calibration)),
        score_(fitted.estimate),
        force_(sensitivity_of_forces_and_parameters(fitted.estimate)) {}

  Discovery run() {
    std::optional<Unexplained> unexplained;
    std::string spent;
    try {
      leave_out(twins(), candidates_.models);
      screen_all();
      refit_the_best();
      if (find_higher()) return {};
      refit_the_significant_beyond_a_step();
      refit_what_the_free_run_shows();
      refit_what_fell_short();
      if (find_higher() || (options_.refits && !ranks().first())) return {};
      unexplained = what_is_accepted();
      if (none_accepted() && refit_the_other_nominated()) unexplained = what_is_accepted();
      const bool more_to_try = !is_of_unknown_form(ranked_, unknown_, context());
      if (more_to_try && none_accepted() && refit_the_other_significant_ones()) unexplained = what_is_accepted();
      if (more_to_try && none_accepted() && refit_afresh()) unexplained = what_is_accepted();
      if (none_accepted()) unexplained = or_what_is_narrow(std::move(unexplained));
      test_fixed_parameters();
    } catch (const TimeLimitReached& limit) {
      spent = limit.what();
    }
    const SuspendedTimeLimit writing_up;
    for (auto& e : ranked_) {
      if (!spent.empty() && e.refit && e.candidate.why.empty()) e.candidate.why = "not judged: " + spent;
    }
    list_unknown();
    describe_search(unexplained);
    say_unfinished(unfinished_, out_);
    if (!spent.empty()) say_cut_off(spent, !ranked_.empty(), out_);
    return std::move(out_);
  }

  /// Where the model without any effect comes higher than the estimate that the search was made at, as its refits show: run() ended there,
  /// and the search is to be made again. nullptr: it does not.
  const FilterEstimate* higher() const { return higher_ ? &*higher_ : nullptr; }
  /// The estimate is the higher one of another search.
  void do_not_look_for_higher() { higher_is_looked_for_ = false; }

  /// Only the effect of the options, with the drop of one step, as a candidate among all families.
  Discovery predict() {
    const std::vector<bool> twin = twins();
    families_ = static_cast<double>(std::count(twin.begin(), twin.end(), false)) + static_cast<double>(count_of_unknown_curves(scores()));
    if (const Effect& asked = registry_.effect(options_.only); asked.spec().has_unknown_form()) {
      out_.candidates = candidates_of_unknown_form(scores(), asked, families_);
      return std::move(out_);
    }
    std::erase_if(candidates_.models, [&](const CandidateModel& s) { return s.effect != options_.only; });
    std::erase_if(candidates_.not_tried, [&](const NotTried& n) { return n.place.effect != options_.only; });
    out_.not_tried = candidates_.not_tried;
    screening_ = screen(scores(), candidates_.models, part(0.0, 1.0));
    rank();
    refit_the_best_asked_for();
    for (auto& e : ranked_) {
      if (!e.refit_begun && e.screening->runs && !e.candidate.absorbed)
        e.candidate.predicted_drop = one_step(refit_work(), score_, *e.screening).drop;
      out_.candidates.push_back(e.candidate);
    }
    return std::move(out_);
  }

 private:
  /// Approximate shares of a search's time, measured on 79 s of flight.
  static constexpr double end_of_screen = 0.45, end_of_curves = 0.5, end_of_refits = 0.9;

  void refit_the_best_asked_for() {
    const auto wanted = [&](const RankedCandidate& e) { return options_.refit_best_of && options_.refit_best_of(e.candidate); };
    const auto best = std::find_if(ranked_.begin(), ranked_.end(), wanted);
    if (best == ranked_.end() || !may_be_significant(*best)) return;
    const ScreeningResult* asked = best->screening;
    refit_wave({.begin = [&](const RankedCandidate& e) { return e.screening == asked ? asked : nullptr; }});
    std::stable_partition(ranked_.begin(), ranked_.end(), [](const RankedCandidate& e) { return e.refit_begun; });
  }

  std::vector<bool> twins() const { return twins_among(candidates_.models, sought_at(estimate_.model.system->spec(), force_)); }

  /// Progress of a part of the search that goes from one share of the whole to another.
  ProgressFn part(double from, double to) const {
    if (!options_.progress) return {};
    return [this, from, to](std::size_t done, std::size_t total) {
      constexpr std::size_t progress_steps = 1000;
      const double share = from + (to - from) * static_cast<double>(done) / static_cast<double>(std::max<std::size_t>(total, 1));
      options_.progress(static_cast<std::size_t>(progress_steps * share), progress_steps);
    };
  }

  ScoreWork scores() const {
    return {.estimate = estimate_,
            .score = score_,
            .force = force_,
            .threads = options_.threads,
            .calibrated = options_.calibration != nullptr};
  }
  SearchContext context() const { return {estimate_, registry_, experiments_, options_, families_}; }
  RefitWork refit_work() const { return work_from(estimate_, context()); }

  /// Every rank comes to the refits, which are shared: none is stopped before.
  void screen_all() {
    std::optional<SuspendedTimeLimit> all_ranks;
    if (ranks_started() > 1) all_ranks.emplace();
    screening_ = screen(scores(), candidates_.models, part(0.0, end_of_screen));
    unknown_ = unknown_curves(scores(), part(end_of_screen, end_of_curves));
    narrow_ = narrow_curves(scores());
    families_ = static_cast<double>(screening_.size() + unknown_.size());
    rank();
  }

  void rank() {
    for (const auto& s : screening_) ranked_.push_back(ranked_as_screened(s, families_));
    sort_by_evidence(ranked_);
  }

  /// The largest predicted drop of those that may be significant; infinity: there is none.
  double best_predicted() const {
    double best = 0.0;
    for (const auto& e : ranked_) {
      if (may_be_significant(e)) best = std::max(best, e.candidate.predicted_drop);
    }
    return best > 0.0 ? best : std::numeric_limits<double>::infinity();
  }
  bool may_be_significant(const RankedCandidate& e) const { return !e.candidate.absorbed && e.candidate.p_value < 5.0 * options_.p_accept; }
  bool significant(const RankedCandidate& e) const { return !e.candidate.absorbed && e.candidate.p_value < options_.p_accept; }
  bool none_accepted() const {
    return std::none_of(ranked_.begin(), ranked_.end(), [](const RankedCandidate& e) { return e.candidate.accepted; });
  }

  /// Some refits, begun together.
  struct Wave {
    std::function<const ScreeningResult*(const RankedCandidate&)> begin;  ///< where a candidate's refit begins; nullptr: it is not in it
    const char* name = "";                                                ///< of its stored jobs
    const FilterEstimate* screened = nullptr;                             ///< RefitWork::screened
    const ScoreTest* score = nullptr;                                     ///< nullptr: the estimate's
  };

  /// Those with a predicted drop above half of the best; under mpirun, where no rank knows what another accepts, all that are significant.
  void refit_the_best() {
    const double half = 0.5 * best_predicted();
    const bool all = ranks().size() > 1;
    refit_wave({.begin = [&](const RankedCandidate& e) {
      return (may_be_significant(e) && e.candidate.predicted_drop >= half) || (all && significant(e)) ? e.screening : nullptr;
    }});
  }

  /// One step of a time constant, a threshold or a width tells little of what it explains at its maximum, nor one of a sign that a sensor
  /// loses, or not: a tenth of what another one explains, there.
  void refit_the_significant_beyond_a_step() {
    constexpr double most_more = 10.0;
    const RankedCandidate* first = ranks().size() > 1 ? nullptr : with_largest_drop(ranked_, options_.p_accept);
    const auto begins = [&, most = effect_and_drop(first)](const RankedCandidate& e) {
      return significant(e) && is_far_from_linear(e) && may_explain_as(most, e, e.candidate.predicted_drop, most_more);
    };
    refit_wave({.begin = [&](const RankedCandidate& e) { return begins(e) ? e.screening : nullptr; }, .name = "_shapes"});
  }

  /// What explains most so far; nothing does: drop 0.
  struct Explained {
    double drop = 0.0;
    bool lags = false;
  };
  static Explained effect_and_drop(const RankedCandidate* e) {
    return e == nullptr ? Explained{} : Explained{e->refit->drop, e->screening->candidate_model->lags};
  }
  /// An effect that promises so much may be worth `most_more` times as much. From far below their maximum lags and delays of inputs and
  /// sensors promise little, and there they are alike: beside one of them 30 times.
  static bool may_explain_as(const Explained& most, const RankedCandidate& e, double promised, double most_more) {
    constexpr double of_lags = 30.0;
    return (most.lags && e.screening->candidate_model->lags ? of_lags : most_more) * promised > most.drop;
  }

  /// The forces that explain most of the free run, each at least a fifth of it, begun from there: down to the first that one step ahead has
  /// found already (under mpirun all of them, as in refit_the_best()).
  void refit_what_the_free_run_shows() {
    calm_ = free_run(estimate_, {experiments_, options_.threads});
    if (!calm_) return;
    calm_score_.emplace(*calm_);
    const ForceSensitivity force = sensitivity_of_forces_and_parameters(*calm_);
    calm_screening_ = screen({*calm_, *calm_score_, force, options_.threads}, candidates_.models);
    nominated_ = forces_shown_by(*calm_, calm_screening_);
    const auto known = std::find_if(nominated_.begin(), nominated_.end(), [this](const ScreeningResult* s) {
      return std::any_of(ranked_.begin(), ranked_.end(), [&](const RankedCandidate& e) {
        return e.screening->candidate_model == s->candidate_model && e.refit && significant(e);
      });
    });
    refit_nominated({nominated_.begin(), ranks().size() > 1 ? nominated_.end() : known}, "_free_run");
  }

  /// False: there is none.
  bool refit_the_other_nominated() {
    if (!calm_ || ranks().size() > 1) return false;
    return refit_nominated(nominated_, "_free_run_others");
  }

  bool refit_nominated(const std::vector<const ScreeningResult*>& nominated, const char* name) {
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
  void require_of_free_run(RankedCandidate& e) {
    const std::optional<FilterEstimate> after = free_run(e.refit->estimate, {experiments_, options_.threads});
    if (!after || is_explained(*calm_, *after)) return;  // none: nothing is left to the random force
    e.refit.reset();
    e.log_p = e.screening->log_p;
    e.candidate = named_candidate(*e.screening, families_);
    e.candidate.why = "not significant: family-wise " + p_equals(e.candidate.p_value) + "; its refit does not explain the free run";
  }
  bool significant_in_screening(const RankedCandidate& e) const { return sidak(e.screening->p_value, families_) < options_.p_accept; }

  /// False: there is none.
  bool refit_the_other_significant_ones() {
    if (ranks().size() > 1) return false;  // refitted with the first
    for (RankedCandidate& e : ranked_) e.candidate.group.clear();
    return refit_wave({.begin = [this](const RankedCandidate& e) { return significant(e) ? e.screening : nullptr; }, .name = "_others"});
  }

  /// Some refits once more, from the study's own values of all else.
  struct Again {
    std::function<bool(const RankedCandidate&)> wanted;
    bool as_refitted = false;  ///< the effect begins as it was refitted; else as it was screened
    const char* name = "";     ///< of the stored jobs
  };

  /// A refit that ends far below what the score promised, or nowhere, has failed: that is no evidence against its effect. What else is
  /// free in the estimate may be where it is to make up for the missing effect. Not of those that promise less than half of what another
  /// one explains, past which they would not be chosen.
  void refit_what_fell_short() {
    const Explained most = effect_and_drop(with_largest_drop(ranked_, options_.p_accept));
    const auto fell_short = [&](const RankedCandidate& e) {
      if (!e.refit_begun || e.candidate.absorbed || !significant_in_screening(e)) return false;
      if (!may_explain_as(most, e, e.screening->result.chi2, 2.0)) return false;
      return e.refit ? e.refit->drop < least_of_score * e.screening->result.chi2 : !was_cut_off(e);
    };
    refit_again({.wanted = fell_short, .name = "_short"});
  }
  bool was_cut_off(const RankedCandidate& e) const {
    return std::find(unfinished_.begin(), unfinished_.end(), effect_at(e.candidate.effect, e.candidate.roles)) != unfinished_.end();
  }

  /// As higher() says: from the refits from which it was not looked for yet.
  bool find_higher() {
    if (!higher_is_looked_for_ || ranks().size() > 1) return false;
    std::vector<const Refit*> refits;
    for (RankedCandidate& e : ranked_) {
      if (!e.refit || !(e.refit->drop > tied_drops) || e.no_higher_at == e.refit->drop) continue;
      e.no_higher_at = e.refit->drop;
      refits.push_back(&*e.refit);
    }
    higher_ = higher_without(refit_work(), refits);
    return higher_.has_value();
  }

  /// The first few significant ones: none could be accepted as it is. False: none gains.
  bool refit_afresh() {
    return refit_again(
        {.wanted = [this](const RankedCandidate& e) { return e.refit && significant(e); }, .as_refitted = true, .name = "_afresh"});
  }

  /// Of the first few that are wanted. False: none gains.
  bool refit_again(const Again& again) {
    if (ranks().size() > 1) return false;
    constexpr std::size_t most = 3;
    std::vector<RankedCandidate*> chosen;
    std::vector<ScreeningResult> begin;
    for (auto& e : ranked_) {
      if (chosen.size() == most || !again.wanted(e)) continue;
      chosen.push_back(&e);
      begin.push_back(again.as_refitted ? as_refitted(*e.screening, e.refit->estimate.model) : *e.screening);
    }
    if (chosen.empty()) return false;
    RefitWork work = refit_work();
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

  /// `name`: of the stored jobs. Empty on ranks other than the first.
  std::vector<SteppedRefit> refitted(const RefitWork& work, const ScoreTest& score, const std::vector<const ScreeningResult*>& effects,
                                     const char* name) {
    std::optional<StoredJobs> stored = options_.refits;
    if (stored) stored->digest += name;
    auto refits = refit_all(work, score, effects, {stored, part(end_of_curves, end_of_refits), options_.stop});
    if (!refits) throw RunError("discover: stopped before all refits were done");
    return std::move(*refits);
  }

  /// False: no candidate is in it.
  bool refit_wave(const Wave& wave) {
    std::vector<RankedCandidate*> chosen;
    std::vector<const ScreeningResult*> effects;
    for (auto& e : ranked_) {
      if (std::ssize(chosen) >= options_.max_refits) break;
      const ScreeningResult* begin = e.refit_begun || !e.candidate.why.empty() ? nullptr : wave.begin(e);
      if (begin == nullptr) continue;
      e.refit_begun = true;
      chosen.push_back(&e);
      effects.push_back(begin);
    }
    if (chosen.empty()) return false;
    RefitWork work = refit_work();
    work.screened = wave.screened;
    std::vector<SteppedRefit> refits = refitted(work, wave.score == nullptr ? score_ : *wave.score, effects, wave.name);
    for (std::size_t k = 0; k < refits.size(); ++k) {
      if (wave.screened == nullptr) chosen[k]->candidate.predicted_drop = refits[k].predicted_drop;
      chosen[k]->refit = std::move(refits[k].refit);
      store_refit(*chosen[k]);
    }
    sort_by_evidence(ranked_);
    return true;
  }

  void store_refit(RankedCandidate& e) {
    Candidate& c = e.candidate;
    if (!e.refit->ok) {
      c.why = e.refit->why;
      if (e.refit->out_of_time) unfinished_.push_back(effect_at(c.effect, c.roles));
      e.refit.reset();
      return;
    }
    describe_refit(e, families_);
  }

  std::optional<Unexplained> what_is_accepted() { return accept_best(ranked_, unknown_, context(), narrow_); }

  /// A force or an error that changes over shorter ways, where nothing else shows as much.
  std::optional<Unexplained> or_what_is_narrow(std::optional<Unexplained> wide) {
    if (narrow_.empty()) return wide;
    families_ += static_cast<double>(narrow_.size());
    out_.tried.push_back("unknown curves of shorter ways: " + std::to_string(narrow_.size()));
    const auto best = std::min_element(narrow_.begin(), narrow_.end(), [](const auto& a, const auto& b) { return a.order() < b.order(); });
    if (is_significant(*best, context()) && shows_more_than(*best, wide)) wide = unexplained_by(*best, unknown_, context());
    if (wide && wide->curve && wide->curve->hats != hats_of_unknown_curves) unknown_ = with_narrow_ones(std::move(unknown_), narrow_);
    return wide;
  }

  /// Than every refit; and than a curve of usual width at least as clearly as two effects are told apart, or than what remains with the
  /// best effect by as much as an effect is not chosen past another one.
  bool shows_more_than(const UnknownCurve& narrow, const std::optional<Unexplained>& wide) const {
    const double shown = largest_drop(ranked_, options_.p_accept);
    if (!wide) return narrow.worth() > shown;
    if (!wide->curve) return narrow.worth() > 2.0 * shown;
    return narrow.worth() > shown && is_clearly_better(narrow, *wide->curve);
  }

  void list_unknown() {
    for (auto& e : ranked_) {
      const std::string p = "family-wise " + p_equals(e.candidate.p_value);
      if (e.candidate.why.empty()) {
        const bool significant = e.candidate.p_value < options_.p_accept;
        e.candidate.why = !significant ? "not significant: " + p
                          : e.refit    ? p + ", behind one that is not accepted"
                                       : p + ", not refitted: tested again with the best in the model";
      }
      out_.candidates.push_back(e.candidate);
      if (e.refit) out_.candidates.back().added = added_force_of(e.refit->estimate, e.screening->candidate_model->strengths);
    }
    std::stable_sort(unknown_.begin(), unknown_.end(), [](const UnknownCurve& a, const UnknownCurve& b) { return a.log_p < b.log_p; });
    for (const auto& curve : unknown_) out_.candidates.push_back(unknown_candidate(curve, families_, options_.p_accept));
    rank_candidates(out_.candidates);
  }

  void describe_search(const std::optional<Unexplained>& unexplained) {
    out_.force = random_force(estimate_);
    for (const auto& s : screening_) out_.tried.push_back(what_was_tried(s));
    std::string curves = "unknown curves:";
    for (const auto& curve : unknown_)
      curves += (curve.kind == PortKind::sensor ? " error of " : " ") + curve.port + "(" + curve.quantity + ")";
    out_.tried.push_back(curves);
    out_.not_tried = candidates_.not_tried;
    write_verdict(out_, with_curves_alike(unexplained, unknown_, scores(), options_.p_accept), options_.p_accept,
                  options_.calibration != nullptr);
    report_sensor_imitations(screening_, score_, out_);
    add_camera_remarks(options_.calibration, options_.p_accept, out_);
  }

  void test_fixed_parameters() {
    const auto best = std::find_if(ranked_.begin(), ranked_.end(), [this](const RankedCandidate& e) { return significant(e); });
    const double predicted = best == ranked_.end() ? 0.0 : best->screening->result.chi2;
    if (auto held = fixed_parameters_in_words(refit_work(), score_, {predicted, families_, options_.p_accept}); !held.empty())
      out_.fixed_parameters = std::move(held);
  }

  const FilterEstimate& estimate_;
  const std::vector<Signals>& experiments_;
  const Registry& registry_;
  DiscoverOptions options_;
  CandidateList candidates_;
  ScoreTest score_;
  ForceSensitivity force_;
  std::vector<ScreeningResult> screening_;
  std::optional<FilterEstimate> calm_;             ///< free_run()
  std::optional<ScoreTest> calm_score_;            ///< there
  std::vector<ScreeningResult> calm_screening_;    ///< there
  std::vector<const ScreeningResult*> nominated_;  ///< of these, the best first
  std::vector<UnknownCurve> unknown_, narrow_;
  std::vector<RankedCandidate> ranked_;
  std::vector<std::string> unfinished_;  ///< effects whose refits were cut off
  std::optional<FilterEstimate> higher_;
  bool higher_is_looked_for_ = true;
  double families_ = 1.0;
  Discovery out_;
};

/// Made again where the model turns out to be higher without any effect than where it was fitted.
Discovery whole_search(const FittedStudy& fitted, const DiscoverOptions& options) {
  Search search(fitted, options);
  Discovery out = search.run();
  const FilterEstimate* higher = search.higher();
  if (higher == nullptr) return out;
  DiscoverOptions again = options;
  if (again.refits) again.refits->digest += "_higher";
  Search there({*higher, fitted.request, fitted.registry, fitted.experiments}, again);
  there.do_not_look_for_higher();
  out = there.run();
  out.sentences.push_back("the fit of this model is not its highest: the search was made where the log-likelihood is higher by " +
                          format_value(higher->objective - fitted.estimate.objective));
  return out;
}

}  // namespace

Discovery discover(const FittedStudy& fitted, const DiscoverOptions& options) {
  const Stopwatch clock;
  const bool whole = options.only.empty();
  const Watch watch("this round of discover", whole ? options.round_limit : 0.0);
  Discovery out;
  try {
    out = whole ? whole_search(fitted, options) : Search(fitted, options).predict();
  } catch (const TimeLimitReached& spent) {
    say_cut_off(spent.what(), false, out);
  }
  out.seconds = clock.seconds();
  return out;
}

}  // namespace misfit
