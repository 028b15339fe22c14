#include "misfit/fit/shooting/shooting.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "misfit/core/text.h"
#include "misfit/core/watch.h"

namespace misfit {

Shooting::Shooting(Model model, const std::vector<Signals>& experiments, ShootingScales scales, std::vector<RowMatrix> start_states)
    : model_(std::move(model)),
      experiments_(experiments),
      sigma_(std::move(scales.sigma)),
      state_scale_(std::move(scales.state_scale)),
      history_(std::move(start_states)),
      free_(model_.free_parameters()),
      values_(model_.values()),
      stepper_(std::make_unique<Stepper>(model_)) {
  for (const auto& experiment : experiments) inputs_.push_back(input_table(experiment, model_));
  for (std::size_t e = 0; e < history_.size(); ++e) {
    RowMatrix& history = history_[e];
    for (std::size_t j = 0; j < model_.state_specs.size(); ++j) {
      const StateSpec& state = model_.state_specs[j];
      auto column = history.col(j).array();
      column = column.max(state.lower).min(state.upper);
      if (state.initial == Initial::fixed && !experiments_[e].after_gap && history.rows() > 0) history(0, j) = state.start;
    }
  }
  for (std::size_t e = 0; e < experiments_.size(); ++e) {
    read_start_.push_back(initial_state(e));
    bool any = false;
    for (std::size_t i = 0; i < experiments_[e].samples() && !any; ++i) {
      for (std::size_t o = 0; o < static_cast<std::size_t>(model_.outputs()); ++o) any = any || counts(e, i, o);
    }
    held_out_.push_back(!any);
    if (any && !experiments_[e].after_gap && !shared_with_) shared_with_ = e;
  }
}

bool Shooting::counts(std::size_t experiment, std::size_t i, std::size_t o) const {
  const Signals& s = experiments_[experiment];
  return i >= s.exclude && !s.held_out(i) && o < s.measured.size() && std::isfinite(s.measured[o].values[i]);
}

void Shooting::set_theta(const double* theta) {
  for (std::size_t c = 0; c < free_.size(); ++c) values_[free_[c]] = theta[c];
  stepper_->evaluator().set_parameters(values_.data());
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
  const std::size_t ny = s.y.cols();
  const Eigen::Index columns = free_.size();
  const Eigen::Index n = model_.states();
  const Signals& signals = experiments_[piece.experiment];
  for (std::size_t i = piece.first; i < piece.last; ++i) {
    for (std::size_t o = 0; o < ny; ++o) {
      const std::size_t row = (i - piece.first) * ny + o;
      const Eigen::Index at = row;
      const bool used = counts(piece.experiment, i, o);
      const double weight = used ? 1.0 / sigma_[o] : 0.0;
      r[row] = used ? (s.y(i - piece.first, o) - signals.measured[o].values[i]) * weight : 0.0;
      if (J == nullptr) continue;
      if (J[0] != nullptr) Eigen::Map<Eigen::RowVectorXd>(J[0] + row * free_.size(), columns) = weight * s.y_rows.row(at).head(columns);
      if (J[1] != nullptr) Eigen::Map<Eigen::RowVectorXd>(J[1] + row * n, n) = weight * s.y_rows.row(at).tail(n);
    }
  }
}

bool Shooting::evaluate(Piece& piece, const double* const* blocks, double* r, double** J) {
  set_theta(blocks[0]);
  Segment& s = piece.segment;
  run_segment({*stepper_, experiments_[piece.experiment], inputs_[piece.experiment]}, {piece.first, piece.last, blocks[1], J != nullptr},
              s);
  if (!s.finite) {
    note_failure(s, piece.experiment);
    return false;
  }
  fill_rows(piece, r, J);
  if (piece.next < 0) return true;
  const int n = model_.states();
  const std::size_t first = s.y.size();
  if (J != nullptr && J[2] != nullptr) std::fill_n(J[2], (first + n) * n, 0.0);
  for (int j = 0; j < n; ++j) {
    const double weight = piece.defect_weight / state_scale_[j];
    const std::size_t row = first + j;
    r[row] = weight * (s.end[j] - blocks[2][j]);
    if (J == nullptr) continue;
    if (J[0] != nullptr)
      Eigen::Map<Eigen::RowVectorXd>(J[0] + row * free_.size(), free_.size()) = weight * s.end_rows.row(j).head(free_.size());
    if (J[1] != nullptr) Eigen::Map<Eigen::RowVectorXd>(J[1] + row * n, n) = weight * s.end_rows.row(j).tail(n);
    if (J[2] != nullptr) J[2][row * n + j] = -weight;
  }
  return true;
}

void Shooting::note_failure(const Segment& segment, std::size_t experiment) {
  failure_ = "simulation diverged (non-finite state) at t = " + format_value(experiments_[experiment].t[segment.failed_at]) + " s of '" +
             experiments_[experiment].name + "'";
  if (!stepper_->failure().empty()) failure_ += " (" + stepper_->failure() + ")";
}

void Shooting::add_priors(LeastSquares& problem, int theta_block, const std::vector<Penalty>& penalties) const {
  for (const PriorRows& rows : prior_rows({parameter_priors(model_), penalties})) {
    problem.add_residuals({theta_block}, static_cast<int>(rows.L.rows()),
                          [rows, columns = std::ssize(free_)](const double* const* blocks, double* r, double** J) {
                            const auto& [first, L, mean] = rows;
                            Eigen::Map<Eigen::VectorXd>(r, L.rows()) =
                                L * (Eigen::Map<const Eigen::VectorXd>(blocks[0] + first, L.cols()) - mean);
                            if (J == nullptr || J[0] == nullptr) return true;
                            Eigen::Map<RowMatrix> jacobian(J[0], L.rows(), columns);
                            jacobian.setZero();
                            jacobian.middleCols(first, L.cols()) = L;
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
    const Parameter& p = model.parameters[index];
    theta.push_back(p.value);
    // Bounds of curve coefficients would bind combinations that mean nothing: roughness holds them.
    // Where there are bounds the solver searches along every step (Armijo), which keeps it from leaping into a far valley where a parameter
    // no longer acts: what has none gets bounds beyond all numbers that a formula can use.
    lower.push_back(p.curve >= 0 ? -infinite : std::max(p.lower, -beyond));
    upper.push_back(p.curve >= 0 ? infinite : std::min(p.upper, beyond));
    bounded = bounded || p.curve < 0;
  }
  if (theta.empty()) {  // initial states alone are looked for: Ceres knows no empty block
    const int nothing = problem.add_block({0.0});
    problem.fix_block(nothing);
    return nothing;
  }
  return bounded ? problem.add_block(theta, lower, upper) : problem.add_block(theta);
}

/// Bounds within which the states of a system are kept.
struct StateBounds {
  std::vector<double> least, most;
  bool any = false;

  explicit StateBounds(const Model& model)
      : least(model.states(), -std::numeric_limits<double>::infinity()), most(least.size(), std::numeric_limits<double>::infinity()) {
    for (std::size_t j = 0; j < model.state_specs.size(); ++j) {
      least[j] = model.state_specs[j].lower;
      most[j] = model.state_specs[j].upper;
      any = any || std::isfinite(least[j]) || std::isfinite(most[j]);
    }
  }
};

}  // namespace

/// One residual block per piece, over parameters and its own initial state, with its defect to the next piece's initial state.
void Shooting::add_pieces(LeastSquares& problem, int theta_block, std::vector<Piece>& pieces) {
  const StateBounds bounds(model_);
  for (Piece& piece : pieces) {
    const auto start = history_[piece.experiment].row(piece.first);
    piece.block = bounds.any ? problem.add_block({start.begin(), start.end()}, bounds.least, bounds.most)
                             : problem.add_block({start.begin(), start.end()});
  }
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    Piece& piece = pieces[k];
    if (k + 1 < pieces.size() && pieces[k + 1].experiment == piece.experiment) piece.next = pieces[k + 1].block;
    std::vector<int> blocks{theta_block, piece.block};
    if (piece.next >= 0) blocks.push_back(piece.next);
    const int residuals = static_cast<int>((piece.last - piece.first) * model_.outputs()) + (piece.next >= 0 ? model_.states() : 0);
    problem.add_residuals(blocks, residuals,
                          [this, &piece](const double* const* x, double* r, double** J) { return evaluate(piece, x, r, J); });
  }
}

LeastSquares::Summary Shooting::solve(const ShootingPass& pass, const std::vector<Penalty>& penalties) {
  failure_.clear();
  if (inputs_.front().plan.first.empty()) plan(kSearchTolerance);
  LeastSquares problem;
  const int theta_block = add_parameters(problem, model_, free_);
  std::vector<Piece> pieces = cut(pass.length);
  for (Piece& piece : pieces) piece.defect_weight = pass.defect_weight;
  add_pieces(problem, theta_block, pieces);
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
  std::optional<SuspendedTimeLimit> writing_up;
  if (summary.out_of_time) writing_up.emplace();
  const std::vector<double>& solved = problem.block(theta_block);
  model_.set_theta(Eigen::Map<const Eigen::VectorXd>(solved.data(), std::ssize(free_)));
  set_theta(solved.data());
  remember(pieces, problem);
  failure_.clear();  // of points that were tried on the way
  return summary;
}

void Shooting::remember(std::vector<Piece>& pieces, const LeastSquares& problem) {
  for (const auto& piece : pieces) {
    const RowMatrix states = run_states({*stepper_, experiments_[piece.experiment], inputs_[piece.experiment]},
                                        {piece.first, piece.last, problem.block(piece.block).data()});
    history_[piece.experiment].middleRows(piece.first, states.rows()) = states;
  }
}

void Shooting::restore(const State& state) {
  model_.parameters = state.parameters;
  history_ = state.history;
}

bool Shooting::move_to(const Eigen::VectorXd& unknowns) {
  const Eigen::Index columns = std::ssize(free_), n = model_.states();
  const auto inside = [](double value, double least, double most) { return value >= least && value <= most; };
  for (Eigen::Index c = 0; c < columns; ++c) {
    const Parameter& p = model_.parameters[free_[c]];
    if (p.curve < 0 && !inside(unknowns[c], p.lower, p.upper)) return false;
  }
  const StateBounds bounds(model_);
  for (Eigen::Index at = columns; at < unknowns.size(); ++at) {
    const std::size_t j = (at - columns) % n;
    if (!inside(unknowns[at], bounds.least[j], bounds.most[j])) return false;
  }
  model_.set_theta(unknowns.head(columns));
  for (std::size_t e = 0; e < history_.size(); ++e) history_[e].row(0) = unknowns.segment(columns + n * e, n).transpose();
  return true;
}

std::vector<RowMatrix> Shooting::predict_segments() {
  set_theta(model_.theta().data());
  std::vector<RowMatrix> out;
  std::array<double, kMaxSensorPorts> y{};
  for (std::size_t e = 0; e < experiments_.size(); ++e) {
    out.emplace_back(history_[e].rows(), model_.outputs());
    for (Eigen::Index i = 0; i < history_[e].rows(); ++i) {
      const std::size_t sample = i;
      const bool known = predict_at({*stepper_, experiments_[e], inputs_[e]}, sample, history_[e].row(i).data(), y.data());
      if (!known) std::fill(y.begin(), y.end(), std::nan(""));
      for (Eigen::Index o = 0; o < out[e].cols(); ++o) out[e](i, o) = y[o];
    }
  }
  return out;
}

std::vector<Segment> Shooting::run(bool sensitivities) {
  std::vector<Segment> out(experiments_.size());
  set_theta(model_.theta().data());
  for (std::size_t e = 0; e < experiments_.size(); ++e) {
    const Eigen::VectorXd x0 = initial_state(e);
    run_segment({*stepper_, experiments_[e], inputs_[e]}, {0, experiments_[e].samples(), x0.data(), sensitivities}, out[e]);
    if (!out[e].finite) note_failure(out[e], e);
  }
  return out;
}

}  // namespace misfit
