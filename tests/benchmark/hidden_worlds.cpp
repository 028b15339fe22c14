#include "tests/benchmark/hidden_worlds.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <stdexcept>

#include "misfit/sim/random_run.h"
#include "tests/benchmark/known_truth.h"

namespace misfit::bench {
namespace {

/// One kind of hidden effect: its coefficients for a size (1: a drop of about 60 in 40 s) at random directions, phases and shapes.
struct Recipe {
  Hidden hidden;
  std::function<std::map<std::string, double>(Dice&, double size)> values;
};

/// One coefficient of either sign.
auto one(const std::string& name, double usual) {
  return [=](Dice& dice, double size) { return std::map<std::string, double>{{name, dice.sign() * usual * size}}; };
}

/// From outside: the strut's wake, vortices, wind.
std::vector<Recipe> flows() {
  const auto wake = [](const std::string& depth, const std::string& push, const std::string& phi, const std::string& width) {
    return [=](Dice& dice, double size) {
      return std::map<std::string, double>{{depth, 0.2 * size}, {push, 0.07 * size}, {phi, dice.angle()}, {width, dice.uniform(0.3, 0.5)}};
    };
  };
  return {{{"strut_wake", "strut_wake", {"phi"}, {}}, wake("wake_depth", "wake_push", "wake_phi", "wake_width")},
          {{"wake_with_cosine_edge", "strut_wake", {"phi"}, {}}, wake("edge_depth", "edge_push", "edge_phi", "edge_width")},
          {{"vortex_shedding", "vortex_shedding", {}, {}},
           [](Dice& dice, double size) {
             const double a = dice.angle(), p = dice.angle(), s = 0.0030 * size;
             return std::map<std::string, double>{{"y_cosine", s * std::cos(a) * std::cos(p)},
                                                  {"y_sine", s * std::cos(a) * std::sin(p)},
                                                  {"z_cosine", s * std::sin(a) * std::cos(p)},
                                                  {"z_sine", s * std::sin(a) * std::sin(p)},
                                                  {"shedding_frequency", dice.uniform(1.0, 4.0)}};
           }},
          {{"drifting_vortices", "vortex_shedding", {}, {}},
           [](Dice& dice, double size) {
             const double a = dice.angle(), s = 0.0030 * size;
             // Over the flight the frequency moves by up to about one width of a line.
             return std::map<std::string, double>{{"drift_y", s * std::cos(a)},
                                                  {"drift_z", s * std::sin(a)},
                                                  {"drift_from", dice.uniform(1.0, 4.0)},
                                                  {"drift_rate", dice.uniform(-1.0, 1.0) * 6e-4}};
           }},
          {{"flow_angularity", "flow_angularity", {}, {}}, [](Dice& dice, double size) {
             const double a = dice.angle(), s = 1.15 * degree * size;
             return std::map<std::string, double>{{"flow_theta", s * std::cos(a)}, {"flow_psi", s * std::sin(a)}};
           }}};
}

/// Of the parachute, its bearing and the camera.
std::vector<Recipe> own_effects() {
  return {{{"coulomb_friction", "coulomb_friction", {"pitch_rate", "lateral_rate"}, {}},
           [](Dice&, double size) {
             return std::map<std::string, double>{{"friction", 13.0 * size}};
           }},
          {{"lateral_damping", "lateral_damping", {"pitch_rate", "lateral_rate"}, {}}, one("C_lateral", 0.7)},
          {{"aerodynamic_lag", "aerodynamic_lag", {}, {}},
           [](Dice& dice, double size) {
             return std::map<std::string, double>{{"share_lag", 0.35 * size}, {"tau_lag", dice.uniform(0.05, 0.3)}};
           }},
          {{"magnus", "magnus", {"pitch_rate", "lateral_rate"}, {}}, one("C_spin", 0.35)},
          {{"camera_roll", "camera_roll", {}, {}}, one("roll_error", 8.0 * degree)},
          {{"image_centre", "image_centre", {}, {}}, [](Dice& dice, double /*size*/) {
             // As its prior says (Table 2): a larger one is rightly taken for wind.
             std::normal_distribution<double> shift(0.0, 10.0 / 3.0);
             const double right = shift(dice.random);
             return std::map<std::string, double>{{"centre_y_error", right}, {"centre_z_error", shift(dice.random)}};
           }}};
}

std::vector<Recipe> listed() {
  std::vector<Recipe> out = flows();
  for (auto& recipe : own_effects()) out.push_back(std::move(recipe));
  return out;
}

std::vector<Recipe> unlisted() {
  return {{{"three_lobes", "", {"phi"}, {}}, one("lobes", 9.0)},
          {{"fast_turning", "", {"lateral_rate", "phi_rate"}, {}}, one("turning", 15.0)},
          {{"turn_by_angle", "", {"alpha_T", "eta"}, {}}, one("twist", 9.0)}};
}

/// C_m of the worlds under data/parachute, every 2 deg from 0 to 24.
constexpr std::array<double, 13> static_table = {0.0,    0.0075,  0.0135,  0.017,   0.0165,  0.0105, 0.0,
                                                 -0.014, -0.0310, -0.0500, -0.0709, -0.0936, -0.1177};

double between(double x) {
  const double place = std::clamp(x / (2.0 * degree), 0.0, 11.999);
  const auto i = static_cast<std::size_t>(place);
  return static_table[i] + (place - static_cast<double>(i)) * (static_table[i + 1] - static_table[i]);
}

ModelRequest base_request() {
  ModelRequest r;
  r.system = "parachute_spherical";
  r.constants = {{"D", 1.5816}, {"S", 1.9554}, {"R_cp", 3.15}, {"m", 0.206},  {"m_a", 0.294},  {"qbar", 736.0},
                 {"V", 35.1},   {"R", 3.447},  {"l_b", 5.69},  {"l_s", 5.61}, {"h_c", 0.1524}, {"K", 133.86}};
  for (const char* key : {"static_moment", "pitch_damping", "gravity"}) r.effects.push_back({key, key, {}, {}});
  return r;
}

/// As a sweep with 1 px of noise leaves it: what is not freed is tested.
Calibration usual_calibration() {
  Calibration c;
  c.camera.h_c = 0.1524;
  c.camera.K = 133.86;
  c.tests = {{"camera_roll", {"camera_roll"}, {0.0}, {0.003}, 0.0, 1.0, false},
             {"image_centre", {"centre_y", "centre_z"}, {0.0, 0.0}, {0.6, 1.2}, 0.0, 1.0, false},
             {"pixel_aspect", {"pixel_aspect"}, {0.0}, {0.003}, 0.0, 1.0, false}};
  c.names = {"h_c", "K"};
  c.covariance = Eigen::Vector2d(0.004 * 0.004, 0.3 * 0.3).asDiagonal();
  c.converged = true;
  return c;
}

void vary_curves(Model& model, Dice& dice) {
  const double trim = dice.uniform(10.5, 13.5) * degree, steepness = dice.uniform(0.8, 1.2);
  set_curve(model, "C_m", [&](double x) { return steepness * between(x * 12.0 * degree / trim); });
  const double base = -0.25 * dice.uniform(0.8, 1.2), hump = 0.55 * dice.uniform(0.6, 1.0);
  set_curve(model, "C_mq", [&](double x) { return base + hump * std::exp(-std::pow((x - trim + 1.0 * degree) / (3.0 * degree), 2)); });
}

double zero_of_static(const Model& model) {
  double low = 8.0 * degree, high = 16.0 * degree;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (curve_value(model, "C_m", middle) > 0.0 ? low : high) = middle;
  }
  return low;
}

std::vector<Hidden> hide(const std::string& kind, Dice& dice, double& strength) {
  std::vector<Hidden> out;
  if (kind == "null") return out;
  const std::vector<Recipe> recipes = kind == "unlisted" ? unlisted() : listed();
  const std::size_t count = kind == "two" ? 2 : 1;
  while (out.size() < count) {
    const Recipe& recipe = recipes[dice.pick(recipes.size())];
    if (!out.empty() && out.front().known_as == recipe.hidden.known_as) continue;
    const double size = std::exp(dice.uniform(std::log(0.3), std::log(3.0)));
    if (out.empty()) strength = size;
    out.push_back(recipe.hidden);
    out.back().values = recipe.values(dice, size);
  }
  return out;
}

Signals fly(const Model& model, double seconds, Dice& dice) {
  constexpr double rate = 59.94, settling = 5.0, white = 0.5;
  Signals s;
  s.name = "flight";
  const auto before = static_cast<int>(std::ceil(settling * rate)), samples = static_cast<int>(std::ceil(seconds * rate));
  for (int i = -before; i < samples; ++i) s.t.push_back(i / rate);
  Stepper stepper(model);
  std::vector<double> x(static_cast<std::size_t>(model.states()), 0.0);
  const double eta = dice.uniform(5.0, 15.0) * degree, phi = dice.angle();
  x[0] = std::sin(eta) * std::sin(phi);
  x[1] = std::sin(eta) * std::cos(phi);
  Segment run;
  run_randomly({stepper, s, input_table(s, model)}, x.data(), dice.random, run);
  if (!run.finite) throw std::runtime_error("the simulated motion is not finite");
  std::normal_distribution<double> normal;
  s.t.erase(s.t.begin(), s.t.begin() + before);
  for (int o = 0; o < 2; ++o) {
    Signal channel;
    channel.name = o == 0 ? "P_y" : "P_z";
    channel.unit = "px";
    for (int i = 0; i < samples; ++i) channel.values.push_back(run.y(before + i, o) + white * normal(dice.random));
    s.measured.push_back(std::move(channel));
  }
  return s;
}

}  // namespace

