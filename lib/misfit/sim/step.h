#pragma once

#include <string>
#include <vector>

#include "misfit/data/signals.h"
#include "misfit/model/evaluator.h"

namespace misfit {

/// One sample interval: inputs at both ends, run between them as each input's Hold says.
struct Interval {
  double t0 = 0.0, t1 = 0.0;  ///< [s]
  const double* u0 = nullptr;
  const double* u1 = nullptr;
};

/// The step map x⁺ = step(x, u, t, p) with Φ = ∂x⁺/∂x and Γ = ∂x⁺/∂p for touched columns: the primitive of output error, filter, smoother
/// and score test. Classical fourth-order Runge–Kutta; the sensitivities are those of the discrete map itself (exact derivatives of what is
/// computed). Sub-steps so that fastest rate × step < 0.5; the rate is taken once per trajectory, in prepare(). One object per thread.
class Stepper {
 public:
  /// Keeps a pointer to `model`, which must outlive it.
  explicit Stepper(const Model& model);

  [[nodiscard]] Evaluator& evaluator() { return evaluator_; }
  [[nodiscard]] int states() const { return n_; }

  /// To be called at the start of a trajectory and after parameters change.
  void prepare(const double* x, const double* u, double t);
  [[nodiscard]] double fastest_rate() const { return fastest_rate_; }

  /// Where the last step that returned false left the finite numbers, in words: time, states, formula and parameters where the system can
  /// say.
  [[nodiscard]] const std::string& failure() const { return failure_; }

  /// Advances x in place. False if a state is no longer finite (x is then unspecified).
  [[nodiscard]] bool step(double* x, const Interval& interval);
  /// The same with derivatives: D has states() rows of kRowStride, [Φ | Γ(slots)]. `slots` is cleared first.
  [[nodiscard]] bool step_linear(double* x, const Interval& interval, Slots& slots, double* D);

 private:
  [[nodiscard]] int substeps(double h) const;
  void inputs_at(const Interval& interval, double fraction, double* u) const;
  template <int N>
  void substep_linear(double* x, const Interval& interval, double from, double to, Slots& slots, double* D);
  template <int N>
  void advance_rows(double h, std::size_t stage, int width, bool sparse, const double* X, double* next, double* D);

  Evaluator evaluator_;
  struct Range {
    int state;
    double lower, upper;
  };
  void keep_in_range(double* x, double* D, int width) const;
  void note_failure(const double* x, const Interval& interval);
  [[nodiscard]] bool finite(const double* x) const;

  int n_, nu_;
  std::vector<Range> ranges_;  ///< states that cannot leave them
  std::string failure_;
  double fastest_rate_ = 0.0;
  std::vector<bool> zero_order_;
  std::vector<double> L_, X_, Y_, sum_;  // rows of kRowStride
};

}  // namespace misfit
