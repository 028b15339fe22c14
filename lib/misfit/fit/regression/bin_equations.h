#pragma once

#include <optional>
#include <string>
#include <vector>

#include "misfit/data/signals.h"
#include "misfit/fit/regression/stencils.h"
#include "misfit/fit/regression/window_regression.h"
#include "misfit/inference/states.h"
#include "misfit/model/model.h"

namespace misfit {

/// The parts of a model with one equation of motion x'' = known + g_s C_static + g_d C_damping.
struct BinForm {
  Model model;              ///< a copy, whose two curves are constants over any level once all their coefficients are equal
  std::size_t output = 0;   ///< channel that shows the level
  int level = 0, rate = 1;  ///< states
  int quantity = 0;         ///< that both curves are functions of
  std::vector<int> static_coefficients, damping_coefficients;  ///< parameters
  std::vector<std::string> taken_as_known;                     ///< free parameters of other effects
};

/// nullopt with the reason in `why` where the model is not of that form.
[[nodiscard]] std::optional<BinForm> bin_form(const Model& model, const Signals& signals, std::string& why);

/// The measured level without held-out samples, averaged over three samples if asked, with its derivatives by stencils, as states; `ok`
/// from `signals.exclude` on.
[[nodiscard]] ReconstructedStates stencil_states(const BinForm& form, const Signals& signals, Stencils stencils, bool average);

/// One equation per sample with known states: acceleration less the right-hand side with both curves zero, and what one unit of either adds
/// to it. Assumes that the right-hand side is linear in both curves (they are strengths).
[[nodiscard]] std::vector<BinEquation> bin_equations(const BinForm& form, const Signals& signals, const ReconstructedStates& states);

}  // namespace misfit
