#pragma once

#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "misfit/data/signals.h"
#include "misfit/model/evaluator.h"
#include "misfit/sim/plan.h"
#include "misfit/sim/radau.h"

namespace misfit {

/// One sample interval: inputs at both ends, run between them as each input's Hold says.
struct Interval {
  double t0 = 0.0, t1 = 0.0;  ///< [s]
  InputsAt u0 = {}, u1 = {};
  std::span<const StepPart> parts = {};  ///< of a plan; empty: equal parts, rate of prepare() × part ≤ 0.5
  double rate = 0.0;                     ///< fastest rate for which `parts` were made [1/s]
};

/// rate × step at which explicit Runge–Kutta steps are made: above, it loses accuracy, then stability.
inline constexpr double kLargestProduct = 0.5;

/// The step map x⁺ = step(x, u, t, p) with Φ = ∂x⁺/∂x and Γ = ∂x⁺/∂p for touched columns: the primitive of output error, filter, smoother
/// and score test. Classical fourth-order Runge–Kutta, or Radau IIA where the plan says so; the sensitivities are those of the discrete map
/// itself (exact derivatives of what is computed). The parts of an interval are those of its plan. They are divided further only where the
/// fastest rate at the start of the trajectory has grown since the plan was made so far that rate × part > 1 (parameters that a search
/// tries). One object per thread.
class Stepper {
 public:
  /// Keeps a pointer to `model`, which must outlive it.
  explicit Stepper(const Model& model);
  Stepper(const Stepper&) = delete;
  Stepper& operator=(const Stepper&) = delete;
  Stepper(Stepper&&) = delete;
  Stepper& operator=(Stepper&&) = delete;
  ~Stepper() = default;

  [[nodiscard]] Evaluator& evaluator() { return evaluator_; }
  [[nodiscard]] int states() const { return n_; }

  /// To be called at the start of a trajectory and after parameters change. `planned`: rate there when the plan was made [1/s].
  void prepare(const double* x, const InputsAt& u, double t, double planned = std::numeric_limits<double>::infinity());
  [[nodiscard]] double fastest_rate() const { return fastest_rate_; }
  /// Of the equations linearised at x, a share into the interval: the largest |A_ii| and sqrt|A_ij A_ji| [1/s].
  [[nodiscard]] double linearised_rate(const double* x, const Interval& interval, double fraction);

  /// Where the last step that returned false left the finite numbers, in words: time, states, formula and parameters where the system can
  /// say.
  [[nodiscard]] const std::string& failure() const { return failure_; }

  /// Advances x in place. False if a state is no longer finite (x is then unspecified).
  [[nodiscard]] bool step(double* x, const Interval& interval);
  /// The same with derivatives: D has states() rows of kRowStride, [Φ | Γ(slots)]. `slots` is cleared first.
  [[nodiscard]] bool step_linear(double* x, const Interval& interval, Slots& slots, double* D);
  /// One step over a share of the interval. False if a state is no longer finite or the implicit step has no solution.
  [[nodiscard]] bool advance(double* x, const Interval& interval, double from, const StepPart& part);

 private:
  /// From where to where a step goes, as shares of its interval.
  struct Share {
    double from, to;
  };
  /// Of an explicit step of length h [s]: how many columns its rows have, and whether the evaluator left parameters as entries.
  struct Stage {
    double h;
    std::size_t number;
    int width;
    bool sparse;
  };
  template <class Advance>
  [[nodiscard]] bool for_each_part(const Interval& interval, const Advance& advance) const;
  [[nodiscard]] int pieces_of(const Interval& interval, double from, const StepPart& part) const;
  /// Inputs at a share of the interval: their values are in `u`.
  InputsAt inputs_at(const Interval& interval, double fraction, double* u) const;
  void explicit_step(double* x, const Interval& interval, const Share& share);
  void explicit_step_linear(double* x, const Interval& interval, const Share& share, const SlotRows& by);
  template <class Solve>
  [[nodiscard]] bool implicit_step(const Interval& interval, const Share& share, const Solve& solve);
  template <class Solve>
  [[nodiscard]] bool implicit_steps(const Interval& interval, const Share& share, const Solve& solve);
  [[nodiscard]] bool solve_implicitly(RadauStep& radau, double* x, double h, const RadauInputs& at) const;
  template <int N>
  void substep_linear(double* x, const Interval& interval, const Share& share, const SlotRows& by);
  template <int N>
  void advance_rows(const Stage& of, const double* X, double* next, double* D);

  Evaluator evaluator_;
  std::unique_ptr<RadauStep> radau_;
  struct Range {
    int state;
    double lower, upper;
  };
  void keep_in_range(double* x, double* D, int width) const;
  void note_failure(const double* x, const Interval& interval);
  [[nodiscard]] bool explain_step(const double* x, const Interval& interval, const Share& share);
  [[nodiscard]] bool finite(const double* x) const;

  int n_, nu_;
  std::vector<Range> ranges_;  ///< states that cannot leave them
  std::string failure_;
  double fastest_rate_ = 0.0, excess_ = 0.0;  ///< at the start of the trajectory; beyond that of the plan [1/s]
  std::vector<Hold> holds_;
  std::vector<double> L_, X_, Y_, sum_;  // rows of kRowStride
};

}  // namespace misfit
