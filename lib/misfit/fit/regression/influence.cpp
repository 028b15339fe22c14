#include "misfit/fit/regression/influence.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "misfit/fit/regression/linear_windows.h"
#include "misfit/math/statistics.h"

namespace misfit {
namespace {

constexpr std::size_t per_column = 4, per_driver = 6;  // regressors: the value now; the means now, H and 2 H earlier, H/2 and H later

/// In sigmas from the mean of what is known; constant ones: 0.
std::vector<double> standard(std::vector<double> values) {
  const MeanAndSigma spread = mean_and_sigma(values);
  for (double& v : values) v = spread.constant() ? 0.0 * v : (v - spread.mean) / spread.sigma;
  return values;
}

/// Means over the last `count` values, NaN where there are fewer.
std::vector<double> running_means(const std::vector<double>& values, std::size_t count) {
  std::vector<double> out(values.size(), std::nan("")), sum(values.size() + 1, 0.0);
  std::size_t last_missing = 0;  // the row behind it
  for (std::size_t k = 1; k <= values.size(); ++k) {
    const bool known = std::isfinite(values[k - 1]);
    if (!known) last_missing = k;
    sum[k] = sum[k - 1] + (known ? values[k - 1] : 0.0);
    if (k >= last_missing + count) out[k - 1] = (sum[k] - sum[k - count]) / static_cast<double>(count);
  }
  return out;
}

struct LaggedPast {
  std::vector<double> values, means;
  bool driver = false;
};

std::size_t regressors_of(const std::vector<LaggedPast>& columns) {
  std::size_t out = 0;
  for (const LaggedPast& c : columns) out += c.driver ? per_driver : per_column;
  return out;
}

/// Sums of squares of y's change in the regressors of the first `columns` columns and a constant, on stretches taken in turn.
class LagRegression {
 public:
  LagRegression(const std::vector<LaggedPast>& columns, std::size_t ahead) {
    const Eigen::Index n = static_cast<Eigen::Index>(regressors_of(columns)) + 1;
    fitted_ = held_out_ = SquaresForm(n);
    const std::size_t rows = columns.front().values.size();
    constexpr std::size_t most = 20000;
    const std::size_t stride = rows / most + 1;
    Eigen::VectorXd row(n);
    for (std::size_t k = 3 * ahead; k + ahead < rows; k += stride) {
      const double change = columns.front().values[k + ahead] - columns.front().values[k];
      fill(columns, k, ahead, row);
      if (!std::isfinite(change) || !row.allFinite()) continue;
      SquaresForm& into = k / (4 * ahead) % 2 == 0 ? fitted_ : held_out_;
      into.matrix.noalias() += row * row.transpose();
      into.right += change * row;
      into.yy += change * change;
      ++into.count;
    }
  }
  /// Mean square of what the first `terms` regressors and the constant leave over where they were not fitted.
  [[nodiscard]] double left(std::size_t terms) const {
    std::vector<Eigen::Index> use{fitted_.right.size() - 1};
    for (std::size_t i = 0; i < terms; ++i) use.push_back(static_cast<Eigen::Index>(i));
    return held_out_.mean_square(fitted_.solve(use));
  }
  [[nodiscard]] bool enough() const {
    const double least = 4.0 * static_cast<double>(fitted_.right.size());
    return fitted_.count > least && held_out_.count > least;
  }

 private:
  static void fill(const std::vector<LaggedPast>& columns, std::size_t k, std::size_t ahead, Eigen::VectorXd& row) {
    Eigen::Index at = 0;
    for (const LaggedPast& c : columns) {
      row[at++] = c.values[k];
      for (const std::size_t back : {std::size_t{0}, ahead, 2 * ahead}) row[at++] = c.means[k - back];
      if (!c.driver) continue;
      row[at++] = c.means[k + (ahead + 1) / 2];
      row[at++] = c.means[k + ahead];
    }
    row[at] = 1.0;
  }

  SquaresForm fitted_, held_out_;
};

}  // namespace

Influence influence_on(const std::vector<double>& y, const std::vector<std::vector<double>>& others,
                       const std::vector<std::vector<double>>& drivers) {
  const std::vector<double> own = standard(y);
  constexpr std::size_t parts = 32;  // window_length() is two swings
  const std::size_t ahead = std::max<std::size_t>(window_length(own) / parts, 1), mean = std::max<std::size_t>(ahead / 2, 1);
  if (others.size() + drivers.size() == 0 || y.size() < 16 * ahead) return {};
  std::vector<LaggedPast> columns{{own, running_means(own, mean), false}};
  for (const bool driver : {false, true}) {
    for (const auto& other : driver ? drivers : others) {
      if (mean_and_sigma(other).constant()) continue;
      const std::vector<double> values = standard(other);
      columns.push_back({values, running_means(values, mean), driver});
    }
  }
  const LagRegression regression(columns, ahead);
  const double total = regression.left(0);
  if (!regression.enough() || !(total > 0.0)) return {};
  const double alone = regression.left(per_column), all = regression.left(regressors_of(columns));
  return {1.0 - alone / total, (alone - all) / total};
}

}  // namespace misfit
