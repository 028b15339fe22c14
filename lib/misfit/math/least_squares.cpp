#include "misfit/math/least_squares.h"

#include <ceres/ceres.h>
#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "misfit/core/lists.h"
#include "misfit/core/watch.h"

namespace misfit {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Ceres reports a failed linear solve through glog whatever its own logging options say; that it failed is in Summary::message.
void silence_glog() {
  static std::once_flag once;
  std::call_once(once, [] { FLAGS_minloglevel = google::GLOG_FATAL; });
}

bool all_finite(const double* values, std::size_t count) {
  return std::all_of(values, values + count, [](double v) { return std::isfinite(v); });
}

// A solve whose time is spent: from then on no point can be evaluated, and it ends with the best one at the end of its iteration. Only an
// interrupt goes through Ceres as an exception, which it survives with one thread: a line search would try twenty more points.
class Stop final : public ceres::IterationCallback {
 public:
  using Values = std::vector<std::vector<double>>;
  /// `present`: of all blocks, at the end of an iteration.
  explicit Stop(std::function<Values()> present) : present_(std::move(present)) {}

  [[nodiscard]] bool stopped() const { return !spent_.empty(); }

  template <class Action>
  bool unless_stopped(const Action& action) {
    if (stopped()) return false;
    try {
      return action();
    } catch (const TimeLimitReached& spent) {
      spent_ = spent.what();
    }
    return false;
  }

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    if (summary.step_is_successful) {
      cost_ = summary.cost;
      best_ = present_();
    }
    unless_stopped([&] {
      report_iteration(summary.iteration, "sum of squares", 2.0 * summary.cost);
      return true;
    });
    return stopped() ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }

  /// Values at the end of the last iteration that went down; after a failure Ceres leaves those of the start.
  [[nodiscard]] const Values& best() const { return best_; }

  void add_to(LeastSquares::Summary& summary) const {
    if (spent_.empty()) return;
    summary.out_of_time = true;
    summary.converged = false;
    summary.usable = std::isfinite(cost_);
    summary.cost = cost_;
    summary.message = spent_;
  }

 private:
  std::function<Values()> present_;
  double cost_ = std::numeric_limits<double>::quiet_NaN();
  Values best_;
  std::string spent_;
};

// Wraps an Evaluate whose sizes are known at run time only. A residual or derivative that is not finite is an evaluation failure.
class RuntimeCost final : public ceres::CostFunction {
 public:
  RuntimeCost(const LeastSquares::Evaluate& evaluate, int residuals, const std::vector<int>& block_sizes, Stop& stop)
      : evaluate_(&evaluate), stop_(&stop) {
    set_num_residuals(residuals);
    *mutable_parameter_block_sizes() = block_sizes;
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    if (!stop_->unless_stopped([&] { return (*evaluate_)(parameters, residuals, jacobians); })) return false;
    const std::size_t rows = num_residuals();
    if (!all_finite(residuals, rows)) return false;
    if (jacobians == nullptr) return true;
    for (std::size_t b = 0; b < parameter_block_sizes().size(); ++b) {
      const std::size_t columns = parameter_block_sizes()[b];
      if (jacobians[b] != nullptr && !all_finite(jacobians[b], rows * columns)) return false;
    }
    return true;
  }

 private:
  const LeastSquares::Evaluate* evaluate_;  // owned by LeastSquares, which outlives the solve
  Stop* stop_;                              // outlives it, too
};

std::unique_ptr<ceres::LossFunction> make_loss(const LeastSquares::Robust& robust) {
  const auto& [loss, scale] = robust;
  switch (loss) {
    case LeastSquares::Loss::none:
      return nullptr;
    case LeastSquares::Loss::huber:
      return std::make_unique<ceres::HuberLoss>(scale);
    case LeastSquares::Loss::cauchy:
      return std::make_unique<ceres::CauchyLoss>(scale);
    case LeastSquares::Loss::tukey:
      return std::make_unique<ceres::TukeyLoss>(scale);
  }
  return nullptr;
}

// QR keeps the digits that forming J'J loses, and costs nothing on small problems; on large ones J'J is twice as fast.
ceres::LinearSolverType choose_linear_solver(bool sparse, std::size_t residuals, std::size_t columns) {
  constexpr std::size_t small = 20000;  // entries of the Jacobian
  if (sparse) return ceres::SPARSE_NORMAL_CHOLESKY;
  return residuals * columns <= small ? ceres::DENSE_QR : ceres::DENSE_NORMAL_CHOLESKY;
}

ceres::Solver::Options to_ceres(const LeastSquares::Options& options, std::size_t residuals, std::size_t columns) {
  ceres::Solver::Options to;
  to.minimizer_type = ceres::TRUST_REGION;
  to.trust_region_strategy_type = ceres::LEVENBERG_MARQUARDT;
  to.max_num_iterations = options.max_iterations;
  to.function_tolerance = options.function_tolerance;
  to.gradient_tolerance = options.gradient_tolerance;
  to.parameter_tolerance = options.parameter_tolerance;
  to.initial_trust_region_radius = options.initial_radius;
  to.max_trust_region_radius = std::max(to.max_trust_region_radius, options.initial_radius);
  to.linear_solver_type = choose_linear_solver(options.sparse, residuals, columns);
  to.dense_linear_algebra_library_type = ceres::EIGEN;
  to.num_threads = 1;  // more than one changes the last digits
  to.logging_type = ceres::SILENT;
  to.minimizer_progress_to_stdout = false;
  return to;
}

