#pragma once

// References
//   [P]  Parachute Aerodynamics from Video Data ("the paper"; lib/misfit/README.md, [1]): Eqs. 1, 5-7.
//   [B]  D. C. Brown, Close-range camera calibration, Photogramm. Eng. 37 (1971): radial distortion.

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

namespace misfit {

/// Which projection turns a direction into pixels.
enum class CameraModel {
  plane_by_plane,  ///< the paper's Eq. 1: each plane on its own, depth l_s − R cos(angle in that plane)
  pinhole          ///< exact: one depth, l_s − R n_x, for both image coordinates
};

/// Parameters of the downstream camera, SI and radians. Frame: x downstream, y left looking upstream, z down.
/// A template so that calibration can take derivatives; plain doubles elsewhere.
template <class T>
struct CameraParameters {
  T h_c{};              ///< height of the camera above the swivel [m]: adds to z
  T K{};                ///< scale at the backshell face [px/m]; focal length in pixels is l_b K
  T camera_roll{};      ///< rotation of the image about the optical axis [rad]: see to_image()
  T centre_y{};         ///< added to P_y [px]
  T centre_z{};         ///< added to P_z [px]
  T pixel_aspect{};     ///< relative stretch of P_y: P_y (1 + pixel_aspect) [-]
  T lens_k1{};          ///< radial distortion P (1 + k1 r²), r = |P| / (l_b K) [-] [B]
  T camera_distance{};  ///< correction of the distance camera – rig [m]: adds to l_b and l_s in every depth, not to l_b K
};

/// Names in the order of the struct, as used in camera.json and studies; units beside.
inline constexpr std::array<const char*, 8> camera_parameter_names = {"h_c",          "K",       "camera_roll",    "centre_y", "centre_z",
                                                                      "pixel_aspect", "lens_k1", "camera_distance"};
inline constexpr std::array<const char*, 8> camera_parameter_units = {"m", "px/m", "rad", "px", "px", "-", "-", "m"};

/// The parameters as an array in the order of camera_parameter_names.
template <class T>
std::array<T*, 8> camera_entries(CameraParameters<T>& c) {
  return {&c.h_c, &c.K, &c.camera_roll, &c.centre_y, &c.centre_z, &c.pixel_aspect, &c.lens_k1, &c.camera_distance};
}
template <class T>
std::array<T, 8> camera_values(const CameraParameters<T>& c) {
  return {c.h_c, c.K, c.camera_roll, c.centre_y, c.centre_z, c.pixel_aspect, c.lens_k1, c.camera_distance};
}

/// Ideal image coordinates → what the camera reports: lens distortion [B], roll, aspect, then centre, the order in which light meets them.
///   P' = P (1 + k1 r²);  P'' = [cos −sin; sin cos] P' on (P_y; P_z), so a positive roll turns +z (down) towards −y;
///   P_y = (1 + pixel_aspect) P''_y + centre_y;  P_z = P''_z + centre_z.
/// Sign and order (the centre is shifted after the roll) are those of the recorded rolled camera: tests/calibrate.
template <class T>
std::array<T, 2> to_image(const CameraParameters<T>& c, const T& focal, const T& p_y, const T& p_z) {
  using std::cos;
  using std::sin;
  const T stretch = T(1.0) + c.lens_k1 * (p_y * p_y + p_z * p_z) / (focal * focal);
  const T cr = cos(c.camera_roll) * stretch;
  const T sr = sin(c.camera_roll) * stretch;
  return {(cr * p_y - sr * p_z) * (T(1.0) + c.pixel_aspect) + c.centre_y, sr * p_y + cr * p_z + c.centre_z};
}

/// The inverse of to_image(): P = q / s, where q is free of centre, aspect and roll, and s³ − s² = k1 |q|² / focal² (Newton; regular at q =
/// 0). nullopt where the lens model has no inverse: k1 |q|² / focal² ≤ −4/27, beyond the radius at which a barrel lens folds back.
/// Derivatives pass through: after convergence one more step is taken, which gives those of the root.
template <class T>
std::optional<std::array<T, 2>> from_image(const CameraParameters<T>& c, const T& focal, const T& P_y, const T& P_z) {
  using std::abs;
  using std::cos;
  using std::sin;
  const T y = (P_y - c.centre_y) / (T(1.0) + c.pixel_aspect);
  const T z = P_z - c.centre_z;
  const T q_y = cos(c.camera_roll) * y + sin(c.camera_roll) * z;
  const T q_z = cos(c.camera_roll) * z - sin(c.camera_roll) * y;
  const T distortion = c.lens_k1 * (q_y * q_y + q_z * q_z) / (focal * focal);
  T s(1.0);
  bool done = false;
  for (int i = 0; i < 60; ++i) {
    const T step = (s * s * (s - T(1.0)) - distortion) / (s * (T(3.0) * s - T(2.0)));
    s = s - step;
    if (!(s > T(2.0 / 3.0))) return std::nullopt;  // also catches NaN
    if (done) return std::array<T, 2>{q_y / s, q_z / s};
    done = abs(step) < T(1e-14) * s;
  }
  return std::nullopt;
}

/// A point at (x downstream of the backshell face, y, z) [m] → (P_y, P_z) [px], pinhole: [P, Eqs. 5-7] with both coordinates.
///   P_z = l_b K (z + h_c) / (l_b − x),  P_y = l_b K y / (l_b − x), then to_image().
/// Valid for x < l_b (in front of the camera); the caller checks.
template <class T>
std::array<T, 2> project_point(const CameraParameters<T>& c, double l_b, const std::array<T, 3>& point) {
  const auto& [x, y, z] = point;
  const T focal = l_b * c.K;
  const T depth = l_b + c.camera_distance - x;
  return to_image(c, focal, T(focal * y / depth), T(focal * (z + c.h_c) / depth));
}

/// Distances between swivel, apex and camera that the projection of the axis needs [m].
struct AxisGeometry {
  double R = 0.0;    ///< swivel → apex
  double l_b = 0.0;  ///< backshell face → camera, along x
  double l_s = 0.0;  ///< swivel → camera, along x; R < l_s
};

/// A camera and where it stands. Keeps a reference to the parameters.
template <class T>
struct AxisCamera {
  CameraModel model = CameraModel::pinhole;
  const CameraParameters<T>& parameters;
  AxisGeometry geometry;
};
template <class T>
AxisCamera(CameraModel, const CameraParameters<T>&, AxisGeometry) -> AxisCamera<T>;

/// Unit vector of the axis from theta = atan2(n_z, n_x), psi = atan2(n_y, n_x), both within ±pi/2: n ~ (cos θ cos ψ, cos θ sin ψ, sin θ cos
/// ψ). Zero over zero only where both angles are ±pi/2.
template <class T>
std::array<T, 3> axis_direction(const T& theta, const T& psi) {
  using std::cos;
  using std::sin;
  using std::sqrt;
  const T x = cos(theta) * cos(psi);
  const T y = cos(theta) * sin(psi);
  const T z = sin(theta) * cos(psi);
  const T length = sqrt(x * x + y * y + z * z);
  return {x / length, y / length, z / length};
}

/// Apex at (theta, psi) [rad] → (P_y, P_z) [px]. With L = l_s + camera_distance and focal length l_b K, then to_image():
///   pinhole:         P_z = l_b K (R n_z + h_c)/(L − R n_x),          P_y = l_b K R n_y/(L − R n_x)
///   plane_by_plane:  P_z = l_b K (R sin θ + h_c)/(L − R cos θ),      P_y = l_b K R sin ψ/(L − R cos ψ)   [P, Eq. 1]
template <class T>
std::array<T, 2> project_axis(const AxisCamera<T>& camera, const T& theta, const T& psi) {
  const auto& [model, c, g] = camera;
  using std::cos;
  using std::sin;
  const T focal = g.l_b * c.K;
  const T L = g.l_s + c.camera_distance;
  if (model == CameraModel::plane_by_plane) {
    const T p_y = focal * g.R * sin(psi) / (L - g.R * cos(psi));
    const T p_z = focal * (g.R * sin(theta) + c.h_c) / (L - g.R * cos(theta));
    return to_image(c, focal, p_y, p_z);
  }
  const std::array<T, 3> n = axis_direction(theta, psi);
  const T depth = L - g.R * n[0];
  return to_image(c, focal, T(focal * g.R * n[1] / depth), T(focal * (g.R * n[2] + c.h_c) / depth));
}

/// The inverse: (P_y, P_z) [px] → (theta, psi) [rad]; nullopt where no angle explains the pixel (its ray passes beside the sphere that the
/// apex moves on, or the lens has no inverse). Of the two points where a ray meets that sphere the one nearer the camera is meant. With u =
/// p_y / focal, v = p_z / focal after from_image(), both are closed:
///   pinhole: depth d from R² = (L − d)² + u² d² + (v d − h_c)²;   plane_by_plane: sin(θ + atan v) = (v L − h_c)/(R sqrt(1 + v²)).
template <class T>
std::optional<std::array<T, 2>> read_axis(const AxisCamera<T>& camera, const T& P_y, const T& P_z) {
  const auto& [model, c, g] = camera;
  using std::asin;
  using std::atan;
  using std::atan2;
  using std::sqrt;
  const T focal = g.l_b * c.K;
  const T L = g.l_s + c.camera_distance;
  const auto ideal = from_image(c, focal, P_y, P_z);
  if (!ideal) return std::nullopt;
  const T u = (*ideal)[0] / focal;
  const T v = (*ideal)[1] / focal;
  if (model == CameraModel::plane_by_plane) {
    const T s_z = (v * L - c.h_c) / (g.R * sqrt(T(1.0) + v * v));
    const T s_y = u * L / (g.R * sqrt(T(1.0) + u * u));
    if (!(s_z > T(-1.0) && s_z < T(1.0) && s_y > T(-1.0) && s_y < T(1.0))) return std::nullopt;
    return std::array<T, 2>{asin(s_z) - atan(v), asin(s_y) - atan(u)};
  }
  const T a = T(1.0) + u * u + v * v;
  const T b = L + v * c.h_c;
  const T e = L * L + c.h_c * c.h_c - g.R * g.R;  // > 0: the camera is outside the sphere
  const T discriminant = b * b - a * e;
  if (!(discriminant > T(0.0) && e > T(0.0) && b > T(0.0))) return std::nullopt;
  const T depth = e / (b + sqrt(discriminant));
  return std::array<T, 2>{atan2(v * depth - c.h_c, L - depth), atan2(u * depth, L - depth)};
}

}  // namespace misfit
