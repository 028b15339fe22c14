#pragma once

#include <string>
#include <vector>

#include "misfit/data/fit.h"
#include "misfit/data/uncertainty.h"
#include "misfit/uncertainty/monte_carlo.h"

namespace misfit {

/// The numbers of a fit whose spread over the runs is wanted: trim, slope of the static curve there, other curves there, parameters that
/// are no curve's coefficients; then the curves at the places of the nominal fit (between the first and the last that samples stand
/// behind).
class QuantitiesOfInterest {
 public:
  /// `nominal`: the study's fit, with its sigmas; `run`: what one run gives of it.
  QuantitiesOfInterest(const Fit& nominal, const Fit& run, std::string static_curve);

  /// Behind them stands 1 if the fit had not converged, else 0.
  [[nodiscard]] std::vector<double> evaluate(const Fit& fit) const;
  /// The first so many are scalars, not points of curves.
  [[nodiscard]] std::size_t scalars() const { return numbers_.size(); }
  /// Numbers and curves with what the runs gave.
  void fill(const MonteCarloResult& result, const std::vector<std::string>& terms, Uncertainty& out) const;

 private:
  [[nodiscard]] std::vector<double> scalars_of(const Fit& fit) const;
  std::string static_curve_;
  std::vector<SpreadNumber> numbers_;
  std::vector<SpreadCurve> curves_;
};

/// Fits that stopped short of their maximum stay in, and are named here: the nominal one, and how many runs (of numbers as evaluate() gives
/// them).
[[nodiscard]] std::vector<std::string> unfinished_notes(const Fit& nominal, const MonteCarloResult& runs);

}  // namespace misfit
