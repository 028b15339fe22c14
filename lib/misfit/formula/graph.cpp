#include "misfit/formula/graph.h"

#include <algorithm>
#include <utility>

namespace misfit::formula {

int arity(Op op) {
  switch (op) {
    case Op::constant:
    case Op::leaf:
      return 0;
    case Op::neg:
    case Op::sqrt:
    case Op::exp:
    case Op::log:
    case Op::sin:
    case Op::cos:
    case Op::tan:
    case Op::asin:
    case Op::acos:
    case Op::atan:
    case Op::sinh:
    case Op::cosh:
    case Op::tanh:
    case Op::abs:
    case Op::sign:
    case Op::negate:
      return 1;
    case Op::select:
      return 3;
    default:
      return 2;
  }
}

int Graph::constant(double value) {
  if (value == 0.0) value = 0.0;  // one zero: −0 is the same node
  if (std::isnan(value)) {        // cannot be looked up
    nodes_.push_back({Op::constant, 0, 0, 0, value, origin_});
    return size() - 1;
  }
  const auto [found, fresh] = known_.try_emplace({static_cast<int>(Op::constant), 0, 0, 0, value}, size());
  if (fresh) nodes_.push_back({Op::constant, 0, 0, 0, value, origin_});
  return found->second;
}

int Graph::leaf(int number) {
  const auto [found, fresh] = known_.try_emplace({static_cast<int>(Op::leaf), number, 0, 0, 0.0}, size());
  if (fresh) nodes_.push_back({Op::leaf, number, 0, 0, 0.0, origin_});
  return found->second;
}

/// A simpler node that is the same, or −1.
int Graph::fold(Op op, int a, int b, int c) {
  switch (op) {
    case Op::add:
      if (is(a, 0.0)) return b;
      if (is(b, 0.0)) return a;
      if (node(b).op == Op::neg) return sub(a, node(b).a);
      return node(a).op == Op::neg ? sub(b, node(a).a) : -1;
    case Op::sub:
      if (is(b, 0.0)) return a;
      if (a == b) return constant(0.0);
      if (is(a, 0.0)) return neg(b);
      return node(b).op == Op::neg ? add(a, node(b).a) : -1;
    case Op::mul:
    case Op::gate:
      if (is(a, 0.0) || is(b, 0.0)) return constant(0.0);
      if (is(a, 1.0)) return b;
      if (is(b, 1.0)) return a;
      if (is(a, -1.0)) return neg(b);
      return is(b, -1.0) ? neg(a) : -1;
    case Op::div:
    case Op::ratio:
      if (is(a, 0.0)) return a;
      return is(b, 1.0) ? a : -1;
    case Op::neg:
      return node(a).op == Op::neg ? node(a).a : -1;
    case Op::select:
      if (is_constant(a)) return node(a).value != 0.0 ? b : c;
      return b == c ? b : -1;
    case Op::min:
    case Op::max:
      return a == b ? a : -1;
    default:
      return -1;
  }
}

int Graph::make(Op op, int a, int b, int c) {
  const int count = arity(op);
  if (count < 3) c = 0;
  if (count < 2) b = 0;
  const bool constants = is_constant(a) && (count < 2 || is_constant(b)) && (count < 3 || is_constant(c));
  if (constants) return constant(apply(op, node(a).value, node(b).value, node(c).value));
  if (const int same = fold(op, a, b, c); same >= 0) return same;
  const bool commutes = op == Op::add || op == Op::mul || op == Op::both || op == Op::either || op == Op::equal || op == Op::hypot;
  if (commutes && b < a) std::swap(a, b);
  const auto [found, fresh] = known_.try_emplace({static_cast<int>(op), a, b, c, 0.0}, size());
  if (fresh) nodes_.push_back({op, a, b, c, 0.0, origin_});
  return found->second;
}

int Graph::whole_power(int a, int power) {
  if (power == 1) return a;
  const int half = whole_power(a, power / 2);
  const int square = mul(half, half);
  return power % 2 == 0 ? square : mul(square, a);
}

int Graph::pow(int a, int b) {
  constexpr double largest_whole_power = 16.0;
  if (!is_constant(b) || is_constant(a)) return make(Op::pow, a, b);
  const double power = node(b).value;
  if (power == 0.0) return constant(1.0);
  if (power == 0.5) return make(Op::sqrt, a);
  if (power != std::round(power) || std::abs(power) > largest_whole_power) return make(Op::pow, a, b);
  const int product = whole_power(a, static_cast<int>(std::abs(power)));
  return power > 0.0 ? product : div(constant(1.0), product);
}

std::vector<int> Graph::leaves_of(int i) const {
  std::vector<char> reached(i + 1, 0);
  reached.back() = 1;
  std::vector<int> out;
  for (int n = i; n >= 0; --n) {
    if (reached[n] == 0) continue;
    const Node& at = node(n);
    if (at.op == Op::leaf) out.push_back(at.a);
    const int count = arity(at.op);
    if (count > 0) reached[at.a] = 1;
    if (count > 1) reached[at.b] = 1;
    if (count > 2) reached[at.c] = 1;
  }
  return out;
}

int Graph::substitute(int i, int number, int by) {
  std::vector<int> image(i + 1);
  for (int n = 0; n <= i; ++n) {
    const Node at = node(n);  // a copy: nodes are added
    const auto of = [&](int k) { return image[k]; };
    int& to = image[n];
    if (at.op == Op::constant) {
      to = n;
    } else if (at.op == Op::leaf) {
      to = at.a == number ? by : n;
    } else {
      const int count = arity(at.op);
      to = make(at.op, of(at.a), count > 1 ? of(at.b) : 0, count > 2 ? of(at.c) : 0);
    }
  }
  return image.back();
}

}  // namespace misfit::formula
