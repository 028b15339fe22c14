#pragma once

// x' = −a x + b u, given as text, and its records.

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "misfit/fit/regression/equation_error.h"
#include "misfit/fit/shooting/output_error.h"
#include "tests/model/declared_texts.h"

namespace misfit::testing_first_order {

using namespace testing_models;

inline constexpr double noise = 0.01;

inline const std::string first_order = R"toml(
[states]
x = { unit = "V", scale = 1.0 }
[inputs]
u = { unit = "V", hold = "zero_order" }
[parameters]
a = { unit = "1/s", value = 0.7, bounds = [0.0, 100.0], free = true }
b = { unit = "1/s", value = 0.7, bounds = [-100.0, 100.0], free = true }
[equations]
x = "-a*x + b*u"
)toml";
inline const std::string one_output = first_order + R"toml([outputs]
y = { unit = "V", formula = "x", noise = 0.01 }
)toml";
inline const std::string two_outputs = first_order + R"toml([outputs]
y = { unit = "V", formula = "x", noise = 0.01 }
z = { unit = "V", formula = "x", noise = 0.01 }
)toml";

/// x' = size u − x from x0, u on and off in turn every 2.5 s; of every output with noise of its own.
inline Signals record(const std::string& name, double size, unsigned seed, double x0 = 0.5, std::size_t outputs = 1) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Signals s;
  s.name = name;
  s.measured = {{"y", "V", {}, 0.0}, {"z", "V", {}, 0.0}};
  s.measured.resize(outputs);
  s.inputs = {{"u", "V", {}, 0.0}};
  constexpr double step = 0.1;
  double x = x0;
  for (std::size_t i = 0; i < 400; ++i) {
    const double u = (i / 25) % 2 == 0 ? size : 0.0;
    s.t.push_back(step * static_cast<double>(i));
    s.inputs[0].values.push_back(u);
    for (Signal& channel : s.measured) channel.values.push_back(x + noise * normal(random));
    x = u + (x - u) * std::exp(-step);
  }
  return s;
}

/// By output error in segments of half a second and longer.
inline FittedModel fitted(const Model& model, const std::vector<Signals>& experiments) {
  OutputErrorStart options;
  options.frequency = 6.0;
  return output_error(equation_error(model, experiments), experiments, options);
}

inline FittedModel fitted(const std::string& text, const std::vector<Signals>& experiments,
                          const std::vector<EffectRequest>& effects = {}) {
  const auto known = registry_with(text);
  return fitted(assemble(request_of("text", effects), *known), experiments);
}

}  // namespace misfit::testing_first_order
