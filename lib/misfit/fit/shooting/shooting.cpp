#include "misfit/fit/shooting/shooting.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "misfit/core/text.h"

namespace misfit {

Shooting::Shooting(Model model, const std::vector<Signals>& experiments, std::vector<double> sigma, std::vector<double> state_scale,
                   std::vector<RowMatrix> start_states)
    : model_(std::move(model)),
      experiments_(experiments),
      sigma_(std::move(sigma)),
      state_scale_(std::move(state_scale)),
      history_(std::move(start_states)),
      free_(model_.free_parameters()),
      values_(model_.values()),
      stepper_(std::make_unique<Stepper>(model_)) {
  for (const auto& experiment : experiments) inputs_.push_back(input_table(experiment, model_.inputs()));
  for (std::size_t e = 0; e < history_.size(); ++e) {
    RowMatrix& history = history_[e];
    for (std::size_t j = 0; j < model_.state_specs.size(); ++j) {
      const StateSpec& state = model_.state_specs[j];
      auto column = history.col(static_cast<Eigen::Index>(j)).array();
      column = column.max(state.lower).min(state.upper);
      if (state.initial == Initial::fixed && !experiments_[e].after_gap && history.rows() > 0)
        history(0, static_cast<Eigen::Index>(j)) = state.start;
    }
  }
  for (std::size_t e = 0; e < experiments_.size(); ++e) {
    read_start_.push_back(initial_state(e));
    bool any = false;
    for (std::size_t i = 0; i < experiments_[e].samples() && !any; ++i) {
      for (std::size_t o = 0; o < static_cast<std::size_t>(model_.outputs()); ++o) any = any || counts(e, i, o);
    }
    held_out_.push_back(!any);
  }
}

bool Shooting::counts(std::size_t experiment, std::size_t i, std::size_t o) const {
  const Signals& s = experiments_[experiment];
  return i >= s.exclude && !s.held_out(i) && o < s.measured.size() && std::isfinite(s.measured[o].values[i]);
}

void Shooting::set_theta(const double* theta) {
  for (std::size_t c = 0; c < free_.size(); ++c) values_[static_cast<std::size_t>(free_[c])] = theta[c];
  stepper_->evaluator().set_parameters(values_.data());
}

void Shooting::set_present_theta() {
  std::vector<double> theta;
  for (int index : free_) theta.push_back(model_.parameters[static_cast<std::size_t>(index)].value);
  set_theta(theta.data());
}

void Shooting::plan(double tolerance) {
  set_present_theta();
  for (std::size_t e = 0; e < inputs_.size(); ++e)
    inputs_[e].plan = plan_along(*stepper_, experiments_[e], inputs_[e], history_[e], tolerance);
}

Eigen::VectorXd Shooting::move_by(const Eigen::VectorXd& step) {
  Eigen::VectorXd made = step;
  const Eigen::Index n = model_.states();
  Eigen::Index at = 0;
  for (int index : free_) {
    Parameter& p = model_.parameters[static_cast<std::size_t>(index)];
    const double before = p.value;
    p.value = p.curve >= 0 ? before + step[at] : std::clamp(before + step[at], p.lower, p.upper);
    made[at++] = p.value - before;
  }
  for (RowMatrix& history : history_) {
    history.row(0) += step.segment(at, n).transpose();
    at += n;
  }
  return made;
}

std::vector<Shooting::Piece> Shooting::cut(std::size_t length) const {
  std::vector<Piece> pieces;
  for (std::size_t e = 0; e < experiments_.size(); ++e) {
    const std::size_t samples = experiments_[e].samples();
    const std::size_t parts = length == 0 ? 1 : std::max<std::size_t>(1, samples / length);
    for (std::size_t k = 0; k < parts; ++k) {
      Piece piece{e, samples * k / parts, samples * (k + 1) / parts};
      pieces.push_back(std::move(piece));
    }
  }
  return pieces;
}

/// Measurement rows: (predicted − measured)/sigma; zero where a sample does not count.
void Shooting::fill_rows(const Piece& piece, double* r, double** J) const {
  const Segment& s = piece.segment;
  const auto ny = static_cast<std::size_t>(s.y.cols());
  const auto columns = static_cast<Eigen::Index>(free_.size());
  const Eigen::Index n = model_.states();
  const Signals& signals = experiments_[piece.experiment];
  for (std::size_t i = piece.first; i < piece.last; ++i) {
    for (std::size_t o = 0; o < ny; ++o) {
      const std::size_t row = (i - piece.first) * ny + o;
      const auto at = static_cast<Eigen::Index>(row);
      const bool used = counts(piece.experiment, i, o);
      const double weight = used ? 1.0 / sigma_[o] : 0.0;
      r[row] =
          used ? (s.y(static_cast<Eigen::Index>(i - piece.first), static_cast<Eigen::Index>(o)) - signals.measured[o].values[i]) * weight
               : 0.0;
      if (J == nullptr) continue;
      if (J[0] != nullptr) Eigen::Map<Eigen::RowVectorXd>(J[0] + row * free_.size(), columns) = weight * s.y_rows.row(at).head(columns);
      if (J[1] != nullptr) Eigen::Map<Eigen::RowVectorXd>(J[1] + row * static_cast<std::size_t>(n), n) = weight * s.y_rows.row(at).tail(n);
    }
  }
}

bool Shooting::evaluate(Piece& piece, double defect_weight, const double* const* blocks, double* r, double** J) {
  set_theta(blocks[0]);
  Segment& s = piece.segment;
  run_segment(*stepper_, experiments_[piece.experiment], inputs_[piece.experiment], piece.first, piece.last, blocks[1], J != nullptr, s);
  if (!s.finite) {
    note_failure(s, piece.experiment);
    return false;
  }
  fill_rows(piece, r, J);
  if (piece.next < 0) return true;
  const int n = model_.states();
  const auto first = static_cast<std::size_t>(s.y.size());
  if (J != nullptr && J[2] != nullptr) std::fill_n(J[2], (first + static_cast<std::size_t>(n)) * static_cast<std::size_t>(n), 0.0);
  for (int j = 0; j < n; ++j) {
    const double weight = defect_weight / state_scale_[static_cast<std::size_t>(j)];
    const std::size_t row = first + static_cast<std::size_t>(j);
    r[row] = weight * (s.end[j] - blocks[2][j]);
    if (J == nullptr) continue;
    if (J[0] != nullptr)
      Eigen::Map<Eigen::RowVectorXd>(J[0] + row * free_.size(), static_cast<Eigen::Index>(free_.size())) =
          weight * s.end_rows.row(j).head(static_cast<Eigen::Index>(free_.size()));
    if (J[1] != nullptr) Eigen::Map<Eigen::RowVectorXd>(J[1] + row * static_cast<std::size_t>(n), n) = weight * s.end_rows.row(j).tail(n);
    if (J[2] != nullptr) J[2][row * static_cast<std::size_t>(n) + static_cast<std::size_t>(j)] = -weight;
  }
  return true;
}

void Shooting::note_failure(const Segment& segment, std::size_t experiment) {
  failure_ = "simulation diverged (non-finite state) at t = " + format_value(experiments_[experiment].t[segment.failed_at]) + " s of '" +
             experiments_[experiment].name + "'";
  if (!stepper_->failure().empty()) failure_ += " (" + stepper_->failure() + ")";
}

void Shooting::add_priors(LeastSquares& problem, int theta_block, const std::vector<Penalty>& penalties) const {
  for (const auto& penalty : penalties) {
    const Eigen::MatrixXd L = penalty_rows(penalty);
    const auto columns = free_.size();
    problem.add_residuals({theta_block}, static_cast<int>(L.rows()),
                          [L, first = penalty.first, columns](const double* const* blocks, double* r, double** J) {
                            const auto rows = L.rows();
                            Eigen::Map<Eigen::VectorXd>(r, rows) = L * Eigen::Map<const Eigen::VectorXd>(blocks[0] + first, L.cols());
                            if (J == nullptr || J[0] == nullptr) return true;
                            Eigen::Map<RowMatrix> jacobian(J[0], rows, static_cast<Eigen::Index>(columns));
                            jacobian.setZero();
                            jacobian.middleCols(first, L.cols()) = L;
                            return true;
                          });
  }
  for (std::size_t c = 0; c < free_.size(); ++c) {
    const Parameter& p = model_.parameters[static_cast<std::size_t>(free_[c])];
    if (!p.prior_sigma || p.curve >= 0) continue;
    const double mean = p.prior_mean, weight = 1.0 / *p.prior_sigma;
    const auto columns = free_.size();
    problem.add_residuals({theta_block}, 1, [c, mean, weight, columns](const double* const* blocks, double* r, double** J) {
      r[0] = weight * (blocks[0][c] - mean);
      if (J == nullptr || J[0] == nullptr) return true;
      std::fill_n(J[0], columns, 0.0);
      J[0][c] = weight;
      return true;
    });
  }
}

namespace {

int add_parameters(LeastSquares& problem, const Model& model, const std::vector<int>& free) {
  constexpr double infinite = std::numeric_limits<double>::infinity(), beyond = 1e300;
  std::vector<double> theta, lower, upper;
  bool bounded = false;
  for (int index : free) {
    const Parameter& p = model.parameters[static_cast<std::size_t>(index)];
    theta.push_back(p.value);
    // Bounds of curve coefficients would bind combinations that mean nothing: roughness holds them.
    // Where there are bounds the solver searches along every step (Armijo), which keeps it from leaping into a far valley where a parameter
    // no longer acts: what has none gets bounds beyond all numbers that a formula can use.
    lower.push_back(p.curve >= 0 ? -infinite : std::max(p.lower, -beyond));
    upper.push_back(p.curve >= 0 ? infinite : std::min(p.upper, beyond));
    bounded = bounded || p.curve < 0;
  }
  return bounded ? problem.add_block(theta, lower, upper) : problem.add_block(theta);
}

/// Bounds within which the states of a system are kept.
struct StateBounds {
  std::vector<double> least, most;
  bool any = false;

