#include "tests/benchmark/coverage_flights.h"

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

constexpr double rate = 59.94;

ModelRequest planar() {
  ModelRequest r;
  r.system = "parachute_planar";
  r.options.flags["induced_angle"] = false;
  r.constants = {{"D", 1.5816}, {"S", 1.9554}, {"R_cp", 3.15}, {"m", 0.206}, {"m_a", 0.294}, {"qbar", 736.0}, {"V", 35.1}};
  for (const char* key : {"static_moment", "pitch_damping", "periodic_forcing"}) r.effects.push_back({key, key, {}, {}});
  return r;
}

ModelRequest spherical() {
  ModelRequest r = planar();
  r.system = "parachute_spherical";
  r.options.flags.clear();
  r.constants.insert({{"R", 3.447}, {"l_b", 5.69}, {"l_s", 5.61}, {"h_c", 0.1524}, {"K", 133.86}});
  r.effects.clear();
  for (const char* key : {"static_moment", "pitch_damping", "gravity", "lateral_damping"}) r.effects.push_back({key, key, {}, {}});
  return r;
}

/// The request with knots over all angles and, for what is simulated, further effects.
Model with_knots(ModelRequest request, const std::vector<std::string>& further, const std::string& damping, const Registry& registry) {
  for (const std::string& curve : {std::string("C_m"), damping}) {
    request.curves[curve].of = "alpha_T";
    for (int i = 0; i <= 49; ++i) request.curves[curve].knots.push_back((0.5 + i * 0.5) * degree);
  }
  for (const auto& key : further) request.effects.push_back({key, key, {}, {}});
  return assemble(request, registry);
}

/// What roughness takes curves to be: C'' is white noise within 5 deg of `middle` (0 beyond). `size`: standard deviation of the curve's
/// departure from its tangent 3 deg away, from flight to flight half of it to twice.
std::function<double(double)> wander(Dice& dice, double middle, double size) {
  constexpr double step = 0.05 * degree, reach = 5.0 * degree, far = 3.0 * degree;
  const auto steps = static_cast<int>(reach / step);
  const double intensity = std::exp(dice.uniform(-std::log(2.0), std::log(2.0))) * size * std::sqrt(3.0 / (far * far * far));
  std::array<std::vector<double>, 2> value, slope;  // below and above
  for (std::size_t side = 0; side < 2; ++side) {
    double v = 0.0, s = 0.0;
    for (int i = 0; i <= steps; ++i) {
      value[side].push_back(v);
      slope[side].push_back(s);
      v += step * s;
      s += intensity * std::sqrt(step) * dice.normal(1.0);
    }
  }
  return [=](double x) {
    const std::size_t side = x < middle ? 0 : 1;
    const double distance = std::abs(x - middle) / step;
    const std::size_t i = std::min(static_cast<std::size_t>(distance), static_cast<std::size_t>(steps));
    return value[side][i] + slope[side][i] * step * (distance - static_cast<double>(i));
  };
}

/// Static moment: stable about a trim.
void vary_static(CoverageFlight& flight, Dice& dice) {
  const double slope = -0.355 * dice.uniform(0.8, 1.2), trim = dice.uniform(10.5, 13.5) * degree;
  constexpr double size = 0.003;
  const auto further = wander(dice, trim, size);
  set_curve(flight.truth, "C_m", [=](double x) { return slope * (x - trim) + further(x); });
  double low = trim - 2.5 * degree, high = trim + 2.5 * degree;  // the spline's own zero
  for (int i = 0; i < 60; ++i) {
    flight.trim = 0.5 * (low + high);
    (curve_value(flight.truth, "C_m", flight.trim) > 0.0 ? low : high) = flight.trim;
  }
}

