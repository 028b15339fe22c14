#include <type_traits>

#include "misfit/math/camera.h"
#include "misfit/model/system_of.h"

namespace {

using namespace misfit;

/// Three-dimensional motion of an axisymmetric parachute about a fixed swivel, seen by one downstream camera
/// (lib/misfit/README.md (12) to (16)). n = unit vector swivel → apex
/// (x downstream, y left looking upstream, z down), states n_y, n_z and their rates, |n_y, n_z| < 1 and n_x > 0:
///   n'' = (tau × n)/I − |n'|² n,  I = (m + m_a) R_cp² (+ port `inertia`)
/// With s = sin(eta) and, where s > 0, theta^ = (n n_x − x^)/s (tilt grows) and phi^ = (n_z ŷ − n_y ẑ)/s (clock angle grows), a pair of
/// in-plane and lateral moments (M_p, M_l) moves n along M_p theta^ + M_l phi^; moments about fixed axes act through tau × n. A moment
/// along n does nothing, so tau_x is never needed. At s = 0 theta^ = ẑ, phi^ = ŷ: any pair of unit vectors serves there, because what is
/// regular enters as a vector. Relative wind at the centre of pressure: v = (V, wind_y, wind_z) − R_cp n'.
struct ParachuteSpherical {
  [[maybe_unused]] static constexpr int NU = 0;
  static constexpr int NX = 4, NP = 4, NF = 4, NQ = 17, NK = 18, NY = 2;
  enum State { y, z, dy, dz };
  enum Constant { D, S, R_cp, m, m_a, qbar, V, R, l_b, l_s, first_camera, K_camera = first_camera + 1, camera_distance = first_camera + 7 };
  enum QuantityIndex {
    n_y,
    n_z,
    eta,
    phi,
    pitch_rate,
    lateral_rate,
    phi_rate,
    gravity_direction,
    gravity_direction_lateral,
    image_scale,
    focal_length,
    dynamic_pressure,
    wind_speed,
    inertia,
    alpha_T,
    wind_cross_axis,
    wind_cross_axis_lateral
  };
  enum QuantityPort { pressure_port, inertia_port, wind_y_port, wind_z_port };
  enum DynamicPort { in_plane, lateral, moment_y, moment_z };

  bool pinhole = true;

  explicit ParachuteSpherical(const SystemOptions& options) {
    const auto flag = options.flags.find("plane_by_plane");
    if (flag != options.flags.end()) pinhole = !flag->second;
  }
  static std::vector<std::string> flags() { return {"plane_by_plane"}; }

  static bool wants(std::uint64_t needed, QuantityIndex i) { return is_needed(needed, static_cast<int>(i)); }

  /// The axis with the unit vectors of its tilt and clock angle: only y and z parts of them are needed.
  template <class T>
  struct Axis {
    T x, sine, theta_y, theta_z, phi_y, phi_z;
  };

  template <class T>
  static Axis<T> axis_of(const T* n) {
    using std::sqrt;
    const T cross_squared = n[y] * n[y] + n[z] * n[z];
    Axis<T> a;
    a.x = sqrt(T(1.0) - cross_squared);
    if (value_of(cross_squared) > 0.0) {
      a.sine = sqrt(cross_squared);
      const T toward_y = n[y] / a.sine, toward_z = n[z] / a.sine;
      a.theta_y = toward_y * a.x;
      a.theta_z = toward_z * a.x;
      a.phi_y = toward_z;
      a.phi_z = -toward_y;
    } else {
      // To first order theta^ = ẑ - n_z x^ and phi^ = ŷ - n_y x^: their x parts count in the derivatives of the relative wind.
      a.sine = n[z];
      a.theta_y = a.phi_z = T(0.0);
      a.theta_z = a.phi_y = T(1.0);
    }
    return a;
  }

  template <class T>
  static T axial_rate(const T* n, const T& n_x) {
    return -(n[y] * n[dy] + n[z] * n[dz]) / n_x;
  }

  template <class T, class K>
  static T moment_of_inertia(const K* k, const T* P) {
    return (k[m] + k[m_a]) * (k[R_cp] * k[R_cp]) + P[inertia_port];
  }

