#pragma once

// Formulas of a few names for tests: x [V], y [V], v [V/s], a [rad], n [-], k [1/s], t [s].

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "misfit/formula/build.h"
#include "misfit/formula/program.h"

namespace misfit::testing_formulas {

struct Name {
  const char* name;
  const char* unit;
};
inline constexpr std::array<Name, 7> known = {{{"x", "V"}, {"y", "V"}, {"v", "V/s"}, {"a", "rad"}, {"n", "-"}, {"k", "1/s"}, {"t", "s"}}};
using Point = std::array<double, known.size()>;

/// A formula ready to be evaluated, with its derivatives by every name.
class Made {
 public:
  explicit Made(const std::string& text, bool steepest = false) {
    const formula::Syntax syntax = formula::parse({text, "formula", {"file.toml", 7, 10}});
    const formula::Names names{[this](const std::string& name) -> std::optional<formula::Meaning> {
                                 for (std::size_t i = 0; i < known.size(); ++i) {
                                   if (name == known[i].name)
                                     return formula::Meaning{graph.leaf(static_cast<int>(i)), formula::measure_of(known[i].unit)};
                                 }
                                 return std::nullopt;
                               },
                               {"x", "y", "v", "a", "n", "k", "t"}};
    meaning = formula::build(syntax, names, graph, 0);
    std::vector<int> leaves, roots{meaning.node};
    for (std::size_t i = 0; i < known.size(); ++i) leaves.push_back(graph.leaf(static_cast<int>(i)));
    for (int slope : graph.derivatives(meaning.node, leaves, steepest)) roots.push_back(slope);
    program = formula::Program(graph, roots, static_cast<int>(known.size()));
  }

  /// Value, then the derivatives.
  std::vector<double> operator()(const Point& at) const {
    std::vector<double> r(static_cast<std::size_t>(program.registers()), std::nan(""));
    std::copy(at.begin(), at.end(), r.begin());
    program.run(r.data());
    std::vector<double> out;
    for (std::size_t root = 0; root <= known.size(); ++root) out.push_back(r[static_cast<std::size_t>(program.place(root))]);
    return out;
  }
  [[nodiscard]] std::string unit() const { return meaning.measure.text(); }

  formula::Graph graph;
  formula::Meaning meaning;
  formula::Program program;
};

inline constexpr Point somewhere = {0.7, -0.3, 1.9, 0.4, 2.5, 0.8, 3.0};

inline double value(const std::string& text, const Point& at = somewhere) { return Made(text)(at)[0]; }

inline std::string error_of(const std::string& text) {
  try {
    const Made made(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace misfit::testing_formulas
