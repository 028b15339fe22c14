#include "misfit/calibrate/sweep_points.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "misfit/core/error.h"
#include "misfit/core/missing.h"
#include "misfit/core/text.h"
#include "misfit/core/units.h"

namespace misfit {
namespace {

double at(const std::vector<double>& column, std::size_t i) { return i < column.size() ? column[i] : kMissing; }

// data/sweep.h: where point k of the rig is at `theta`.
SweepPoint rig_point(int k, double theta, const RigGeometry& g) {
  const double c = std::cos(theta);
  const double s = std::sin(theta);
  SweepPoint p{.point = k, .theta = theta, .P_y = kMissing, .P_z = kMissing};
  p.x = g.l_p + (k == 1 ? g.R1 * c : k == 2 ? -g.R2 * c : g.R3 * c);
  p.z = k == 1 ? g.R1 * s : k == 2 ? g.R2 * s : -g.R3 * s;
  return p;
}

void check_geometry(const RigGeometry& g, const SweepPoint& p) {
  if (g.l_b > 0.0 && p.x < g.l_b) return;
  throw InputError("geometry: at theta = " + format_value(p.theta / kDegree) + " deg reference point " + std::to_string(p.point) + " is " +
                   format_value(p.x) + " m downstream of the backshell face, at or behind the camera (l_b = " + format_value(g.l_b) +
                   " m); check l_b, l_p, R1, R2 and R3");
}

}  // namespace

std::vector<SweepPoint> sweep_points(const Sweep& sweep, const RigGeometry& geometry) {
  std::vector<SweepPoint> points;
  std::set<double> angles;
  for (std::size_t i = 0; i < sweep.theta.size(); ++i) {
    if (!std::isfinite(sweep.theta[i])) continue;
    for (int k = 1; k <= 3; ++k) {
      SweepPoint p = rig_point(k, sweep.theta[i], geometry);
      check_geometry(geometry, p);
      p.P_y = at(sweep.P_y[k - 1], i);
      p.P_z = at(sweep.P_z[k - 1], i);
      if (!std::isfinite(p.P_y) && !std::isfinite(p.P_z)) continue;
      points.push_back(p);
      angles.insert(p.theta);
    }
  }
  if (angles.size() < 3) {
    throw RunError("the sweep has measured points at " + std::to_string(angles.size()) +
                   (angles.size() == 1 ? " angle" : " different angles") +
                   "; a calibration needs at least three, so that h_c and K are not only determined but checked");
  }
  return points;
}

bool has_y(const std::vector<SweepPoint>& points) {
  return std::any_of(points.begin(), points.end(), [](const SweepPoint& p) { return std::isfinite(p.P_y); });
}

}  // namespace misfit