  template <class T, class K, class U>
  void quantities(const PointOf<T, K, U>& at, std::uint64_t needed, T* q) const {
    const auto& [n, u, t, k, P] = at;
    using std::atan2;
    using std::sqrt;
    const Axis<T> a = axis_of(n);
    const bool tilted = value_of(a.sine) > 0.0;
    q[n_y] = n[y];
    q[n_z] = n[z];
    if (wants(needed, eta)) q[eta] = tilted ? T(atan2(a.sine, a.x)) : T(0.0);
    if (wants(needed, phi)) q[phi] = tilted ? T(atan2(n[y], n[z])) : T(0.0);
    const T n_x_rate = axial_rate(n, a.x);
    q[pitch_rate] = a.theta_y * n[dy] + a.theta_z * n[dz] - a.sine * n_x_rate;
    q[lateral_rate] = a.phi_y * n[dy] + a.phi_z * n[dz];
    if (wants(needed, phi_rate)) q[phi_rate] = tilted ? T(q[lateral_rate] / a.sine) : T(0.0);
    q[gravity_direction] = a.theta_z;
    q[gravity_direction_lateral] = a.phi_z;
    if (wants(needed, image_scale)) q[image_scale] = T(k[l_b] * k[K_camera]) / (k[l_s] + k[camera_distance] - k[R] * a.x);
    q[focal_length] = T(k[l_b] * k[K_camera]);
    q[dynamic_pressure] = k[qbar] + P[pressure_port];
    q[inertia] = moment_of_inertia(k, P);
    // The root only where the pressure is changed: it costs as much as everything else here.
    q[wind_speed] = vanishes(P[pressure_port]) ? T(k[V]) : T(k[V] * sqrt(T(q[dynamic_pressure] / k[qbar])));
    if (wants(needed, alpha_T) || wants(needed, wind_cross_axis) || wants(needed, wind_cross_axis_lateral))
      relative_wind(at, a, n_x_rate, q);
  }

  /// Components of (v × n)/|v| about the axes of in-plane and lateral rotation; alpha_T between n and v.
  template <class T, class K, class U>
  static void relative_wind(const PointOf<T, K, U>& at, const Axis<T>& a, const T& n_x_rate, T* q) {
    const auto& [n, u, t, k, P] = at;
    using std::atan2;
    using std::sqrt;
    const T v_x = q[wind_speed] - k[R_cp] * n_x_rate;
    const T v_y = P[wind_y_port] - k[R_cp] * n[dy];
    const T v_z = P[wind_z_port] - k[R_cp] * n[dz];
    const T in_plane_wind = v_x * a.sine - (a.theta_y * v_y + a.theta_z * v_z);
    T across = -(a.phi_y * v_y + a.phi_z * v_z);
    if (value_of(a.sine) == 0.0) across += v_x * n[y];
    const T along = v_x * a.x + v_y * n[y] + v_z * n[z];
    const T cross_squared = in_plane_wind * in_plane_wind + across * across;
    const T speed = sqrt(T(cross_squared + along * along));
    q[wind_cross_axis] = in_plane_wind / speed;
    q[wind_cross_axis_lateral] = across / speed;
    q[alpha_T] =
        value_of(cross_squared) > 0.0 ? T(atan2(T(sqrt(cross_squared)), along)) : T(value_of(along) < 0.0 ? 3.14159265358979323846 : 0.0);
  }

  template <class T, class K, class U>
  void rates(const PointOf<T, K, U>& at, const T* F, T* dx) const {
    const auto& [n, u, t, k, P] = at;
    const Axis<T> a = axis_of(n);
    const T n_x_rate = axial_rate(n, a.x);
    const T turning = n[dy] * n[dy] + n[dz] * n[dz] + n_x_rate * n_x_rate;
    const T I = moment_of_inertia(k, P);
    dx[y] = n[dy];
    dx[z] = n[dz];
    dx[dy] = (F[in_plane] * a.theta_y + F[lateral] * a.phi_y + F[moment_z] * a.x) / I - turning * n[y];
    dx[dz] = (F[in_plane] * a.theta_z + F[lateral] * a.phi_z - F[moment_y] * a.x) / I - turning * n[z];
  }

  template <class T, class K>
  static CameraParameters<T> camera_of(const K* k) {
    CameraParameters<T> camera;
    const auto entries = camera_entries(camera);
    for (std::size_t i = 0; i < entries.size(); ++i) *entries[i] = T(k[first_camera + i]);
    return camera;
  }

  template <class T, class K, class U>
  void outputs(const PointOf<T, K, U>& at, T* pixels) const {
    const T* n = at.x;
    const K* k = at.k;
    using std::atan2;
    using std::sqrt;
    const CameraParameters<T> camera = camera_of<T>(k);
    const T n_x = sqrt(T(1.0) - n[y] * n[y] - n[z] * n[z]);
    std::array<T, 2> P;
    if (pinhole) {
      const T focal = T(k[l_b]) * camera.K;
      const T depth = T(k[l_s]) + camera.camera_distance - k[R] * n_x;
      P = to_image(camera, focal, T(focal * (k[R] * n[y]) / depth), T(focal * (k[R] * n[z] + camera.h_c) / depth));
    } else if constexpr (!std::is_same_v<T, formula::Symbol>) {
      const AxisGeometry rig{value_of(k[R]), value_of(k[l_b]), value_of(k[l_s])};
      P = project_axis(AxisCamera{CameraModel::plane_by_plane, camera, rig}, T(atan2(n[z], n_x)), T(atan2(n[y], n_x)));
    }
    pixels[0] = P[0];
    pixels[1] = P[1];
  }

