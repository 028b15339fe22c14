#include <vector>

#include "misfit/core/lists.h"
#include "misfit/formula/graph.h"

namespace misfit::formula {
namespace {

/// One reverse sweep: adjoints are nodes of the same graph.
class Sweep {
 public:
  Sweep(Graph& graph, int out, bool steepest) : g_(graph), steepest_(steepest), adjoint_(out + 1, -1), masked_(adjoint_.size(), 0) {
    adjoint_.back() = g_.constant(1.0);
  }

  void run() {
    for (int n = int_size(adjoint_) - 1; n >= 0; --n) {
      const int seed = adjoint(n);
      if (seed < 0 || g_.is(seed, 0.0)) continue;
      seed_ = seed;
      mask_ = masked_[n];
      const Node at = g_.node(n);
      if (arity(at.op) == 1) {
        unary(n, at);
      } else if (arity(at.op) > 1) {
        binary(n, at);
      }
    }
  }
  int adjoint(int n) const { return n < int_size(adjoint_) ? adjoint_[n] : -1; }

 private:
  void push(int to, int value) {
    int& sum = adjoint_[to];
    sum = sum < 0 ? value : g_.add(sum, value);
    masked_[to] = static_cast<char>(masked_[to] | mask_);
  }
  /// seed · local; a branch that is not taken must not bring in what is not finite there.
  int times(int local) { return mask_ != 0 ? g_.make(Op::gate, seed_, local) : g_.mul(seed_, local); }
  int over(int local) { return mask_ != 0 ? g_.make(Op::ratio, seed_, local) : g_.div(seed_, local); }
  int square(int a) { return g_.mul(a, a); }
  int one() { return g_.constant(1.0); }
  void choose(int condition, int then, int otherwise) {
    const int zero = g_.constant(0.0);
    mask_ = 1;
    push(then, g_.make(Op::select, condition, seed_, zero));
    push(otherwise, g_.make(Op::select, condition, zero, seed_));
  }

  void unary(int n, const Node& at) {
    const int a = at.a;
    switch (at.op) {
      case Op::neg:
        return push(a, g_.neg(seed_));
      case Op::sqrt:
        return push(a, g_.make(Op::ratio, g_.mul(g_.constant(0.5), seed_), n));
      case Op::exp:
        return push(a, times(n));
      case Op::log:
        return push(a, over(a));
      case Op::sin:
        return push(a, times(g_.make(Op::cos, a)));
      case Op::cos:
        return push(a, g_.neg(times(g_.make(Op::sin, a))));
      case Op::tan:
        return push(a, times(g_.add(one(), square(n))));
      case Op::asin:
        return push(a, g_.make(Op::ratio, seed_, g_.make(Op::sqrt, g_.sub(one(), square(a)))));
      case Op::acos:
        return push(a, g_.neg(g_.make(Op::ratio, seed_, g_.make(Op::sqrt, g_.sub(one(), square(a))))));
      case Op::atan:
        return push(a, over(g_.add(one(), square(a))));
      case Op::sinh:
        return push(a, times(g_.make(Op::cosh, a)));
      case Op::cosh:
        return push(a, times(g_.make(Op::sinh, a)));
      case Op::tanh:
        return push(a, steepest_ ? seed_ : times(g_.sub(one(), square(n))));
      case Op::abs:
        return push(a, times(g_.make(Op::sign, a)));
      default:
        return;  // sign, negate: flat
    }
  }

  void binary(int n, const Node& at) {
    const int a = at.a, b = at.b;
    switch (at.op) {
      case Op::add:
        return push(a, seed_), push(b, seed_);
      case Op::sub:
        return push(a, seed_), push(b, g_.neg(seed_));
      case Op::mul:
        return push(a, times(b)), push(b, times(a));
      case Op::div: {
        const int w = over(b);
        push(a, w);
        seed_ = w;
        return push(b, g_.neg(times(n)));
      }
      case Op::atan2:
        return round(a, b, g_.add(square(a), square(b)), true);
      case Op::hypot:
        return round(a, b, n, false);
      case Op::min:
        return choose(g_.make(Op::less_equal, a, b), a, b);
      case Op::max:
        return choose(g_.make(Op::less_equal, b, a), a, b);
      case Op::select:
        return choose(at.a, at.b, at.c);
      case Op::pow:
        return power(n, a, b);
      default:
        return;  // comparisons are flat; gate and ratio stand in derivatives alone
    }
  }

  /// hypot: a/n, b/n; atan2: b/r², −a/r².
  void round(int a, int b, int under, bool angle) {
    const int first = g_.make(Op::ratio, times(angle ? b : a), under), second = g_.make(Op::ratio, times(angle ? a : b), under);
    push(a, first);
    push(b, angle ? g_.neg(second) : second);
  }

  void power(int n, int a, int b) {
    const bool regular = g_.is_constant(b) && g_.node(b).value >= 1.0;
    const int by_b = g_.mul(seed_, b);
    const int slope = regular ? g_.pow(a, g_.sub(b, one())) : g_.make(Op::ratio, n, a);
    push(a, mask_ != 0 ? g_.make(Op::gate, by_b, slope) : g_.mul(by_b, slope));
    if (g_.is_constant(b)) return;
    const int positive = g_.make(Op::less, g_.constant(0.0), a);
    push(b, g_.make(Op::gate, g_.make(Op::select, positive, seed_, g_.constant(0.0)), g_.mul(n, g_.make(Op::log, a))));
  }

  Graph& g_;
  bool steepest_;
  std::vector<int> adjoint_;
  std::vector<char> masked_;
  int seed_ = 0;
  char mask_ = 0;
};

}  // namespace

std::vector<int> Graph::derivatives(int out, const std::vector<int>& leaves, bool steepest) {
  const int origin = origin_;
  origin_ = -1;
  Sweep sweep(*this, out, steepest);
  sweep.run();
  std::vector<int> by;
  for (int leaf_node : leaves) {
    const int found = sweep.adjoint(leaf_node);
    by.push_back(found < 0 ? constant(0.0) : found);
  }
  origin_ = origin;
  return by;
}

}  // namespace misfit::formula
