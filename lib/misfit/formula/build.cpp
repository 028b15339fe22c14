#include "misfit/formula/build.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <utility>

#include "misfit/core/lists.h"
#include "misfit/core/shown.h"

namespace misfit::formula {
namespace {

const std::map<std::string, Op>& plain_functions() {
  static const std::map<std::string, Op> all = {{"exp", Op::exp},   {"log", Op::log},   {"sin", Op::sin},   {"cos", Op::cos},
                                                {"tan", Op::tan},   {"asin", Op::asin}, {"acos", Op::acos}, {"atan", Op::atan},
                                                {"sinh", Op::sinh}, {"cosh", Op::cosh}, {"tanh", Op::tanh}};
  return all;
}

class Builder {
 public:
  Builder(const Syntax& syntax, const Names& names, Graph& graph, int origin)
      : syntax_(syntax), names_(names), g_(graph), origin_(origin) {}

  Meaning run() {
    for (int i = 0; i < int_size(syntax_.nodes); ++i) {
      at_ = &syntax_.nodes[i];
      g_.set_origin(origin_ + i);
      made_.push_back(one());
    }
    g_.set_origin(-1);
    return made_.back();
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { syntax_.source.fail(at_->begin, at_->end, message); }
  const Meaning& arg(std::size_t k) const { return made_[at_->arguments[k]]; }
  std::string shown(std::size_t k) const {
    const Expression& e = syntax_.nodes[at_->arguments[k]];
    constexpr std::size_t longest = 40;
    std::string part = syntax_.source.text.substr(e.begin, e.end - e.begin);
    if (part.size() > longest) part = part.substr(0, longest - 3) + "...";
    const Measure& m = made_[at_->arguments[k]].measure;
    return "'" + part + "' " + (m.truth ? "(a condition)" : "[" + m.text() + "]");
  }

  /// " (R [V], i [A])": what the names within these arguments measure; empty where they are names themselves.
  std::string units_within(const std::vector<std::size_t>& arguments) const {
    std::vector<std::string> out;
    for (const std::size_t k : arguments) {
      const Expression& whole = syntax_.nodes[at_->arguments[k]];
      for (std::size_t node = 0; node < made_.size() && whole.kind != Expression::Kind::name; ++node) {
        const Expression& e = syntax_.nodes[node];
        if (e.kind != Expression::Kind::name || e.begin < whole.begin || e.end > whole.end) continue;
        std::string unit = misfit::shown(e.text) + " [" + made_[node].measure.text() + "]";
        if (std::find(out.begin(), out.end(), unit) == out.end()) out.push_back(std::move(unit));
      }
    }
    return out.empty() ? "" : fmt::format(" ({})", fmt::join(out, ", "));
  }

  Meaning one() {
    if (at_->kind == Expression::Kind::number) {
      Meaning out{g_.constant(at_->value), {}};
      out.measure.any = at_->value == 0.0;
      return out;
    }
    if (at_->kind == Expression::Kind::name) return name();
    for (std::size_t k = 0; k < at_->arguments.size(); ++k) {
      const bool wanted = at_->text == "and" || at_->text == "or" || at_->text == "not" || (at_->text == "if" && k == 0);
      if (arg(k).measure.truth != wanted) {
        fail(wanted ? "a condition as 'x > 0' is expected, not " + shown(k)
                    : shown(k) + " is no number: if(condition, value, other value) makes one of it");
      }
    }
    return at_->kind == Expression::Kind::operation ? operation() : call();
  }

  Meaning name() const {
    if (at_->text == "pi") return {g_.constant(std::numbers::pi), {}};
    if (names_.refusal) {
      if (const std::string why = names_.refusal(at_->text); !why.empty()) fail(why);
    }
    if (auto meaning = names_.find(at_->text)) return *meaning;
    fail("there is no '" + misfit::shown(at_->text) + "' here" + suggest(at_->text, names_.all));
  }

  /// The common unit of arguments first … last.
  Measure alike(std::size_t first, std::size_t last) const {
    Measure common = arg(first).measure;
    std::size_t holder = first;
    for (std::size_t k = first + 1; k <= last; ++k) {
      if (!common.fits(arg(k).measure)) {
        const bool number = g_.is_constant(arg(k).node) || g_.is_constant(arg(holder).node);
        fail(shown(holder) + " and " + shown(k) + " measure different things" +
             (number ? ": a number with a unit needs a name under [parameters]" : units_within({holder, k})));
      }
      if (common.any) {
        common = arg(k).measure;
        holder = k;
      }
    }
    return common;
  }
  void plain(std::size_t k) const {
    if (!arg(k).measure.is_plain()) fail(at_->text + " needs a number or an angle, " + shown(k) + " has a unit");
  }

  Meaning operation() {
    const std::string& op = at_->text;
    if (op == "neg") return {g_.neg(arg(0).node), arg(0).measure};
    if (op == "not") return truth(g_.make(Op::negate, arg(0).node));
    const int a = arg(0).node, b = arg(1).node;
    if (op == "and") return truth(g_.make(Op::both, a, b));
    if (op == "or") return truth(g_.make(Op::either, a, b));
    if (op == "*") return scaled(g_.mul(a, b), 1.0);
    if (op == "/") return scaled(g_.div(a, b), -1.0);
    if (op == "^") return power();
    const Measure common = alike(0, 1);
    if (op == "+") return {g_.add(a, b), common};
    if (op == "-") return {g_.sub(a, b), common};
    if (op == "<") return truth(g_.make(Op::less, a, b));
    if (op == "<=") return truth(g_.make(Op::less_equal, a, b));
    if (op == ">") return truth(g_.make(Op::less, b, a));
    if (op == ">=") return truth(g_.make(Op::less_equal, b, a));
    const int same = g_.make(Op::equal, a, b);
    return truth(op == "==" ? same : g_.make(Op::negate, same));
  }
  static Meaning truth(int node) {
    Meaning out{node, {}};
    out.measure.truth = true;
    return out;
  }
  Meaning scaled(int node, double power) const {
    Measure m = product(arg(0).measure, 1.0, arg(1).measure, power);
    m.any = arg(0).measure.any || (power > 0.0 && arg(1).measure.any);
    return {node, m};
  }

  Meaning power() {
    if (!arg(1).measure.is_plain()) fail("the exponent " + shown(1) + " must have no unit");
    const int node = g_.pow(arg(0).node, arg(1).node);
    if (g_.is_constant(arg(1).node)) return {node, product(arg(0).measure, g_.node(arg(1).node).value, {}, 1.0)};
    if (!arg(0).measure.is_plain()) fail(shown(0) + " has a unit: then the exponent must be a number, not " + shown(1));
    return {node, {}};
  }

  Meaning call() {
    const std::string& f = at_->text;
    const auto simple = plain_functions().find(f);
    if (simple != plain_functions().end()) {
      plain(0);
      return {g_.make(simple->second, arg(0).node), {}};
    }
    const int a = arg(0).node;
    if (f == "sqrt") return {g_.make(Op::sqrt, a), product(arg(0).measure, 0.5, {}, 1.0)};
    if (f == "pow") return power();
    if (f == "log10") {
      plain(0);
      return {g_.mul(g_.make(Op::log, a), g_.constant(1.0 / std::numbers::ln10)), {}};
    }
    if (f == "if") return {g_.make(Op::select, a, arg(1).node, arg(2).node), alike(1, 2)};
    const Measure common = alike(0, at_->arguments.size() - 1);
    if (f == "abs") return {rounded_abs(a, width(1)), common};
    if (f == "sign") return {width(1) < 0 ? g_.make(Op::sign, a) : g_.make(Op::tanh, g_.div(a, width(1))), {}};
    if (f == "smooth_step") return {g_.mul(g_.constant(0.5), g_.add(g_.constant(1.0), g_.make(Op::tanh, g_.div(a, arg(1).node)))), {}};
    const int b = arg(1).node;
    if (f == "atan2") return {g_.make(Op::atan2, a, b), {}};
    if (f == "hypot") return {g_.make(Op::hypot, a, b), common};
    if (f == "min") return {extreme(a, b, width(2), false), common};
    if (f == "max") return {extreme(a, b, width(2), true), common};
    return {extreme(extreme(a, b, width(3), true), arg(2).node, width(3), false), common};  // saturate
  }
  /// Node of an optional argument, −1 if it is absent.
  int width(std::size_t k) const { return k < at_->arguments.size() ? arg(k).node : -1; }
  int rounded_abs(int a, int w) { return w < 0 ? g_.make(Op::abs, a) : g_.make(Op::sqrt, g_.add(g_.mul(a, a), g_.mul(w, w))); }
  int extreme(int a, int b, int w, bool largest) {
    if (w < 0) return g_.make(largest ? Op::max : Op::min, a, b);
    const int spread = rounded_abs(g_.sub(a, b), w), sum = g_.add(a, b);
    return g_.mul(g_.constant(0.5), largest ? g_.add(sum, spread) : g_.sub(sum, spread));
  }

  const Syntax& syntax_;
  const Names& names_;
  Graph& g_;
  int origin_;
  const Expression* at_ = nullptr;
  std::vector<Meaning> made_;
};

}  // namespace

Meaning build(const Syntax& syntax, const Names& names, Graph& graph, int origin) { return Builder(syntax, names, graph, origin).run(); }

void check_unit(const Syntax& syntax, const Meaning& found, const Measure& wanted, const std::string& of) {
  const int end = int_size(syntax.source.text);
  if (found.measure.truth) syntax.source.fail(0, end, "a number is needed, this is a condition");
  if (!found.measure.fits(wanted))
    syntax.source.fail(0, end, "it has [" + found.measure.text() + "], " + of + " needs [" + wanted.text() + "]");
}

}  // namespace misfit::formula