World draw_world(const std::string& kind, int number, double seconds, const Registry& truth) {
  World world;
  world.kind = kind;
  world.number = number;
  Dice dice(kind, number);
  world.request = base_request();
  world.hidden = hide(kind, dice, world.strength);
  ModelRequest full = world.request;
  for (const char* curve : {"C_m", "C_mq"}) {
    full.curves[curve].of = "alpha_T";
    for (int i = 0; i <= 24; ++i) full.curves[curve].knots.push_back((0.5 + i * 24.5 / 24.0) * degree);
  }
  for (const auto& h : world.hidden) full.effects.push_back({h.effect, h.effect, {}, {}});
  full.effects.push_back({"gust", "gust", {}, {}});
  full.effects.push_back({"apex_jitter", "apex_jitter", {}, {}});
  world.truth = assemble(full, truth);
  vary_curves(world.truth, dice);
  world.trim = zero_of_static(world.truth);
  set(world.truth, "gust_sigma", 27.0);
  set(world.truth, "gust_tau", 0.1);
  set(world.truth, "jitter", dice.uniform(0.7, 1.3));
  set(world.truth, "jitter_frequency", dice.uniform(8.0, 10.0));
  set(world.truth, "jitter_damping", 0.1);
  world.calibrated = true;
  for (const auto& h : world.hidden) {
    for (const auto& [name, value] : h.values) set(world.truth, name, value);
    if (h.effect == "camera_roll" || h.effect == "image_centre") world.calibrated = false;
  }
  world.calibration = usual_calibration();
  world.experiments = {fly(world.truth, seconds, dice)};
  return world;
}

}  // namespace misfit::bench