  explicit StateBounds(const Model& model)
      : least(static_cast<std::size_t>(model.states()), -std::numeric_limits<double>::infinity()),
        most(least.size(), std::numeric_limits<double>::infinity()) {
    for (std::size_t j = 0; j < model.state_specs.size(); ++j) {
      least[j] = model.state_specs[j].lower;
      most[j] = model.state_specs[j].upper;
      any = any || std::isfinite(least[j]) || std::isfinite(most[j]);
    }
  }
};

}  // namespace

LeastSquares::Summary Shooting::solve(const ShootingPass& pass, const std::vector<Penalty>& penalties) {
  failure_.clear();
  if (inputs_.front().plan.first.empty()) plan(kSearchTolerance);
  LeastSquares problem;
  const int theta_block = add_parameters(problem, model_, free_);
  std::vector<Piece> pieces = cut(pass.length);
  const StateBounds bounds(model_);
  for (auto& piece : pieces) {
    const auto start = history_[piece.experiment].row(static_cast<Eigen::Index>(piece.first));
    piece.block = bounds.any ? problem.add_block({start.begin(), start.end()}, bounds.least, bounds.most)
                             : problem.add_block({start.begin(), start.end()});
  }
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    Piece& piece = pieces[k];
    if (k + 1 < pieces.size() && pieces[k + 1].experiment == piece.experiment) piece.next = pieces[k + 1].block;
    std::vector<int> blocks{theta_block, piece.block};
    if (piece.next >= 0) blocks.push_back(piece.next);
    const int residuals =
        static_cast<int>((piece.last - piece.first) * static_cast<std::size_t>(model_.outputs())) + (piece.next >= 0 ? model_.states() : 0);
    problem.add_residuals(blocks, residuals, [this, &piece, weight = pass.defect_weight](const double* const* x, double* r, double** J) {
      return evaluate(piece, weight, x, r, J);
    });
  }
  add_initial(problem, pieces);
  add_priors(problem, theta_block, penalties);
  LeastSquares::Options options;
  options.max_iterations = pass.max_iterations;
  options.function_tolerance = pass.tolerance;
  options.initial_radius = pass.initial_radius;
  options.sparse = pieces.size() > 4;
  LeastSquares::Summary summary = problem.solve(options);
  linearisations_ += summary.linearisations;
  if (!summary.usable) return summary;
  const std::vector<double>& solved = problem.block(theta_block);
  for (std::size_t c = 0; c < free_.size(); ++c) model_.parameters[static_cast<std::size_t>(free_[c])].value = solved[c];
  set_theta(solved.data());
  remember(pieces, problem);
  return summary;
}

