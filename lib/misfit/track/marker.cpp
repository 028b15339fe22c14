#include "misfit/track/marker.h"

#include <algorithm>
#include <cmath>

namespace misfit {
namespace {

/// Edge profile: 0 far outside (u <= −1), 1 far inside.
double rise(double u) {
  if (u <= -1.0) return 0.0;
  if (u >= 1.0) return 1.0;
  const double u2 = u * u;
  return 0.5 + u * (15.0 - 10.0 * u2 + 3.0 * u2 * u2) / 16.0;
}

double rise_slope(double u) {
  if (u <= -1.0 || u >= 1.0) return 0.0;
  const double v = 1.0 - u * u;
  return 15.0 / 16.0 * v * v;
}

/// Shape k: a disc of that radius and edge about the origin, seen at `at`.
struct Disc {
  double radius, edge;
};

void set_disc(ShapeValue& s, std::size_t k, const Disc& disc, const std::array<double, 2>& at) {
  const auto& [x, y] = at;
  const double edge = disc.edge;
  const double rho = std::hypot(x, y);
  const double u = (disc.radius - rho) / edge;
  const double slope = rise_slope(u) / edge;
  s.value[k] = rise(u);
  s.by_radius[k] = slope;
  s.by_edge[k] = -slope * u;
  if (rho < 1e-9) return;
  s.by_x[k] = -slope * x / rho;
  s.by_y[k] = -slope * y / rho;
}

/// Catmull-Rom weights of the four samples about a fraction f in [0, 1), and their slopes.
void cubic_weights(double f, std::array<double, 4>& w, std::array<double, 4>& d) {
  const double f2 = f * f, f3 = f2 * f;
  w = {0.5 * (-f + 2.0 * f2 - f3), 0.5 * (2.0 - 5.0 * f2 + 3.0 * f3), 0.5 * (f + 4.0 * f2 - 3.0 * f3), 0.5 * (-f2 + f3)};
  d = {0.5 * (-1.0 + 4.0 * f - 3.0 * f2), 0.5 * (-10.0 * f + 9.0 * f2), 0.5 * (1.0 + 8.0 * f - 9.0 * f2), 0.5 * (-2.0 * f + 3.0 * f2)};
}

void set_picture(ShapeValue& s, const Image& picture, double x, double y) {
  const double column = x + 0.5 * (picture.width - 1), row = y + 0.5 * (picture.height - 1);
  const double c0 = std::floor(column), r0 = std::floor(row);
  std::array<double, 4> wx{}, dx{}, wy{}, dy{};
  cubic_weights(column - c0, wx, dx);
  cubic_weights(row - r0, wy, dy);
  for (int j = 0; j < 4; ++j) {
    const int r = std::clamp(static_cast<int>(r0) - 1 + j, 0, picture.height - 1);
    for (int i = 0; i < 4; ++i) {
      const int c = std::clamp(static_cast<int>(c0) - 1 + i, 0, picture.width - 1);
      const double grey = picture(c, r);
      s.value[0] += wx[i] * wy[j] * grey;
      s.by_x[0] += dx[i] * wy[j] * grey;
      s.by_y[0] += wx[i] * dy[j] * grey;
    }
  }
}

}  // namespace

double Marker::reach_x() const { return kind == MarkerKind::picture ? 0.5 * (picture.width - 1) : outer; }
double Marker::reach_y() const { return kind == MarkerKind::picture ? 0.5 * (picture.height - 1) : outer; }

ShapeValue shape_at(const Marker& marker, double x, double y) {
  ShapeValue s;
  if (marker.kind == MarkerKind::picture) {
    set_picture(s, marker.picture, x, y);
    return s;
  }
  set_disc(s, 0, {marker.outer, marker.edge}, {x, y});
  if (marker.kind == MarkerKind::ring) set_disc(s, 1, {marker.inner, marker.edge}, {x, y});
  return s;
}

Marker nominal_marker(MarkerKind kind, double diameter) {
  Marker marker;
  marker.kind = kind;
  marker.outer = 0.5 * diameter;
  marker.inner = 0.45 * marker.outer;
  marker.edge = 1.0;
  marker.levels = {100.0, kind == MarkerKind::dark ? -100.0 : 100.0, kind == MarkerKind::ring ? -150.0 : 0.0};
  return marker;
}

const char* name_of(MarkerKind kind) {
  switch (kind) {
    case MarkerKind::ring:
      return "ring";
    case MarkerKind::bright:
      return "bright";
    case MarkerKind::dark:
      return "dark";
    case MarkerKind::picture:
      break;
  }
  return "picture";
}

}  // namespace misfit
