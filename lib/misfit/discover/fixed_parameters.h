#pragma once

#include <optional>
#include <string>
#include <vector>

#include "misfit/diagnose/score.h"
#include "misfit/discover/refit.h"

namespace misfit {

/// A parameter of the system that the study fixes, and what these data say of it.
struct FixedParameter {
  std::string name, unit;
  double value = 0.0;                ///< as fixed [unit]
  double wanted = 0.0, sigma = 0.0;  ///< after one Gauss–Newton step, or freed [unit]
  double predicted_drop = 0.0;
  double p_value = 1.0;  ///< of its own test, or of the drop
  std::optional<double> actual_drop = {};
};

/// The score test of every number of the system that is fixed, alone (score.h): a model can lack nothing and have a wrong constant. Without
/// those that act on outputs alone (with the gains fixed their information is overestimated, candidate_model.cpp) and those that the free
/// parameters describe already. The most significant first.
[[nodiscard]] std::vector<FixedParameter> fixed_parameters(const FilterEstimate& estimate, const ScoreTest& score);

/// Frees it and estimates again: `wanted`, `sigma`, `actual_drop` and `p_value`, unless no maximum is reached. TimeLimitReached.
void free_and_refit(const RefitWork& work, FixedParameter& fixed);

/// The search for effects beside which they are looked at.
struct FixedSearch {
  double best_predicted = 0.0;  ///< what the score promises of the best effect; 0: none is significant
  double families = 1.0, p_accept = 0.01;
};

/// "k is fixed at 39 1/s^2, but these data ask for 40.00 ± 0.05 1/s^2 (drop 380, family-wise p = 1e-83): …": of those whose score
/// promises about as much as that of the best effect (at least 0.8 of it), or, where none is significant, that are so themselves. The first
/// of them is freed and estimated again; where its drop is then not significant it is left out, and the next one is the first.
/// TimeLimitReached.
[[nodiscard]] std::vector<std::string> fixed_parameters_in_words(const RefitWork& work, const ScoreTest& score, const FixedSearch& search);

}  // namespace misfit
