#pragma once

#include <optional>
#include <vector>

#include "misfit/discover/refit.h"

namespace misfit {

/// A library effect in the ranking of a search, best first.
struct RankedCandidate {
  const ScreeningResult* screening = nullptr;
  Candidate candidate;
  std::optional<Refit> refit;
  bool refit_begun = false;
  double log_p = 0.0;  ///< of the refit where there is one
  /// Its refit is a limiting case that is no longer the effect: a part of one that exists as a whole only, a memory longer than the
  /// recording, a step of an output of which the measurements are no multiples, an edge outside of the operating range. Its drop says
  /// nothing of the effect then.
  bool degenerate = false;
  bool alone_gains_nothing = false;  ///< refused for its held-out gain, and for nothing else
  /// Drop of the refit beside which no second effect was found to hold: not looked for again until there is another refit.
  std::optional<double> no_second_at;
  /// Drop of the refit from which the model without the effect was found to be no higher than the estimate (higher_without()).
  std::optional<double> no_higher_at;
};

/// As it was screened, among `families`.
[[nodiscard]] RankedCandidate ranked_as_screened(const ScreeningResult& screening, double families);

/// The candidate with what its refit found: drop, p-value and log_p, values, where it acts, what it leaves of the random force.
void describe_refit(RankedCandidate& e, double families);

/// Those that the free parameters describe last, what was refitted first, then by log_p.
void sort_by_evidence(std::vector<RankedCandidate>& ranked);

/// Not described by the free parameters, and its family-wise p-value is below that of acceptance; or below five times that, which a refit
/// may bring below.
[[nodiscard]] bool is_significant(const RankedCandidate& e, double p_accept);
[[nodiscard]] bool may_be_significant(const RankedCandidate& e, double p_accept);

/// Shapes, or a frequency, were scanned, or the effect exists as a whole only (CoefficientSpec::whole): one step of a linearised model says
/// little of what it explains.
[[nodiscard]] bool is_far_from_linear(const RankedCandidate& e);

/// Of the refits below a family-wise p-value; nullptr: there is none.
[[nodiscard]] const RankedCandidate* with_largest_drop(const std::vector<RankedCandidate>& ranked, double p_accept);
/// 0: there is none.
[[nodiscard]] double largest_drop(const std::vector<RankedCandidate>& ranked, double p_accept);

}  // namespace misfit
