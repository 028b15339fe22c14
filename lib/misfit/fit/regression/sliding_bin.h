#pragma once

// References
//   [P]  Parachute Aerodynamics from Video Data ("the paper"; lib/misfit/README.md, [1]): Eqs. 8-11, "Sliding Window Matrix Solution".
//   [MK] E. A. Morelli, V. Klein, J. Guidance 20 (1997).

#include "misfit/data/bin_size.h"
#include "misfit/data/fit.h"
#include "misfit/data/signals.h"
#include "misfit/fit/regression/stencils.h"
#include "misfit/model/model.h"

namespace misfit {

struct SlidingBinOptions {
  double width = BinSize{}.width;    ///< of a bin [unit of the level, rad for angles]
  double step = BinSize{}.step;      ///< by which it slides [unit of the level]
  std::size_t minimum_samples = 30;  ///< bins with fewer are left out and counted; at least 4
  bool three_point_average = true;   ///< average the channel over three samples first, as [P] did; false where it is averaged already
  bool curves_only = false;          ///< curves and trim with white sigmas, no warnings or facts: for thousands of fits
  std::optional<bool> driven = {};   ///< is the motion driven: the result of equation_error(); absent: from the residuals of the bins
  Stencils stencils = Stencils::second_order_four_point;  ///< "second order ... (four-point stencils)" [P]; the other interpretation is
                                                          ///< run too, its differences are in facts["stencils"]
};

/// The paper's method, to the letter [P]: rate and acceleration of the measured level by finite differences; in bins that slide over the
/// level, least squares of acceleration − known part on static line and damping, C = C_slope x + C_0 (Eq. 11); the result stands at the
/// mean level of the bin.
///
/// `model`: one equation of motion x'' = known + g_s C_static(level) + g_d C_damping(level) whose level is measured (the system's
/// regression form; SystemSpec::static_curve and damping_curve, of one quantity). Gains and known part come from evaluating it: effects
/// other than the two curves are taken as known at their present parameter values (a warning names what was free). The curves' own knots
/// and coefficients are not used. The induced angle is in the damping: this is C_m_alphadot, not C_mq.
///
/// `signals`: one experiment. Held-out samples are not touched, not even by stencils; the first `exclude` give no equation.
///
/// Gives Fit.curves (static, damping: x = mean level, count = samples of the bin), trim, noise["equation_residual"], the damping over all
/// data as parameters["NAME_all_data"], and in facts: telescoped_sum, all_data, bins, stencils, average, whiteness. Nothing is predicted.
///
/// Sigmas: residual variance of the bin and the correlation of residuals in time [MK], to the reach of average and stencil (six samples),
/// for driven motion to half a period; right to 15 % against the scatter over 100 draws of noise on the validation motion, but never below
/// 0.3 of the white one (all data: too wide by ten). They know nothing of biases: bins and the average flatten what bends or jumps; noise
/// of a level is also in its own acceleration (fourth_order: −2.5/h² of it), so that C_static errs where the density of levels changes
/// fast, at the turning points.
///
/// On any stationary motion Σ x'' x' = Σ (x'²/2)' telescopes: the acceleration adds nothing to the damping over all data, whatever
/// the truth; what stands there is what the known terms (gravity, coning) add (facts["all_data"] gives both). Where the motion is driven
/// (driven.h) and that sum is within 2 sigma of 0 (from the scatter of its periods; of less than two it is not distinguished from 0),
/// damping is marked not informative, and also where the equation leaves more than a fifth of the averaged acceleration, or that is not
/// known. A deterministic limit cycle telescopes as well, but there Eq. 8 holds at every sample and bins are right (the paper's
/// validation): they stay informative, and a warning says that the average over all data says nothing.
///
/// Declines (status, message) where the model has no such form, too few samples are usable or the level does not move. InputError for
/// widths, steps or counts that make no sense.
[[nodiscard]] Fit sliding_bin(const Model& model, const Signals& signals, const SlidingBinOptions& options = {});

}  // namespace misfit
