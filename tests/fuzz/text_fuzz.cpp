// Whatever text comes in, misfit answers with a model or with an InputError: no crash, no hang, no leak, no undefined behaviour.
// The first character determines what the rest is: f a formula, e the line of a declared effect, s a declared system, anything else a
// study.

#include <misfit_models_registry.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <string>

#include "misfit/core/error.h"
#include "misfit/formula/build.h"
#include "misfit/formula/program.h"
#include "misfit/model/declared.h"
#include "misfit/model/evaluator.h"
#include "misfit/model/request.h"

namespace {

using namespace misfit;

const Registry& registry() {
  static const Registry* known = [] {
    auto* made = new Registry;  // lives as long as the program
    misfit_models_register(*made);
    return made;
  }();
  return *known;
}

void try_formula(const std::string& text) {
  constexpr std::array<const char*, 4> names = {"x", "y", "a", "t"}, units = {"V", "V/s", "-", "s"};
  formula::Graph graph;
  const formula::Names known{[&](const std::string& name) -> std::optional<formula::Meaning> {
                               for (std::size_t i = 0; i < names.size(); ++i) {
                                 if (name == names[i])
                                   return formula::Meaning{graph.leaf(static_cast<int>(i)), formula::measure_of(units[i])};
                               }
                               return std::nullopt;
                             },
                             {names.begin(), names.end()}};
  const formula::Syntax syntax = formula::parse({text, "formula", {"fuzz", 1, 1}});
  std::vector<int> roots{formula::build(syntax, known, graph, 0).node}, leaves;
  for (int i = 0; i < 4; ++i) leaves.push_back(graph.leaf(i));
  for (int slope : graph.derivatives(roots[0], leaves)) roots.push_back(slope);
  const formula::Program program(graph, roots, 4);
  std::vector<double> r(static_cast<std::size_t>(program.registers()), 0.3);
  program.run(r.data());
  static_cast<void>(program.culprit(0, r.data()));
}

/// The rates, outputs and their derivatives once, at the start values.
void run_once(const Model& model) {
  Evaluator evaluator(model);
  std::vector<double> x(static_cast<std::size_t>(model.states()), 0.3), u(static_cast<std::size_t>(model.inputs()) + 1, 0.2);
  std::vector<double> dx(x.size()), D(static_cast<std::size_t>(std::max(model.states(), evaluator.sensor_ports())) * kRowStride),
      y(static_cast<std::size_t>(evaluator.sensor_ports()));
  Slots slots;
  evaluator.linearise_rates({x.data(), u.data(), 0.0}, slots, dx.data(), D.data());
  slots.clear();
  evaluator.linearise_outputs({x.data(), u.data(), 0.0}, slots, y.data(), D.data());
  static_cast<void>(evaluator.fastest_rate(x.data(), u.data(), 0.0));
  static_cast<void>(evaluator.explain(x.data(), u.data(), 0.0));
}

void try_system(const std::string& text) {
  Registry own = Registry::over(registry());
  own.add(declared_system(text, "fuzz.toml", "fuzz"));
  ModelRequest request;
  request.system = "fuzz";
  const std::unique_ptr<System> system = own.system("fuzz").make({});
  for (const auto& constant : system->spec().constants) {
    if (constant.required) request.constants[constant.name] = std::clamp(1.0, constant.lower, constant.upper);
  }
  run_once(assemble(request, own));
}

void try_study(const std::string& text) {
  static const std::string file = "/dev/shm/misfit_fuzz_" + std::to_string(getpid()) + ".toml";
  std::ofstream(file, std::ios::binary) << text;
  const Study study = read_study(file);
  const auto known = study_registry(study, registry());
  StudyModel model = read_model(study, *known);
  for (const auto& [name, of] : curves_without_knots(model.request, *known)) model.request.curves[name] = {of, {0.1, 0.2}, {}, {}};
  run_once(assemble(model.request, *known));
}

void try_effect(const std::string& line) { try_study("[system]\nkind = \"cascaded_tanks\"\n[effects]\nmore = " + line + "\n"); }

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
  try {
    switch (data[0]) {
      case 'f':
        try_formula(text);
        break;
      case 'e':
        try_effect(text);
        break;
      case 's':
        try_system(text);
        break;
      default:
        try_study(text);
    }
  } catch (const InputError&) {  // refused in words
  }
  return 0;
}
