#pragma once

// Inside of declared systems: not for other files.

#include <memory>
#include <string>
#include <vector>

#include "misfit/core/lists.h"
#include "misfit/formula/program.h"
#include "misfit/model/declared_text.h"

namespace misfit::declared {

/// Several formulas and, where wanted, their derivatives as one program, and where its results go.
struct Tape {
  struct Entry {
    int place, from;  ///< index in the block, register
  };
  formula::Program program;
  std::vector<Entry> value, by_x, by_P, by_F, by_k;
};

/// Numbers of the leaves: states, inputs, time, constants, quantity ports, dynamic ports.
struct Leaves {
  int nx = 0, nu = 0, nk = 0, np = 0, nf = 0;
  [[nodiscard]] int x(int i) const { return i; }
  [[nodiscard]] int u(int i) const { return nx + i; }
  [[nodiscard]] int t() const { return nx + nu; }
  [[nodiscard]] int k(int i) const { return nx + nu + 1 + i; }
  [[nodiscard]] int P(int i) const { return k(nk) + i; }
  [[nodiscard]] int F(int i) const { return P(np) + i; }
  [[nodiscard]] int count() const { return F(nf); }
};

/// A declared system ready to run; shared by all that are made of one file, and never changed.
struct Compiled {
  SystemSpec spec;
  Leaves leaves;
  formula::Graph graph;
  std::vector<formula::Syntax> texts;  ///< nodes of the graph have origins in them …
  std::vector<int> first_origin;       ///< … from this number on
  std::vector<int> rate_nodes;
  std::vector<std::pair<int, int>> readable;  ///< output → the one state on which it depends, along a straight line
  // Values alone; with derivatives by x (and F); by constants too; by quantity ports as well.
  Tape rates, rates_x, rates_k, rates_all, rates_steep;
  Tape quantities, quantities_x, quantities_k, quantities_all;
  Tape outputs, outputs_x, outputs_k, outputs_all;
};

/// Default roles and force ports, and what [roles] says instead; the first `own_ports` dynamic ports are those of [ports].
void set_roles(Declaration& declaration, int own_ports);

/// All programs of `c`, whose graph is complete.
void make_tapes(Compiled& c, const std::vector<int>& quantities, const std::vector<int>& outputs, const Source& where);

/// Builds graph and programs. InputError where a formula is wrong.
[[nodiscard]] std::shared_ptr<const Compiled> compile(Declaration declaration);

/// The system of such a file.
[[nodiscard]] std::unique_ptr<System> make_system(std::shared_ptr<const Compiled> compiled);

}  // namespace misfit::declared
