// Generated code against the program's Evaluator.
#include <gmock/gmock.h>

#include "misfit/formula/program.h"
#include "tests/export/generated.h"
#include "tests/model/declared_texts.h"

namespace misfit {
namespace {

using namespace testing_models;
using namespace testing_export;

/// A body in the wind, so that effects of the parachute act on equations given as text.
const std::string body_text = R"toml(
[states]
angle = { unit = "rad", min = -3.0 }
rate = { unit = "rad/s" }
[inputs]
gust = { unit = "m/s" }
[parameters]
S = { unit = "m^2", value = 1.9 }
D = { unit = "m", value = 1.6 }
inertia = { unit = "kg m^2", value = 5.0 }
speed = { unit = "m/s", value = 35.0 }
density = { unit = "kg/m^3", value = 1.2 }
brake = { unit = "1/s", value = 0.3 }
top = { unit = "rad/s", value = 3.0 }
soft = { unit = "rad/s", value = 0.2 }
bend = { unit = "rad", value = 0.4 }
[quantities]
wind_speed = { unit = "m/s", formula = "speed + gust" }
dynamic_pressure = { unit = "Pa", formula = "0.5*density*wind_speed^2" }
alpha_T = { unit = "rad", formula = "if(angle > bend, bend + 0.5*(angle - bend), angle)" }
wind_cross_axis = { unit = "-", formula = "sin(angle)" }
pitch_rate = { unit = "rad/s", formula = "rate" }
[ports]
pitching_moment = { unit = "N m" }
[equations]
angle = "rate"
rate = "pitching_moment/inertia - brake*S/D^2*min(rate, top, soft) - brake*abs(rate)*sign(angle)"
[outputs]
tilt = { unit = "rad", formula = "angle + 0.01*bend*sign(rate)" }
turning = { unit = "rad/s", formula = "max(rate, -top)" }
)toml";

double uniform(std::mt19937_64& random, double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); }

/// Every parameter, curves' coefficients too, somewhere inside of its bounds and near its scale.
void scatter(Model& model, std::mt19937_64& random) {
  for (std::size_t i = model.system->spec().constants.size(); i < model.parameters.size(); ++i) {
    Parameter& p = model.parameters[i];
    const double size = std::max(std::abs(p.value), p.scale);
    p.value = std::clamp(uniform(random, 0.5, 1.5) * size, p.lower, p.upper);
    if (p.curve >= 0) p.value = uniform(random, -1.0, 1.0) * p.scale;
  }
}

/// Sensor ports behind the outputs to which an effect adds: name, and place in what the evaluator predicts.
std::vector<std::pair<std::string, int>> shifts_of(const Model& model) {
  std::vector<std::pair<std::string, int>> out;
  const int outputs = model.outputs();
  for (int port = outputs; port <= 2 * outputs; ++port) {
    const bool used = std::any_of(model.effects.begin(), model.effects.end(), [&](const BoundEffect& e) {
      return e.kind == PortKind::sensor && std::find(e.ports.begin(), e.ports.end(), port) != e.ports.end();
    });
    if (used)
      out.emplace_back(port == outputs ? all_sample_times : sample_time_of(model.system->spec().outputs[port - outputs - 1].name), port);
  }
  return out;
}

Questions questions_of(const Model& model, std::mt19937_64& random, int count = 200) {
  Questions ask;
  ask.states = model.states();
  ask.inputs = model.inputs() + int_size(model.late_inputs());
  ask.outputs = model.outputs();
  for (const auto& [name, port] : shifts_of(model)) ask.sample_times.push_back(name);
  for (int i = 0; i < count; ++i) {
    Row point;
    for (int k = 0; k < ask.states + ask.inputs; ++k) point.push_back(uniform(random, -1.0, 1.0) * (i % 3 == 0 ? 4.0 : 0.5));
    point.push_back(uniform(random, 0.0, 60.0));
    ask.points.push_back(point);
  }
  return ask;
}

/// A record in which every input has always been what the exported code is given as its late value, behind the inputs `u`.
RecordedInputs always_late(const Model& model, const double* u) {
  RecordedInputs out{{0.0}, std::vector<Hold>(static_cast<std::size_t>(model.inputs()), Hold::first_order), {}};
  out.values.assign(out.stride(), 0.0);
  const std::vector<LateInputUse> late = model.late_inputs();
  for (std::size_t i = 0; i < late.size(); ++i)
    out.values[static_cast<std::size_t>(late[i].input)] = u[static_cast<std::size_t>(model.inputs()) + i];
  return out;
}

