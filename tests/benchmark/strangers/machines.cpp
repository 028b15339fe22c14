// Motors, drives and vehicles. Right-hand sides: Isermann, Mechatronic Systems (2005); Nise, Control Systems Engineering; Rajamani, Vehicle
// Dynamics and Control (2012); Jelali, Kroll, Hydraulic Servo-systems (2003).
#include <cmath>
#include <numbers>

#include "tests/benchmark/strangers/parts.h"

namespace strangers {
namespace {

System dc_motor() {
  System s;
  s.name = "dc_motor";
  s.text = R"toml(# Permanent-magnet DC motor, armature and shaft
[system]
doc = "DC motor"
[states]
w = { unit = "rad/s" }      # speed
i = { unit = "A" }          # armature current
[inputs]
U = { unit = "V", hold = "{hold}" }
[parameters]
R = { unit = "V/A", value = {R}, free = true, bounds = [0.0, 100.0] }
L = { unit = "V s/A", value = {L}, free = true, bounds = [1e-4, 10.0] }
K = { unit = "V s", value = {K}, free = true, bounds = [0.0, 10.0] }
J = { unit = "kg m^2", value = {J}, free = true, bounds = [1e-6, 1.0] }
b = { unit = "N m s", value = {b}, free = true, bounds = [0.0, 1.0] }
[equations]
w = "(K*i - b*w)/J"
i = "(U - R*i - K*w)/L"
[outputs]
w = { unit = "rad/s", noise = 0.5 }
i = { unit = "A", noise = 0.05 }
)toml";
  s.parameters = {{"R", 0.8, 1.5}, {"L", 0.05, 0.15}, {"K", 0.08, 0.15}, {"J", 0.0015, 0.004}, {"b", 2e-4, 1e-3}};
  s.initial = {0, 0, 0};  // the angle is not in the model
  s.inputs = {{"U", "V", 1, -12, 12}};
  s.outputs = {{"w", "rad/s"}, {"i", "A"}};
  s.rates = [](const double* x, const double* u, const Values& p, double* dx) {
    const double load = dry(x[0], p) + p("fan") * std::abs(x[0]) * x[0] + p("load") + p("cogging") * std::sin(7 * x[2]);
    dx[0] = (p("K") * x[1] - p("b") * x[0]) / p("J") - load;
    dx[1] = (u[0] - p("R") * (1 + p("heating") * x[1] * x[1]) * x[1] - p("K") * x[0]) / p("L");
    dx[2] = x[0];
  };
  s.observe = [](const double* x, const double*, const Values&, double* y) { y[0] = x[0], y[1] = x[1]; };
  s.slowest = 0.3, s.step_low = 0.005, s.step_high = 0.02, s.fine_step = 0.001;
  s.disturbed = {0};
  s.effects = {
      {"coulomb",
       Site::plant,
       0,
       {{"coulomb", 5, 100}, {"width", 0.5, 1.0}},
       {"coulomb_friction@dw/dt"},
       "coulomb_friction = { port = \"dw/dt\", rate = \"w\", start = { friction = {coulomb}, width = {width} } }"},
      {"fan_load",
       Site::plant,
       0,
       {{"fan", 0.003, 0.05}},
       {"quadratic_drag@dw/dt"},
       "quadratic_drag = { port = \"dw/dt\", rate = \"w\", start = { drag = {fan} } }"},
      {"load_torque",
       Site::plant,
       0,
       {{"load", 5, 100, true}},
       {"input_offset@dw/dt"},
       "input_offset = { port = \"dw/dt\", start = { input_offset = -{load} } }"},
      shifted_sensor(1, "i"),
      late_sensor(0, "w"),
      limited_input("di/dt", "1/L"),
      late_input("di/dt", "1/L"),
      {"unsigned_w",
       Site::sensor,
       0,
       {{"folded", 1, 1}},
       {"sensor_absolute@w"},
       "sensor_absolute = { output = \"w\", start = { folded = 0.99, fold_width = 0.5 } }"},
      {"cogging", Site::plant, 0, {{"cogging", 30, 300}}, {}, ""},
      {"heating", Site::plant, 0, {{"heating", 0.003, 0.05}}, {}, ""},
  };
  return s;
}

/// Speed alone, armature without inductance: the model comes from misfit init.
System motor_speed() {
  System s;
  s.name = "motor_speed";
  s.parameters = {{"gain", 5, 12}, {"tau", 0.2, 0.5}};
  s.initial = {0};
  s.inputs = {{"U", "V", 1, -12, 12}};
  s.outputs = {{"w", "rad/s"}};
  s.rates = [](const double* x, const double* u, const Values& p, double* dx) {
    const double load = dry(x[0], p) + p("fan") * std::abs(x[0]) * x[0] + (x[0] < 0.0 ? p("backward") * x[0] : 0.0);
    dx[0] = (p("gain") * u[0] * (1 + p("weak") * std::abs(u[0])) - x[0]) / p("tau") - load;
  };
  s.observe = [](const double* x, const double*, const Values&, double* y) { y[0] = x[0]; };
  s.slowest = 0.4, s.step_low = 0.01, s.step_high = 0.04, s.fine_step = 0.002;
  s.disturbed = {0};
  s.effects = {
      {"coulomb",
       Site::plant,
       0,
       {{"coulomb", 5, 80}, {"width", 0.5, 1.0}},
       {"coulomb_friction@dw"},
       "coulomb_friction = { port = \"PORT\", rate = \"w\", start = { friction = {coulomb}, width = {width} } }"},
      {"fan_load",
       Site::plant,
       0,
       {{"fan", 0.003, 0.05}},
       {"quadratic_drag@dw"},
       "quadratic_drag = { port = \"PORT\", rate = \"w\", start = { drag = {fan} } }"},
      {"input_delay",
       Site::input,
       0,
       {{"delay", 0.6, 6.0}},
       {"delay@dw", "sensor_delay@w", "time_offset"},
       "delay = { port = \"PORT\", start = { delayed_gain = {gain/tau}, delay = {delay} } }"},
      {"input_saturation",
       Site::input,
       0,
       {{"limit", 0.4, 0.85}},
       {"saturation@dw"},
       "saturation = { port = \"PORT\", start = { saturated_gain = {gain/tau}, limit = {limit} } }"},
      slow_sensor(0, "w"),
      clipped_sensor(0, "w"),
      {"unsigned_w",
       Site::sensor,
       0,
       {{"folded", 1, 1}},
       {"sensor_absolute@w"},
       "sensor_absolute = { output = \"w\", start = { folded = 0.99, fold_width = 0.5 } }"},
      {"one_way", Site::plant, 0, {{"backward", 0.1, 2}}, {}, ""},
      {"field_weakening", Site::plant, 0, {{"weak", -0.05, -0.01}}, {}, ""},
  };
  return s;
}

/// Position loop of a servo with its linkage; the model comes from misfit init.
System servo() {
  System s;
  s.name = "servo";
  s.parameters = {{"k", 40, 120}, {"d", 4, 12}};
  s.initial = {0, 0};
  s.inputs = {{"u", "rad", 1, -1, 1}};
  s.outputs = {{"q", "rad"}};
  s.rates = [](const double* x, const double* u, const Values& p, double* dx) {
    dx[0] = x[1];
    dx[1] = (p("k") * (u[0] - x[0]) - p("d") * x[1] - dry(x[1], p) - p("cubic") * x[0] * x[0] * x[0]) / (1 + p("arm") * std::cos(2 * x[0]));
  };
  s.observe = [](const double* x, const double*, const Values&, double* y) { y[0] = x[0]; };
  s.slowest = 0.3, s.step_low = 0.005, s.step_high = 0.03, s.fine_step = 0.001;
  s.disturbed = {1};
  s.effects = {
      {"backlash",
       Site::input,
       0,
       {{"play", 0.02, 0.15}},
       {"backlash@dq_rate/dt;displacement=u"},
       "backlash = { displacement = \"u\", port = \"PORT\", start = { play_stiffness = {k}, play = {play}, backlash_tau = 0.002 } }"},
      {"coulomb",
       Site::plant,
       0,
       {{"coulomb", 1, 12}, {"width", 0.02, 0.05}},
       {"coulomb_friction@dq_rate/dt"},
       "coulomb_friction = { port = \"PORT\", rate = \"q_rate\", start = { friction = {coulomb}, width = {width} } }"},
      {"hardening",
       Site::plant,
       0,
       {{"cubic", 3, 60, true}},
       {"cubic_stiffness@dq_rate/dt"},
       "cubic_stiffness = { port = \"PORT\", displacement = \"q\", start = { cubic_stiffness = {cubic} } }"},
      {"input_delay",
       Site::input,
       0,
       {{"delay", 0.6, 6.0}},
       {"delay@dq_rate/dt", "sensor_delay@q", "time_offset"},
       "delay = { port = \"PORT\", start = { delayed_gain = {k}, delay = {delay} } }"},
      {"input_saturation",
       Site::input,
       0,
       {{"limit", 0.4, 0.85}},
       {"saturation@dq_rate/dt"},
       "saturation = { port = \"PORT\", start = { saturated_gain = {k}, limit = {limit} } }"},
      slow_sensor(0, "q"),
      {"coarse_q",
       Site::sensor,
       0,
       {{"step", 4, 20}},
       {"sensor_quantisation@q"},
       "sensor_quantisation = { output = \"q\", start = { rounded = 0.99, step = {step} } }"},
      {"arm_inertia", Site::plant, 0, {{"arm", 0.1, 0.5}}, {}, ""},
      slow_actuator("slew_limit"),
  };
  return s;
}

/// Roll axis of a drone, on a test stand with springs.
System drone_roll() {
  System s;
  s.name = "drone_roll";
  s.text = R"toml([system]
doc = "roll axis of a quadrotor on a sprung test stand"
[states]
phi = { unit = "rad" }
p = { unit = "rad/s", rate_of = "phi" }
[inputs]
u = { unit = "-", hold = "{hold}", doc = "difference of the motor commands" }
[parameters]
Lu = { unit = "rad/s^2", value = {Lu}, free = true }
Lp = { unit = "1/s", value = {Lp}, free = true }
Lphi = { unit = "1/s^2", value = {Lphi}, free = true }
[equations]
p = "Lu*u - Lp*p - Lphi*phi"
[outputs]
phi = { unit = "rad", noise = 0.01 }
p = { unit = "rad/s", noise = 0.02 }
)toml";
  s.parameters = {{"Lu", 20, 50}, {"Lp", 1, 5}, {"Lphi", 15, 60}};
  s.initial = {0, 0};
  s.inputs = {{"u", "-", 1, -1, 1}};
  s.outputs = {{"phi", "rad"}, {"p", "rad/s"}};
  s.rates = [](const double* x, const double* u, const Values& p, double* dx) {
    dx[0] = x[1];
    dx[1] = p("Lu") * u[0] * (1 - p("loss") * std::abs(x[1])) - p("Lp") * x[1] - p("Lphi") * x[0] - p("drag") * std::abs(x[1]) * x[1] +
            p("trim") - dry(x[1], p);
  };
  s.observe = [](const double* x, const double*, const Values&, double* y) { y[0] = x[0], y[1] = x[1]; };
  s.slowest = 0.35, s.step_low = 0.005, s.step_high = 0.02, s.fine_step = 0.001;
  s.disturbed = {1};
  s.effects = {
      shifted_sensor(1, "p"),
      shifted_sensor(0, "phi"),
      late_input("dp/dt", "Lu"),
      late_sensor(1, "p"),
      slow_sensor(0, "phi"),
      {"drag",
       Site::plant,
       0,
       {{"drag", 0.1, 3}},
       {"quadratic_drag@dp/dt"},
       "quadratic_drag = { port = \"dp/dt\", start = { drag = {drag} } }"},
      {"dry_stand",
       Site::plant,
       0,
       {{"coulomb", 0.5, 6}, {"width", 0.02, 0.05}},
       {"coulomb_friction@dp/dt"},
       "coulomb_friction = { port = \"dp/dt\", start = { friction = {coulomb}, width = {width} } }"},
      limited_input("dp/dt", "Lu"),
      {"thrust_loss", Site::plant, 0, {{"loss", 0.03, 0.2}}, {}, ""},
      slow_actuator("slow_motors"),
  };
  // A trim and an angle that is off by trim/Lphi are one thing.
  s.effects[1].right = {"bias@phi", "input_offset@dp/dt"};
  return s;
}