  /// The geometry of plane_by_plane is numbers.
  [[nodiscard]] bool traceable() const { return pinhole; }

  /// n_y and n_z from pixels; false where no direction explains them.
  bool read_states(const double* pixels, const double* k, double* n) const {
    const CameraParameters<double> camera = camera_of<double>(k);
    const auto angles =
        read_axis(AxisCamera{pinhole ? CameraModel::pinhole : CameraModel::plane_by_plane, camera, AxisGeometry{k[R], k[l_b], k[l_s]}},
                  pixels[0], pixels[1]);
    if (!angles) return false;
    const std::array<double, 3> direction = axis_direction((*angles)[0], (*angles)[1]);
    n[y] = direction[1];
    n[z] = direction[2];
    return true;
  }

  static std::vector<QuantitySpec> quantity_list() {
    return {{.name = "n_y", .unit = "-", .doc = "axis, part to the left (looking upstream)", .carries_sign = true, .explains = false},
            {.name = "n_z", .unit = "-", .doc = "axis, part downward", .carries_sign = true, .explains = false},
            {.name = "eta", .unit = "rad", .doc = "geometric tilt of the axis", .explains = false},
            {.name = "phi", .unit = "rad", .doc = "clock angle atan2(n_y, n_z)", .carries_sign = true},
            {.name = "pitch_rate", .unit = "rad/s", .doc = "rotation rate in the plane of the tilt", .carries_sign = true},
            {.name = "lateral_rate", .unit = "rad/s", .doc = "rotation rate across the plane of the tilt", .carries_sign = true},
            {.name = "phi_rate", .unit = "rad/s", .doc = "rate of the clock angle", .carries_sign = true, .explains = false},
            {.name = "gravity_direction", .unit = "-", .doc = "cos(phi) cos(eta)", .carries_sign = true, .explains = false},
            {.name = "gravity_direction_lateral", .unit = "-", .doc = "-sin(phi)", .carries_sign = true, .explains = false},
            {.name = "image_scale", .unit = "px/m", .doc = "pixels per metre at the apex", .explains = false, .of_sensor = true},
            {.name = "focal_length", .unit = "px", .doc = "l_b K", .explains = false, .of_sensor = true},
            {.name = "dynamic_pressure", .unit = "Pa", .doc = "free-stream dynamic pressure", .explains = false},
            {.name = "wind_speed", .unit = "m/s", .doc = "free-stream speed along x", .explains = false},
            {.name = "inertia", .unit = "kg m^2", .doc = "(m + m_a) R_cp^2", .explains = false},
            {.name = "alpha_T", .unit = "rad", .doc = "total angle of attack, between axis and relative wind"},
            {.name = "wind_cross_axis",
             .unit = "-",
             .doc = "in-plane component of (wind direction x axis)",
             .carries_sign = true,
             .explains = false},
            {.name = "wind_cross_axis_lateral",
             .unit = "-",
             .doc = "lateral component of (wind direction x axis)",
             .carries_sign = true,
             .explains = false}};
  }

  static std::vector<ConstantSpec> constant_list() {
    constexpr double huge = 1e6;
    std::vector<ConstantSpec> list = {
        {.name = "D", .unit = "m", .doc = "reference diameter", .lower = 1e-6, .upper = huge},
        {.name = "S", .unit = "m^2", .doc = "reference area", .lower = 1e-6, .upper = huge},
        {.name = "R_cp", .unit = "m", .doc = "swivel to centre of pressure", .lower = 1e-6, .upper = huge},
        {.name = "m", .unit = "kg", .doc = "mass of the parachute", .lower = 1e-9, .upper = huge},
        {.name = "m_a", .unit = "kg", .doc = "apparent mass", .lower = 0.0, .upper = huge},
        {.name = "qbar", .unit = "Pa", .doc = "dynamic pressure", .lower = 1e-6, .upper = 1e9},
        {.name = "V", .unit = "m/s", .doc = "free-stream speed", .lower = 1e-6, .upper = 1e5},
        {.name = "R", .unit = "m", .doc = "swivel to apex", .lower = 1e-6, .upper = huge, .of_sensor = true},
        {.name = "l_b", .unit = "m", .doc = "backshell face to camera", .lower = 1e-6, .upper = huge, .of_sensor = true},
        {.name = "l_s", .unit = "m", .doc = "swivel to camera", .lower = 1e-6, .upper = huge, .of_sensor = true}};
    for (std::size_t i = 0; i < camera_parameter_names.size(); ++i) {
      const bool scale = i == 1;
      list.push_back({.name = camera_parameter_names[i],
                      .unit = camera_parameter_units[i],
                      .doc = "of the camera, from its calibration",
                      .lower = scale ? 1e-6 : -huge,
                      .upper = huge,
                      .required = false,
                      .value = scale ? 1.0 : 0.0,
                      .of_sensor = true});
    }
    return list;
  }

