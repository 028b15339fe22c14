#pragma once

#include <string>
#include <utility>
#include <vector>

#include "misfit/formula/graph.h"
#include "misfit/model/model.h"

namespace misfit {

/// The right-hand side and the outputs of an assembled model as one graph, in the order of the Evaluator (lib/misfit/README.md (1), (2)).
/// Leaves: states, inputs, time, all parameters, and values of curves.
struct ModelFormulas {
  struct CurveUse {
    int curve = 0;     ///< index into Model::curves; over_sine curves enter divided by the sine of their quantity
    int argument = 0;  ///< node
  };
  formula::Graph graph;
  int states = 0, inputs = 0, parameters = 0;
  std::vector<LateInputUse> late;    ///< each is an input more, behind those of the system
  std::vector<CurveUse> curve_uses;  ///< leaf first_curve() + i
  std::vector<int> rates, outputs;   ///< nodes
  /// Nodes of the shifts of the times at which outputs are taken [s], with the name that each has as a port; empty: none is shifted.
  std::vector<std::pair<std::string, int>> sample_times;
  std::string lack;  ///< why there are no formulas; empty: there are

  [[nodiscard]] int input(int i) const { return states + i; }
  [[nodiscard]] int time() const { return states + inputs; }
  [[nodiscard]] int parameter(int i) const { return time() + 1 + i; }
  [[nodiscard]] int first_curve() const { return parameter(parameters); }
};

/// Of a system declared as text, and of one in C++ whose formulas can be called with symbols (model/system_of.h); likewise its effects
/// (model/effect.h). `lack` says which cannot.
[[nodiscard]] ModelFormulas model_formulas(const Model& model);

}  // namespace misfit