void Shooting::remember(std::vector<Piece>& pieces, const LeastSquares& problem) {
  for (const auto& piece : pieces) {
    const RowMatrix states = run_states(*stepper_, experiments_[piece.experiment], inputs_[piece.experiment], piece.first, piece.last,
                                        problem.block(piece.block).data());
    history_[piece.experiment].middleRows(static_cast<Eigen::Index>(piece.first), states.rows()) = states;
  }
}

void Shooting::restore(const State& state) {
  model_.parameters = state.parameters;
  history_ = state.history;
}

std::vector<RowMatrix> Shooting::predict_segments() {
  set_present_theta();
  std::vector<RowMatrix> out;
  std::vector<double> y(static_cast<std::size_t>(model_.outputs()) + 1);
  for (std::size_t e = 0; e < experiments_.size(); ++e) {
    out.emplace_back(history_[e].rows(), model_.outputs());
    for (Eigen::Index i = 0; i < history_[e].rows(); ++i) {
      const auto sample = static_cast<std::size_t>(i);
      const bool known = predict_at(*stepper_, experiments_[e], inputs_[e], sample, history_[e].row(i).data(), y.data());
      if (!known) std::fill(y.begin(), y.end(), std::nan(""));
      for (Eigen::Index o = 0; o < out[e].cols(); ++o) out[e](i, o) = y[static_cast<std::size_t>(o)];
    }
  }
  return out;
}

std::vector<Segment> Shooting::run(bool sensitivities) {
  std::vector<Segment> out(experiments_.size());
  set_present_theta();
  for (std::size_t e = 0; e < experiments_.size(); ++e) {
    const Eigen::VectorXd x0 = initial_state(e);
    run_segment(*stepper_, experiments_[e], inputs_[e], 0, experiments_[e].samples(), x0.data(), sensitivities, out[e]);
    if (!out[e].finite) note_failure(out[e], e);
  }
  return out;
}

}  // namespace misfit
