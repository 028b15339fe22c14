#include "misfit/model/system_of.h"

namespace {

using namespace misfit;

/// Motion in the plane through tunnel axis and parachute axis; the clock angle phi(t) is an input, from the measurement:
/// lib/misfit/README.md (8) to (11); the paper is its [1].
///   I eta'' = M,  I = (m + m_a) R_cp² (+ port `inertia`)
///   relative wind: w_eta = V sin(eta) + R_cp eta',  w_phi = R_cp phi' sin(eta),  w_x = V cos(eta)
///   alpha_T = atan2(sqrt(w_eta² + w_phi²), w_x);  in-plane component of (v̂ × n): w_eta/|w|
/// With induced_angle = false: alpha_T = eta, the paper's Eq. 8; then alpha_T carries the sign of eta.
/// The wind follows the dynamic pressure, V_felt = V sqrt(q/qbar), so that a port on the pressure changes both.
struct ParachutePlanar {
  [[maybe_unused]] static constexpr int NU = 2;
  static constexpr int NX = 2, NP = 2, NF = 1, NQ = 10, NK = 7, NY = 1;
  enum State { tilt, tilt_rate };
  enum Input { clock_angle, clock_angle_rate };
  enum Output { measured_tilt };
  enum Constant { D, S, R_cp, m, m_a, qbar, V };
  enum QuantityIndex { eta, pitch_rate, phi, phi_rate, gravity_direction, dynamic_pressure, wind_speed, inertia, alpha_T, wind_cross_axis };
  enum QuantityPort { pressure_port, inertia_port };
  enum DynamicPort { in_plane };

  bool induced = true;

  explicit ParachutePlanar(const SystemOptions& options) {
    const auto flag = options.flags.find("induced_angle");
    if (flag != options.flags.end()) induced = flag->second;
  }
  static std::vector<std::string> flags() { return {"induced_angle"}; }

  static bool wants(std::uint64_t needed, QuantityIndex i) { return is_needed(needed, static_cast<int>(i)); }

  template <class T, class K>
  static T moment_of_inertia(const K* k, const T* P) {
    return (k[m] + k[m_a]) * (k[R_cp] * k[R_cp]) + P[inertia_port];
  }

  template <class T, class K, class U>
  void quantities(const PointOf<T, K, U>& at, std::uint64_t needed, T* q) const {
    const auto& [x, u, t, k, P] = at;
    using std::cos;
    using std::sqrt;
    q[eta] = x[tilt];
    q[pitch_rate] = x[tilt_rate];
    q[phi] = T(u[clock_angle]);
    q[phi_rate] = T(u[clock_angle_rate]);
    q[dynamic_pressure] = k[qbar] + P[pressure_port];
    q[inertia] = moment_of_inertia(k, P);
    if (wants(needed, gravity_direction)) q[gravity_direction] = cos(u[clock_angle]) * cos(x[tilt]);
    // The root only where the pressure is changed: it costs as much as everything else here.
    q[wind_speed] = vanishes(P[pressure_port]) ? T(k[V]) : T(k[V] * sqrt(T(q[dynamic_pressure] / k[qbar])));
    if (!induced) {
      q[alpha_T] = x[tilt];
      q[wind_cross_axis] = T(1.0);  // alpha_T carries the sign: C_m enters undivided (QuantitySpec::carries_sign)
    } else if (wants(needed, alpha_T) || wants(needed, wind_cross_axis)) {
      relative_wind(x, u, k, q);
    }
  }

  /// Regular everywhere but at alpha_T = 0 exactly, where the derivative of the (even) angle is taken as 0; every use of alpha_T there is
  /// even or odd-over-sine, so nothing is lost.
  template <class T, class K, class U>
  static void relative_wind(const T* x, const U* u, const K* k, T* q) {
    using std::atan2;
    using std::cos;
    using std::sin;
    using std::sqrt;
    const T sine = sin(x[tilt]);
    const T in_plane_wind = q[wind_speed] * sine + k[R_cp] * x[tilt_rate];
    const T across = k[R_cp] * u[clock_angle_rate] * sine;
    const T along = q[wind_speed] * cos(x[tilt]);
    const T cross_squared = in_plane_wind * in_plane_wind + across * across;
    q[wind_cross_axis] = in_plane_wind / sqrt(T(cross_squared + along * along));
    q[alpha_T] =
        value_of(cross_squared) > 0.0 ? T(atan2(T(sqrt(cross_squared)), along)) : T(value_of(along) < 0.0 ? 3.14159265358979323846 : 0.0);
  }

  template <class T, class K, class U>
  void rates(const PointOf<T, K, U>& at, const T* F, T* dx) const {
    const auto& [x, u, t, k, P] = at;
    dx[tilt] = x[tilt_rate];
    dx[tilt_rate] = F[in_plane] / moment_of_inertia(k, P);
  }

  template <class T, class K, class U>
  void outputs(const PointOf<T, K, U>& at, T* y) const {
    y[measured_tilt] = at.x[tilt];
  }

