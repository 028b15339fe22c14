#pragma once

#include <functional>
#include <string>
#include <vector>

namespace misfit {

/// Nonlinear least squares, min ½ Σ ρ_k(|r_k|²) over parameter blocks, solved by Ceres (one thread, logging silenced). The only
/// file that includes ceres/ceres.h is least_squares.cpp: calibrate and the fits share it.
class LeastSquares {
 public:
  /// r: `residuals` values; J[b], if J and J[b] are not null: row-major residuals × size of block b. Returns false where the model cannot
  /// be evaluated (the step is then shortened). Must not throw, but for Stopped.
  using Evaluate = std::function<bool(const double* const* blocks, double* r, double** J)>;

  enum class Loss { none, huber, cauchy, tukey };
  struct Robust {
    Loss loss = Loss::none;
    double scale = 1.0;  ///< the loss' width in units of the residual
  };

  /// Adds a block and returns its number. Bounds are ±infinity where absent. `values` is the start, `solution()` the end.
  int add_block(std::vector<double> values, std::vector<double> lower = {}, std::vector<double> upper = {});
  /// Fixes a block at its start.
  void fix_block(int block);
  /// `residuals` ≥ 1.
  void add_residuals(std::vector<int> blocks, int residuals, Evaluate evaluate, const Robust& robust = {Loss::none, 1.0});

  struct Options {
    int max_iterations = 50;
    double function_tolerance = 1e-8;
    double gradient_tolerance = 1e-12;
    double parameter_tolerance = 1e-10;
    double initial_radius = 1e4;  ///< of the trust region (Levenberg–Marquardt); 1e8 and more: nearly Gauss–Newton
    bool sparse = false;          ///< many blocks with few neighbours (multiple shooting)
  };
  struct Summary {
    bool converged = false;  ///< a tolerance was met; false: iteration limit, failure
    bool usable = false;     ///< the solution is at least no worse than the start
    std::string message;     ///< why it stopped: "the sum of squares no longer changes"
    double cost = 0.0;       ///< ½ Σ ρ
    int iterations = 0;      ///< linearisations after the first
    int linearisations = 0;
    bool out_of_time =
        false;  ///< a limit of time was spent (TimeLimitReached, whose words are the message): the blocks are the best so far
  };
  /// Throws Interrupted.
  [[nodiscard]] Summary solve(const Options& options);
  [[nodiscard]] const std::vector<double>& block(int number) const { return blocks_[number].values; }

 private:
  struct Block {
    std::vector<double> values, lower, upper;
    bool fixed = false;
  };
  struct Residuals {
    std::vector<int> blocks;
    int count = 0;
    Evaluate evaluate;
    Robust robust;
  };
  std::vector<Block> blocks_;
  std::vector<Residuals> residuals_;
};

}  // namespace misfit
