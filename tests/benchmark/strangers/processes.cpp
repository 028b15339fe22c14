// Heat, batteries, ships, bioreactors. Right-hand sides: Incropera, Fundamentals of Heat and Mass Transfer; Plett, Battery Management
// Systems (2015); Fossen, Marine Craft Hydrodynamics (2011); Bastin and Dochain, On-line Estimation and Adaptive Control of Bioreactors
// (1990).
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/benchmark/strangers/parts.h"

namespace strangers {
namespace {

/// Indoor temperature over heating and weather; the model comes from misfit init.
System thermal_house() {
  System s;
  s.name = "thermal_house";
  s.parameters = {{"gain", 0.003, 0.006}, {"tau", 1e4, 3e4}};
  s.initial = {15, 15};
  s.inputs = {{"Q", "W", 1, 0, 3000}, {"T_out", "K", 1, 0, 12, true}};
  s.outputs = {{"T", "K"}};
  s.rates = [](const double* x, const double* u, const Values& p, double* dx) {
    const double lost = x[0] - u[1];
    const double sun = p("sun") * std::sin(2 * std::numbers::pi * p("t") / 86400);
    const double draught = p("draught") * lost * std::abs(lost) + p("open") * std::max(x[0] - 19.0, 0.0) * lost;
    dx[0] = (p("gain") * u[0] - lost - p("wall") * (x[0] - x[1]) - draught + sun + p("warming") * p("t") / 86400) / p("tau");
    dx[1] = p("wall") > 0.0 ? (x[0] - x[1]) / p("wall_tau") : 0.0;
  };
  s.observe = [](const double* x, const double*, const Values&, double* y) { y[0] = x[0]; };
  s.slowest = 2e4, s.step_low = 300, s.step_high = 900, s.fine_step = 60;
  s.disturbed = {0};
  s.effects = {
      {"wall_mass",
       Site::plant,
       0,
       {{"wall", 0.3, 3}, {"wall_tau", 2e4, 1e5}},
       {"lag@dT"},
       "lag = { port = \"PORT\", level = \"T\", start = { lag_stiffness = {wall/tau}, tau = {wall_tau} } }"},
      {"sun",
       Site::plant,
       0,
       {{"sun", 0.1, 3}},
       {"periodic_forcing@dT"},
       "periodic_forcing = { port = \"PORT\", start = { cosine = 0, sine = {sun/tau}, frequency = 1.1574074e-5 } }"},
      {"warming",
       Site::plant,
       0,
       {{"warming", 0.05, 1}},
       {"drift@dT"},
       "drift = { port = \"PORT\", start = { drift = {warming/86400/tau} } }"},
      {"late_heating",
       Site::input,
       0,
       {{"delay", 0.6, 6.0}},
       {"delay@dT;input=Q"},
       "delay = { port = \"PORT\", input = \"Q\", start = { delayed_gain = {gain/tau}, delay = {delay} } }"},
      {"heater_limit",
       Site::input,
       0,
       {{"limit", 0.5, 0.9}},
       {"saturation@dT;input=Q"},
       "saturation = { port = \"PORT\", input = \"Q\", start = { saturated_gain = {gain/tau}, limit = {limit} } }"},
      slow_sensor(0, "T"),
      {"coarse_T",
       Site::sensor,
       0,
       {{"step", 4, 20}},
       {"sensor_quantisation@T"},
       "sensor_quantisation = { output = \"T\", start = { rounded = 0.99, step = {step} } }"},
      {"draught", Site::plant, 0, {{"draught", 0.01, 0.1}}, {}, ""},
      {"open_windows", Site::plant, 0, {{"open", 0.03, 0.3}}, {}, ""},
  };
  return s;
}

System heat_exchanger() {
  System s;
  s.name = "heat_exchanger";
  s.text = R"toml(# Double-pipe heat exchanger, one lump a side; temperatures are those above the cold inlet
[system]
doc = "heat exchanger"
[states]
Th = { unit = "K", scale = 10.0 }
Tc = { unit = "K", scale = 10.0 }
[inputs]
mh = { unit = "kg/s", hold = "{hold}", doc = "hot flow" }
Tin = { unit = "K", hold = "{hold}", doc = "hot inlet" }
[parameters]
Mh = { unit = "kg", value = {Mh}, free = true, bounds = [0.1, 1000.0], doc = "hot side, as water" }
Mc = { unit = "kg", value = {Mc}, free = true, bounds = [0.1, 1000.0] }
h = { unit = "kg/s", value = {h}, free = true, bounds = [0.0, 10.0], doc = "UA over the heat capacity" }
mc = { unit = "kg/s", value = {=mc}, doc = "cold flow" }
[equations]
Th = "(mh*(Tin - Th) - h*(Th - Tc))/Mh"
Tc = "(h*(Th - Tc) - mc*Tc)/Mc"
[outputs]
Th = { unit = "K", noise = 0.1 }
Tc = { unit = "K", noise = 0.1 }
)toml";
  s.parameters = {{"Mh", 4, 10}, {"Mc", 5, 12}, {"h", 0.1, 0.3}, {"mc", 0.1, 0.3}};
  s.initial = {30, 15, 30};
  s.inputs = {{"mh", "kg/s", 1, 0.05, 0.35}, {"Tin", "K", 1, 40, 60, true}};
  s.outputs = {{"Th", "K"}, {"Tc", "K"}};
  s.rates = [](const double* x, const double* u, const Values& p, double* dx) {
    const double h = p("h") * (1 - p("fouling") * p("t") / 1000) * (1 + p("turbulence") * (u[0] - 0.2));
    dx[0] = (u[0] * (u[1] - x[0]) - h * (x[0] - x[1]) - p("shell") * (x[0] - x[2]) - p("loss")) / p("Mh");
    dx[1] = (h * (x[0] - x[1]) - p("mc") * x[1] - p("cold_loss") * x[1]) / p("Mc");
    dx[2] = p("shell") > 0.0 ? (x[0] - x[2]) / p("shell_tau") : 0.0;
  };
  s.observe = [](const double* x, const double*, const Values&, double* y) { y[0] = x[0], y[1] = x[1]; };
  s.slowest = 40, s.step_low = 1, s.step_high = 4, s.fine_step = 0.2;
  s.disturbed = {0};
  s.effects = {
      {"constant_loss",
       Site::plant,
       0,
       {{"loss", 0.05, 1}},
       {"input_offset@dTh/dt"},
       "input_offset = { port = \"dTh/dt\", start = { input_offset = -{loss/Mh} } }"},
      {"cold_loss",
       Site::plant,
       0,
       {{"cold_loss", 0.005, 0.1}},
       {"viscous_friction@dTc/dt"},
       "viscous_friction = { port = \"dTc/dt\", rate = \"Tc\", start = { viscosity = {cold_loss/Mc} } }"},
      {"shell_mass",
       Site::plant,
       0,
       {{"shell", 0.02, 0.3}, {"shell_tau", 30, 200}},
       {"lag@dTh/dt"},
       "lag = { port = \"dTh/dt\", level = \"Th\", start = { lag_stiffness = {shell/Mh}, tau = {shell_tau} } }"},
      slow_sensor(1, "Tc"),
      late_sensor(0, "Th"),
      shifted_sensor(1, "Tc"),
      clipped_sensor(0, "Th"),
      {"fouling", Site::plant, 0, {{"fouling", 0.03, 0.4}}, {}, ""},
      {"turbulence", Site::plant, 0, {{"turbulence", 0.5, 3}}, {}, ""},
  };
  return s;
}

System battery() {
  System s;
  s.name = "battery";
  s.text = R"toml(# Cell with one RC pair; the open-circuit voltage is a straight line of the state of charge
[states]
soc = { unit = "-", initial = { kind = "free", value = 0.5 } }
V1 = { unit = "V", scale = 0.05 }
[inputs]
I = { unit = "A", hold = "{hold}", doc = "discharge is positive" }
[parameters]
Q = { unit = "A s", value = {=Q} }
E0 = { unit = "V", value = {=E0} }
E1 = { unit = "V", value = {E1}, free = true, bounds = [0.0, 10.0] }
R0 = { unit = "V/A", value = {R0}, free = true, bounds = [0.0, 1.0] }
R1 = { unit = "V/A", value = {R1}, free = true, bounds = [0.0, 1.0] }
tau1 = { unit = "s", value = {tau1}, free = true, bounds = [0.1, 1e4] }
[equations]
soc = "-I/Q"
V1 = "(R1*I - V1)/tau1"
[outputs]
V = { unit = "V", formula = "E0 + E1*soc - R0*I - V1", noise = 0.002 }
)toml";
  s.parameters = {{"Q", 7000, 11000}, {"E0", 3.2, 3.4}, {"E1", 0.6, 1}, {"R0", 0.008, 0.02}, {"R1", 0.01, 0.03}, {"tau1", 20, 60}};
  s.initial = {0.5, 0, 0};
  s.inputs = {{"I", "A", 1, -6, 6}};
  s.outputs = {{"V", "V"}};
  s.rates = [](const double* x, const double* u, const Values& p, double* dx) {
    dx[0] = -(u[0] + p("stray")) / p("Q") - p("leak") * x[0];
    dx[1] = (p("R1") * u[0] - x[1]) / p("tau1");
    dx[2] = p("R2") > 0.0 ? (p("R2") * u[0] - x[2]) / p("tau2") : 0.0;
  };
  s.observe = [](const double* x, const double* u, const Values& p, double* y) {
    const double aged = p("R0") * (1 + p("starved") * (0.5 - x[0])), knee = p("knee") * std::pow(x[0] - 0.5, 3);
    y[0] = p("E0") + p("E1") * x[0] + knee - aged * u[0] - x[1] - x[2] - p("sticky") * std::tanh(u[0] / 0.2);
  };
  s.slowest = 60, s.step_low = 1, s.step_high = 5, s.fine_step = 0.5;
  s.disturbed = {1};
  // Both pairs in one: level V1 + V2, the second a lag on the first.
  s.effects = {
      {"second_pair",
       Site::plant,
       0,
       {{"R2", 0.01, 0.04}, {"tau2", 200, 800}},
       {"lag@dV1/dt"},
       "lag = { port = \"dV1/dt\", level = \"V1\", start = { lag_stiffness = {R2/R1/tau1}, tau = {tau2} } }"},
      {"stray_current",
       Site::plant,
       0,
       {{"stray", 0.05, 1}},
       {"input_offset@dsoc/dt"},
       "input_offset = { port = \"dsoc/dt\", start = { input_offset = -{stray/Q} } }"},
      {"self_discharge",
       Site::plant,
       0,
       {{"leak", 1e-5, 3e-4}},
       {"viscous_friction@dsoc/dt"},
       "viscous_friction = { port = \"dsoc/dt\", rate = \"soc\", start = { viscosity = {leak} } }"},
      late_sensor(0, "V"),
      slow_sensor(0, "V"),
      {"coarse_V",
       Site::sensor,
       0,
       {{"step", 4, 20}},
       {"sensor_quantisation@V"},
       "sensor_quantisation = { output = \"V\", start = { rounded = 0.99, step = {step} } }"},
      clipped_sensor(0, "V"),
      {"starved", Site::plant, 0, {{"starved", 1, 5}}, {}, ""},
      {"sticky_voltage", Site::plant, 0, {{"sticky", 0.003, 0.03}}, {}, ""},
      {"knee", Site::plant, 0, {{"knee", 2, 20}}, {}, ""},
  };
  s.effects[3].right = {"sensor_delay@V", "time_offset"};
  return s;
}

