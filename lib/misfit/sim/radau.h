#pragma once

// References
//   [HW] E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, 2nd ed. (1996), IV.5, IV.8: Radau IIA.

#include <array>
#include <vector>

#include "misfit/model/evaluator.h"

namespace misfit {

/// Time and inputs at the three stages of a step.
struct RadauInputs {
  std::array<double, 3> t{};
  std::array<InputsAt, 3> u{};  ///< of `values`
  std::array<std::array<double, kMaxInputs>, 3> values{};
};

/// One step of Radau IIA with three stages [HW]: implicit, order 5 (stiff systems: not less than 3), L-stable. For parts of an interval on
/// which an explicit step would have to be short for stability alone. Its stages Y_i = x + h Σ a_ij f(Y_j) are solved by Newton's iteration
/// with the evaluator's exact Jacobian; x⁺ = Y_3. Derivatives of the step by the implicit function theorem: (I − h a ⊗ A) ∂Y = ∂x + h a B,
/// exact derivatives of what is computed. Holds its memory, so that no step allocates.
class RadauStep {
 public:
  static constexpr std::array<double, 3> stage_at = {0.15505102572168219, 0.64494897427831781, 1.0};  // (4 ∓ √6)/10, 1

  /// Keeps a pointer to `evaluator`, which must outlive it.
  explicit RadauStep(Evaluator& evaluator);

  /// Advances x by h. False if Newton's iteration does not converge: x is as before.
  [[nodiscard]] bool step(double* x, double h, const RadauInputs& at);
  /// The same with derivatives, which are advanced with x. New slots may be added.
  [[nodiscard]] bool step_linear(double* x, double h, const RadauInputs& at, const SlotRows& by);

 private:
  [[nodiscard]] bool solve_stages(const double* x, double h, const RadauInputs& at);
  void linearise_stage(std::size_t stage, const RadauInputs& at, Slots& slots);
  void fill_matrix(double h);
  [[nodiscard]] bool factorise();
  void solve(int width, int row_length, double* rows) const;
  void take_derivatives(double h, int width, double* D);

  static constexpr std::size_t kMost = std::size_t{3} * kMaxStates;
  Evaluator* evaluator_;
  std::size_t n_, N_;  ///< states; unknowns of the stages
  std::array<double, kMost> Y_{}, f_{}, scale_{};
  std::array<double, kMost * kMost> lu_{};
  std::array<std::size_t, kMost> row_{};  ///< of the matrix, in the order of its factors
  std::vector<double> L_, rows_;          ///< N_ rows of kRowStride: linearised rates of the stages; right-hand sides, ∂Y
  Slots own_;
};

}  // namespace misfit
