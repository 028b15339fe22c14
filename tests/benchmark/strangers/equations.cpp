// Right-hand sides and outputs of the systems; what is not hidden is 0 in `p`. Texts and numbers: strangers/*.toml.
// Sources: Isermann, Mechatronic Systems (2005); Rajamani, Vehicle Dynamics and Control (2012); Jelali, Kroll, Hydraulic Servo-systems
// (2003); Incropera, Fundamentals of Heat and Mass Transfer; Plett, Battery Management Systems (2015); Fossen, Marine Craft Hydrodynamics
// (2011); Bastin, Dochain, On-line Estimation and Adaptive Control of Bioreactors (1990).
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>

#include "tests/benchmark/strangers/world.h"

namespace strangers {
namespace {

double sign(double v) { return v > 0.0 ? 1.0 : v < 0.0 ? -1.0 : 0.0; }
double dry(double rate, const Values& p) { return p("coulomb") > 0.0 ? p("coulomb") * std::tanh(rate / p("width")) : 0.0; }
double beyond(double v, double edge) { return v > edge ? v - edge : v < -edge ? v + edge : 0.0; }

void dc_motor(const double* x, const double* u, const Values& p, double* dx, double* y) {
  const double load = dry(x[0], p) + p("fan") * std::abs(x[0]) * x[0] + p("load") + p("cogging") * std::sin(7 * x[2]);
  dx[0] = (p("K") * x[1] - p("b") * x[0]) / p("J") - load;
  const double brushes = p("brushes") * std::tanh(x[1] / 0.2);
  dx[1] = (u[0] - p("R") * (1 + p("heating") * x[1] * x[1]) * x[1] - brushes - p("K") * x[0]) / p("L");
  dx[2] = x[0];
  y[0] = x[0];
  y[1] = x[1];
}

void motor_speed(const double* x, const double* u, const Values& p, double* dx, double* y) {
  const double load = dry(x[0], p) + p("fan") * std::abs(x[0]) * x[0] + (x[0] < 0.0 ? p("backward") * x[0] : 0.0);
  dx[0] = (p("gain") * u[0] * (1 + p("weak") * std::abs(u[0])) - x[0]) / p("tau") - load;
  y[0] = x[0];
}

void servo(const double* x, const double* u, const Values& p, double* dx, double* y) {
  dx[0] = x[1];
  dx[1] = (p("k") * (u[0] - x[0]) - p("d") * x[1] - dry(x[1], p) - p("cubic") * x[0] * x[0] * x[0]) / (1 + p("arm") * std::cos(2 * x[0]));
  y[0] = x[0];
}

void drone_roll(const double* x, const double* u, const Values& p, double* dx, double* y) {
  dx[0] = x[1];
  dx[1] = p("Lu") * u[0] * (1 - p("loss") * std::abs(x[1])) - p("Lp") * x[1] - p("Lphi") * x[0] - p("drag") * std::abs(x[1]) * x[1] -
          dry(x[1], p);
  y[0] = x[0];
  y[1] = x[1];
}

void quarter_car(const double* x, const double* u, const Values& p, double* dx, double* y) {
  const double d = x[0] - x[2], rate = x[1] - x[3];
  double strut = -p("ks") * d - p("cs") * rate - dry(rate, p) - p("cubic") * d * d * d - p("drag") * std::abs(rate) * rate;
  if (p("stop") > 0.0) strut -= p("stop_stiffness") * beyond(d, p("stop"));
  if (rate > 0.0) strut -= p("rebound") * rate;
  const double reach = u[0] - x[2], tyre = p("lift") > 0.0 ? std::max(reach, -p("lift")) : reach;
  dx[0] = x[1], dx[2] = x[3];
  dx[1] = strut / p("ms");
  dx[3] = (-strut + p("kt") * tyre) / p("mu");
  y[0] = x[0] - x[2];
  y[1] = x[0];
}

void hydraulic_cylinder(const double* x, const double* u, const Values& p, double* dx, double* y) {
  double flow = p("Kq") * u[0];
  if (p("supply") > 0.0) flow *= std::sqrt(std::max(1.0 - std::tanh(20 * u[0]) * x[2] / p("supply"), 0.0));
  const double seal = dry(x[1], p) + p("uneven") * std::pow(std::tanh(x[1] / 0.005), 2) + p("load");
  dx[0] = x[1];
  dx[1] = (p("A") * x[2] - p("k") * x[0] - p("b") * x[1]) / p("m") - seal;
  dx[2] = p("C") * (flow - p("A") * x[1] - p("Kc") * x[2]) - p("orifice") * sign(x[2]) * std::sqrt(std::abs(x[2])) + p("valve");
  y[0] = x[0];
  y[1] = x[2];
}

void two_mass_drive(const double* x, const double* u, const Values& p, double* dx, double* y) {
  const double slip = x[0] - x[1];
  double twist = x[2];
  if (p("gap") > 0.0) twist = beyond(twist, p("gap"));
  twist *= 1 + p("joint") * std::cos(2 * x[3]);
  const double shaft = p("ks") * twist + p("ds") * slip + p("cubic") * x[2] * x[2] * x[2] + p("dry_shaft") * std::tanh(slip / 0.02);
  dx[0] = (u[0] - shaft - p("b") * x[0]) / p("J1");
  dx[1] = (shaft - p("b") * x[1]) / p("J2") - dry(x[1], p) - p("load") - p("unbalance") * std::sin(x[3]);
  dx[2] = slip;
  dx[3] = x[1];
  y[0] = x[0];
  y[1] = x[1];
}

void cart_pendulum(const double* x, const double* u, const Values& p, double* dx, double* y) {
  const double at = x[0] / 0.02, magnet = p("magnet") * at * std::exp(-0.5 * at * at);
  const double belt = p("cogging") * std::sin(2 * std::numbers::pi * x[0] / 0.05) + magnet;
  const double cart = u[0] - p("k") * x[0] - p("b") * x[1] - dry(x[1], p) - p("cubic") * x[0] * x[0] * x[0] - belt;
  const double pivot = -p("c") * x[3] - p("dry_pivot") * std::tanh(x[3] / 0.05) - p("drag") * std::abs(x[3]) * x[3];
  const double sine = std::sin(x[2]), cosine = std::cos(x[2]), m = p("m"), l = p("l");
  dx[0] = x[1], dx[2] = x[3];
  dx[1] = (cart + m * sine * (l * x[3] * x[3] + 9.81 * cosine) - cosine / l * pivot) / (p("M") + m * sine * sine);
  dx[3] = pivot / (m * l * l) - 9.81 / l * sine - cosine / l * dx[1];
  y[0] = x[0];
  y[1] = x[2];
}

void thermal_house(const double* x, const double* u, const Values& p, double* dx, double* y) {
  const double lost = x[0] - u[1];
  const double sun = p("sun") * std::sin(2 * std::numbers::pi * p("t") / 86400);
  const double draught = p("draught") * lost * std::abs(lost) + p("open") * std::max(x[0] - 19.0, 0.0) * lost;
  dx[0] = (p("gain") * u[0] - lost - p("wall") * (x[0] - x[1]) - draught + sun + p("warming") * p("t") / 86400) / p("tau");
  dx[1] = p("wall") > 0.0 ? (x[0] - x[1]) / p("wall_tau") : 0.0;
  y[0] = x[0];
}

void heat_exchanger(const double* x, const double* u, const Values& p, double* dx, double* y) {
  const double shed = 1 + p("shedding") * std::sin(p("t") / 37);
  const double film = 1 + p("film") * std::exp(-std::pow((x[0] - 30) / 4, 2));
  const double h = p("h") * (1 - p("fouling") * p("t") / 1000) * (1 + p("turbulence") * (u[0] - 0.2)) * shed * film;
  dx[0] = (u[0] * (u[1] - x[0]) - h * (x[0] - x[1]) - p("shell") * (x[0] - x[2]) - p("loss")) / p("Mh");
  dx[1] = (h * (x[0] - x[1]) - p("mc") * x[1] - p("cold_loss") * x[1]) / p("Mc");
  dx[2] = p("shell") > 0.0 ? (x[0] - x[2]) / p("shell_tau") : 0.0;
  y[0] = x[0];
  y[1] = x[1];
}

void battery(const double* x, const double* u, const Values& p, double* dx, double* y) {
  dx[0] = -(u[0] + p("stray")) / p("Q") - p("leak") * x[0];
  dx[1] = (p("R1") * u[0] - x[1]) / p("tau1");
  dx[2] = p("R2") > 0.0 ? (p("R2") * u[0] - x[2]) / p("tau2") : 0.0;
  const double aged = p("R0") * (1 + p("starved") * (0.5 - x[0])), knee = p("knee") * std::pow(x[0] - 0.5, 3);
  y[0] = p("E0") + p("E1") * x[0] + knee - aged * u[0] - x[1] - x[2] - p("sticky") * std::tanh(u[0] / 0.2);
}

void ship_yaw(const double* x, const double* u, const Values& p, double* dx, double* y) {
  const double slowed = 1.0 / (1.0 + p("speed_loss") * x[0] * x[0]);
  dx[0] = (p("K") * u[0] * slowed - x[0]) / p("T") - p("cubic") * x[0] * x[0] * x[0] - p("drag") * std::abs(x[0]) * x[0] +
          p("waves") * std::sin(p("encounter") * p("t"));
  y[0] = x[0];
}

void chemostat(const double* x, const double* u, const Values& p, double* dx, double* y) {
  const double X = std::max(x[0], 0.0), S = std::max(x[1], 0.0);
  const double poisoned = 1 + p("poisoned") * std::sin(p("t") / 9000);
  const double clumps = 1 - p("clumps") * std::exp(-std::pow((X - 4) / 0.5, 2));
  const double mu = p("mu_max") * S / (p("Ks") + S) * (1 - p("crowding") * X) * poisoned * clumps;
  dx[0] = (mu - u[0]) * X - p("death") * X;
  dx[1] = u[0] * (p("Sin") - S) - mu * X / p("Y") + p("spill");
  y[0] = x[0];
  y[1] = x[1];
}

}  // namespace

Equations equations_of(const std::string& system) {
  static const std::map<std::string, Equations> all = {{"dc_motor", dc_motor},
                                                       {"motor_speed", motor_speed},
                                                       {"servo", servo},
                                                       {"drone_roll", drone_roll},
                                                       {"quarter_car", quarter_car},
                                                       {"hydraulic_cylinder", hydraulic_cylinder},
                                                       {"two_mass_drive", two_mass_drive},
                                                       {"cart_pendulum", cart_pendulum},
                                                       {"thermal_house", thermal_house},
                                                       {"heat_exchanger", heat_exchanger},
                                                       {"battery", battery},
                                                       {"ship_yaw", ship_yaw},
                                                       {"chemostat", chemostat}};
  const auto found = all.find(system);
  if (found == all.end()) throw std::invalid_argument("no equations of a system " + system);
  return found->second;
}

}  // namespace strangers
