#include "misfit/discover/discover.h"

#include <algorithm>
#include <utility>

#include "misfit/core/stopwatch.h"
#include "misfit/core/text.h"
#include "misfit/core/watch.h"
#include "misfit/diagnose/distinct_ports.h"
#include "misfit/discover/accept.h"
#include "misfit/discover/added_force.h"
#include "misfit/discover/beside_a_curve.h"
#include "misfit/discover/candidate.h"
#include "misfit/discover/conditional.h"
#include "misfit/discover/fixed_parameters.h"
#include "misfit/discover/lack_of_fit.h"
#include "misfit/discover/refit_waves.h"
#include "misfit/discover/unfinished.h"
#include "misfit/discover/unknown_curves.h"
#include "misfit/discover/unknown_form.h"
#include "misfit/discover/verdict.h"
#include "misfit/fit/filter/noise_report.h"
#include "misfit/jobs/ranks.h"

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
      waves_->refit_where_signs_are_lost();
      // The readings themselves show whole steps, and other effects take what rounding does for lags and clocks: those wait.
      if (!waves_->refit_where_steps_are_coarse() && !refit_in_waves()) return {};
      unexplained = what_is_accepted();
      if (none_accepted() && waves_->refit_the_other_nominated()) unexplained = what_is_accepted();
      const bool more_to_try = !is_of_unknown_form(ranked_, unknown_, context());
      if (more_to_try && none_accepted() && waves_->refit_the_other_significant_ones()) unexplained = what_is_accepted();
      if (more_to_try && none_accepted() && waves_->refit_afresh()) {
        if (find_higher()) return {};  // the model without them was not begun afresh
        unexplained = what_is_accepted();
      }
      if (more_to_try && none_accepted() && waves_->refit_what_a_slow_force_hides()) {
        std::optional<Unexplained> beside = what_is_accepted();
        if (!none_accepted() || !unexplained) unexplained = std::move(beside);  // what one leaves that is refused, too, tells less
      }
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
    if (waves_) say_unfinished(waves_->unfinished(), out_);
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
  /// False: the model without any effect is found to come higher.
  bool refit_in_waves() {
    waves_->refit_the_best();
    if (find_higher()) return false;
    waves_->refit_the_significant_beyond_a_step();
    waves_->refit_what_the_free_run_shows();
    waves_->refit_what_fell_short();
    waves_->refit_beside_an_edge_not_visited();
    waves_->refit_what_promises_little();
    return !find_higher();
  }

  /// Approximate shares of a search's time, measured on 79 s of flight.
  static constexpr double end_of_screen = 0.45, end_of_curves = 0.5, end_of_refits = 0.9;

  void refit_the_best_asked_for() {
    const auto wanted = [&](const RankedCandidate& e) { return options_.refit_best_of && options_.refit_best_of(e.candidate); };
    const auto best = std::find_if(ranked_.begin(), ranked_.end(), wanted);
    if (best == ranked_.end() || !(may_be_significant(*best, options_.p_accept) || waves_->reads_coarse_steps(*best))) return;
    waves_->refit_alone(*best);
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

  void screen_all() {
    screening_ = screen(scores(), candidates_.models, part(0.0, end_of_screen));
    unknown_ = unknown_curves(scores(), part(end_of_screen, end_of_curves));
    narrow_ = narrow_curves(scores());
    families_ = static_cast<double>(screening_.size() + unknown_.size());
    rank();
  }

  void rank() {
    for (const auto& s : screening_) ranked_.push_back(ranked_as_screened(s, families_));
    leave_out_what_a_finer_curve_describes(scores(), ranked_);
    sort_by_evidence(ranked_);
    waves_.emplace(context(), score_, candidates_.models, ranked_, part(end_of_curves, end_of_refits));
  }

  bool find_higher() {
    if (higher_is_looked_for_) higher_ = waves_->higher();
    return higher_.has_value();
  }

  bool none_accepted() const {
    return std::none_of(ranked_.begin(), ranked_.end(), [](const RankedCandidate& e) { return e.candidate.accepted; });
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

  /// Where no effect describes the curve, though one describes what these data cannot tell from it: that.
  std::optional<Unexplained> or_what_can_be_added(std::optional<Unexplained> unexplained) const {
    if (!unexplained || !unexplained->curve || !unexplained->effects.empty() || !unexplained->curve->memory.empty()) return unexplained;
    for (const UnknownCurve& alike : curves_alike(*unexplained->curve, unknown_, scores(), options_.p_accept)) {
      if (Unexplained instead = unexplained_by(alike, unknown_, context()); !instead.effects.empty()) return instead;
    }
    return unexplained;
  }

  void describe_search(std::optional<Unexplained> unexplained) {
    unexplained = or_what_can_be_added(std::move(unexplained));
    out_.force = estimated_force(estimate_);
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
    const auto best =
        std::find_if(ranked_.begin(), ranked_.end(), [this](const RankedCandidate& e) { return is_significant(e, options_.p_accept); });
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
  std::vector<UnknownCurve> unknown_, narrow_;
  std::vector<RankedCandidate> ranked_;
  std::optional<RefitWaves> waves_;  ///< of these
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
  // Ranks share the refits of every wave: one that stopped alone would leave the others waiting.
  const Watch watch("this round of discover", whole && ranks_started() == 1 ? options.round_limit : 0.0);
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