std::vector<Row> evaluated(const Model& model, const Questions& ask) {
  Evaluator evaluator(model);
  std::vector<Row> rows;
  for (const Row& point : ask.points) {
    const double *x = point.data(), *u = x + ask.states, t = point.back();
    Row row(ask.states), y(evaluator.sensor_ports());
    const RecordedInputs recorded = always_late(model, u);
    evaluator.rates(x, {u, &recorded}, t, row.data());
    evaluator.predict(x, {u, &recorded}, t, y.data());
    row.insert(row.end(), y.begin(), y.begin() + ask.outputs);
    for (const auto& [name, port] : shifts_of(model)) row.push_back(y[static_cast<std::size_t>(port)]);
    for (const Curve& curve : model.curves) {
      const CurvePoint at = curve.spline.at(point[0]);
      double value = 0.0;
      for (int j = 0; j < 4; ++j) value += at.w[j] * model.parameters[curve.first + at.first + j].value;
      row.push_back(value);
    }
    rows.push_back(row);
  }
  return rows;
}

void expect_agreement(const ModelRequest& request, const Registry& known, unsigned seed) {
  std::mt19937_64 random(seed);
  Exported exported{"a study", "", "misfit", {}, assemble(request, known)};
  scatter(*exported.model, random);
  Questions ask = questions_of(*exported.model, random);
  for (const Curve& curve : exported.model->curves) ask.curves.push_back("curve_" + curve.name);
  expect_both_give(exported, ask, evaluated(*exported.model, ask));
}

TEST(GeneratedCode, AgreesOnADeclaredSystem) {
  const auto known = registry_with(duffing_text);
  expect_agreement(request_of("text"), *known, 1);
}

TEST(GeneratedCode, AgreesOnASystemOfTheProgram) { expect_agreement(request_of("cascaded_tanks"), registry(), 2); }

TEST(GeneratedCode, AgreesWithEffectsOnEveryKindOfPort) {
  const auto known = registry_with(duffing_text);
  expect_agreement(request_of("text", {effect("coulomb_friction"), effect("stribeck_friction", {{"rate", "y"}, {"port", "dy/dt"}}),
                                       effect("saturation", {{"input", "u"}}), effect("constant_force", {{"port", "u"}}),
                                       effect("bias", {{"output", "y"}}), effect("delay", {{"input", "u"}}), effect("hysteresis"),
                                       effect("backlash", {{"displacement", "y"}}), effect("drift"), effect("periodic_forcing"),
                                       effect("dead_zone", {{"displacement", "y"}}), effect("sensor_delay"), effect("sensor_saturation"),
                                       effect("time_offset"), effect("sensor_clock", {{"time_of_output", "sample_time_y"}})}),
                   *known, 3);
}

TEST(GeneratedCode, NamesMemoryAndLateInputsAndSaysThatShiftsOfTimeAddUp) {
  const auto known = registry_with(duffing_text);
  const ModelRequest request = request_of("text", {effect("delay", {{"input", "u"}}), effect("hysteresis"), effect("time_offset"),
                                                   effect("sensor_clock", {{"time_of_output", "sample_time_y"}})});
  const Exported exported{"a study", "", "misfit", {}, assemble(request, *known)};
  const std::string text = python_source(exported);
  const Model& model = *exported.model;
  ASSERT_FALSE(model.own_state_names.empty());
  EXPECT_THAT(text, testing::HasSubstr(", \"" + model.own_state_names.back() + "\"]\ninputs = [\"u\", \"u_late\"]"));
  EXPECT_THAT(text, testing::HasSubstr("y[0] belongs to the time t + sample_time + sample_time_y."));
}

TEST(GeneratedCode, AgreesWithAnEffectDeclaredInTheStudy) {
  auto known = registry_with(duffing_text);
  const SystemSpec spec = known->system("text").make({})->spec();
  known->add(declared_effect(
      effect_in_one_line("spill", R"toml({ port = "push", formula = "-c*max(y - level, 0, level)*(1 + sin(pi*y/level))", )toml"
                                  R"toml(parameters = { c = { unit = "1/s^2", value = 0.4 }, level = { unit = "V", value = 0.2 } } })toml"),
      spec));
  expect_agreement(request_of("text", {effect("spill")}), *known, 4);
}

TEST(GeneratedCode, AgreesWithCurvesOutsideOfTheirKnotsToo) {
  const auto known = registry_with(body_text, "body");
  ModelRequest request = request_of("body", {effect("static_moment"), effect("pitch_damping"), effect("viscous_friction")});
  request.curves["C_m"] = {"alpha_T", {0.05, 0.1, 0.2, 0.45, 0.7}, {}, {}};
  request.curves["C_mq"] = {"alpha_T", {0.08, 0.3, 0.6}, {}, {}};
  request.curves["viscosity"] = {"angle", {-0.4, 0.1, 0.5, 0.8}, {}, {}};
  expect_agreement(request, *known, 5);
}

TEST(GeneratedCode, AgreesOnTheParachute) {
  expect_agreement(parachute(true, {effect("coulomb_friction"), effect("apparent_inertia")}), registry(), 6);
  expect_agreement(parachute(false, {effect("relative_dynamic_pressure")}), registry(), 7);
  expect_agreement(
      spherical({effect("magnus"), effect("aerodynamic_lag"), effect("vortex_shedding"), effect("strut_wake"), effect("lateral_damping"),
                 effect("flow_angularity"), effect("camera_roll"), effect("lens_distortion"), effect("dynamic_pressure_drift")}),
      registry(), 8);
}