/// Yaw rate over rudder, in degrees; the model comes from misfit init.
System ship_yaw() {
  constexpr double degree = std::numbers::pi / 180.0;
  System s;
  s.name = "ship_yaw";
  s.parameters = {{"K", 0.05, 0.15}, {"T", 15, 40}};
  s.initial = {0};
  s.inputs = {{"delta", "deg", degree, -25, 25}};
  s.outputs = {{"r", "deg/s", degree}};
  s.rates = [](const double* x, const double* u, const Values& p, double* dx) {
    const double slowed = 1.0 / (1.0 + p("speed_loss") * x[0] * x[0]);
    dx[0] = (p("K") * u[0] * slowed - x[0]) / p("T") - p("cubic") * x[0] * x[0] * x[0] - p("drag") * std::abs(x[0]) * x[0] +
            p("waves") * std::sin(p("encounter") * p("t"));
  };
  s.observe = [](const double* x, const double*, const Values&, double* y) { y[0] = x[0]; };
  s.slowest = 25, s.step_low = 0.5, s.step_high = 2, s.fine_step = 0.1;
  s.disturbed = {0};
  s.effects = {
      {"cubic",
       Site::plant,
       0,
       {{"cubic", 2, 60}},
       {"cubic_stiffness@dr"},
       "cubic_stiffness = { port = \"PORT\", displacement = \"r\", start = { cubic_stiffness = {cubic} } }"},
      {"norrbin",
       Site::plant,
       0,
       {{"drag", 0.1, 2}},
       {"quadratic_drag@dr"},
       "quadratic_drag = { port = \"PORT\", rate = \"r\", start = { drag = {drag} } }"},
      {"waves",
       Site::plant,
       0,
       {{"waves", 1e-5, 4e-4}, {"encounter", 0.3, 1.0}},
       {"periodic_forcing@dr"},
       "periodic_forcing = { port = \"PORT\", start = { cosine = 0, sine = {waves}, frequency = {0.15915494*encounter} } }"},
      {"input_delay",
       Site::input,
       0,
       {{"delay", 0.6, 6.0}},
       {"delay@dr", "sensor_delay@r", "time_offset"},
       "delay = { port = \"PORT\", start = { delayed_gain = {K/T}, delay = {delay} } }"},
      {"rudder_limit",
       Site::input,
       0,
       {{"limit", 0.4, 0.85}},
       {"saturation@dr"},
       "saturation = { port = \"PORT\", start = { saturated_gain = {K/T}, limit = {limit} } }"},
      slow_sensor(0, "r"),
      {"coarse_r",
       Site::sensor,
       0,
       {{"step", 4, 20}},
       {"sensor_quantisation@r"},
       "sensor_quantisation = { output = \"r\", start = { rounded = 0.99, step = {step} } }"},
      {"speed_loss", Site::plant, 0, {{"speed_loss", 200, 4000}}, {}, ""},
      slow_actuator("rudder_rate", 0.5, 3),
  };
  return s;
}

