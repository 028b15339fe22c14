#pragma once

#include <string>
#include <vector>

#include "misfit/data/fit.h"
#include "misfit/data/ladder.h"
#include "misfit/data/verdict.h"

namespace misfit {

/// RMS errors of a fit and its random force. With a random force the model is corrected at each measurement: the error is that of the next
/// one.
[[nodiscard]] std::vector<ErrorChange> errors_of(const Fit& fit);

/// "not distinguishable from 0": of a random force whose sigma could not be estimated; else empty.
[[nodiscard]] std::string not_distinguishable(const Estimate& force);

/// Errors at the farthest horizon and random force of two rungs, what tells most first. `fit`: of which the sampling gives the horizon its
/// time; nullptr: none.
[[nodiscard]] std::vector<ErrorChange> errors_between(const Rung& first, const Rung& last, const Fit* fit);

/// A change that stands for itself: beyond its sigma, or a clear fall where no sigma is known.
[[nodiscard]] bool is_telling(const ErrorChange& change);

/// A rise by a fifth or more, beyond its sigma where that is known.
[[nodiscard]] bool clearly_rises(const ErrorChange& change);

/// The drop of what a rung added is no more than chance gives for so many parameters. False where no likelihood compares it with the model
/// before.
[[nodiscard]] bool explains_no_more_than_chance(const Rung& rung);

/// "the RMS error of w falls from 8 V to 1.2 V (−85 %)".
[[nodiscard]] std::string change_in_words(const ErrorChange& change);

/// "31.2 ± 1.2 N m to 27.56 ± 0.90 N m (−12 %)": of a change, or the value alone; its remark.
[[nodiscard]] std::string shown(const ErrorChange& change);

}  // namespace misfit
