#pragma once

#include <random>
#include <vector>

#include "misfit/sim/trajectory.h"

namespace misfit {

/// Whether some effect of the model has a random own state (gusts, jitter) that is excited at this state.
[[nodiscard]] bool has_random_states(Evaluator& evaluator, const double* x, const InputsAt& u, double t);

/// A realisation of a model with random own states, dz = drift dt + diffusion dW, over all samples of `signals`; y and finite are filled.
/// Each interval is cut so that fastest rate × step < 0.1, and each part is stepped as: half of the noise, deterministic step map, half of
/// the noise (Strang splitting; weak order two for noise that does not depend on the state). The stationary variance of an
/// Ornstein–Uhlenbeck process is then x coth(x) ≤ 1.0034 times the true one (x = step/tau). Noise intensities are taken at the start of
/// each interval. The state starts at x0 as given: gusts from 0 need some time constants to reach their size.
/// `further`: noise intensity added to that of each own state [unit/sqrt(s)] (in squares); empty: none. For a random force whose noise the
/// model does not carry itself.
void run_randomly(const Simulation& simulation, const double* x0, std::mt19937_64& random, Segment& out,
                  const std::vector<double>& further = {});

}  // namespace misfit
