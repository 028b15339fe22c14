#include "misfit/formula/symbol.h"

#include <stdexcept>
#include <utility>

namespace misfit::formula {
namespace {

/// A call of a formula: answers to its first comparisons are given, further ones are taken to hold.
struct Call {
  Graph& graph;
  std::vector<bool> answers;
  std::vector<int> conditions = {};  ///< nodes of the comparisons met
};

thread_local Call* call = nullptr;

class Tracer {
 public:
  Tracer(Graph& graph, std::size_t count, const std::function<void(Symbol* out)>& formula)
      : graph_(graph), count_(count), formula_(formula) {}

  std::vector<int> run(const std::vector<bool>& answers) {
    constexpr int most = 4096;
    if (++calls_ > most) throw std::length_error("a formula with too many comparisons");
    Call now{graph_, answers};
    call = &now;
    std::vector<Symbol> out(count_);
    formula_(out.data());
    std::vector<int> nodes;
    for (const Symbol& symbol : out) nodes.push_back(symbol.node());
    call = nullptr;
    for (std::size_t i = now.conditions.size(); i-- > answers.size();) {
      std::vector<bool> other(now.answers.begin(), now.answers.begin() + i);
      other.push_back(false);
      const std::vector<int> otherwise = run(other);
      for (std::size_t k = 0; k < count_; ++k) nodes[k] = graph_.make(Op::select, now.conditions[i], nodes[k], otherwise[k]);
    }
    return nodes;
  }

 private:
  Graph& graph_;
  std::size_t count_;
  const std::function<void(Symbol* out)>& formula_;
  int calls_ = 0;
};

}  // namespace

Symbol Symbol::of_node(int node) {
  Symbol out;
  out.node_ = node;
  return out;
}

int Symbol::node() const { return node_ >= 0 ? node_ : call->graph.constant(value_); }

Symbol Symbol::apply(Op op, const Symbol& a, const Symbol& b, const Symbol& c) {
  const int count = arity(op);
  if (a.node_ < 0 && (count < 2 || b.node_ < 0) && (count < 3 || c.node_ < 0)) return formula::apply(op, a.value_, b.value_, c.value_);
  const int first = a.node();
  const int node = call->graph.make(op, first, count > 1 ? b.node() : first, count > 2 ? c.node() : first);
  const Node& made = call->graph.node(node);
  return made.op == Op::constant ? Symbol(made.value) : of_node(node);
}

/// The same comparison in one call has one answer.
bool Symbol::answer(Op op, const Symbol& a, const Symbol& b) {
  if (a.node_ < 0 && b.node_ < 0) return holds(op, a.value_, b.value_);
  const int condition = call->graph.make(op, a.node(), b.node());
  const Node& made = call->graph.node(condition);
  if (made.op == Op::constant) return made.value != 0.0;
  for (std::size_t i = 0; i < call->conditions.size(); ++i) {
    if (call->conditions[i] == condition) return call->answers[i];
  }
  call->conditions.push_back(condition);
  if (call->answers.size() < call->conditions.size()) call->answers.push_back(true);
  return call->answers[call->conditions.size() - 1];
}

std::vector<int> trace(Graph& graph, std::size_t count, const std::function<void(Symbol* out)>& formula) {
  return Tracer(graph, count, formula).run({});
}

}  // namespace misfit::formula
