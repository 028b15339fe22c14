#include "misfit/discover/ranked.h"

#include <algorithm>
#include <cmath>

#include "misfit/discover/added_force.h"
#include "misfit/discover/candidate.h"
#include "misfit/math/statistics.h"
#include "misfit/model/whole_steps.h"

namespace misfit {

RankedCandidate ranked_as_screened(const ScreeningResult& screening, double families) {
  RankedCandidate out;
  out.screening = &screening;
  out.log_p = screening.log_p;
  out.candidate = named_candidate(screening, families);
  return out;
}

void describe_refit(RankedCandidate& e, double families) {
  Candidate& c = e.candidate;
  const Refit& refit = *e.refit;
  c.actual_drop = refit.drop;
  c.held_out_gain.reset();  // that of an earlier refit
  e.log_p = log_drop_tail(*e.screening->candidate_model, refit.drop) + std::log(e.screening->cells_effective);
  // Whole steps are seen in the measurements: they are not the best of many effects that were tried.
  const Model& refitted = refit.estimate.model;
  c.p_value = family_wise_p(e.log_p, reads_whole_steps(refitted, refitted.effects.back()) ? 1.0 : families);
  c.parameters = refit.parameters;
  c.roles = refit.moved.value_or(e.screening->candidate_model->roles);
  c.also = refit.also.empty() ? std::nullopt : std::optional(refit.also);
  c.holds = refit.holds.empty() ? std::nullopt : std::optional(refit.holds);
  c.free = refit.free;
  c.fixed = refit.fixed;
  const FilterEstimate& there = refit.estimate;
  c.refit_values = there.model.values();
  c.refit_log_noise = pack(there.noise, there.model.system->spec(), there.reference).value;
  c.force = random_force(there);
}

void sort_by_evidence(std::vector<RankedCandidate>& ranked) {
  std::stable_sort(ranked.begin(), ranked.end(), [](const RankedCandidate& a, const RankedCandidate& b) {
    if (a.candidate.absorbed != b.candidate.absorbed) return b.candidate.absorbed;
    if (a.refit.has_value() != b.refit.has_value()) return a.refit.has_value();
    return a.log_p < b.log_p;
  });
}

bool is_significant(const RankedCandidate& e, double p_accept) { return !e.candidate.absorbed && e.candidate.p_value < p_accept; }

bool may_be_significant(const RankedCandidate& e, double p_accept) {
  constexpr double most = 5.0;
  return is_significant(e, most * p_accept);
}

bool is_far_from_linear(const RankedCandidate& e) {
  const CandidateModel& c = *e.screening->candidate_model;
  const auto& coefficients = c.model.effects.back().effect->spec().coefficients;
  const bool whole = std::any_of(coefficients.begin(), coefficients.end(), [](const CoefficientSpec& s) { return s.whole != 0.0; });
  return whole || c.cells.size() > 1 || c.frequency >= 0;
}

const RankedCandidate* with_largest_drop(const std::vector<RankedCandidate>& ranked, double p_accept) {
  const RankedCandidate* out = nullptr;
  for (const RankedCandidate& e : ranked) {
    const bool counts = e.refit && is_significant(e, p_accept) && e.refit->drop > 0.0;
    if (counts && (out == nullptr || e.refit->drop > out->refit->drop)) out = &e;
  }
  return out;
}

double largest_drop(const std::vector<RankedCandidate>& ranked, double p_accept) {
  const RankedCandidate* first = with_largest_drop(ranked, p_accept);
  return first == nullptr ? 0.0 : first->refit->drop;
}

}  // namespace misfit
