#include "misfit/discover/pairs.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "misfit/core/text.h"
#include "misfit/discover/conditional.h"
#include "misfit/discover/lack_of_fit.h"
#include "misfit/discover/verdict.h"
#include "misfit/math/statistics.h"

namespace misfit {
namespace {

/// The other known effect with the lowest p in the model that holds `in`, whether or not it was significant without `in`; none if it is
/// not significant there.
struct SecondEffect {
  const RankedCandidate* entry = nullptr;
  ScreeningResult score;
};
SecondEffect second_effect_given(const RankedCandidate& in, const ConditionalScores& conditional,
                                 const std::vector<RankedCandidate>& ranked, double p_accept) {
  SecondEffect best;
  for (const RankedCandidate& other : ranked) {
    if (&other == &in || !other.screening->runs || other.candidate.absorbed || other.candidate.family == CandidateFamily::sensor) continue;
    auto found = conditional.score(other);
    if (!found || found->result.dof == 0 || (best.entry != nullptr && found->log_p >= best.score.log_p)) continue;
    best = {&other, std::move(*found)};
  }
  if (best.entry != nullptr && family_wise_p(best.score.log_p, static_cast<double>(ranked.size())) > p_accept) best.entry = nullptr;
  return best;
}

/// Is `in` significant beside the other? Drop 2 [log L(both) − log L(other alone)] with its family-wise p, as for any refitted drop.
bool needed_given(const RankedCandidate& in, const Refit& both, const RankedCandidate& other, const SearchContext& context) {
  std::optional<Refit> fitted;
  if (!other.refit) fitted = refit(work_from(context.estimate, context), *other.screening);
  const Refit& alone = other.refit ? *other.refit : *fitted;
  if (!alone.ok || !alone.estimate.converged) return false;
  const double drop = in.refit->drop + both.drop - alone.drop;
  const double log_p = log_drop_tail(*in.screening->candidate_model, drop) + std::log(in.screening->cells_effective);
  return family_wise_p(log_p, context.families) < context.options.p_accept;
}

/// Do both act on a port of the other, and depend on a quantity that the other reads?
bool compete(const CandidateModel& a, const CandidateModel& b) {
  const auto shared = [](const auto& one, const auto& other) {
    return std::any_of(one.begin(), one.end(), [&](const auto& x) { return std::find(other.begin(), other.end(), x) != other.end(); });
  };
  return shared(a.port_names, b.port_names) && shared(a.quantities, b.quantities);
}

/// chi² of two candidates together, each at its best cell.
double joint_chi2(const ScoreTest& score, const RankedCandidate& a, const RankedCandidate& b) {
  RowMatrix columns(a.screening->columns.rows(), a.screening->columns.cols() + b.screening->columns.cols());
  columns << a.screening->columns, b.screening->columns;
  return score.test(columns).chi2;
}

/// `b` added to the refitted `a` from its score there, both at their maximum; not ok where one is not needed beside the other or a strength
/// of either ends at a bound.
Refit refit_beside(const RankedCandidate& a, const RankedCandidate& b, const ScreeningResult& score, const SearchContext& context) {
  Refit out = refit(work_from(a.refit->estimate, context), score);
  if (!out.ok || !out.estimate.converged || !(out.drop > 0.0)) return {};
  const Model& model = out.estimate.model;
  if (ends_at_bound(model, a.screening->candidate_model->strengths) || ends_at_bound(model, score.candidate_model->strengths)) return {};
  return needed_given(a, out, b, context) ? std::move(out) : Refit{};
}

Refit refit_of_both(const RankedCandidate& a, const RankedCandidate& b, const SearchContext& context) {
  const ConditionalScores conditional(*a.refit, context);  // whose candidate models the score points to
  const auto score = conditional.score(b);
  return score && score->result.dof > 0 ? refit_beside(a, b, *score, context) : Refit{};
}

/// Others of the single effect's port and quantity, forces without memory.
std::vector<RankedCandidate*> rivals_of(const RankedCandidate& single, std::vector<RankedCandidate>& ranked) {
  std::vector<RankedCandidate*> out;
  for (RankedCandidate& e : ranked) {
    const CandidateModel& other = *e.screening->candidate_model;
    if (&e == &single || !e.screening->runs || e.screening->columns.cols() == 0 || e.candidate.absorbed) continue;
    if (other.family != CandidateFamily::sensor && !other.lags && compete(*single.screening->candidate_model, other)) out.push_back(&e);
  }
  return out;
}

/// By joint chi²: the best pair of rivals of which one was refitted, and the best companion of the single effect.
struct BestPairs {
  RankedCandidate *first = nullptr, *second = nullptr, *beside_single = nullptr;
};

/// Nothing where no pair of rivals is above the single effect with its best companion.
BestPairs best_pairs(const RankedCandidate& single, const std::vector<RankedCandidate*>& rivals, const FilterEstimate& estimate) {
  const ScoreTest score(estimate);
  BestPairs out;
  double with_single = 0.0, without = 0.0;
  for (std::size_t i = 0; i < rivals.size(); ++i) {
    if (const double chi2 = joint_chi2(score, single, *rivals[i]); chi2 > with_single) with_single = chi2, out.beside_single = rivals[i];
    for (std::size_t j = i + 1; j < rivals.size(); ++j) {
      if (!rivals[i]->refit && !rivals[j]->refit) continue;
      if (const double chi2 = joint_chi2(score, *rivals[i], *rivals[j]); chi2 > without)
        without = chi2, out.first = rivals[i], out.second = rivals[j];
    }
  }
  if (!(without > with_single)) return {};
  if (!out.first->refit || (out.second->refit && out.second->refit->drop > out.first->refit->drop)) std::swap(out.first, out.second);
  return out;
}

std::optional<Pair> second_beside(const RankedCandidate& in, const std::vector<RankedCandidate>& ranked, HeldOut& held_out,
                                  const SearchContext& context) {
  const DiscoverOptions& options = context.options;
  const ConditionalScores conditional(*in.refit, context);
  const SecondEffect second = second_effect_given(in, conditional, ranked, options.p_accept);
  if (second.entry == nullptr) return std::nullopt;
  const Refit both = refit_beside(in, *second.entry, second.score, context);
  if (!both.ok) return std::nullopt;
  Pair out;
  out.second = second.entry;
  if (in.alone_gains_nothing) {
    out.held_out_gain = held_out.gain(both.estimate);
    // Neither gains anything by itself, and the second is the best of all: the largest of N gains by chance is about log N.
    const double by_chance = std::log(static_cast<double>(ranked.size()));
    const int parameters = estimated_parameters(*in.refit) + estimated_parameters(both);
    if (!(out.held_out_gain > least_held_out_gain(parameters) + by_chance)) return std::nullopt;
  }
  // The threshold stays a share of the drop of `in` alone, as in step 5: with the drop of both, a better second effect would allow more
  // lack of fit.
  const bool lags = in.screening->candidate_model->lags || second.score.candidate_model->lags;
  if (lags && remaining_memory(both, in.refit->drop, ranked, context)) return std::nullopt;
  if (remaining_lack_of_fit(both.estimate, *second.score.candidate_model, {in.refit->drop, least_share_of_all, 2}, options))
    return std::nullopt;
  return out;
}

}  // namespace

std::optional<Pair> explaining_effect(RankedCandidate& in, const std::vector<RankedCandidate>& ranked, HeldOut& held_out,
                                      const SearchContext& context) {
  if (in.no_second_at == in.refit->drop) return std::nullopt;
  std::optional<Pair> found = second_beside(in, ranked, held_out, context);
  if (!found) in.no_second_at = in.refit->drop;
  return found;
}

std::optional<PairInstead> better_pair(std::vector<RankedCandidate>& ranked, RankedCandidate& single, HeldOut& held_out,
                                       const SearchContext& context) {
  constexpr double clearly = 10.0;  // of the drop
  if (single.screening->candidate_model->family == CandidateFamily::sensor || single.screening->candidate_model->lags) return std::nullopt;
  const BestPairs best = best_pairs(single, rivals_of(single, ranked), context.estimate);
  if (best.first == nullptr) return std::nullopt;
  const Refit both = refit_of_both(*best.first, *best.second, context);
  if (!both.ok) return std::nullopt;
  const double drop = best.first->refit->drop + both.drop;
  const Refit beside = refit_of_both(single, *best.beside_single, context);
  if (!(drop > single.refit->drop + (beside.ok ? beside.drop : 0.0) + clearly)) return std::nullopt;
  Candidate& first = best.first->candidate;
  const double gain = held_out.gain(both.estimate);
  if (!(gain > single.candidate.held_out_gain.value_or(0.0))) return std::nullopt;
  if (!first.held_out_gain) first.held_out_gain = held_out.gain(best.first->refit->estimate);
  single.candidate.why =
      label(first) + " and " + label(best.second->candidate) + " explain more between them (drop " + format_value(drop) + ")";
  return PairInstead{best.first, {.second = best.second, .held_out_gain = gain, .in_place_of = label(single.candidate), .drop = drop}};
}

std::string in_words(const Pair& pair, bool alone_gains_nothing) {
  const std::string second = label(pair.second->candidate);
  if (!pair.in_place_of.empty())
    return "together with " + second + " it explains more (drop " + format_value(pair.drop) + ") than " + pair.in_place_of +
           ", which imitates both: add " + second + " next";
  if (!alone_gains_nothing) return second + " explains what remains: add it next";
  return "it takes two: together with " + second + " the held-out likelihood rises by " + format_value(pair.held_out_gain) +
         ": add that next";
}

}  // namespace misfit
