#pragma once

#include <optional>
#include <vector>

#include "misfit/discover/refit.h"
#include "misfit/discover/verdict.h"

namespace misfit {

/// A library effect in the ranking of a search, best first.
struct RankedCandidate {
  const ScreeningResult* screening = nullptr;
  Candidate candidate;
  std::optional<Refit> refit;
  bool refit_begun = false;
  double log_p = 0.0;  ///< of the refit where there is one
  /// Its refit is a limiting case that is no longer the effect: a part of one that exists as a whole only, a memory longer than the
  /// recording, an edge outside of the operating range. Its drop says nothing of the effect then.
  bool degenerate = false;
  bool alone_gains_nothing = false;  ///< refused for its held-out gain, and for nothing else
};

/// What a search works on, for testing again in another model.
struct SearchContext {
  const FilterEstimate& estimate;
  const Registry& registry;
  const std::vector<Signals>& experiments;
  const DiscoverOptions& options;
  double families = 1.0;  ///< that a p-value is corrected for
};

/// Refitted drops nearer than this do not distinguish two effects: beyond it the evidence is "very strong" (Kass & Raftery, Bayes Factors,
/// J. Am. Stat. Assoc. 90 (1995), section 3.2).
inline constexpr double tied_drops = 10.0;

/// A refit has failed if its drop is below this share of the chi² that its score promised.
inline constexpr double least_of_score = 0.5;

/// The acceptance rule of discovery: at most one of the refitted candidates, which stand in front, best first. p_accept: 0.01 unless the
/// options say otherwise; numbers and formulas: lib/misfit/README.md, 6.5.
///
/// 1. A candidate is refused (`refusal`) if its family-wise p is not below p_accept, its refit has not converged, only a part of an effect
///    is found that exists as a whole (whole_strength.h), one of its strengths ends at a bound, all are smaller than two sigmas, or a time
///    by which it remembers is, a parameter that was known to 5 % is not known to 50 % beside it, it remembers for longer than half of the
///    recording or has not one period in it, it has an edge where nothing was, or the held-out log-likelihood rises by less than 1/2 for
///    each of its parameters. The first reason that holds is noted.
/// 2. The others come by what they gain, on the estimation's measurements and the held-out ones together (`gain_of`); those within 3 of
///    the best by the number of their parameters, then as in the list, but a lag, delay or limit of a sensor after the plant. Unknown
///    curves and surfaces are screened again with the candidate in the model (`remaining_lack_of_fit`), and with a lag or delay the others
///    (`remaining_memory`). If none remains of a quantity that the candidate, or an alias before it, reads (of any, if it lags, is a
///    sensor's, or has a scanned frequency), it is chosen: the first such. Else it is an alias: an effect that may only imitate the missing
///    one.
/// 3. A choice is not made past a candidate with more than twice its drop (`not_past_a_larger_one`): if that is an alias whose lack of fit
///    a second effect removes, as in step 4, it is accepted first, since two effects are missing; if it is another one, is refused, or is
///    an unknown curve of the first screening, none is accepted.
/// 4. If every one that is not refused is an alias: accepted is the first whose lack of fit a second known effect removes, of any quantity,
///    if each is needed beside the other and no strength of the two ends at a bound (`explaining_effect`). Else, of the first three that
///    were refused for their held-out gain alone, the first that gains together with a second effect what both must, and leaves as little:
///    two effects that hide each other (an offset and dry friction). So in step 3, of a larger one that was refused for that.
/// 5. If two others of the port and quantity of the accepted one, a force without memory, explain 10 more between them, refitted, than it
///    does with the best of these, each needed beside the other, with a larger held-out gain, the first of them takes its place
///    (`better_pair`): the sum of two forms often looks like a third.
/// 6. The accepted one becomes the first of the list.
/// 7. The first is grouped with those that these data cannot distinguish from it (`find_groups`): a refitted drop within 10, and neither
///    has a significant score once the other is in the model.
/// 8. If one is accepted, every other that was refitted gets the reason why it is not (`explain_others`), and nothing is unexplained.
/// 9. Else what remains may depend on a quantity in a way that no named effect describes (`unexplained_force`). Returned is the curve that
///    remains with the first alias (unless the best explains more than twice as much), or with the best candidate if that is significant
///    but was refused, provided that the best candidate has a lower p than every unknown curve and is what its name says; else the best
///    unknown curve, if its family-wise p is below p_accept and no refitted first candidate has a lower p.
[[nodiscard]] std::optional<Unexplained> accept_best(std::vector<RankedCandidate>& ranked, const std::vector<UnknownCurve>& unknown,
                                                     const SearchContext& context);

}  // namespace misfit
