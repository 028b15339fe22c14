#pragma once

#include <algorithm>
#include <ostream>

#include "tests/model/requests.h"

namespace misfit::testing_models {

/// A named model on which the laws of assembled models are tried. Values are set and shaken.
struct Case {
  std::string name;
  ModelRequest request;

  [[nodiscard]] Model model() const {
    Model m = assemble(request, registry());
    if (m.find_curve("C_m") != nullptr) set_parachute_curves(m);
    shake(m, 17);
    return m;
  }
  friend void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }
};

inline Case with_free_constants(Case c) {
  free_all_constants(c.request);
  c.name += "_free_constants";
  return c;
}

/// Strengths at values that count: shake() alone leaves them within 30 % of their scale.
inline ModelRequest with_values(ModelRequest request, const std::map<std::string, double>& values) {
  for (const auto& [name, value] : values) request.parameters[name].value = value;
  return request;
}

inline ModelRequest with_scale_curve(ModelRequest request) {
  request.curves["scale_error"] = {"position_reading", {-0.5, 0.0, 0.5}, {}, {}};
  return request;
}

/// The effect that lends a coefficient stands behind the one that borrows it.
inline ModelRequest lender_last(ModelRequest request) {
  std::rotate(request.effects.begin(), request.effects.begin() + 1, request.effects.end());
  return request;
}

/// Constants that act on the outputs alone.
inline ModelRequest free_camera(ModelRequest request) {
  for (const char* name : {"h_c", "K", "camera_roll", "lens_k1", "R", "l_s"}) request.parameters[name].free = true;
  return request;
}

/// Two curves of one quantity over the same knots, which an evaluator may look up together.
inline ModelRequest with_equal_knots(ModelRequest request) {
  request.curves["C_m_alphadot"].knots = request.curves["C_m"].knots;
  return request;
}

/// Both forms of the planar parachute, one effect of each kind on it, and everything at once.
inline std::vector<Case> planar_cases() {
  const std::map<std::string, double> friction = {{"friction", 8.0}, {"width", 0.2}};
  return {
      {"paper_form", parachute(false)},
      {"induced_form", parachute(true)},
      {"curves_on_equal_knots", with_equal_knots(parachute(false))},
      {"force", with_values(parachute(true, {effect("periodic_forcing")}), {{"cosine", 4.0}, {"sine", -7.0}, {"frequency", 1.7}})},
      {"changed_quantity", with_values(parachute(true, {effect("dynamic_pressure_drift")}), {{"pressure_drift", 20.0}, {"t_drift", -3.0}})},
      {"changed_quantity_reads_state", with_values(parachute(true, {effect("inertia_swell")}), {{"swell", 6.0}})},
      {"memory_on_a_force", with_values(parachute(true, {effect("lag")}), {{"lag_stiffness", 120.0}, {"tau", 0.3}})},
      {"memory_on_a_quantity", with_values(parachute(false, {effect("pressure_memory")}), {{"blockage", 900.0}, {"blockage_tau", 0.4}})},
      {"sensor", with_values(parachute(false, {effect("bias")}), {{"offset", 0.01}})},
      {"shifted_time",
       with_values(parachute(true, {effect("time_offset"), effect("periodic_forcing")}), {{"clock_offset", 0.013}, {"cosine", 9.0}})},
      {"friction", with_values(parachute(true, {effect("coulomb_friction"), effect("viscous_friction")}), friction)},
      {"everything", parachute(true, {effect("periodic_forcing"), effect("dynamic_pressure_drift"), effect("inertia_swell"), effect("lag"),
                                      effect("pressure_memory"), effect("bias"), effect("time_offset"), effect("viscous_friction")})}};
}

inline std::vector<Case> cases_of_other_systems() {
  return {
      {"cart_all_ports",
       cart({effect("viscous_friction"), effect("viscous_friction", {{"rate", "x"}, {"port", "slip"}}, "leak"), effect("lag"),
             effect("bias", {{"output", "speed_reading"}}), effect("periodic_forcing", {{"port", "added_mass"}}, "breathing")})},
      {"cart_two_ports_of_one_effect", with_values(cart({effect("own_weight", {{"also", "slip"}})}), {{"share", 0.4}})},
      {"cart_sensor_memory", with_values(cart({effect("sensor_lag"), effect("sensor_scale")}), {{"share", 0.7}, {"scale_error", 0.05}})},
      {"cart_friction_with_memory",
       with_values(cart({effect("hysteresis"), effect("backlash"), effect("coulomb_friction"), effect("stribeck_friction"),
                         effect("directional_friction"), effect("quadratic_drag")}),
                   {{"hysteresis", 3.0},
                    {"yield", 0.2},
                    {"play_stiffness", 5.0},
                    {"play", 0.05},
                    {"friction", 4.0},
                    {"breakaway", 2.0},
                    {"asymmetry", 0.5},
                    {"drag", 0.7}})},
      {"cart_late_sensor_and_input", with_values(cart({effect("sensor_delay"), effect("delay"), effect("cubic_stiffness")}),
                                                 {{"late_share", 0.8}, {"sensor_delay", 0.2}, {"delayed_gain", 1.5}, {"delay", 0.3}})},
      {"cart_sensors_with_clocks", with_values(cart({effect("sensor_clock", {{"time_of_output", "sample_time_speed_reading"}}),
                                                     effect("viscous_friction"), effect("sensor_lag")}),
                                               {{"sensor_offset", -0.07}, {"clock_rate", 0.02}, {"share", 0.7}})},
      {"tanks_that_spill",
       with_values(
           tanks({effect("overflow", {{"level", "x1"}, {"port", "dx1/dt"}}),
                  effect("overflow_into", {{"level", "x1"}, {"to_port", "dx2/dt"}}), effect("sensor_lag"), effect("input_gain")}),
           {{"spill", 0.5}, {"threshold", 0.1}, {"caught", 0.3}, {"caught_threshold", -0.2}, {"share", 0.6}, {"gain_error", 0.02}})},
      {"tanks_that_spill_into_each_other",
       with_values(tanks({effect("overflow_between", {{"level", "x1"}, {"port", "dx1/dt"}, {"to_port", "dx2/dt"}})}),
                   {{"spilled", 0.5}, {"spill_edge", 0.1}, {"caught_share", 0.3}})},
      {"declared_pendulum", declared("pendulum", {})},
      {"declared_with_effects",
       declared("pendulum", {effect("coulomb_friction"), effect("viscous_friction"), effect("bias"), effect("lag")})},
      {"declared_with_changed_input", declared("duffing", {effect("viscous_friction"), effect("bias", {{"output", "u"}}, "zero_of_u")})},
      {"cart_curve_of_an_output", with_scale_curve(cart({effect("sensor_scale"), effect("coulomb_friction")}))}};
}