  [[nodiscard]] SystemSpec spec() const {
    SystemSpec s;
    s.key = "parachute_spherical";
    s.doc = "three-dimensional motion about the swivel, in pixels of one downstream camera";
    s.formula = "n'' = (tau x n)/I - |n'|^2 n, I = (m + m_a) R_cp^2; P by the camera";
    s.source = "rigid rotation of a line without spin; lib/misfit/README.md (12), (13)";
    s.states = {{.name = "n_y", .unit = "-", .scale = 0.1},
                {.name = "n_z", .unit = "-", .scale = 0.1},
                {.name = "n_y_rate", .unit = "1/s", .rate_of = y, .scale = 2.0},
                {.name = "n_z_rate", .unit = "1/s", .rate_of = z, .scale = 2.0}};
    s.quantities = quantity_list();
    s.base_quantities = dynamic_pressure;
    s.quantity_ports = {{.name = "dynamic_pressure", .unit = "Pa", .doc = "changes q and, as sqrt(q), V", .conjugate = "dynamic_pressure"},
                        {.name = "inertia", .unit = "kg m^2", .doc = "adds to I", .conjugate = "inertia"},
                        {.name = "wind_y", .unit = "m/s", .doc = "wind to the left (looking upstream)", .conjugate = "wind_speed"},
                        {.name = "wind_z", .unit = "m/s", .doc = "wind downward", .conjugate = "wind_speed"}};
    s.dynamic_ports = {
        {.name = "pitching_moment", .unit = "N m", .doc = "moment in the plane of the tilt, positive opens it", .conjugate = "pitch_rate"},
        {.name = "lateral_moment",
         .unit = "N m",
         .doc = "moment across it, positive turns the clock angle forward",
         .conjugate = "lateral_rate"},
        {.name = "moment_y", .unit = "N m", .doc = "moment about the fixed y axis: positive lifts (-n_z)"},
        {.name = "moment_z", .unit = "N m", .doc = "moment about the fixed z axis: positive moves to +y"}};
    s.constants = constant_list();
    constexpr double typical_noise = 0.5;
    s.outputs = {{.name = "P_y", .unit = "px", .noise = typical_noise}, {.name = "P_z", .unit = "px", .noise = typical_noise}};
    s.roles = {{"rate", "pitch_rate"},           {"level", "eta"},
               {"port", "pitching_moment"},      {"output", "P_z"},
               {"rate_lateral", "lateral_rate"}, {"port_lateral", "lateral_moment"}};
    s.force_ports = {"moment_y", "moment_z"};
    s.includes = {"coning"};
    s.readable_states = {y, z};
    s.regression = {.kind = "parachute_planar", .flags = {{"induced_angle", false}}};
    s.static_curve = "C_m";
    s.damping_curve = "C_mq";
    s.folded_angle = {.name = "alpha_T", .signed_name = "alpha", .even_curves = {"C_mq", "C_m_alphadot"}};
    s.compared_quantities = {{.name = "alpha_T"}, {.name = "phi_rate", .distribution_only = true}};  // undefined at zero tilt: unbounded
    constexpr double typical_rate = 15.0;
    s.fastest_rate = typical_rate;
    return s;
  }

  /// C_m_alphadot = C_mq + (2 R_cp/D) C_m_alpha cos(alpha_T), lib/misfit/README.md (11): the induced angle damps as well.
  [[nodiscard]] std::vector<DerivedCurve> derived_curves(const double* k) const {
    const double lever = 2.0 * k[R_cp] / k[D];
    return {{.name = "C_m_alphadot",
             .of = "alpha_T",
             .unit = "-",
             .doc = "C_mq + (2 R_cp/D) C_m_alpha cos(alpha_T)",
             .terms = {{.curve = "C_mq", .factor = [](double) { return 1.0; }},
                       {.curve = "C_m", .derivative = 1, .factor = [lever](double a) { return lever * std::cos(a); }}}}};
  }
};

}  // namespace

MISFIT_SYSTEM(parachute_spherical, ParachuteSpherical)
