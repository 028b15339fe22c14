#include "misfit/fit/regression/lost_sign.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "misfit/math/decompositions.h"
#include "misfit/math/statistics.h"
#include "misfit/sim/trajectory.h"

namespace misfit {
namespace {

/// The regression's samples: of each experiment in turn, without those whose past is missing.
struct SignRegression {
  struct Row {
    std::size_t experiment = 0, sample = 0;
    bool counted = true;  ///< not held out
    bool goes_on = true;  ///< its past is that of the row before
    double y = 0.0, before = 0.0, before_that = 0.0;
  };
  std::vector<Row> rows;
  RowMatrix r;  ///< a row each; 1 last
};

const Signal* channel(const Signals& signals, const std::string& name) {
  const auto found = std::find_if(signals.measured.begin(), signals.measured.end(), [&](const Signal& s) { return s.name == name; });
  return found == signals.measured.end() ? nullptr : &*found;
}

bool is_recorded(const Signal& input) { return !input.values.empty(); }

std::vector<double> regressors_at(const Signals& signals, const std::string& output, std::size_t k) {
  std::vector<double> out;
  for (const Signal& input : signals.inputs) {
    if (is_recorded(input)) out.insert(out.end(), {input.values[k], input.values[k - 1]});
  }
  for (const Signal& other : signals.measured) {
    if (other.name != output) out.push_back(other.values[k - 1]);
  }
  out.push_back(1.0);
  return out;
}

bool finite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

/// Empty where an experiment lacks the output, or there are too few samples.
SignRegression regression_of(const std::vector<Signals>& experiments, const std::string& output) {
  SignRegression out;
  std::vector<double> values;
  std::size_t columns = 0;
  for (std::size_t e = 0; e < experiments.size(); ++e) {
    const Signals& signals = experiments[e];
    const Signal* y = channel(signals, output);
    if (y == nullptr) return {};
    for (std::size_t k = std::max<std::size_t>(signals.exclude, 2); k < signals.samples(); ++k) {
      const std::vector<double> r = regressors_at(signals, output, k);
      if (!finite(r) || !finite({y->values[k], y->values[k - 1], y->values[k - 2]}) || (columns != 0 && r.size() != columns)) continue;
      columns = r.size();
      const bool goes_on = !out.rows.empty() && out.rows.back().experiment == e && out.rows.back().sample + 1 == k;
      out.rows.push_back({e, k, !signals.held_out(k), goes_on, y->values[k], y->values[k - 1], y->values[k - 2]});
      values.insert(values.end(), r.begin(), r.end());
    }
  }
  constexpr std::size_t of_parameters = 10;
  if (out.rows.size() < of_parameters * (columns + 2)) return {};
  out.r = Eigen::Map<const RowMatrix>(values.data(), std::ssize(out.rows), static_cast<Eigen::Index>(columns));
  return out;
}

/// Signs of a row's sample, the one before and the one before that.
using Signs = std::array<int, 3>;

struct SignedFit {
  std::vector<Signs> signs;
  Eigen::VectorXd coefficients;  ///< a, b, then those of r
  double squares = std::numeric_limits<double>::infinity();
};

/// The coefficients and the squares of what is left, by the counted samples.
void fit_coefficients(const SignRegression& of, SignedFit& fit) {
  const Eigen::Index width = of.r.cols() + 2;
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(width, width);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(width), x(width);
  double total = 0.0;
  for (std::size_t k = 0; k < of.rows.size(); ++k) {
    const auto& row = of.rows[k];
    if (!row.counted) continue;
    x << fit.signs[k][1] * row.before, fit.signs[k][2] * row.before_that, of.r.row(static_cast<Eigen::Index>(k)).transpose();
    const double y = fit.signs[k][0] * row.y;
    normal += x * x.transpose();
    right += y * x;
    total += y * y;
  }
  fit.coefficients = minimum_norm_solve(normal, right);
  constexpr double rounding = 1e-10;  // of the squares: what is less says nothing
  fit.squares = std::max(total - right.dot(fit.coefficients), rounding * total);
}

/// A pair of signs: bit 0 of a sample, bit 1 of the one before; set: negative.
constexpr int pairs = 4;
int sign_of(int pair, int bit) { return (pair >> bit & 1) != 0 ? -1 : 1; }

/// For every row and pair of signs at it, the best pair at the row before.
struct BestPaths {
  std::vector<std::array<int, pairs>> from;
  std::vector<int> end_before;  ///< where a row does not go on: the pair with which the row before it ends
  int end = 0;                  ///< with which the last row does
};

int least_of(const std::array<double, pairs>& cost) { return static_cast<int>(std::min_element(cost.begin(), cost.end()) - cost.begin()); }

BestPaths best_paths(const SignRegression& of, const Eigen::VectorXd& coefficients) {
  const std::size_t n = of.rows.size();
  BestPaths out{std::vector<std::array<int, pairs>>(n), std::vector<int>(n, 0)};
  std::array<double, pairs> cost{};
  for (std::size_t k = 0; k < n; ++k) {
    const auto& row = of.rows[k];
    if (!row.goes_on) {
      out.end_before[k] = least_of(cost);
      cost.fill(cost[out.end_before[k]]);
    }
    const double forced = of.r.row(static_cast<Eigen::Index>(k)).dot(coefficients.tail(of.r.cols()));
    std::array<double, pairs> next{};
    next.fill(std::numeric_limits<double>::infinity());
    for (int before = 0; before < pairs; ++before) {
      const double predicted =
          coefficients[0] * sign_of(before, 0) * row.before + coefficients[1] * sign_of(before, 1) * row.before_that + forced;
      for (int now = 0; now < 2; ++now) {
        const int to = (before & 1) << 1 | now;
        const double error = sign_of(to, 0) * row.y - predicted, with = cost[before] + error * error;
        if (!(with < next[to])) continue;
        next[to] = with;
        out.from[k][to] = before;
      }
    }
    cost = next;
  }
  out.end = least_of(cost);
  return out;
}

/// The signs that leave the least squares with these coefficients, by dynamic programming over the pairs of a sample and the one before.
void choose_signs(const SignRegression& of, SignedFit& fit) {
  const BestPaths best = best_paths(of, fit.coefficients);
  int pair = best.end;
  for (std::size_t k = of.rows.size(); k-- > 0;) {
    const int before = best.from[k][pair];
    fit.signs[k] = {sign_of(pair, 0), sign_of(before, 0), sign_of(before, 1)};
    pair = of.rows[k].goes_on ? before : best.end_before[k];
  }
}

SignedFit fit_from(const SignRegression& of, const std::vector<int>& signs) {
  constexpr int most = 30;
  SignedFit out;
  for (std::size_t k = 0; k < signs.size(); ++k) {
    const int before = of.rows[k].goes_on ? signs[k - 1] : signs[k];
    const int before_that = of.rows[k].goes_on && of.rows[k - 1].goes_on ? signs[k - 2] : before;
    out.signs.push_back({signs[k], before, before_that});
  }
  for (int turn = 0; turn < most; ++turn) {
    fit_coefficients(of, out);
    const std::vector<Signs> known = out.signs;
    choose_signs(of, out);
    if (out.signs == known) break;
  }
  return out;
}

/// An output that goes through zero wherever it is near it and least.
std::vector<int> signs_through_zero(const SignRegression& of) {
  constexpr double near = 0.1;  // of its largest value
  double largest = 0.0;
  for (const auto& row : of.rows) largest = std::max(largest, row.y);
  std::vector<int> out;
  int sign = 1;
  for (const auto& row : of.rows) {
    const bool least = row.before < near * largest && row.before <= row.before_that && row.before < row.y;
    if (row.goes_on && least) sign = -sign;
    out.push_back(sign);
  }
  return out;
}

std::vector<int> signs_of_column(const SignRegression& of, Eigen::Index column) {
  const Eigen::VectorXd r = of.r.col(column);
  const double middle = median(std::vector<double>(r.begin(), r.end()));
  std::vector<int> out;
  for (const double value : r) out.push_back(value < middle ? -1 : 1);
  return out;
}

bool is_negative_somewhere(const SignRegression& of) {
  constexpr double noise = 0.1, rare = 0.01;  // of the usual size
  std::vector<double> sizes;
  for (const auto& row : of.rows) sizes.push_back(std::abs(row.y));
  const double least = -noise * median(std::move(sizes));
  const auto below = std::count_if(of.rows.begin(), of.rows.end(), [&](const auto& row) { return row.y < least; });
  return static_cast<double>(below) > rare * static_cast<double>(of.rows.size());
}

/// The first input raises it; without inputs it is mostly positive.
void orient(SignedFit& fit, const SignRegression& of, bool has_inputs) {
  double sum = 0.0;
  if (has_inputs) sum = fit.coefficients[2] + fit.coefficients[3];
  for (std::size_t k = 0; !has_inputs && k < fit.signs.size(); ++k) sum += fit.signs[k][0] * of.rows[k].y;
  if (sum >= 0.0) return;
  for (Signs& signs : fit.signs) {
    for (int& sign : signs) sign = -sign;
  }
}

}  // namespace

std::optional<SignedRecord> with_signs(const std::vector<Signals>& experiments, const std::string& output) {
  constexpr double most_left = 0.5;
  const SignRegression of = regression_of(experiments, output);
  if (of.rows.empty() || is_negative_somewhere(of)) return std::nullopt;
  SignedFit without;
  without.signs.assign(of.rows.size(), {1, 1, 1});
  fit_coefficients(of, without);
  SignedFit best = fit_from(of, signs_through_zero(of));
  for (Eigen::Index column = 0; column + 1 < of.r.cols(); ++column) {
    SignedFit there = fit_from(of, signs_of_column(of, column));
    if (there.squares < best.squares) best = std::move(there);
  }
  SignedRecord out;
  out.left = best.squares / without.squares;
  if (!(out.left < most_left)) return std::nullopt;
  const std::vector<Signal>& inputs = experiments.front().inputs;
  orient(best, of, std::any_of(inputs.begin(), inputs.end(), is_recorded));
  out.experiments = experiments;
  for (Signals& signals : out.experiments) {
    for (Signal& s : signals.measured) {
      if (s.name != output) continue;
      std::fill_n(s.values.begin(), s.values.size(), std::numeric_limits<double>::quiet_NaN());
    }
  }
  for (std::size_t k = 0; k < of.rows.size(); ++k) {
    const auto& row = of.rows[k];
    for (Signal& s : out.experiments[row.experiment].measured) {
      if (s.name == output) s.values[row.sample] = best.signs[k][0] * row.y;
    }
    if (row.goes_on && best.signs[k][0] != best.signs[k][1]) ++out.changes;
  }
  return out;
}

}  // namespace misfit
