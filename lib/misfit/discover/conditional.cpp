#include "misfit/discover/conditional.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "misfit/discover/lack_of_fit.h"
#include "misfit/math/statistics.h"

namespace misfit {

std::string label(const Candidate& c) { return effect_at(c.effect, c.roles); }

RefitWork work_from(const FilterEstimate& estimate, const SearchContext& context) {
  return {.without = estimate,
          .experiments = context.experiments,
          .registry = context.registry,
          .threads = context.options.threads,
          .time_limit = context.options.refit_limit};
}

ConditionalScores::ConditionalScores(const Refit& in, const SearchContext& context)
    : in_(in), list_(candidate_models(in.estimate, in.request, context.registry, context.options.calibration)), score_(in.estimate) {}

std::optional<ScreeningResult> ConditionalScores::score(const RankedCandidate& other) const {
  const CandidateModel* candidate_model = in_list(other);
  return candidate_model == nullptr ? std::nullopt : score_at(*candidate_model, other.screening->cell, other);
}

std::optional<ScreeningResult> ConditionalScores::best_score(const RankedCandidate& other) const {
  const CandidateModel* candidate_model = in_list(other);
  std::optional<ScreeningResult> best;
  if (candidate_model == nullptr) return best;
  for (const std::vector<double>& cell : candidate_model->cells) {
    std::optional<ScreeningResult> found = score_at(*candidate_model, cell, other);
    if (found && (!best || found->result.chi2 > best->result.chi2)) best = std::move(found);
  }
  return best;
}

/// At the place where it was screened: its refit may have moved it to the input itself (Refit::moved), which is no place of the list.
const CandidateModel* ConditionalScores::in_list(const RankedCandidate& other) const {
  const CandidateModel& screened = *other.screening->candidate_model;
  const auto found = std::find_if(list_.begin(), list_.end(),
                                  [&](const CandidateModel& s) { return s.effect == screened.effect && s.roles == screened.roles; });
  return found == list_.end() ? nullptr : &*found;
}

std::optional<ScreeningResult> ConditionalScores::score_at(const CandidateModel& candidate_model, const std::vector<double>& at,
                                                           const RankedCandidate& other) const {
  CellScore cell = score_cell(in_.estimate, score_, candidate_model, at);
  if (cell.columns.size() == 0) return std::nullopt;
  ScreeningResult out;
  out.candidate_model = &candidate_model;
  out.cell = at;
  out.cells_effective = other.screening->cells_effective;
  out.result = std::move(cell.result);
  out.columns = std::move(cell.columns);
  out.log_p = log_score_tail(candidate_model, out.result) + std::log(out.cells_effective);
  return out;
}

bool adds_nothing(const ConditionalScores& in, const RankedCandidate& other, double p_accept) {
  const auto found = in.score(other);
  return found && (found->result.dof == 0 || !(chi_square_tail(found->result.chi2, found->result.dof) < p_accept));
}

std::optional<UnknownCurve> remaining_memory(const Refit& in, double drop, const std::vector<RankedCandidate>& ranked,
                                             const SearchContext& context) {
  std::optional<UnknownCurve> worst;
  const ConditionalScores conditional(in, context);
  for (const RankedCandidate& other : ranked) {
    const CandidateModel& lag = *other.screening->candidate_model;
    if (!lag.lags || lag.ports.empty() || !other.screening->runs || other.candidate.absorbed) continue;
    const std::optional<ScreeningResult> found = conditional.best_score(other);  // none of the effect that is in the model
    if (!found || found->result.dof == 0) continue;
    const double p = family_wise_p(found->log_p, static_cast<double>(ranked.size()));
    if (p > context.options.p_accept || found->result.chi2 - 2.0 * found->result.dof < least_share_of_drop * drop) continue;
    if (worst && worst->log_p < found->log_p) continue;
    UnknownCurve memory;
    memory.port = lag.port_names.front();
    memory.quantity = past_read_by(lag.model.system->spec(), lag.model.effects.back());
    memory.memory = label(other.candidate);
    memory.result = found->result;
    memory.log_p = found->log_p;
    memory.p_value = p;
    worst = std::move(memory);
  }
  return worst;
}

}  // namespace misfit
