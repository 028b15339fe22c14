#include "misfit/track/sweep_points.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "misfit/core/error.h"
#include "misfit/core/lists.h"

namespace misfit {
namespace {

double square(const PixelPoint& a, const PixelPoint& b) { return std::pow(a.column - b.column, 2.0) + std::pow(a.row - b.row, 2.0); }

/// The choice of markers (or none, at the price of `reach`) for the three expected places with the least sum of squares.
SweepPoints nearest(const std::array<PixelPoint, 3>& expected, const std::vector<PixelPoint>& found, double reach) {
  const int n = int_size(found);
  double best = 1e300;
  SweepPoints out;
  const auto price = [&](std::size_t k, int m) { return m == n ? reach * reach : square(expected[k], found[m]); };
  const auto clash = [n](int a, int b) { return a == b && a != n; };
  for (int a = 0; a <= n; ++a) {
    for (int b = 0; b <= n; ++b) {
      for (int c = 0; c <= n; ++c) {
        const double sum = price(0, a) + price(1, b) + price(2, c);
        if (clash(a, b) || clash(b, c) || clash(a, c) || sum >= best) continue;
        best = sum;
        const std::array<int, 3> chosen{a, b, c};
        for (std::size_t k = 0; k < 3; ++k)
          out[k] = chosen[k] == n || price(k, chosen[k]) > reach * reach ? std::nullopt : std::optional(found[chosen[k]]);
      }
    }
  }
  return out;
}

/// Follows the points through the pictures `order`, the first of which is assigned.
class Follower {
 public:
  Follower(const std::vector<double>& theta, const std::vector<std::vector<PixelPoint>>& found, double reach, std::vector<SweepPoints>& out)
      : theta_(theta), found_(found), reach_(reach), out_(out) {}

  void follow(const std::vector<std::size_t>& order) {
    std::array<std::vector<std::size_t>, 3> seen;
    for (std::size_t step = 0; step < order.size(); ++step) {
      const std::size_t k = order[step];
      if (step > 0) out_[k] = nearest(expected(seen, theta_[k]), found_[k], reach_);
      for (std::size_t p = 0; p < 3; ++p) {
        if (out_[k][p]) seen[p].push_back(k);
      }
    }
  }

 private:
  [[nodiscard]] std::array<PixelPoint, 3> expected(const std::array<std::vector<std::size_t>, 3>& seen, double theta) const {
    std::array<PixelPoint, 3> out;
    for (std::size_t p = 0; p < 3; ++p) {
      if (seen[p].empty()) {
        out[p] = {-1e6, -1e6};
        continue;
      }
      const std::size_t b = seen[p].back();
      out[p] = *out_[b][p];
      if (seen[p].size() < 2) continue;
      const std::size_t a = seen[p][seen[p].size() - 2];
      if (std::abs(theta_[b] - theta_[a]) < 1e-9) continue;
      const double f = (theta - theta_[b]) / (theta_[b] - theta_[a]);
      out[p].column += f * (out_[b][p]->column - out_[a][p]->column);
      out[p].row += f * (out_[b][p]->row - out_[a][p]->row);
    }
    return out;
  }

  const std::vector<double>& theta_;
  const std::vector<std::vector<PixelPoint>>& found_;
  double reach_;
  std::vector<SweepPoints>& out_;
};

/// Lowest in the picture first for theta > 0, highest first for theta < 0: the three best found.
SweepPoints by_geometry(double theta, const std::vector<PixelPoint>& found) {
  std::vector<PixelPoint> three(found.begin(), found.begin() + 3);
  std::sort(three.begin(), three.end(),
            [theta](const PixelPoint& a, const PixelPoint& b) { return theta > 0.0 ? a.row > b.row : a.row < b.row; });
  return {three[0], three[1], three[2]};
}

}  // namespace

std::vector<SweepPoints> assign_sweep_points(const std::vector<double>& theta, const std::vector<std::vector<PixelPoint>>& found,
                                             const std::vector<PixelPoint>& first, double reach) {
  std::vector<SweepPoints> out(theta.size());
  std::size_t anchor = theta.size();
  if (first.size() == 3 && !theta.empty()) {
    anchor = 0;
    out[0] = nearest({first[0], first[1], first[2]}, found[0], reach);
  } else {
    for (std::size_t k = 0; k < theta.size(); ++k) {
      if (found[k].size() >= 3 && (anchor == theta.size() || std::abs(theta[k]) > std::abs(theta[anchor]))) anchor = k;
    }
    if (anchor == theta.size())
      throw RunError("no picture of the sweep shows three markers: the three points of the rig cannot be identified");
    out[anchor] = by_geometry(theta[anchor], found[anchor]);
  }
  std::vector<std::size_t> order(theta.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return theta[a] < theta[b]; });
  const auto at = std::find(order.begin(), order.end(), anchor);
  Follower follower(theta, found, reach, out);
  follower.follow({at, order.end()});
  follower.follow({std::make_reverse_iterator(at + 1), order.rend()});
  return out;
}

}  // namespace misfit