System quarter_car() {
  System s;
  s.name = "quarter_car";
  s.text = R"toml(# Quarter car on a four-post rig: body s, wheel u, road zr
[system]
doc = "quarter car"
[states]
zs = { unit = "m", scale = 0.02 }
vs = { unit = "m/s", rate_of = "zs", scale = 0.2 }
zu = { unit = "m", scale = 0.02 }
vu = { unit = "m/s", rate_of = "zu", scale = 0.5 }
[inputs]
zr = { unit = "m", hold = "{hold}" }
[parameters]
ms = { unit = "kg", value = {=ms} }
mu = { unit = "kg", value = {=mu} }
ks = { unit = "N/m", value = {ks}, free = true }
cs = { unit = "N s/m", value = {cs}, free = true }
kt = { unit = "N/m", value = {kt}, free = true }
[quantities]
stroke = { unit = "m", formula = "zs - zu" }
stroke_rate = { unit = "m/s", formula = "vs - vu" }
[ports]
strut = { unit = "N", rate = "stroke_rate", doc = "force of the strut on the body" }
[equations]
vs = "(-ks*stroke - cs*stroke_rate + strut)/ms"
vu = "(ks*stroke + cs*stroke_rate - strut - kt*(zu - zr))/mu"
[outputs]
d = { unit = "m", formula = "zs - zu", noise = 0.001 }
zs = { unit = "m", noise = 0.001 }
)toml";
  s.parameters = {{"ms", 250, 350}, {"mu", 35, 50}, {"ks", 14000, 22000}, {"cs", 900, 1800}, {"kt", 120000, 200000}};
  s.initial = {0, 0, 0, 0};
  s.inputs = {{"zr", "m", 1, -0.04, 0.04}};
  s.outputs = {{"d", "m"}, {"zs", "m"}};
  s.rates = [](const double* x, const double* u, const Values& p, double* dx) {
    const double d = x[0] - x[2], rate = x[1] - x[3];
    double strut = -p("ks") * d - p("cs") * rate - dry(rate, p) - p("cubic") * d * d * d - p("drag") * std::abs(rate) * rate;
    if (p("stop") > 0.0) strut -= p("stop_stiffness") * beyond(d, p("stop"));
    if (rate > 0.0) strut -= p("rebound") * rate;
    const double reach = u[0] - x[2], tyre = p("lift") > 0.0 ? std::max(reach, -p("lift")) : reach;
    dx[0] = x[1], dx[2] = x[3];
    dx[1] = strut / p("ms");
    dx[3] = (-strut + p("kt") * tyre) / p("mu");
  };
  s.observe = [](const double* x, const double*, const Values&, double* y) { y[0] = x[0] - x[2], y[1] = x[0]; };
  s.slowest = 0.2, s.step_low = 0.004, s.step_high = 0.01, s.fine_step = 0.0005;
  s.disturbed = {1};
  s.effects = {
      {"strut_friction",
       Site::plant,
       0,
       {{"coulomb", 10, 150}, {"width", 0.005, 0.01}},
       {"coulomb_friction@strut"},
       "coulomb_friction = { port = \"strut\", rate = \"stroke_rate\", start = { friction = {coulomb}, width = {width} } }"},
      {"hardening",
       Site::plant,
       0,
       {{"cubic", 1e6, 3e7}},
       {"cubic_stiffness@strut"},
       "cubic_stiffness = { port = \"strut\", displacement = \"stroke\", start = { cubic_stiffness = {cubic} } }"},
      {"bump_stop",
       Site::plant,
       0,
       {{"stop", 0.012, 0.03}, {"stop_stiffness", 1e4, 1e5}},
       {"dead_zone@strut"},
       "dead_zone = { port = \"strut\", displacement = \"stroke\", start = { stop_stiffness = {stop_stiffness}, half_width = {stop} } }"},
      {"orifice",
       Site::plant,
       0,
       {{"drag", 300, 5000}},
       {"quadratic_drag@strut"},
       "quadratic_drag = { port = \"strut\", rate = \"stroke_rate\", start = { drag = {drag} } }"},
      shifted_sensor(0, "d"),
      late_sensor(1, "zs"),
      {"road_delay",
       Site::input,
       0,
       {{"delay", 0.6, 5.0}},
       {"delay@dvu/dt", "time_offset"},
       "delay = { port = \"dvu/dt\", start = { delayed_gain = {kt/mu}, delay = {delay} } }"},
      {"rebound", Site::plant, 0, {{"rebound", 200, 2000}}, {}, ""},
      {"wheel_lift", Site::plant, 0, {{"lift", 0.001, 0.005}}, {}, ""},
  };
  return s;
}