/// The test's cart takes inputs as numbers alone.
TEST(GeneratedCode, WithoutFormulasSaysSoAndHasThemInWords) {
  const Exported exported{"a study", "", "misfit", {}, assemble(cart({effect("viscous_friction")}), registry())};
  for (const std::string& text : {c_source(exported), python_source(exported)}) {
    EXPECT_THAT(text, testing::HasSubstr("No right-hand side: the equations of system 'test_oscillator'"));
    EXPECT_THAT(text, testing::HasSubstr("test_oscillator: (mass + P) v' = drive - stiffness x + force"));
    EXPECT_THAT(text, testing::HasSubstr("viscous_friction: F = "));
    EXPECT_THAT(text, testing::Not(testing::HasSubstr("rates(")));
  }
  const Exported field{"a study", "", "misfit", {}, assemble(spherical({effect("field_offset")}), registry())};
  EXPECT_THAT(c_source(field), testing::HasSubstr("No right-hand side: effect 'field_offset' is compiled C++"));
}

/// A fit in bins has no model: its curves are straight lines between the bins.
TEST(GeneratedCode, OfBinsHasThemOnTheirGrid) {
  Exported exported{"a study", "", "misfit", {}, std::nullopt};
  exported.fit.method = "sliding_bin";
  exported.fit.curves.push_back(
      {"C_m", "alpha_T", "rad", "-", {0.1, 0.2, 0.4}, {1.0, 3.0, -2.0}, {0.1, 0.2, 0.3}, {5, 5, 5}, true, "", true});
  Questions ask;
  ask.curves = {"curve_C_m", "curve_C_m_sigma"};
  ask.points = {{0.0}, {0.1}, {0.15}, {0.25}, {0.4}, {0.9}};
  expect_both_give(exported, ask, {{1.0, 0.1}, {1.0, 0.1}, {2.0, 0.15}, {1.75, 0.225}, {-2.0, 0.3}, {-2.0, 0.3}});
}

/// Names in code, units and texts are a user's: nothing of them may end a comment or begin a statement.
TEST(GeneratedCode, HoldsOddNames) {
  const auto known = registry_with(duffing_text);
  Exported exported{"*/ \"\"\" \\\nint x = ;\\", "rung 1 \\", "misfit", {}, assemble(request_of("text"), *known)};
  Questions ask;
  ask.states = 2;
  ask.inputs = ask.outputs = 1;
  ask.points = {{0.3, -1.2, 0.7, 0.0}};
  expect_both_give(exported, ask, evaluated(*exported.model, ask));
}

/// Every formula of the program, read back as a graph, at its worked examples and at random points.
TEST(FormulasReadBack, AreThoseOfEveryEffect) {
  std::vector<std::string> not_readable;
  std::mt19937_64 random(7);
  for (const std::string& key : registry().effect_keys()) {
    const Effect& effect = registry().effect(key);
    const EffectSpec& spec = effect.spec();
    const std::size_t nq = spec.quantities.size(), nc = spec.coefficients.size(), nz = spec.states.size(), nk = spec.constants.size();
    const std::size_t results = spec.ports.size() + nz, leaves = nq + nc + nz + nk + 1;
    formula::Graph graph;
    std::vector<int> nodes;
    for (std::size_t i = 0; i < leaves; ++i) nodes.push_back(graph.leaf(static_cast<int>(i)));
    bool readable = false;
    const std::vector<int> roots = formula::trace(graph, results, [&](formula::Symbol* out) {
      std::vector<formula::Symbol> in;
      for (const int node : nodes) in.push_back(formula::Symbol::of_node(node));
      readable = effect.trace({in.data(), in.data() + nq, in.data() + nq + nc, in.data() + nq + nc + nz, in.back()}, out);
    });
    if (!readable) {
      not_readable.push_back(key);
      continue;
    }
    const formula::Program program(graph, roots, static_cast<int>(leaves));
    for (int trial = 0; trial < 50; ++trial) {
      std::vector<double> registers(program.registers());
      for (std::size_t i = 0; i < leaves; ++i) registers[i] = uniform(random, -1.0, 1.0) * (trial % 2 == 0 ? 1.0 : 1e-3);
      const double* in = registers.data();
      std::vector<double> wanted(results);
      effect.evaluate({in, in + nq, in + nq + nc, in + nq + nc + nz, in[leaves - 1]}, wanted.data());
      program.run(registers.data());
      for (std::size_t r = 0; r < results; ++r) {
        const double found = registers[program.place(r)];
        if (std::isnan(wanted[r]) && std::isnan(found)) continue;
        EXPECT_NEAR(found, wanted[r], 1e-12 * std::abs(wanted[r])) << key << ", result " << r;
      }
    }
  }
  EXPECT_THAT(not_readable, testing::ElementsAre("field_offset"));
}

}  // namespace
}  // namespace misfit
