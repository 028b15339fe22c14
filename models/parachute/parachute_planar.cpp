#include "misfit/model/system_of.h"

namespace {

using namespace misfit;

/// Motion in the plane through tunnel axis and parachute axis; the clock angle phi(t) is an input, from the measurement:
/// lib/misfit/README.md (8) to (11); the paper is its [1].
///   I eta'' = M,  I = (m + m_a) R_cp² (+ port `inertia`)
///   felt wind: w_eta = V sin(eta) + R_cp eta',  w_phi = R_cp phi' sin(eta),  w_x = V cos(eta)
///   alpha_T = atan2(sqrt(w_eta² + w_phi²), w_x);  in-plane component of (v̂ × n): w_eta/|w|
/// With induced_angle = false: alpha_T = eta, the paper's Eq. 8; then alpha_T carries the sign of eta.
/// The wind follows the dynamic pressure, V_felt = V sqrt(q/qbar), so that a port on the pressure changes both.
struct ParachutePlanar {
  [[maybe_unused]] static constexpr int NU = 2;
  static constexpr int NX = 2, NP = 2, NF = 1, NQ = 10, NK = 7, NY = 1;
  enum Constant { D, S, R_cp, m, m_a, qbar, V };
  enum QuantityIndex { eta, pitch_rate, phi, phi_rate, gravity_direction, dynamic_pressure, wind_speed, inertia, alpha_T, wind_cross_axis };
  enum QuantityPort { pressure_port, inertia_port };

  bool induced = true;

  explicit ParachutePlanar(const SystemOptions& options) {
    const auto flag = options.flags.find("induced_angle");
    if (flag != options.flags.end()) induced = flag->second;
  }
  static std::vector<std::string> flags() { return {"induced_angle"}; }

  static bool wants(std::uint64_t needed, QuantityIndex i) { return (needed >> static_cast<unsigned>(i) & 1U) != 0U; }

  template <class T, class K>
  static T moment_of_inertia(const K* k, const T* P) {
    return (k[m] + k[m_a]) * (k[R_cp] * k[R_cp]) + P[inertia_port];
  }

  template <class T, class K>
  void quantities(const T* x, const double* u, double /*t*/, const K* k, const T* P, std::uint64_t needed, T* q) const {
    using std::cos;
    using std::sqrt;
    q[eta] = x[0];
    q[pitch_rate] = x[1];
    q[phi] = T(u[0]);
    q[phi_rate] = T(u[1]);
    q[dynamic_pressure] = k[qbar] + P[pressure_port];
    q[inertia] = moment_of_inertia(k, P);
    if (wants(needed, gravity_direction)) q[gravity_direction] = std::cos(u[0]) * cos(x[0]);
    // The root only where the pressure is changed: it costs as much as everything else here.
    q[wind_speed] = vanishes(P[pressure_port]) ? T(k[V]) : T(k[V] * sqrt(T(q[dynamic_pressure] / k[qbar])));
    if (!induced) {
      q[alpha_T] = x[0];
      q[wind_cross_axis] = T(1.0);  // alpha_T carries the sign: C_m enters undivided (QuantitySpec::carries_sign)
    } else if (wants(needed, alpha_T) || wants(needed, wind_cross_axis)) {
      felt_wind(x, u, k, q);
    }
  }

  /// Regular everywhere but at alpha_T = 0 exactly, where the derivative of the (even) angle is taken as 0; every use of alpha_T there is
  /// even or odd-over-sine, so nothing is lost.
  template <class T, class K>
  static void felt_wind(const T* x, const double* u, const K* k, T* q) {
    using std::atan2;
    using std::cos;
    using std::sin;
    using std::sqrt;
    const T sine = sin(x[0]);
    const T in_plane = q[wind_speed] * sine + k[R_cp] * x[1];
    const T across = k[R_cp] * u[1] * sine;
    const T along = q[wind_speed] * cos(x[0]);
    const T cross_squared = in_plane * in_plane + across * across;
    q[wind_cross_axis] = in_plane / sqrt(T(cross_squared + along * along));
    q[alpha_T] =
        value_of(cross_squared) > 0.0 ? T(atan2(T(sqrt(cross_squared)), along)) : T(value_of(along) < 0.0 ? 3.14159265358979323846 : 0.0);
  }

  template <class T, class K>
  void rates(const T* x, const double* /*u*/, double /*t*/, const K* k, const T* P, const T* F, T* dx) const {
    dx[0] = x[1];
    dx[1] = F[0] / moment_of_inertia(k, P);
  }

