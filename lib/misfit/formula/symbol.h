#pragma once

#include <functional>
#include <vector>

#include "misfit/formula/graph.h"

// A formula that is compiled C++, read back as a graph: it is called with symbols in place of numbers.

namespace misfit::formula {

/// A number that knows how it was computed: a constant, or a node of the graph of the trace under way (trace()). Comparisons ask the trace,
/// which calls the formula again for the other answer.
class Symbol {
 public:
  Symbol() = default;
  Symbol(double value) : value_(value) {}  // NOLINT(google-explicit-constructor): numbers stand in formulas
  /// A node of the graph of the trace under way.
  [[nodiscard]] static Symbol of_node(int node);
  /// Its node there.
  [[nodiscard]] int node() const;
  /// Any operation; it reads as many as its arity says.
  [[nodiscard]] static Symbol apply(Op op, const Symbol& a, const Symbol& b = 0.0, const Symbol& c = 0.0);

  Symbol& operator+=(const Symbol& b) { return *this = *this + b; }
  Symbol& operator-=(const Symbol& b) { return *this = *this - b; }
  Symbol& operator*=(const Symbol& b) { return *this = *this * b; }
  Symbol& operator/=(const Symbol& b) { return *this = *this / b; }
  Symbol operator-() const { return apply(Op::neg, *this); }

  friend Symbol operator+(const Symbol& a, const Symbol& b) { return apply(Op::add, a, b); }
  friend Symbol operator-(const Symbol& a, const Symbol& b) { return apply(Op::sub, a, b); }
  friend Symbol operator*(const Symbol& a, const Symbol& b) { return apply(Op::mul, a, b); }
  friend Symbol operator/(const Symbol& a, const Symbol& b) { return apply(Op::div, a, b); }
  friend bool operator<(const Symbol& a, const Symbol& b) { return answer(Op::less, a, b); }
  friend bool operator<=(const Symbol& a, const Symbol& b) { return answer(Op::less_equal, a, b); }
  friend bool operator>(const Symbol& a, const Symbol& b) { return answer(Op::less, b, a); }
  friend bool operator>=(const Symbol& a, const Symbol& b) { return answer(Op::less_equal, b, a); }
  friend bool operator==(const Symbol& a, const Symbol& b) { return answer(Op::equal, a, b); }

  friend Symbol sqrt(const Symbol& a) { return apply(Op::sqrt, a); }
  friend Symbol exp(const Symbol& a) { return apply(Op::exp, a); }
  friend Symbol log(const Symbol& a) { return apply(Op::log, a); }
  friend Symbol sin(const Symbol& a) { return apply(Op::sin, a); }
  friend Symbol cos(const Symbol& a) { return apply(Op::cos, a); }
  friend Symbol tan(const Symbol& a) { return apply(Op::tan, a); }
  friend Symbol asin(const Symbol& a) { return apply(Op::asin, a); }
  friend Symbol acos(const Symbol& a) { return apply(Op::acos, a); }
  friend Symbol atan(const Symbol& a) { return apply(Op::atan, a); }
  friend Symbol sinh(const Symbol& a) { return apply(Op::sinh, a); }
  friend Symbol cosh(const Symbol& a) { return apply(Op::cosh, a); }
  friend Symbol tanh(const Symbol& a) { return apply(Op::tanh, a); }
  friend Symbol abs(const Symbol& a) { return apply(Op::abs, a); }
  friend Symbol atan2(const Symbol& a, const Symbol& b) { return apply(Op::atan2, a, b); }
  friend Symbol hypot(const Symbol& a, const Symbol& b) { return apply(Op::hypot, a, b); }
  friend Symbol pow(const Symbol& a, const Symbol& b) { return apply(Op::pow, a, b); }

  /// Of a Jet its number (math/scalar.h): here the symbol itself, which can be compared.
  friend const Symbol& value_of(const Symbol& a) { return a; }

 private:
  static bool answer(Op op, const Symbol& a, const Symbol& b);

  double value_ = 0.0;
  int node_ = -1;  ///< -1: a constant
};

/// Nodes of `graph` that compute the `count` results of `formula`, which reads Symbol::of_node(…). It is called once for every combination
/// of answers to its comparisons, and the results are joined by selection: it must do nothing else than compute. std::length_error where
/// more than 4096 combinations would be needed. One trace at a time on each thread.
[[nodiscard]] std::vector<int> trace(Graph& graph, std::size_t count, const std::function<void(Symbol* out)>& formula);

}  // namespace misfit::formula
