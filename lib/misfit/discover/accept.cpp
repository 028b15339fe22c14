#include "misfit/discover/accept.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "misfit/core/text.h"
#include "misfit/discover/conditional.h"
#include "misfit/discover/drift.h"
#include "misfit/discover/lack_of_fit.h"
#include "misfit/discover/pairs.h"
#include "misfit/discover/unknown_form.h"
#include "misfit/discover/verdict.h"
#include "misfit/discover/whole_strength.h"
#include "misfit/inference/beyond_record.h"
#include "misfit/math/statistics.h"
#include "misfit/model/memory.h"
#include "misfit/model/whole_steps.h"

namespace misfit {
namespace {

constexpr double tied_gains = 3.0;  // [log-likelihood] a drop of 6

CandidateModel with_quantities(CandidateModel candidate_model, const std::vector<int>& quantities) {
  candidate_model.quantities.insert(candidate_model.quantities.end(), quantities.begin(), quantities.end());
  return candidate_model;
}

/// [s]
double longest_recording(const std::vector<Signals>& experiments) {
  double longest = 0.0;
  for (const Signals& s : experiments) longest = std::max(longest, s.seconds());
  return longest;
}

/// What the search could still gain is little beside what it has: enough to choose by; `add` goes on from there.
bool near_a_maximum(const Refit& refit) {
  constexpr double little = 0.01;  // of the drop
  const std::optional<double>& left = refit.estimate.newton_decrement;
  return refit.estimate.converged || (left && 2.0 * *left < little * refit.drop);
}

/// Not significant as refitted: as it is, or because its refit has not found what its score promises.
std::string not_significant(const RankedCandidate& e, const SearchContext& context) {
  const double promised = e.screening->result.chi2;
  const bool in_screening = family_wise_p(e.screening->log_p, context.families) < context.options.p_accept;
  if (!in_screening || !(e.refit->drop < least_of_score * promised)) return "not significant: family-wise " + p_equals(e.candidate.p_value);
  return "its refit failed: it ends at a drop of " + format_value(e.refit->drop) + " where the score test predicts " +
         format_value(promised) + ", which is no evidence against it";
}

/// Whole steps of the measurements, where they are most of what is not predicted: they are seen in the measurements themselves, so that
/// neither a search that a sawtooth stops nor what is held out, where a filter that takes its output for known to a hundredth of a step is
/// far too sure, speaks against them.
bool is_seen_in_measurements(const RankedCandidate& e, const SearchContext& context) {
  const Model& refitted = e.refit->estimate.model;
  return e.refit->partial.empty() && on_whole_steps(refitted, context.experiments) && are_coarse_steps(refitted, context.estimate);
}

/// The reason why it cannot be accepted; empty if there is none. Notes in `e` whether its refit is degenerate, its held-out gain (which may
/// take two fits), and whether that alone, or predictions farther ahead alone, speak against it.
std::string reason_against(RankedCandidate& e, HeldOut& held_out, const SearchContext& context) {
  Candidate& c = e.candidate;
  e.alone_gains_nothing = false;
  c.grows_ahead.reset();
  if (!(c.p_value < context.options.p_accept)) return not_significant(e, context);
  if (is_seen_in_measurements(e, context)) {
    if (!c.held_out_gain) c.held_out_gain = held_out.gain(e.refit->estimate);
    return "";
  }
  if (!near_a_maximum(*e.refit)) return "its refit has not converged: " + e.refit->estimate.message;
  const Model& refitted = e.refit->estimate.model;
  const auto memory = outlasts_recording(refitted, refitted.effects.back(), longest_recording(context.experiments));
  const auto off_steps = off_whole_steps(refitted, context.experiments);
  const auto no_edge = edge_not_visited(e.refit->estimate), no_wave = recurs_nowhere(e.refit->estimate);
  const auto idle = idle_input(e.refit->estimate), no_limit = hardly_reached(e.refit->estimate);
  e.degenerate = memory || off_steps || no_edge || no_wave || idle || no_limit || !e.refit->partial.empty();
  if (idle) return *idle + " acts nowhere in the model, so that nothing of what it does can be " + c.effect + ": input_gain comes first";
  if (!e.refit->partial.empty()) return "only a part of it is found: " + e.refit->partial;
  if (const auto bound = ends_at_bound(refitted, e.screening->candidate_model->strengths)) return *bound;
  if (const auto unknown = undetermined_strengths(refitted, e.refit->estimate.covariance, e.screening->candidate_model->strengths))
    return *unknown;
  if (const auto time = undetermined_time(refitted, e.refit->estimate.covariance)) return *time;
  if (const auto collinear = no_longer_determined(e.refit->estimate, context.estimate)) return *collinear;
  if (memory) return "its " + *memory;
  if (off_steps) return *off_steps;
  if (no_edge) return *no_edge;
  if (no_wave) return *no_wave;
  if (no_limit) return *no_limit;
  if (!c.held_out_gain) c.held_out_gain = held_out.gain(e.refit->estimate);
  const bool gains = *c.held_out_gain > least_held_out_gain(estimated_parameters(*e.refit));
  if (const double growth = held_out.growth_ahead(e.refit->estimate); growth > kMostGrowthOfErrors) {
    if (gains) c.grows_ahead = growth;
    return growth_in_words(growth);
  }
  e.alone_gains_nothing = !gains;
  if (!e.alone_gains_nothing) return "";
  if (!(*c.held_out_gain > 0.0)) return "the held-out log-likelihood does not rise (" + format_value(*c.held_out_gain) + ")";
  const int parameters = estimated_parameters(*e.refit);
  return "the held-out log-likelihood rises by " + format_value(*c.held_out_gain) + ", but " +
         counted(parameters, "new parameter needs", "new parameters need") + " more than " + format_value(least_held_out_gain(parameters));
}

/// Step 4. That measurements are in whole steps is seen in them, whatever the fit makes of the rounding: it is said beside the reason.
std::string judge(RankedCandidate& e, HeldOut& held_out, const SearchContext& context) {
  std::string why = reason_against(e, held_out, context);
  if (why.empty() || !(e.candidate.p_value < context.options.p_accept)) return why;
  const auto steps = on_whole_steps(e.refit->estimate.model, context.experiments);
  return steps ? why + "; " + *steps : why;
}

/// Within what neither could be preferred for. Two lags or delays are of different states, whose beginnings are not known: what the filter
/// assumes of each costs up to tied_drops, whichever is there.
bool are_tied(const RankedCandidate& a, const RankedCandidate& b) {
  const bool both_lag = a.screening->candidate_model->lags && b.screening->candidate_model->lags;
  return std::abs(a.refit->drop - b.refit->drop) <= (both_lag ? 2.0 : 1.0) * tied_drops;
}

/// Two names of one thing, as E1(I) and R0(soc) in E1 soc - R0 I: beside what is free in the model their columns span the same, so that
/// they score the same to all digits but those of rounding. A refit of one may end lower all the same.
bool score_the_same(const RankedCandidate& a, const RankedCandidate& b) {
  constexpr double rounding = 1e-6;
  const auto is_linear = [](const RankedCandidate& e) { return e.screening->runs && !e.candidate.absorbed && !is_far_from_linear(e); };
  if (!is_linear(a) || !is_linear(b) || a.candidate.dof != b.candidate.dof) return false;
  const double chi2 = a.screening->result.chi2;
  return chi2 > 0.0 && std::abs(b.screening->result.chi2 - chi2) < rounding * chi2;
}

bool is_read_in_steps(const RankedCandidate& e) {
  const Model& refitted = e.refit->estimate.model;
  return reads_whole_steps(refitted, refitted.effects.back());
}

/// Step 8: groups the best candidate with those that these data cannot distinguish from it. Not with one that has an edge which nothing
/// visits: with the other edge alone it is a candidate of its own. Nor with whole steps, which the measurements show themselves, and of
/// which the score of a sawtooth says nothing beside another effect.
void find_groups(std::vector<RankedCandidate>& ranked, const SearchContext& context) {
  if (ranked.empty() || !ranked.front().refit) return;
  RankedCandidate& best = ranked.front();
  std::vector<RankedCandidate*> members = {&best};
  const ConditionalScores given_best(*best.refit, context);
  const double p_accept = context.options.p_accept;
  for (std::size_t k = 1; k < ranked.size(); ++k) {
    RankedCandidate& other = ranked[k];
    if (score_the_same(other, best)) {
      members.push_back(&other);
      continue;
    }
    if (!other.refit || !are_tied(other, best) || edge_not_visited(other.refit->estimate)) continue;
    if (is_read_in_steps(best) || is_read_in_steps(other)) continue;
    if (!adds_nothing(given_best, other, p_accept) || !adds_nothing(ConditionalScores(*other.refit, context), best, p_accept)) continue;
    members.push_back(&other);
  }
  if (members.size() < 2) return;
  std::vector<std::string> group;
  for (const RankedCandidate* e : members) group.push_back(label(e->candidate));
  for (RankedCandidate* e : members) e->candidate.group = group;
}

double gain_of(const RankedCandidate& e) { return gain_in_all(e.candidate); }

/// What decided between one that is not refused and the accepted one (steps 5 and 7).
std::string why_not_before(const RankedCandidate& other, const RankedCandidate& best) {
  const std::string than = label(best.candidate);
  if (!(other.refit->drop > best.refit->drop)) return "explains less than " + than;
  if (gain_of(other) < gain_of(best)) return "explains more than " + than + " here, but less of what is held out, and less in all";
  return "explains hardly more than " + than +
         (estimated_parameters(*other.refit) > estimated_parameters(*best.refit)
              ? ", which has fewer parameters"
              : ", which comes first: what a sensor does can stand for much of what the plant does");
}

/// After step 8: reasons for those that were refitted and are not accepted, the accepted one in front.
void explain_others(std::vector<RankedCandidate>& ranked) {
  const Candidate& best = ranked.front().candidate;
  for (std::size_t k = 1; k < ranked.size(); ++k) {
    Candidate& other = ranked[k].candidate;
    if (!other.why.empty() || !ranked[k].refit) continue;
    const bool indistinguishable = std::find(other.group.begin(), other.group.end(), label(best)) != other.group.end();
    other.why = indistinguishable ? "these data cannot distinguish it from " + label(best)
                                  : why_not_before(ranked[k], ranked.front()) + "; tested again once that is added";
  }
}

using Place = std::vector<RankedCandidate>::iterator;

/// A candidate that step 4 does not refuse but with which a curve of a quantity that it reads is still significant: it may only imitate the
/// missing effect.
struct Imitation {
  Place at;
  UnknownCurve remaining;
};

/// The accepted candidate, or the end of the list; and the second effect beside which it holds, if it does not by itself. None where a
/// force of unknown form explains more: that one.
struct Choice {
  Place at;
  std::optional<Pair> pair = std::nullopt;
  std::optional<UnknownCurve> larger = std::nullopt;
};

/// Dynamics or a nonlinearity of a sensor (lag, delay, saturation) that nothing is known of beforehand: it can imitate much of what the
/// plant does.
bool is_sensor_distortion(const RankedCandidate& e) {
  const CandidateModel& candidate_model = *e.screening->candidate_model;
  const bool memory = has_memory(candidate_model.model.effects.back().effect->spec());
  return candidate_model.family == CandidateFamily::sensor && !candidate_model.has_priors && (memory || !candidate_model.shapes.empty());
}

/// Step 4, and the order of step 5.
std::vector<Place> not_refused(std::vector<RankedCandidate>& ranked, HeldOut& held_out, const SearchContext& context) {
  std::vector<Place> out;
  for (auto e = ranked.begin(); e != ranked.end() && e->refit; ++e) {
    e->candidate.why = judge(*e, held_out, context);
    if (e->candidate.why.empty()) out.push_back(e);
  }
  std::stable_sort(out.begin(), out.end(), [](Place a, Place b) { return gain_of(*a) > gain_of(*b); });
  if (out.empty()) return out;
  const double best = gain_of(*out.front());
  const auto tied = std::find_if(out.begin(), out.end(), [&](Place e) { return gain_of(*e) < best - tied_gains; });
  std::sort(out.begin(), tied);  // as in the list
  std::stable_sort(out.begin(), tied, [](Place a, Place b) { return estimated_parameters(*a->refit) < estimated_parameters(*b->refit); });
  std::stable_partition(out.begin(), tied, [](Place e) { return !is_sensor_distortion(*e); });
  return out;
}

/// Step 5: the first without lack of fit. Those before it are imitations.
Choice first_without_lack_of_fit(std::vector<RankedCandidate>& ranked, std::vector<Imitation>& imitations, HeldOut& held_out,
                                 const SearchContext& context) {
  std::vector<int> read;  // by the imitations
  for (const Place e : not_refused(ranked, held_out, context)) {
    const CandidateModel& candidate_model = *e->screening->candidate_model;
    auto left = remaining_lack_of_fit(e->refit->estimate, with_quantities(candidate_model, read), {e->refit->drop}, context.options);
    if (!left && candidate_model.lags) left = remaining_memory(*e->refit, e->refit->drop, ranked, context);
    if (!left) return {e};
    e->candidate.why = "lack of fit remains: with it in the model " + left->label() + " is still significant, " + p_equals(left->p_value) +
                       ", a predicted drop of " + format_value(left->result.chi2) + ", beside the effect's own of " +
                       format_value(e->refit->drop);
    e->candidate.remaining = left->label();
    imitations.push_back({e, *left});
    read.insert(read.end(), candidate_model.quantities.begin(), candidate_model.quantities.end());
  }
  return {ranked.end()};
}

/// Curves of unknown form that promised more than the choice did where all were screened, and are worth a tenth of what it explains: a
/// score far from the maximum, or one that vanishes, promises little.
std::vector<UnknownCurve> larger_than(const RankedCandidate& choice, const std::vector<UnknownCurve>& unknown,
                                      const SearchContext& context) {
  constexpr double of_drop = 0.1;
  const double least = std::max(choice.screening->result.chi2, of_drop * choice.refit->drop);
  std::vector<UnknownCurve> out;
  std::copy_if(unknown.begin(), unknown.end(), std::back_inserter(out),
               [&](const UnknownCurve& curve) { return is_significant(curve, context) && curve.worth() > least; });
  return out;
}

/// What may be missing beside, or in place of, every candidate.
struct Curves {
  const std::vector<UnknownCurve>& unknown;
  const std::vector<UnknownCurve>& narrow;  ///< most of what is sharp is a little better described by these: they are to show much more
};

std::optional<UnknownCurve> first_above(double least, const std::vector<UnknownCurve>& curves) {
  const auto found = std::find_if(curves.begin(), curves.end(), [least](const UnknownCurve& curve) { return curve.worth() > least; });
  return found == curves.end() ? std::nullopt : std::optional(*found);
}

/// Step 5: a choice is not made past one that explains more than twice as much. Such an imitation is chosen in its place if a second effect
/// explains what it leaves; for others, one that is refused, and an unknown form, nothing is.
Choice not_past_a_larger_one(std::vector<RankedCandidate>& ranked, const Choice& choice, const std::vector<Imitation>& imitations,
                             const Curves& curves, HeldOut& held_out, const SearchContext& context) {
  const double least = 2.0 * choice.at->refit->drop;
  const auto past = [&](const std::string& larger, const std::string& which) -> Choice {
    choice.at->candidate.why = "explains less than half of what " + larger + " does; " + which;
    return {ranked.end()};
  };
  for (const Imitation& imitation : imitations) {
    if (!(imitation.at->refit->drop > least)) continue;
    if (const auto pair = explaining_effect(*imitation.at, ranked, held_out, context)) return {imitation.at, pair};
    return past(label(imitation.at->candidate), "the larger one leaves a lack of fit that no second effect removes");
  }
  // A degenerate refit is no effect, but so much that something else explains is still missing beside the choice.
  for (auto e = ranked.begin(); e != ranked.end(); ++e) {
    if (!e->refit || e->candidate.why.empty() || !(e->refit->drop > least) || !(e->candidate.p_value < context.options.p_accept)) continue;
    if (e->alone_gains_nothing) {
      if (const auto pair = explaining_effect(*e, ranked, held_out, context)) return {e, pair};
    }
    return past(label(e->candidate), "the larger one cannot be accepted: " + e->candidate.why);
  }
  for (const auto* list : {&curves.unknown, &curves.narrow}) {
    const auto larger = first_above(least, *list);
    if (!larger) continue;
    Choice none = past(larger->label(), "no known effect describes the larger one");
    none.larger = larger;
    return none;
  }
  if (auto larger = mostly_left(choice.at->refit->estimate, larger_than(*choice.at, curves.unknown, context), context.options)) {
    choice.at->candidate.why = "explains less than " + larger->label() +
                               " would, of which more than half is left with it in the model; no known effect describes the larger one";
    return {.at = ranked.end(), .larger = std::move(larger)};
  }
  return choice;
}

/// Step 7: the first of a pair that explains clearly more, in place of the choice.
Choice or_a_better_pair(std::vector<RankedCandidate>& ranked, const Choice& choice, HeldOut& held_out, const SearchContext& context) {
  if (choice.pair) return choice;
  const auto instead = better_pair(ranked, *choice.at, held_out, context);
  return instead ? Choice{ranked.begin() + (instead->first - ranked.data()), instead->pair} : choice;
}

/// Of two imitations that are missing together, the one that explains more by itself is chosen.
Choice larger_of_two(const Place at, const Pair& pair, std::vector<RankedCandidate>& ranked) {
  const auto second = ranked.begin() + (pair.second - ranked.data());
  if (!second->candidate.remaining || !(second->refit->drop > at->refit->drop)) return {at, pair};
  Pair swapped = pair;
  swapped.second = &*at;
  return {second, swapped};
}

/// The second one explains more than twice as much, but cannot be chosen itself: no choice is made past it (as in step 5).
bool is_past_its_second(const Place at, const Pair& pair) {
  return pair.second->refit && !pair.second->candidate.remaining && pair.second->refit->drop > 2.0 * at->refit->drop;
}

/// Step 6: the first imitation whose lack of fit a second effect removes; else the first that gains nothing by itself on what is held out,
/// but does together with another.
Choice first_with_a_second_effect(std::vector<RankedCandidate>& ranked, const std::vector<Imitation>& imitations, HeldOut& held_out,
                                  const SearchContext& context) {
  constexpr int most = 3;
  for (const Imitation& imitation : imitations) {
    const auto pair = explaining_effect(*imitation.at, ranked, held_out, context);
    if (pair && !is_past_its_second(imitation.at, *pair)) return larger_of_two(imitation.at, *pair, ranked);
  }
  int tried = 0;
  for (auto e = ranked.begin(); e != ranked.end() && e->refit && tried < most; ++e) {
    if (!e->alone_gains_nothing) continue;
    ++tried;
    if (const auto pair = explaining_effect(*e, ranked, held_out, context)) return {e, pair};
  }
  return {ranked.end()};
}

/// Marks the choice as accepted, says why, and makes it the first of the list.
void move_to_front(std::vector<RankedCandidate>& ranked, const Choice& choice, const SearchContext& context) {
  Candidate& c = choice.at->candidate;
  c.accepted = true;
  c.remaining.reset();  // the second one explains it
  c.why = "family-wise " + p_equals(c.p_value) + ", held-out gain " + format_value(*c.held_out_gain);
  if (is_seen_in_measurements(*choice.at, context)) c.why += "; it is seen in the measurements themselves, whatever the fit makes of it";
  const FilterEstimate& there = choice.at->refit->estimate;
  if (!there.converged) c.why += "; " + there.message;
  if (const std::string drifts = drifts_in_words(there.model, there.covariance); !drifts.empty()) c.why += "; " + drifts;
  if (choice.pair) c.why += "; " + in_words(*choice.pair, choice.at->alone_gains_nothing);
  std::rotate(ranked.begin(), choice.at, choice.at + 1);
}

/// The curve that remains with the first imitation, else with the best candidate if that is significant but was refused. An imitation
/// beside which the best explains more than twice as much says nothing.
std::optional<UnknownCurve> remaining_with_best(const std::vector<RankedCandidate>& ranked, const std::vector<Imitation>& imitations,
                                                const SearchContext& context) {
  const bool refused = !ranked.empty() && ranked.front().refit && ranked.front().candidate.p_value < context.options.p_accept;
  const double best_drop = refused && !ranked.front().degenerate ? ranked.front().refit->drop : 0.0;
  if (!imitations.empty() && !(best_drop > 2.0 * imitations.front().at->refit->drop)) return imitations.front().remaining;
  if (!refused) return std::nullopt;
  const RankedCandidate& best = ranked.front();
  const bool periodic = best.screening->candidate_model->frequency >= 0;  // what it leaves is rather a frequency that changes
  if (best.degenerate || periodic) return std::nullopt;
  return remaining_lack_of_fit(best.refit->estimate, *best.screening->candidate_model, {best.refit->drop}, context.options);
}

Unexplained unexplained_as(const UnknownCurve& form, std::string quantities, double p, const std::vector<UnknownCurve>& unknown,
                           const SearchContext& context) {
  const SystemSpec& system = context.estimate.model.system->spec();
  return {form.kind, form.port, std::move(quantities), p, effects_of_unknown_form(form, unknown, system, context.registry)};
}

/// Step 9: a force that depends on a quantity in a way that no named effect describes: the curve that remains with the best candidate if
/// that candidate is more significant than any unknown curve, else the most significant unknown curve; first of all the `larger` one past
/// which no choice was made.
std::optional<Unexplained> unexplained_force(const std::vector<RankedCandidate>& ranked, const std::optional<UnknownCurve>& left,
                                             const std::optional<UnknownCurve>& larger, const std::vector<UnknownCurve>& unknown,
                                             const SearchContext& context) {
  const auto best = std::min_element(unknown.begin(), unknown.end(), [](const auto& a, const auto& b) { return a.order() < b.order(); });
  if (larger) return unexplained_by(*larger, unknown, context);
  const bool any = best != unknown.end();
  const bool front_better = any && !ranked.empty() && !ranked.front().degenerate && ranked.front().log_p < best->log_p;
  if (left && (!any || front_better)) return unexplained_as(*left, left->quantities(), left->p_value, unknown, context);
  if (!any || (front_better && ranked.front().refit)) return std::nullopt;  // what a known effect explains better is not unknown
  if (!is_significant(*best, context)) return std::nullopt;
  return unexplained_by(*best, unknown, context);
}

}  // namespace

bool is_significant(const UnknownCurve& curve, const SearchContext& context) {
  return sidak(curve.p_value, context.families) < context.options.p_accept;
}

Unexplained unexplained_by(const UnknownCurve& curve, const std::vector<UnknownCurve>& unknown, const SearchContext& context) {
  Unexplained out = unexplained_as(curve, curve.quantity, sidak(curve.p_value, context.families), unknown, context);
  out.curve = curve;
  return out;
}

std::optional<Unexplained> accept_best(std::vector<RankedCandidate>& ranked, const std::vector<UnknownCurve>& unknown,
                                       const SearchContext& context, const std::vector<UnknownCurve>& narrow) {
  std::vector<Imitation> imitations;
  HeldOut held_out(context.estimate, context.experiments, context.options.threads);
  Choice choice = first_without_lack_of_fit(ranked, imitations, held_out, context);
  choice = choice.at != ranked.end() ? not_past_a_larger_one(ranked, choice, imitations, {unknown, narrow}, held_out, context)
                                     : first_with_a_second_effect(ranked, imitations, held_out, context);
  if (choice.at != ranked.end()) choice = or_a_better_pair(ranked, choice, held_out, context);
  const bool accepted = choice.at != ranked.end();
  if (accepted) move_to_front(ranked, choice, context);
  find_groups(ranked, context);
  if (accepted) explain_others(ranked);
  if (accepted) return std::nullopt;
  return unexplained_force(ranked, remaining_with_best(ranked, imitations, context), choice.larger, unknown, context);
}

bool is_of_unknown_form(const std::vector<RankedCandidate>& ranked, const std::vector<UnknownCurve>& unknown,
                        const SearchContext& context) {
  double of_candidates = 0.0, of_curves = 0.0;
  for (const RankedCandidate& e : ranked) {
    if (!e.candidate.absorbed) of_candidates = std::max(of_candidates, e.screening->result.chi2);
  }
  for (const UnknownCurve& curve : unknown) {
    if (is_significant(curve, context)) of_curves = std::max(of_curves, curve.worth());
  }
  return of_curves > 2.0 * of_candidates;
}

}  // namespace misfit