  [[nodiscard]] SystemSpec spec() const {
    SystemSpec s;
    s.key = "parachute_planar";
    s.doc = induced ? "motion in the plane of the tilt, canopy feels V x - R_cp n'" : "the paper's Eq. 8: alpha_T is the state";
    s.formula = "I eta'' = sum of moments, I = (m + m_a) R_cp^2";
    s.source =
        "Schoenenberger, Queen, Cruz, Parachute Aerodynamics from Video Data, AIAA 2005-1633 (2005), Eq. 8; lib/misfit/README.md (8) to "
        "(11)";
    s.states = {{.name = "eta", .unit = "rad", .scale = 0.1}, {.name = "eta_rate", .unit = "rad/s", .rate_of = tilt, .scale = 2.0}};
    s.force_ports = {"pitching_moment"};
    s.inputs = {{.name = "phi", .unit = "rad", .doc = "clock angle of the axis, unwrapped", .hold = Hold::first_order},
                {.name = "phi_rate", .unit = "rad/s", .doc = "its rate", .hold = Hold::first_order}};
    s.quantities = quantity_specs();
    s.base_quantities = dynamic_pressure;
    if (induced) {
      s.quantities[alpha_T].inputs = s.quantities[wind_cross_axis].inputs = {"phi_rate"};
    } else {
      s.quantities[alpha_T].carries_sign = true;
    }
    s.quantity_ports = {{.name = "dynamic_pressure", .unit = "Pa", .doc = "changes q and, as sqrt(q), V", .conjugate = "dynamic_pressure"},
                        {.name = "inertia", .unit = "kg m^2", .doc = "adds to I", .conjugate = "inertia"}};
    s.dynamic_ports = {
        {.name = "pitching_moment", .unit = "N m", .doc = "moment in the plane of the tilt, positive opens it", .conjugate = "pitch_rate"}};
    s.constants = constant_specs();
    constexpr double typical_noise = 2e-3;
    s.outputs = {{.name = induced ? "eta" : "alpha_T", .unit = "rad", .observes = tilt, .noise = typical_noise}};
    s.roles = {{"rate", "pitch_rate"}, {"level", "eta"}, {"port", "pitching_moment"}, {"output", s.outputs.front().name}};
    if (!induced) s.coefficient_names = {{"C_mq", "C_m_alphadot"}};
    s.regression = {.kind = "parachute_planar", .flags = {{"induced_angle", false}}};
    s.static_curve = "C_m";
    s.damping_curve = induced ? "C_mq" : "C_m_alphadot";
    s.folded_angle = {.name = "alpha_T", .signed_name = "alpha", .even_curves = {"C_mq", "C_m_alphadot"}};
    s.compared_quantities = {{.name = "alpha_T"}, {.name = "phi_rate", .distribution_only = true}};  // undefined at zero tilt: unbounded
    constexpr double typical_rate = 15.0;
    s.fastest_rate = typical_rate;
    return s;
  }

  [[nodiscard]] static std::vector<QuantitySpec> quantity_specs() {
    return {{.name = "eta", .unit = "rad", .doc = "geometric tilt of the axis"},
            {.name = "pitch_rate", .unit = "rad/s", .doc = "rotation rate in the plane of the tilt"},
            {.name = "phi", .unit = "rad", .doc = "clock angle", .inputs = {"phi"}},
            {.name = "phi_rate", .unit = "rad/s", .doc = "rate of the clock angle", .inputs = {"phi_rate"}},
            {.name = "gravity_direction", .unit = "-", .doc = "cos(phi) cos(eta)", .inputs = {"phi"}, .explains = false},
            {.name = "dynamic_pressure", .unit = "Pa", .doc = "free-stream dynamic pressure", .explains = false},
            {.name = "wind_speed", .unit = "m/s", .doc = "free-stream speed", .explains = false},
            {.name = "inertia", .unit = "kg m^2", .doc = "(m + m_a) R_cp^2", .explains = false},
            {.name = "alpha_T", .unit = "rad", .doc = "total angle of attack"},
            {.name = "wind_cross_axis", .unit = "-", .doc = "in-plane component of (wind direction x axis)"}};
  }

  [[nodiscard]] static std::vector<ConstantSpec> constant_specs() {
    constexpr double huge = 1e6;
    return {{.name = "D", .unit = "m", .doc = "reference diameter", .lower = 1e-6, .upper = huge},
            {.name = "S", .unit = "m^2", .doc = "reference area", .lower = 1e-6, .upper = huge},
            {.name = "R_cp", .unit = "m", .doc = "swivel to centre of pressure", .lower = 1e-6, .upper = huge},
            {.name = "m", .unit = "kg", .doc = "mass of the parachute", .lower = 1e-9, .upper = huge},
            {.name = "m_a", .unit = "kg", .doc = "apparent mass", .lower = 0.0, .upper = huge},
            {.name = "qbar", .unit = "Pa", .doc = "dynamic pressure", .lower = 1e-6, .upper = 1e9},
            {.name = "V", .unit = "m/s", .doc = "free-stream speed", .lower = 1e-6, .upper = 1e5}};
  }

  /// C_m_alphadot = C_mq + (2 R_cp/D) C_m_alpha cos(alpha_T), lib/misfit/README.md (11): the induced angle damps as well.
  [[nodiscard]] std::vector<DerivedCurve> derived_curves(const double* k) const {
    if (!induced) return {};
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

MISFIT_SYSTEM(parachute_planar, ParachutePlanar)