/// Stationary resonance (position of a damped oscillator driven by white noise), sampled.
std::vector<double> resonance(Dice& dice, std::size_t samples, double sigma, double frequency, double damping) {
  const double omega = 2.0 * std::numbers::pi * frequency, h = 1.0 / rate;
  const double decay = std::exp(-damping * omega * h), turn = omega * std::sqrt(1.0 - damping * damping) * h;
  // An AR(2) with the oscillator's poles; its variance is brought to sigma².
  const double a1 = 2.0 * decay * std::cos(turn), a2 = -decay * decay;
  const double variance = (1.0 - a2) / ((1.0 + a2) * ((1.0 - a2) * (1.0 - a2) - a1 * a1));
  const double drive = sigma / std::sqrt(variance);
  std::vector<double> out;
  double before = 0.0, last = 0.0;
  constexpr int settling = 600;
  for (int i = -settling; i < static_cast<int>(samples); ++i) {
    const double next = a1 * last + a2 * before + dice.normal(drive);
    before = last;
    last = next;
    if (i >= 0) out.push_back(next);
  }
  return out;
}

/// Outputs of the truth, run from `before` seconds ahead; empty where it leaves the finite numbers.
RowMatrix run_truth(CoverageFlight& flight, const std::vector<double>& start, double seconds, double before, Dice& dice) {
  Signals& s = flight.signals;
  const auto ahead = static_cast<Eigen::Index>(std::ceil(before * rate)), samples = static_cast<Eigen::Index>(std::ceil(seconds * rate));
  for (Eigen::Index i = -ahead; i < samples; ++i) s.t.push_back(static_cast<double>(i) / rate);
  const std::vector<double> still(s.t.size(), 0.0);
  for (const auto& input : flight.truth.system->spec().inputs) s.inputs.push_back({input.name, input.unit, still});
  Stepper stepper(flight.truth);
  Segment run;
  run_randomly({stepper, s, input_table(s, flight.truth)}, start.data(), dice.random, run);
  if (!run.finite) return {};
  s.t.erase(s.t.begin(), s.t.begin() + ahead);
  for (auto& input : s.inputs) input.values.resize(s.t.size());
  return run.y.bottomRows(samples);
}

void choose_angles(CoverageFlight& flight, std::vector<double> visited) {
  std::sort(visited.begin(), visited.end());
  for (const double share : {0.1, 0.3, 0.5, 0.7, 0.9})
    flight.angles.push_back(visited[static_cast<std::size_t>(share * static_cast<double>(visited.size() - 1))]);
}

CoverageFlight limit_cycle(const std::string& kind, double seconds, Dice& dice, const Registry& registry) {
  CoverageFlight flight;
  flight.request = planar();
  flight.free = {"cosine", "sine", "frequency"};
  flight.truth = with_knots(flight.request, {}, "C_m_alphadot", registry);
  vary_static(flight, dice);
  const double push = dice.uniform(0.08, 0.14), width = dice.uniform(1.2, 1.8) * degree, trim = flight.trim;
  constexpr double size = 0.04;
  const auto further = wander(dice, trim, size);
  set_curve(flight.truth, "C_m_alphadot", [=](double x) { return push * (1.0 - std::pow((x - trim) / width, 2)) + further(x); });
  const double strength = dice.uniform(3.0, 6.0), phase = dice.angle(), frequency = dice.uniform(1.0, 1.6);
  set(flight.truth, "cosine", strength * std::cos(phase));
  set(flight.truth, "sine", strength * std::sin(phase));
  set(flight.truth, "frequency", frequency);
  constexpr double resolution = 0.02;  // of the frequency at which the estimation starts [Hz]
  flight.request.parameters["frequency"].value = std::round(frequency / resolution) * resolution;
  flight.request.parameters["frequency"].free = true;
  const RowMatrix y = run_truth(flight, {trim + dice.uniform(1.0, 3.0) * degree, 0.0}, seconds, 0.0, dice);
  if (y.rows() == 0) return flight;
  const double white = (kind == "white" ? 0.1 : 0.03) * degree, jitter = kind == "white" ? 0.0 : 0.1 * degree;
  const std::vector<double> shaking = resonance(dice, flight.signals.samples(), jitter, dice.uniform(8.0, 10.0), 0.1);
  Signal channel{"alpha_T", "rad", {}, 0.0};
  for (std::size_t i = 0; i < flight.signals.samples(); ++i)
    channel.values.push_back(y(static_cast<Eigen::Index>(i), 0) + shaking[i] + dice.normal(white));
  flight.signals.measured.push_back(std::move(channel));
  choose_angles(flight, {y.col(0).begin(), y.col(0).end()});
  return flight;
}