System chemostat() {
  System s;
  s.name = "chemostat";
  s.text = R"toml(# Chemostat with Monod kinetics; time in hours would be usual, seconds are asked for
[states]
X = { unit = "kg/m^3", min = 0.0, initial = { kind = "free", value = 2.0 } }
S = { unit = "kg/m^3", min = 0.0, initial = { kind = "free", value = 1.0 } }
[inputs]
D = { unit = "1/s", hold = "{hold}", doc = "dilution rate" }
[parameters]
mu_max = { unit = "1/s", value = {mu_max}, free = true, bounds = [1e-6, 1e-2] }
Ks = { unit = "kg/m^3", value = {Ks}, free = true, bounds = [1e-3, 100.0] }
Y = { unit = "-", value = {Y}, free = true, bounds = [0.01, 2.0] }
Sin = { unit = "kg/m^3", value = {=Sin} }
[quantities]
mu = { unit = "1/s", formula = "mu_max*S/(Ks + S)" }
[equations]
X = "(mu - D)*X"
S = "D*(Sin - S) - mu*X/Y"
[outputs]
X = { unit = "kg/m^3", noise = 0.05 }
S = { unit = "kg/m^3", noise = 0.05 }
)toml";
  s.parameters = {{"mu_max", 1.2e-4, 2e-4}, {"Ks", 0.5, 1.5}, {"Y", 0.4, 0.6}, {"Sin", 8, 12}};
  s.initial = {4, 1.5};
  s.inputs = {{"D", "1/s", 1, 2e-5, 9e-5}};
  s.outputs = {{"X", "kg/m^3"}, {"S", "kg/m^3"}};
  s.rates = [](const double* x, const double* u, const Values& p, double* dx) {
    const double X = std::max(x[0], 0.0), S = std::max(x[1], 0.0);
    const double slowed = 1 + p("inhibition") * S * S / p("Ks");
    const double mu = p("mu_max") * S / (p("Ks") + S + (slowed - 1)) * (1 - p("crowding") * X);
    dx[0] = (mu - u[0]) * X - p("death") * X;
    dx[1] = u[0] * (p("Sin") - S) - mu * X / p("Y") + p("spill");
  };
  s.observe = [](const double* x, const double*, const Values&, double* y) { y[0] = x[0], y[1] = x[1]; };
  s.slowest = 2e4, s.step_low = 300, s.step_high = 1200, s.fine_step = 60;
  s.disturbed = {0};
  s.effects = {
      {"death",
       Site::plant,
       0,
       {{"death", 1e-6, 2e-5}},
       {"viscous_friction@dX/dt"},
       "viscous_friction = { port = \"dX/dt\", rate = \"X\", start = { viscosity = {death} } }"},
      {"side_feed",
       Site::plant,
       0,
       {{"spill", 5e-6, 1e-4}},
       {"input_offset@dS/dt"},
       "input_offset = { port = \"dS/dt\", start = { input_offset = {spill} } }"},
      shifted_sensor(1, "S"),
      shifted_sensor(0, "X"),
      slow_sensor(0, "X"),
      late_sensor(1, "S"),
      clipped_sensor(0, "X"),
      {"crowding", Site::plant, 0, {{"crowding", 0.01, 0.1}}, {}, ""},
      {"fading_probe", Site::sensor, 0, {{"fading", 0.05, 0.4}}, {}, ""},
  };
  return s;
}

}  // namespace

std::vector<System> processes() { return {thermal_house(), heat_exchanger(), battery(), ship_yaw(), chemostat()}; }

std::vector<System> all_systems() {
  std::vector<System> all = machines();
  for (auto& system : processes()) all.push_back(std::move(system));
  return all;
}

}  // namespace strangers
