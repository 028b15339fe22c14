#pragma once

#include <cstdint>
#include <vector>

#include "misfit/formula/symbol.h"

namespace misfit::formula {

inline constexpr int kMaxRegisters = 3000;  ///< of one program: leaves, constants and one per operation

/// A part of a graph as a flat list of operations on registers: leaves first, then constants, then results in order.
class Program {
 public:
  Program() = default;
  /// What `roots` (nodes) need. `leaves`: numbers 0 … leaves−1 are registers of the same number. InputError if it is too long.
  Program(const Graph& graph, const std::vector<int>& roots, int leaves);

  /// The leaves are filled by the caller; nothing is allocated.
  void run(double* registers) const {
    for (const Constant& c : constants_) registers[c.at] = c.value;
    for (const Step& s : steps_) registers[s.to] = apply(s.op, registers[s.a], registers[s.b], registers[s.c]);
  }
  /// The same over symbols, inside of trace(): its roots.
  [[nodiscard]] std::vector<Symbol> trace(std::vector<Symbol> leaves) const;
  [[nodiscard]] int place(std::size_t root) const { return places_[root]; }  ///< register of a root
  [[nodiscard]] int registers() const { return registers_; }

  struct Step {
    Op op;
    std::uint16_t a, b, c, to;
    int node;  ///< of the graph
  };
  [[nodiscard]] const std::vector<Step>& steps() const { return steps_; }
  /// The step that made `root` not finite from finite numbers, after run(); nullptr if it is finite. `root` counts as in the constructor.
  [[nodiscard]] const Step* culprit(std::size_t root, const double* registers) const;

 private:
  struct Constant {
    std::uint16_t at;
    double value;
  };
  std::vector<Step> steps_;
  std::vector<Constant> constants_;
  std::vector<int> places_;
  int registers_ = 0;
};

}  // namespace misfit::formula