/// Tilts from pixels by the pinhole of spherical(), without its height: near enough to the angles of attack to choose five by.
std::vector<double> tilts(const RowMatrix& pixels) {
  constexpr double l_b = 5.69, l_s = 5.61, R = 3.447, K = 133.86;
  std::vector<double> out;
  for (Eigen::Index i = 0; i < pixels.rows(); ++i) {
    double sine = 0.0;
    for (int round = 0; round < 5; ++round)
      sine = std::min(0.9, std::hypot(pixels(i, 0), pixels(i, 1)) * (l_s - R * std::sqrt(1.0 - sine * sine)) / (l_b * K * R));
    out.push_back(std::asin(sine));
  }
  return out;
}

CoverageFlight in_gusts(double seconds, Dice& dice, const Registry& registry) {
  CoverageFlight flight;
  flight.request = spherical();
  flight.free = {"C_lateral"};
  flight.truth = with_knots(flight.request, {"gust"}, "C_mq", registry);
  vary_static(flight, dice);
  const double base = -0.25 * dice.uniform(0.8, 1.2);
  constexpr double size = 0.1;
  const auto further = wander(dice, flight.trim, size);
  set_curve(flight.truth, "C_mq", [=](double x) { return base + further(x); });
  set(flight.truth, "C_lateral", dice.uniform(-0.4, 0.1));
  flight.force = 27.0;
  flight.force_time = 0.1;
  set(flight.truth, "gust_sigma", flight.force);
  set(flight.truth, "gust_tau", flight.force_time);
  std::vector<double> start(static_cast<std::size_t>(flight.truth.states()), 0.0);
  const double eta = dice.uniform(8.0, 15.0) * degree, phi = dice.angle();
  start[0] = std::sin(eta) * std::sin(phi);
  start[1] = std::sin(eta) * std::cos(phi);
  constexpr double settling = 5.0, white = 0.5, jitter = 1.0;
  const RowMatrix y = run_truth(flight, start, seconds, settling, dice);
  if (y.rows() == 0) return flight;
  for (Eigen::Index o = 0; o < 2; ++o) {
    const std::vector<double> shaking = resonance(dice, flight.signals.samples(), jitter, 9.0, 0.1);
    Signal channel{o == 0 ? "P_y" : "P_z", "px", {}, 0.0};
    for (std::size_t i = 0; i < flight.signals.samples(); ++i)
      channel.values.push_back(y(static_cast<Eigen::Index>(i), o) + shaking[i] + dice.normal(white));
    flight.signals.measured.push_back(std::move(channel));
  }
  choose_angles(flight, tilts(y));
  return flight;
}

}  // namespace

CoverageFlight draw_flight(const std::string& kind, int number, double seconds, const Registry& registry) {
  Dice dice(kind, number);
  constexpr int most = 20;  // curves that throw the canopy over are drawn again
  for (int attempt = 0; attempt < most; ++attempt) {
    CoverageFlight flight = kind == "forced" ? in_gusts(seconds, dice, registry) : limit_cycle(kind, seconds, dice, registry);
    flight.signals.name = "flight";
    // One that was thrown over hangs there: the apex hardly moves, at what looks like a small angle.
    constexpr double upright = 30.0 * degree, hanging = 1.0 * degree;
    if (!flight.angles.empty() && flight.angles.back() < upright && flight.angles.back() - flight.angles.front() > hanging) return flight;
  }
  throw std::runtime_error("no flight stays up");
}

}  // namespace misfit::bench
