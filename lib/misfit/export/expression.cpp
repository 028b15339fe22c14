#include "misfit/export/expression.h"

#include <fmt/format.h>

#include <cmath>
#include <set>

namespace misfit {
namespace {

using formula::Node;
using formula::Op;

const char* function_name(Op op) {
  switch (op) {
    case Op::sqrt:
      return "sqrt";
    case Op::exp:
      return "exp";
    case Op::log:
      return "log";
    case Op::sin:
      return "sin";
    case Op::cos:
      return "cos";
    case Op::tan:
      return "tan";
    case Op::asin:
      return "asin";
    case Op::acos:
      return "acos";
    case Op::atan:
      return "atan";
    case Op::atan2:
      return "atan2";
    case Op::sinh:
      return "sinh";
    case Op::cosh:
      return "cosh";
    case Op::tanh:
      return "tanh";
    case Op::abs:
      return "fabs";
    case Op::hypot:
      return "hypot";
    case Op::pow:
      return "pow";
    default:
      return nullptr;
  }
}

class Writer {
 public:
  Writer(const ModelFormulas& formulas, const LeafNames& names, const Language& language)
      : formulas_(formulas), graph_(formulas.graph), names_(names), language_(language), uses_(graph_.size(), 0), text_(graph_.size()) {}

  std::string run(const std::vector<int>& roots, const std::vector<std::string>& targets) {
    for (const int root : roots) count(root);
    for (std::size_t i = 0; i < roots.size(); ++i) {
      const std::string value = text(roots[i]);
      out_ += fmt::format("  {} = {}{}\n", targets[i], value, language_.end);
    }
    return out_;
  }

 private:
  /// Nodes that an operation, or the value of a curve, is computed from.
  [[nodiscard]] std::vector<int> arguments(int node) const {
    const Node& at = graph_.node(node);
    if (at.op == Op::leaf && at.a >= formulas_.first_curve()) return {formulas_.curve_uses[at.a - formulas_.first_curve()].argument};
    std::vector<int> all = {at.a, at.b, at.c};
    all.resize(formula::arity(at.op));
    return all;
  }
  void count(int node) {
    if (uses_[node]++ > 0) return;
    for (const int argument : arguments(node)) {
      count(argument);
      if (repeats(graph_.node(node).op)) ++uses_[argument];
    }
  }
  /// Operations whose text names an argument twice.
  static bool repeats(Op op) { return op == Op::sign || op == Op::min || op == Op::max || op == Op::gate || op == Op::ratio; }

  const std::string& text(int node) {
    std::string& known = text_[node];
    if (!known.empty()) return known;
    std::vector<std::string> parts;
    for (const int argument : arguments(node)) parts.push_back(is_condition_of(argument, node) ? condition_text(argument) : text(argument));
    std::string value = operation(node, parts);
    constexpr std::size_t longest = 100;
    if (!parts.empty() && (uses_[node] > 1 || value.size() > longest)) {
      const std::string name = fmt::format("v{}", ++values_);
      out_ += fmt::format("  {}{} = {}{}\n", language_.declare, name, value, language_.end);
      value = name;
    }
    return known = value;
  }

  /// What a choice depends on stands in it as a condition, other truths as 1 or 0.
  [[nodiscard]] bool is_condition_of(int argument, int node) const {
    const Node& at = graph_.node(node);
    return at.op == Op::select && at.a == argument && argument != at.b && argument != at.c;
  }
  std::string condition_text(int node) {
    const Op op = graph_.node(node).op;
    const bool compares = op == Op::less || op == Op::less_equal || op == Op::equal;
    if (!compares || uses_[node] > 1) return text(node) + " != 0.0";
    std::vector<std::string> parts;
    for (const int argument : arguments(node)) parts.push_back(text(argument));
    return condition(op, parts);
  }

  [[nodiscard]] std::string operation(int node, const std::vector<std::string>& p) const {
    const Node& at = graph_.node(node);
    if (at.op == Op::constant) return at.value < 0.0 ? "(" + number_text(at.value) + ")" : number_text(at.value);
    if (at.op == Op::leaf) return leaf(at.a, p);
    if (const char* name = function_name(at.op)) return std::string(language_.function_prefix) + name + "(" + joined(p) + ")";
    if (at.op == Op::div && graph_.is_constant(at.b) && !graph_.is(at.b, 0.0)) return "(" + p[0] + " / " + p[1] + ")";
    return arithmetic(at.op, p);
  }
  [[nodiscard]] std::string leaf(int number, const std::vector<std::string>& p) const {
    if (p.empty()) return names_.leaves[number];
    return names_.curves[formulas_.curve_uses[number - formulas_.first_curve()].curve] + "(" + p.front() + ")";
  }
  static std::string joined(const std::vector<std::string>& p) { return p.size() > 1 ? p[0] + ", " + p[1] : p[0]; }

  [[nodiscard]] std::string arithmetic(Op op, const std::vector<std::string>& p) const {
    const auto choose = language_.choose;
    switch (op) {
      case Op::add:
        return "(" + p[0] + " + " + p[1] + ")";
      case Op::sub:
        return "(" + p[0] + " - " + p[1] + ")";
      case Op::mul:
        return "(" + p[0] + " * " + p[1] + ")";
      case Op::div:
        return language_.divide(p[0], p[1]);
      case Op::neg:
        return "(-" + p[0] + ")";
      case Op::sign:
        return choose(p[0] + " > 0.0", "1.0", choose(p[0] + " < 0.0", "-1.0", p[0]));
      case Op::min:
        return choose(p[1] + " < " + p[0], p[1], p[0]);
      case Op::max:
        return choose(p[1] + " > " + p[0], p[1], p[0]);
      case Op::select:
        return choose(p[0], p[1], p[2]);
      case Op::gate:
        return choose(p[0] + " == 0.0", "0.0", "(" + p[0] + " * " + p[1] + ")");
      case Op::ratio:
        return choose(p[0] + " == 0.0" + language_.either + p[1] + " == 0.0", "0.0", language_.divide(p[0], p[1]));
      default:
        return choose(condition(op, p), "1.0", "0.0");
    }
  }
  [[nodiscard]] std::string condition(Op op, const std::vector<std::string>& p) const {
    switch (op) {
      case Op::less:
        return p[0] + " < " + p[1];
      case Op::less_equal:
        return p[0] + " <= " + p[1];
      case Op::equal:
        return p[0] + " == " + p[1];
      case Op::both:
        return p[0] + " != 0.0" + language_.both + p[1] + " != 0.0";
      case Op::either:
        return p[0] + " != 0.0" + language_.either + p[1] + " != 0.0";
      default:
        return p[0] + " == 0.0";
    }
  }

  const ModelFormulas& formulas_;
  const formula::Graph& graph_;
  const LeafNames& names_;
  const Language& language_;
  std::vector<int> uses_;
  std::vector<std::string> text_;
  std::string out_;
  int values_ = 0;
};

}  // namespace

std::string statements(const ModelFormulas& formulas, const std::vector<int>& roots, const std::vector<std::string>& targets,
                       const LeafNames& names, const Language& language) {
  return Writer(formulas, names, language).run(roots, targets);
}

std::string number_text(double value) {
  std::string text = fmt::format("{}", value);  // the shortest that reads back as the same number
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

}  // namespace misfit
