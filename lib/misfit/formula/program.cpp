#include "misfit/formula/program.h"

#include <cmath>
#include <string>

#include "misfit/core/error.h"

namespace misfit::formula {

Program::Program(const Graph& graph, const std::vector<int>& roots, int leaves) : registers_(leaves) {
  std::vector<char> needed(graph.size(), 0);
  for (int root : roots) needed[root] = 1;
  for (int n = graph.size() - 1; n >= 0; --n) {
    if (needed[n] == 0) continue;
    const Node& node = graph.node(n);
    const int count = arity(node.op);
    if (count > 0) needed[node.a] = 1;
    if (count > 1) needed[node.b] = 1;
    if (count > 2) needed[node.c] = 1;
  }
  std::vector<std::uint16_t> place(needed.size(), 0);
  for (int n = 0; n < graph.size(); ++n) {
    if (needed[n] == 0) continue;
    const Node& node = graph.node(n);
    if (node.op == Op::leaf) {
      place[n] = static_cast<std::uint16_t>(node.a);
      continue;
    }
    if (registers_ >= kMaxRegisters)
      throw InputError("the formulas together need more than " + std::to_string(kMaxRegisters) + " operations: they are too long");
    const auto at = static_cast<std::uint16_t>(registers_++);
    place[n] = at;
    if (node.op == Op::constant) {
      constants_.push_back({at, node.value});
      continue;
    }
    const int count = arity(node.op);
    const auto register_of = [&](int k, bool used) { return used ? place[k] : place[node.a]; };
    steps_.push_back({node.op, register_of(node.a, true), register_of(node.b, count > 1), register_of(node.c, count > 2), at, n});
  }
  for (int root : roots) places_.push_back(place[root]);
}

std::vector<Symbol> Program::trace(std::vector<Symbol> leaves) const {
  leaves.resize(registers_);
  for (const Constant& c : constants_) leaves[c.at] = c.value;
  for (const Step& s : steps_) leaves[s.to] = Symbol::apply(s.op, leaves[s.a], leaves[s.b], leaves[s.c]);
  std::vector<Symbol> roots;
  for (const int at : places_) roots.push_back(leaves[at]);
  return roots;
}

const Program::Step* Program::culprit(std::size_t root, const double* registers) const {
  int at = places_[root];
  const Step* found = nullptr;
  while (!std::isfinite(registers[at])) {
    const Step* step = nullptr;
    for (const Step& s : steps_) {
      if (s.to == at) step = &s;
    }
    if (step == nullptr) return found;  // a leaf is not finite
    found = step;
    const bool chooses = step->op == Op::select;
    const int first = chooses ? (registers[step->a] != 0.0 ? step->b : step->c) : step->a;
    const int second = chooses ? first : step->b;
    if (std::isfinite(registers[first]) && std::isfinite(registers[second])) return found;
    at = std::isfinite(registers[first]) ? second : first;
  }
  return found;
}

}  // namespace misfit::formula
