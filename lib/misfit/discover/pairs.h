#pragma once

#include <optional>
#include <string>
#include <vector>

#include "misfit/discover/accept.h"

namespace misfit {

// Effects that are missing together.

/// The other of two.
struct Pair {
  const RankedCandidate* second = nullptr;
  double held_out_gain = 0.0;  ///< of both
  std::string in_place_of;     ///< the single effect that would have been accepted without it
  double drop = 0.0;           ///< of both, where they are in its place
};

/// Step 6 of accept_best(), for one candidate: another known effect beside which `in` holds. Of an imitation: it removes the lack of fit
/// that `in` leaves; of one that gains nothing by itself on what is held out: both together do, too. That there is none is noted in `in`.
[[nodiscard]] std::optional<Pair> explaining_effect(RankedCandidate& in, const std::vector<RankedCandidate>& ranked, HeldOut& held_out,
                                                    const SearchContext& context);

/// Two effects in the place of one.
struct PairInstead {
  RankedCandidate* first = nullptr;
  Pair pair;
};

/// Step 7 of accept_best(): two effects of the quantity and port of the chosen one that explain more between them than it does with any
/// other of these. What is the sum of two forms (dry friction and drag) often looks like a third (a cubic), which leaves little. Asked of
/// forces without memory only.
[[nodiscard]] std::optional<PairInstead> better_pair(std::vector<RankedCandidate>& ranked, RankedCandidate& single, HeldOut& held_out,
                                                     const SearchContext& context);

/// Why the first of a pair is accepted; `alone_gains_nothing`: RankedCandidate's.
[[nodiscard]] std::string in_words(const Pair& pair, bool alone_gains_nothing);

}  // namespace misfit