  template <class T, class K>
  void outputs(const T* x, const double* /*u*/, double /*t*/, const K* /*k*/, T* y) const {
    y[0] = x[0];
  }

  [[nodiscard]] SystemSpec spec() const {
    SystemSpec s;
    s.key = "parachute_planar";
    s.doc = induced ? "motion in the plane of the tilt, canopy feels V x - R_cp n'" : "the paper's Eq. 8: alpha_T is the state";
    s.formula = "I eta'' = sum of moments, I = (m + m_a) R_cp^2";
    s.source = "paper Eq. 8; lib/misfit/README.md (8) to (11)";
    s.states = {{"eta", "rad", -1, 0.1}, {"eta_rate", "rad/s", 0, 2.0}};
    s.force_ports = {"pitching_moment"};
    s.inputs = {{"phi", "rad", "clock angle of the axis, unwrapped", Hold::first_order},
                {"phi_rate", "rad/s", "its rate", Hold::first_order}};
    s.quantities = {{"eta", "rad", "geometric tilt of the axis", {}, false},
                    {"pitch_rate", "rad/s", "rotation rate in the plane of the tilt", {}, false},
                    {"phi", "rad", "clock angle", {"phi"}, false},
                    {"phi_rate", "rad/s", "rate of the clock angle", {"phi_rate"}, false},
                    {"gravity_direction", "-", "cos(phi) cos(eta)", {"phi"}, false, false},
                    {"dynamic_pressure", "Pa", "free-stream dynamic pressure", {}, false, false},
                    {"wind_speed", "m/s", "free-stream speed", {}, false, false},
                    {"inertia", "kg m^2", "(m + m_a) R_cp^2", {}, false, false},
                    {"alpha_T", "rad", "total angle of attack", {}, false},
                    {"wind_cross_axis", "-", "in-plane component of (wind direction x axis)", {}, false}};
    s.base_quantities = 5;
    if (induced) {
      s.quantities[alpha_T].inputs = s.quantities[wind_cross_axis].inputs = {"phi_rate"};
    } else {
      s.quantities[alpha_T].carries_sign = true;
    }
    s.quantity_ports = {{"dynamic_pressure", "Pa", "changes q and, as sqrt(q), V", "dynamic_pressure"},
                        {"inertia", "kg m^2", "adds to I", "inertia"}};
    s.dynamic_ports = {{"pitching_moment", "N m", "moment in the plane of the tilt, positive opens it", "pitch_rate"}};
    constexpr double huge = 1e6;
    s.constants = {{"D", "m", "reference diameter", 1e-6, huge, true, 0.0},
                   {"S", "m^2", "reference area", 1e-6, huge, true, 0.0},
                   {"R_cp", "m", "swivel to centre of pressure", 1e-6, huge, true, 0.0},
                   {"m", "kg", "mass of the parachute", 1e-9, huge, true, 0.0},
                   {"m_a", "kg", "apparent mass", 0.0, huge, true, 0.0},
                   {"qbar", "Pa", "dynamic pressure", 1e-6, 1e9, true, 0.0},
                   {"V", "m/s", "free-stream speed", 1e-6, 1e5, true, 0.0}};
    constexpr double typical_noise = 2e-3;
    s.outputs = {{induced ? "eta" : "alpha_T", "rad", 0, typical_noise}};
    s.roles = {{"rate", "pitch_rate"}, {"level", "eta"}, {"port", "pitching_moment"}, {"output", s.outputs.front().name}};
    if (!induced) s.coefficient_names = {{"C_mq", "C_m_alphadot"}};
    s.regression = {"parachute_planar", {{"induced_angle", false}}};
    s.static_curve = "C_m";
    s.damping_curve = induced ? "C_mq" : "C_m_alphadot";
    constexpr double typical_rate = 15.0;
    s.fastest_rate = typical_rate;
    return s;
  }

  /// C_m_alphadot = C_mq + (2 R_cp/D) C_m_alpha cos(alpha_T), lib/misfit/README.md (11): the induced angle damps as well.
  [[nodiscard]] std::vector<DerivedCurve> derived_curves(const double* k) const {
    if (!induced) return {};
    const double lever = 2.0 * k[R_cp] / k[D];
    return {{"C_m_alphadot",
             "alpha_T",
             "-",
             "C_mq + (2 R_cp/D) C_m_alpha cos(alpha_T)",
             {{"C_mq", 0, [](double) { return 1.0; }}, {"C_m", 1, [lever](double a) { return lever * std::cos(a); }}}}};
  }
};

}  // namespace

MISFIT_SYSTEM(parachute_planar, ParachutePlanar)