System hydraulic_cylinder() {
  System s;
  s.name = "hydraulic_cylinder";
  s.text = R"toml(# Valve-controlled cylinder against a spring, load pressure p
[states]
x = { unit = "m", scale = 0.1 }
v = { unit = "m/s", rate_of = "x", scale = 0.2 }
p = { unit = "Pa", scale = 1e6 }
[inputs]
u = { unit = "-", hold = "{hold}", doc = "valve opening" }
[parameters]
m = { unit = "kg", value = {=m} }
A = { unit = "m^2", value = {=A} }
k = { unit = "N/m", value = {k}, free = true }
b = { unit = "N s/m", value = {b}, free = true }
C = { unit = "Pa/m^3", value = {C}, free = true, doc = "4 beta/V" }
Kq = { unit = "m^3/s", value = {Kq}, free = true }
Kc = { unit = "m^3/s/Pa", value = {Kc}, free = true, doc = "flow-pressure gain of the valve" }
[equations]
v = "(A*p - k*x - b*v)/m"
p = "C*(Kq*u - A*v - Kc*p)"
[outputs]
x = { unit = "m", noise = 0.001 }
p = { unit = "Pa", noise = 1e4 }
)toml";
  s.parameters = {{"m", 40, 80},     {"A", 8e-4, 1.5e-3}, {"k", 8e3, 2e4},       {"b", 400, 1500},
                  {"C", 5e10, 2e11}, {"Kq", 1e-4, 3e-4},  {"Kc", 3e-11, 1.5e-10}};
  s.initial = {0, 0, 0};
  s.inputs = {{"u", "-", 1, -1, 1}};
  s.outputs = {{"x", "m"}, {"p", "Pa"}};
  s.rates = [](const double* x, const double* u, const Values& p, double* dx) {
    double flow = p("Kq") * u[0];
    if (p("supply") > 0.0) flow *= std::sqrt(std::max(1.0 - std::tanh(20 * u[0]) * x[2] / p("supply"), 0.0));
    const double seal = dry(x[1], p) + p("uneven") * std::pow(std::tanh(x[1] / 0.005), 2) + p("load");
    dx[0] = x[1];
    dx[1] = (p("A") * x[2] - p("k") * x[0] - p("b") * x[1]) / p("m") - seal;
    dx[2] = p("C") * (flow - p("A") * x[1] - p("Kc") * x[2]) - p("orifice") * sign(x[2]) * std::sqrt(std::abs(x[2])) + p("valve");
  };
  s.observe = [](const double* x, const double*, const Values&, double* y) { y[0] = x[0], y[1] = x[2]; };
  s.slowest = 0.4, s.step_low = 0.005, s.step_high = 0.015, s.fine_step = 0.0005;
  s.disturbed = {1};
  s.effects = {
      {"seal_friction",
       Site::plant,
       0,
       {{"coulomb", 0.3, 8}, {"width", 0.003, 0.006}},
       {"coulomb_friction@dv/dt"},
       "coulomb_friction = { port = \"dv/dt\", start = { friction = {coulomb}, width = {width} } }"},
      {"uneven_seals",
       Site::plant,
       0,
       {{"uneven", 0.3, 5, true}},
       {"directional_friction@dv/dt"},
       "coulomb_friction = { port = \"dv/dt\", start = { friction = 0, width = 0.005 } }\n"
       "directional_friction = { port = \"dv/dt\", start = { asymmetry = {uneven} } }"},
      {"load_force",
       Site::plant,
       0,
       {{"load", 0.5, 10, true}},
       {"input_offset@dv/dt", "bias@p"},
       "input_offset = { port = \"dv/dt\", start = { input_offset = -{load} } }"},
      {"valve_offset",
       Site::plant,
       0,
       {{"valve", 1e5, 2e6, true}},
       {"input_offset@dp/dt"},
       "input_offset = { port = \"dp/dt\", start = { input_offset = {valve} } }"},
      limited_input("dp/dt", "C*Kq"),
      late_input("dp/dt", "C*Kq"),
      late_sensor(1, "p"),
      slow_sensor(0, "x"),
      {"valve_pressure", Site::plant, 0, {{"supply", 8e5, 4e6}}, {}, ""},
      {"orifice_leak", Site::plant, 0, {{"orifice", 1e3, 1.2e4}}, {}, ""},
  };
  return s;
}