/// Why Ceres stopped; its own words begin with the rule that it followed, and go on with numbers in its notation.
std::string in_words(const ceres::Solver::Summary& summary) {
  const auto begins = [&](const char* words) { return summary.message.starts_with(words); };
  if (begins("Function tolerance")) return "the sum of squares no longer changes";
  if (begins("Gradient tolerance")) return "the slope of the sum of squares is zero";
  if (begins("Parameter tolerance")) return "the parameters no longer change";
  if (begins("Minimum trust region radius")) return "no smaller step lowers the sum of squares";
  if (begins("Maximum number of iterations")) return "iteration limit: the sum of squares may still fall";
  if (summary.termination_type == ceres::CONVERGENCE) return "the sum of squares is at a minimum";
  if (summary.IsSolutionUsable()) return "no minimum of the sum of squares was reached";
  return summary.message.find("valuation failed") != std::string::npos ? "the model cannot be evaluated at the values to start from"
                                                                       : "no step lowers the sum of squares";
}

void describe(const ceres::Solver::Summary& summary, LeastSquares::Summary& result) {
  result.converged = summary.termination_type == ceres::CONVERGENCE;
  result.usable = summary.IsSolutionUsable();
  if (result.usable) result.cost = summary.final_cost;
  result.linearisations = std::max(0, summary.num_jacobian_evaluations);
  result.iterations = std::max(0, result.linearisations - 1);
  result.message = in_words(summary);
}

// With its bounds, or constant; how many free columns that makes.
template <class Block>
std::size_t add_to(ceres::Problem& problem, Block& block) {
  problem.AddParameterBlock(block.values.data(), int_size(block.values));
  if (block.fixed) {
    problem.SetParameterBlockConstant(block.values.data());
    return 0;
  }
  for (int i = 0; i < int_size(block.values); ++i) {
    if (block.lower[i] > -infinity) problem.SetParameterLowerBound(block.values.data(), i, block.lower[i]);
    if (block.upper[i] < infinity) problem.SetParameterUpperBound(block.values.data(), i, block.upper[i]);
  }
  return block.values.size();
}

// Why a block cannot be a start; empty if it can. Ceres would say it with addresses.
std::string infeasible(std::size_t number, const std::vector<double>& values, const std::vector<double>& lower,
                       const std::vector<double>& upper) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::ostringstream text;
    text << "block " << number << ", entry " << i << ": start " << values[i];
    if (!std::isfinite(values[i])) return text.str() + " is not finite";
    text << " is outside its bounds [" << lower[i] << ", " << upper[i] << "], or these are empty";
    if (!(lower[i] < upper[i]) || values[i] < lower[i] || values[i] > upper[i]) return text.str();
  }
  return {};
}

}  // namespace

int LeastSquares::add_block(std::vector<double> values, std::vector<double> lower, std::vector<double> upper) {
  if (values.empty()) throw std::invalid_argument("LeastSquares::add_block: an empty block");
  if (lower.empty()) lower.assign(values.size(), -infinity);
  if (upper.empty()) upper.assign(values.size(), infinity);
  if (lower.size() != values.size() || upper.size() != values.size()) {
    throw std::invalid_argument("LeastSquares::add_block: bounds and values differ in length");
  }
  blocks_.push_back({std::move(values), std::move(lower), std::move(upper), false});
  return int_size(blocks_) - 1;
}

void LeastSquares::fix_block(int block) { blocks_.at(block).fixed = true; }

void LeastSquares::add_residuals(std::vector<int> blocks, int residuals, Evaluate evaluate, const Robust& robust) {
  if (residuals < 1 || blocks.empty()) throw std::invalid_argument("LeastSquares::add_residuals: no residuals or no blocks");
  if (robust.loss != Loss::none && !(robust.scale > 0.0))
    throw std::invalid_argument("LeastSquares::add_residuals: the loss' width must be positive");
  for (const int b : blocks) static_cast<void>(blocks_.at(b));
  residuals_.push_back({std::move(blocks), residuals, std::move(evaluate), robust});
}

LeastSquares::Summary LeastSquares::solve(const Options& options) {
  silence_glog();
  Summary result;
  result.cost = std::numeric_limits<double>::quiet_NaN();
  const auto values = [this] {
    Stop::Values out;
    for (const Block& block : blocks_) out.push_back(block.values);
    return out;
  };
  const Stop::Values before = values();
  Stop stop(values);
  ceres::Problem problem;
  std::size_t columns = 0;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    Block& block = blocks_[b];
    if (!block.fixed) result.message = infeasible(b, block.values, block.lower, block.upper);
    if (!result.message.empty()) return result;
    columns += add_to(problem, block);
  }
  std::size_t rows = 0;
  for (const Residuals& term : residuals_) {
    std::vector<int> sizes;
    std::vector<double*> pointers;
    for (const int b : term.blocks) {
      Block& block = blocks_[b];
      sizes.push_back(int_size(block.values));
      pointers.push_back(block.values.data());
    }
    auto cost = std::make_unique<RuntimeCost>(term.evaluate, term.count, sizes, stop);
    problem.AddResidualBlock(cost.release(), make_loss(term.robust).release(), pointers);  // the problem owns both
    rows += term.count;
  }
  ceres::Solver::Summary summary;
  ceres::Solver::Options to = to_ceres(options, rows, columns);
  to.callbacks.push_back(&stop);
  to.update_state_every_iteration = true;
  ceres::Solve(to, &problem, &summary);
  describe(summary, result);
  stop.add_to(result);
  if (result.usable && !result.out_of_time) return result;
  const Stop::Values& end = result.usable ? stop.best() : before;
  for (std::size_t b = 0; b < blocks_.size(); ++b) blocks_[b].values = end[b];
  return result;
}

}  // namespace misfit
