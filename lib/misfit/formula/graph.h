#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

// Formulas as a graph in which every value is computed once: constants are folded, common parts shared, derivatives are further nodes.

#include "misfit/core/lists.h"

namespace misfit::formula {

enum class Op : std::uint8_t {
  constant,
  leaf,
  add,
  sub,
  mul,
  div,
  neg,
  sqrt,
  exp,
  log,
  sin,
  cos,
  tan,
  asin,
  acos,
  atan,
  atan2,
  sinh,
  cosh,
  tanh,
  abs,
  sign,
  min,
  max,
  hypot,
  pow,
  less,
  less_equal,
  equal,
  both,
  either,
  negate,  ///< truth: 1 or 0
  select,  ///< a != 0 ? b : c
  gate,    ///< a·b, and 0 where a is 0 whatever b is: a branch that is not taken moves nothing
  ratio    ///< a/b, and 0 where a or b is 0
};

/// Functions of one number.
[[nodiscard]] inline double apply_function(Op op, double a) {
  switch (op) {
    case Op::exp:
      return std::exp(a);
    case Op::log:
      return std::log(a);
    case Op::sin:
      return std::sin(a);
    case Op::cos:
      return std::cos(a);
    case Op::tan:
      return std::tan(a);
    case Op::asin:
      return std::asin(a);
    case Op::acos:
      return std::acos(a);
    case Op::atan:
      return std::atan(a);
    case Op::sinh:
      return std::sinh(a);
    case Op::cosh:
      return std::cosh(a);
    case Op::tanh:
      return std::tanh(a);
    default:
      return a;
  }
}

/// Comparisons and what joins them.
[[nodiscard]] inline bool holds(Op op, double a, double b) {
  switch (op) {
    case Op::less:
      return a < b;
    case Op::less_equal:
      return a <= b;
    case Op::equal:
      return a == b;
    case Op::both:
      return a != 0.0 && b != 0.0;
    case Op::either:
      return a != 0.0 || b != 0.0;
    default:
      return a == 0.0;
  }
}

/// What an operation computes; also used to fold constants.
[[nodiscard]] inline double apply(Op op, double a, double b, double c) {
  switch (op) {
    case Op::add:
      return a + b;
    case Op::sub:
      return a - b;
    case Op::mul:
      return a * b;
    case Op::div:
      return a / b;
    case Op::neg:
      return -a;
    case Op::sqrt:
      return std::sqrt(a);
    case Op::abs:
      return std::abs(a);
    case Op::sign:
      return a > 0.0 ? 1.0 : a < 0.0 ? -1.0 : a;
    case Op::min:
      return b < a ? b : a;
    case Op::max:
      return b > a ? b : a;
    case Op::atan2:
      return std::atan2(a, b);
    case Op::hypot:
      return std::hypot(a, b);
    case Op::pow:
      return std::pow(a, b);
    case Op::select:
      return a != 0.0 ? b : c;
    case Op::gate:
      return a == 0.0 ? 0.0 : a * b;
    case Op::ratio:
      return a == 0.0 || b == 0.0 ? 0.0 : a / b;
    case Op::less:
    case Op::less_equal:
    case Op::equal:
    case Op::both:
    case Op::either:
    case Op::negate:
      return holds(op, a, b) ? 1.0 : 0.0;
    default:
      return apply_function(op, a);
  }
}

/// Number of nodes that an operation reads.
[[nodiscard]] int arity(Op op);

struct Node {
  Op op = Op::constant;
  int a = 0, b = 0, c = 0;  ///< nodes before this one; of a leaf, `a` is its number
  double value = 0.0;       ///< of a constant
  int origin = -1;          ///< who wrote it first, see Graph::set_origin
};

class Graph {
 public:
  int constant(double value);
  int leaf(int number);
  int make(Op op, int a, int b = 0, int c = 0);

  int add(int a, int b) { return make(Op::add, a, b); }
  int sub(int a, int b) { return make(Op::sub, a, b); }
  int mul(int a, int b) { return make(Op::mul, a, b); }
  int div(int a, int b) { return make(Op::div, a, b); }
  int neg(int a) { return make(Op::neg, a); }
  /// a^b. Whole powers to 16 become products, halves roots.
  int pow(int a, int b);

  [[nodiscard]] const Node& node(int i) const { return nodes_[i]; }
  [[nodiscard]] int size() const { return int_size(nodes_); }
  [[nodiscard]] bool is(int i, double value) const { return node(i).op == Op::constant && node(i).value == value; }
  [[nodiscard]] bool is_constant(int i) const { return node(i).op == Op::constant; }
  /// Nodes made from now on have this origin.
  void set_origin(int origin) { origin_ = origin; }

  /// Which leaves (numbers) a node depends on.
  [[nodiscard]] std::vector<int> leaves_of(int i) const;
  /// The same formula with leaf `number` replaced by a node.
  int substitute(int i, int number, int by);

  /// ∂out/∂(each of `leaves`, node numbers), as nodes, by a reverse sweep. Kinks: the derivative of the branch taken, at the kink itself
  /// that of the first argument (max, min), of `then` where the condition holds (if), 0 (abs, sign). Where a function has no finite
  /// derivative (sqrt and fractional powers at 0, asin and acos at ±1, hypot and atan2 at the origin) it is taken as 0. `steepest`: tanh at
  /// its steepest everywhere, for the fastest rate.
  std::vector<int> derivatives(int out, const std::vector<int>& leaves, bool steepest = false);

 private:
  int fold(Op op, int a, int b, int c);
  int whole_power(int a, int power);

  std::vector<Node> nodes_;
  std::map<std::tuple<int, int, int, int, double>, int> known_;
  int origin_ = -1;
};

}  // namespace misfit::formula