System two_mass_drive() {
  System s;
  s.name = "two_mass_drive";
  s.text = R"toml([system]
doc = "two-mass drive: motor 1, elastic shaft, load 2"
[states]
w1 = { unit = "rad/s" }
w2 = { unit = "rad/s" }
twist = { unit = "rad", scale = 0.1 }
[inputs]
T = { unit = "N m", hold = "{hold}" }
[parameters]
J1 = { unit = "kg m^2", value = {J1}, free = true, bounds = [1e-4, 10.0] }
J2 = { unit = "kg m^2", value = {J2}, free = true, bounds = [1e-4, 10.0] }
ks = { unit = "N m/rad", value = {ks}, free = true, bounds = [0.0, 1e5] }
ds = { unit = "N m s/rad", value = {ds}, free = true, bounds = [0.0, 1e3] }
b = { unit = "N m s/rad", value = {b}, free = true, bounds = [0.0, 1e3] }
[quantities]
slip = { unit = "rad/s", formula = "w1 - w2" }
[ports]
shaft = { unit = "N m", rate = "slip", doc = "torque on the motor, its opposite on the load" }
[equations]
w1 = "(T - ks*twist - ds*slip + shaft - b*w1)/J1"
w2 = "(ks*twist + ds*slip - shaft - b*w2)/J2"
twist = "w1 - w2"
[outputs]
w1 = { unit = "rad/s", noise = 0.1 }
w2 = { unit = "rad/s", noise = 0.1 }
)toml";
  s.parameters = {{"J1", 0.02, 0.05}, {"J2", 0.04, 0.1}, {"ks", 10, 30}, {"ds", 0.02, 0.1}, {"b", 0.05, 0.15}};
  s.initial = {0, 0, 0, 0};  // the angle of the load is not in the model
  s.inputs = {{"T", "N m", 1, -3, 3}};
  s.outputs = {{"w1", "rad/s"}, {"w2", "rad/s"}};
  s.rates = [](const double* x, const double* u, const Values& p, double* dx) {
    const double slip = x[0] - x[1];
    double twist = x[2];
    if (p("gap") > 0.0) twist = beyond(twist, p("gap"));
    const double shaft = p("ks") * twist + p("ds") * slip + p("cubic") * x[2] * x[2] * x[2] + p("dry_shaft") * std::tanh(slip / 0.02);
    dx[0] = (u[0] - shaft - p("b") * x[0]) / p("J1");
    dx[1] = (shaft - p("b") * x[1]) / p("J2") - dry(x[1], p) - p("load") - p("unbalance") * std::sin(x[3]);
    dx[2] = slip;
    dx[3] = x[1];
  };
  s.observe = [](const double* x, const double*, const Values&, double* y) { y[0] = x[0], y[1] = x[1]; };
  s.slowest = 0.5, s.step_low = 0.005, s.step_high = 0.02, s.fine_step = 0.0005;
  s.disturbed = {1};
  s.effects = {
      {"load_friction",
       Site::plant,
       0,
       {{"coulomb", 0.5, 10}, {"width", 0.1, 0.2}},
       {"coulomb_friction@dw2/dt"},
       "coulomb_friction = { port = \"dw2/dt\", rate = \"w2\", start = { friction = {coulomb}, width = {width} } }"},
      {"load_torque",
       Site::plant,
       0,
       {{"load", 0.3, 8, true}},
       {"input_offset@dw2/dt", "input_offset@dw1/dt"},
       "input_offset = { port = \"dw2/dt\", start = { input_offset = -{load} } }"},
      {"hard_shaft",
       Site::plant,
       0,
       {{"cubic", 100, 3000}},
       {"cubic_stiffness@shaft"},
       "cubic_stiffness = { port = \"shaft\", displacement = \"twist\", start = { cubic_stiffness = {cubic} } }"},
      {"gap",
       Site::plant,
       0,
       {{"gap", 0.005, 0.05}},
       {"dead_zone@shaft", "backlash@shaft"},
       "dead_zone = { port = \"shaft\", displacement = \"twist\", start = { stop_stiffness = {0.98*ks}, half_width = {gap} } }\n"
       "[parameters]\nks = { value = {0.02*ks} }"},
      {"dry_shaft",
       Site::plant,
       0,
       {{"dry_shaft", 0.02, 0.3}},
       {"coulomb_friction@shaft"},
       "coulomb_friction = { port = \"shaft\", rate = \"slip\", start = { friction = {dry_shaft}, width = 0.02 } }"},
      late_sensor(1, "w2"),
      shifted_sensor(0, "w1"),
      limited_input("dw1/dt", "1/J1"),
      {"unbalance", Site::plant, 0, {{"unbalance", 0.5, 10}}, {}, ""},
      {"uneven_sensor", Site::sensor, 0, {{"curve", 0.03, 0.2}}, {}, ""},
  };
  return s;
}