inline std::vector<Case> spherical_cases() {
  return {{"spherical", spherical()},
          {"wake", with_values(spherical({effect("strut_wake")}),
                               {{"wake_depth", 0.5}, {"wake_push", 0.15}, {"wake_phi", -1.6}, {"wake_width", 0.9}})},
          {"wake_before_what_it_weakens", lender_last(with_values(spherical({effect("strut_wake")}), {{"wake_depth", 0.5}}))},
          {"upwash", with_values(spherical({effect("flow_angularity")}), {{"flow_theta", 0.03}, {"flow_psi", -0.02}})},
          {"wrong_camera",
           with_values(spherical({effect("camera_roll"), effect("image_centre"), effect("scale_error"), effect("camera_height_error"),
                                  effect("pixel_aspect"), effect("lens_distortion"), effect("field_offset")}),
                       {{"roll_error", 0.05}, {"K_error", 2.0}, {"h_c_error", 0.02}, {"aspect_error", 0.02}, {"k1_error", -0.1}})},
          {"channels_along_wrong_axes",
           with_values(spherical({effect("cross_talk", {{"output", "P_y"}, {"other_signal", "P_z"}}),
                                  effect("output_rotation", {{"output", "P_y"}, {"other_output", "P_z"}, {"other_signal", "P_z"}})}),
                       {{"cross_share", 0.04}, {"rotation", 0.07}})},
          {"free_camera", free_camera(spherical({effect("strut_wake"), effect("scale_error")}))},
          {"free_camera_that_moves_the_canopy", free_camera(spherical({effect("viscous_friction", {{"rate", "image_scale"}})}))},
          {"random_states", with_values(spherical({effect("gust"), effect("apex_jitter")}), {{"gust_sigma", 27.0}, {"jitter", 1.0}})},
          {"other_physics", with_values(spherical({effect("magnus"), effect("relative_dynamic_pressure"), effect("apparent_inertia"),
                                                   effect("lateral_damping"), effect("coulomb_friction"), effect("viscous_friction")}),
                                        {{"C_spin", 0.05},
                                         {"relative_pressure", 1.0},
                                         {"inertia_growth", 10.0},
                                         {"friction", 20.0},
                                         {"width", 0.2},
                                         {"viscosity", 5.0}})},
          {"lagging_flow",
           with_values(spherical({effect("aerodynamic_lag"), effect("vortex_shedding")}), {{"share_lag", 0.3}, {"y_sine", 0.01}})}};
}

/// All of these, each also with all constants freed.
inline std::vector<Case> cases() {
  std::vector<Case> all;
  for (const auto& part : {planar_cases(), spherical_cases(), cases_of_other_systems()}) {
    for (const auto& c : part) {
      all.push_back(c);
      all.push_back(with_free_constants(c));
    }
  }
  return all;
}

/// States and inputs at which the laws are tried: random, plus rest at 0, where angles have no derivative of their own.
struct Sample {
  std::vector<double> x, u;
  double t;
  RecordedInputs recorded;  ///< from long before to long after

  [[nodiscard]] InputsAt inputs() const { return {u.data(), &recorded}; }
};
inline std::vector<Sample> samples_of(const Model& model, int count) {
  std::mt19937 random(23);
  std::normal_distribution<double> normal;
  std::vector<Sample> samples;
  const auto& states = model.system->spec().states;
  const bool spherical = states.size() == 4;
  for (int s = 0; s < count; ++s) {
    Sample sample{{}, {}, 0.7 * s, {}};
    for (int i = 0; i < model.states(); ++i) {
      const double size = spherical && i < 4 ? 1.5 * states[static_cast<std::size_t>(i)].scale : i == 1 ? 1.0 : 0.25;
      sample.x.push_back(s == 0 ? 0.0 : size * normal(random));
    }
    for (int i = 0; i < model.inputs(); ++i) sample.u.push_back(s == 0 ? 0.0 : normal(random));
    sample.recorded = {{-100.0, 200.0}, std::vector<Hold>(sample.u.size(), Hold::first_order), {}};
    for (const double end : {1.7, -2.3}) {
      for (int i = 0; i < std::max(model.inputs(), 1); ++i) sample.recorded.values.push_back(end + 0.3 * i);
    }
    samples.push_back(sample);
  }
  return samples;
}

}  // namespace misfit::testing_models
