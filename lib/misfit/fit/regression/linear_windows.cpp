#include "misfit/fit/regression/linear_windows.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "misfit/math/decompositions.h"

namespace misfit {
namespace {

using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;

/// Exact step of the linear system over dt: state to state, and a constant driver to state.
struct Step {
  Small transition;
  Eigen::VectorXd driven;
};

Step step_of(const Poles& poles, double dt) {
  const Eigen::Index n = poles.order;
  Small a = Small::Zero(n + 1, n + 1);
  if (n == 1) {
    a(0, 0) = -poles.damping;
  } else {
    a(0, 1) = 1.0;
    a(1, 0) = -poles.stiffness;
    a(1, 1) = -poles.damping;
  }
  a(n - 1, n) = 1.0;
  const Eigen::MatrixXd whole = exponential(a * dt);
  return {whole.topLeftCorner(n, n), whole.topRightCorner(n, 1)};
}

/// Steps over intervals rounded to a tenth of the usual one: the stamps of a logger jitter.
class Steps {
 public:
  Steps(const Poles& poles, double usual) : poles_(poles), unit_(0.1 * usual) {}
  const Step& over(double dt) {
    const long count = std::max(std::lround(dt / unit_), 1L);
    const auto known = steps_.find(count);
    return known != steps_.end() ? known->second : steps_.emplace(count, step_of(poles_, unit_ * static_cast<double>(count))).first->second;
  }

 private:
  Poles poles_;
  double unit_;
  std::map<long, Step> steps_;
};

/// Answers of y to each driver, to a constant and to each initial state: a row per sample.
Eigen::MatrixXd answers(const WindowedRecord& record, const WindowedRecord::Window& window, const Poles& poles, Steps& steps) {
  const Eigen::Index n = poles.order, m = record.drivers.cols();
  const Eigen::Index rows = window.to - window.from;
  Eigen::MatrixXd out(rows, m + 1 + n), state = Eigen::MatrixXd::Zero(n, m + 1 + n);
  state.rightCols(n).setIdentity();
  for (Eigen::Index k = 0; k < rows; ++k) {
    out.row(k) = state.row(0);
    const std::size_t at = window.from + static_cast<std::size_t>(k);
    if (at + 1 == window.to) break;
    const Step& step = steps.over(record.t[at + 1] - record.t[at]);
    state = (step.transition * state).eval();
    state.leftCols(m) += step.driven * record.drivers.row(static_cast<Eigen::Index>(at));
    state.col(m) += step.driven;
  }
  return out;
}

/// The quadratic form of one window, its initial state projected out.
SquaresForm squares_of_window(const WindowedRecord& record, const WindowedRecord::Window& window, const Eigen::MatrixXd& answer,
                              Eigen::Index order) {
  const Eigen::Index m = answer.cols() - order;
  Eigen::VectorXd y(answer.rows());
  Eigen::MatrixXd known = answer;
  SquaresForm out(m);
  for (Eigen::Index k = 0; k < y.size(); ++k) {
    y[k] = record.y[window.from + static_cast<std::size_t>(k)];
    if (std::isfinite(y[k])) {
      ++out.count;
    } else {
      y[k] = 0.0;
      known.row(k).setZero();
    }
  }
  const Eigen::MatrixXd normal = known.transpose() * known;
  const Eigen::VectorXd right = known.transpose() * y;
  const Eigen::MatrixXd start = pseudoinverse(normal.bottomRightCorner(order, order));
  const Eigen::MatrixXd mixed = normal.topRightCorner(m, order);
  out.matrix = normal.topLeftCorner(m, m) - mixed * start * mixed.transpose();
  out.right = right.head(m) - mixed * start * right.tail(order);
  out.yy = y.squaredNorm() - right.tail(order).dot(start * right.tail(order));
  out.count = std::max(out.count - static_cast<double>(order), 0.0);
  return out;
}

}  // namespace

SquaresForm& SquaresForm::operator+=(const SquaresForm& other) {
  matrix += other.matrix;
  right += other.right;
  yy += other.yy;
  count += other.count;
  return *this;
}

Eigen::VectorXd SquaresForm::solve(const std::vector<Eigen::Index>& terms) const {
  const auto n = std::ssize(terms);
  Eigen::MatrixXd part(n, n);
  Eigen::VectorXd of(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    of[i] = right[terms[i]];
    for (Eigen::Index j = 0; j < n; ++j) part(i, j) = matrix(terms[i], terms[j]);
  }
  const Eigen::VectorXd solved = minimum_norm_solve(part, of);
  Eigen::VectorXd out = Eigen::VectorXd::Zero(right.size());
  for (Eigen::Index i = 0; i < n; ++i) out[terms[i]] = solved[i];
  return out;
}

double SquaresForm::mean_square(const Eigen::VectorXd& coefficients) const {
  const double sum = yy - 2.0 * coefficients.dot(right) + coefficients.dot(matrix * coefficients);
  return std::max(sum, 0.0) / std::max(count, 1.0);
}

FittedAndHeldOut squares_of(const WindowedRecord& record, const Poles& poles) {
  const Eigen::Index size = record.drivers.cols() + 1;
  FittedAndHeldOut out{poles, SquaresForm(size), SquaresForm(size)};
  Steps steps(poles, record.step);
  for (std::size_t i = 0; i < record.windows.size(); ++i) {
    const Eigen::MatrixXd answer = answers(record, record.windows[i], poles, steps);
    const SquaresForm own = squares_of_window(record, record.windows[i], answer, poles.order);
    if (i % 2 == 0) out.fitted += own;
    if (i % 2 == 1 || record.windows.size() == 1) out.held_out += own;
  }
  return out;
}

std::size_t window_length(const std::vector<double>& y) {
  constexpr double beyond = 0.3;  // sigma from the mean, on either side, before a crossing counts
  std::size_t crossings = 0;
  int side = 0;
  for (const double v : y) {
    const int now = v > beyond ? 1 : v < -beyond ? -1 : 0;
    if (now == 0) continue;
    crossings += side != 0 && now != side ? 1U : 0U;
    side = now;
  }
  constexpr std::size_t least = 20, windows = 8;
  const std::size_t most = std::max<std::size_t>(y.size() / windows, least);
  return std::clamp(4 * y.size() / std::max<std::size_t>(crossings, 1), least, most);
}

std::vector<WindowedRecord::Window> windows_of(const std::vector<double>& t, double step, std::size_t length) {
  constexpr double gap = 5.0;
  constexpr std::size_t least = 8, most = 40000;
  std::vector<WindowedRecord::Window> all;
  for (std::size_t from = 0, k = 1; k <= t.size(); ++k) {
    const bool cut = k == t.size() || t[k] - t[k - 1] > gap * step;
    if (!cut && k - from < length) continue;
    if (k - from >= least) all.push_back({from, k});
    from = k;
  }
  const std::size_t allowed = std::max<std::size_t>(most / length, least);
  if (all.size() <= allowed) return all;
  std::vector<WindowedRecord::Window> out;
  for (std::size_t i = 0; i < allowed; ++i) out.push_back(all[i * all.size() / allowed]);
  return out;
}

}  // namespace misfit