System cart_pendulum() {
  System s;
  s.name = "cart_pendulum";
  s.text = R"toml(# Hanging pendulum on a cart that is tied down by a weak spring
[states]
x = { unit = "m" }
v = { unit = "m/s", rate_of = "x" }
th = { unit = "rad" }
om = { unit = "rad/s", rate_of = "th" }
[inputs]
F = { unit = "N", hold = "{hold}" }
[parameters]
M = { unit = "kg", value = {M}, free = true, bounds = [0.01, 100.0] }
m = { unit = "kg", value = {=m} }
l = { unit = "m", value = {l}, free = true, bounds = [0.01, 10.0] }
k = { unit = "N/m", value = {k}, free = true }
b = { unit = "N s/m", value = {b}, free = true }
c = { unit = "N m s", value = {c}, free = true }
g = { unit = "m/s^2", value = 9.81 }
[ports]
cart = { unit = "N", rate = "v" }
pivot = { unit = "N m", rate = "om" }
[equations]
v = "(F + cart - k*x - b*v + m*sin(th)*(l*om^2 + g*cos(th)) - cos(th)/l*(pivot - c*om))/(M + m*sin(th)^2)"
om = "(pivot - c*om)/(m*l^2) - g/l*sin(th) - cos(th)/l*(F + cart - k*x - b*v + m*sin(th)*(l*om^2 + g*cos(th)) - cos(th)/l*(pivot - c*om))/(M + m*sin(th)^2)"
[outputs]
x = { unit = "m", noise = 0.002 }
th = { unit = "rad", noise = 0.01 }
)toml";
  s.parameters = {{"M", 0.6, 1.5}, {"m", 0.2, 0.4}, {"l", 0.3, 0.6}, {"k", 5, 20}, {"b", 0.5, 2}, {"c", 0.002, 0.01}};
  s.initial = {0, 0, 0, 0};
  s.inputs = {{"F", "N", 1, -4, 4}};
  s.outputs = {{"x", "m"}, {"th", "rad"}};
  s.rates = [](const double* x, const double* u, const Values& p, double* dx) {
    const double belt = p("cogging") * std::sin(2 * std::numbers::pi * x[0] / 0.05);
    const double cart = u[0] - p("k") * x[0] - p("b") * x[1] - dry(x[1], p) - p("cubic") * x[0] * x[0] * x[0] - belt;
    const double pivot = -p("c") * x[3] - p("dry_pivot") * std::tanh(x[3] / 0.05) - p("drag") * std::abs(x[3]) * x[3];
    const double sine = std::sin(x[2]), cosine = std::cos(x[2]), m = p("m"), l = p("l");
    dx[0] = x[1], dx[2] = x[3];
    dx[1] = (cart + m * sine * (l * x[3] * x[3] + 9.81 * cosine) - cosine / l * pivot) / (p("M") + m * sine * sine);
    dx[3] = pivot / (m * l * l) - 9.81 / l * sine - cosine / l * dx[1];
  };
  s.observe = [](const double* x, const double*, const Values&, double* y) { y[0] = x[0], y[1] = x[2]; };
  s.slowest = 0.6, s.step_low = 0.01, s.step_high = 0.04, s.fine_step = 0.001;
  s.disturbed = {1};
  s.effects = {
      {"cart_friction",
       Site::plant,
       0,
       {{"coulomb", 0.05, 1}, {"width", 0.01, 0.02}},
       {"coulomb_friction@cart"},
       "coulomb_friction = { port = \"cart\", rate = \"v\", start = { friction = {coulomb}, width = {width} } }"},
      {"pivot_friction",
       Site::plant,
       0,
       {{"dry_pivot", 0.002, 0.03}},
       {"coulomb_friction@pivot"},
       "coulomb_friction = { port = \"pivot\", rate = \"om\", start = { friction = {dry_pivot}, width = 0.05 } }"},
      {"air_drag",
       Site::plant,
       0,
       {{"drag", 0.0005, 0.01}},
       {"quadratic_drag@pivot"},
       "quadratic_drag = { port = \"pivot\", rate = \"om\", start = { drag = {drag} } }"},
      {"hard_spring",
       Site::plant,
       0,
       {{"cubic", 5, 100}},
       {"cubic_stiffness@cart"},
       "cubic_stiffness = { port = \"cart\", displacement = \"x\", start = { cubic_stiffness = {cubic} } }"},
      shifted_sensor(1, "th"),
      late_sensor(1, "th"),
      late_input("cart", "1"),
      limited_input("cart", "1"),
      {"belt_cogging", Site::plant, 0, {{"cogging", 0.2, 2}}, {}, ""},
      slow_actuator("slew_limit"),
  };
  return s;
}

}  // namespace

std::vector<System> machines() {
  return {dc_motor(), motor_speed(), servo(), drone_roll(), quarter_car(), hydraulic_cylinder(), two_mass_drive(), cart_pendulum()};
}

}  // namespace strangers
