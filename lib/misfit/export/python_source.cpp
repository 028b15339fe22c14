#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "misfit/core/lists.h"
#include "misfit/core/shown.h"
#include "misfit/core/unique_name.h"
#include "misfit/export/source.h"

namespace misfit {
namespace {

constexpr Language python_language{.choose = [](const std::string& condition, const std::string& yes,
                                                const std::string& no) { return "(" + yes + " if " + condition + " else " + no + ")"; },
                                   .divide = [](const std::string& a, const std::string& b) { return "_div(" + a + ", " + b + ")"; },
                                   .both = " and ",
                                   .either = " or ",
                                   .function_prefix = "_",
                                   .declare = "",
                                   .end = ""};

/// Python raises where C has inf and nan.
constexpr const char* functions_text = R"(
import math


def _div(a, b):
  if b != 0.0:
    return a / b
  return math.nan if a == 0.0 or a != a else math.copysign(math.inf, a) * math.copysign(1.0, b)


def _function(f, at_overflow=math.inf):
  def call(*numbers):
    try:
      return f(*numbers)
    except OverflowError:
      return at_overflow(*numbers) if callable(at_overflow) else at_overflow
    except ValueError:
      return math.nan
  return call


_sqrt, _exp, _sin, _cos, _tan = (_function(f) for f in (math.sqrt, math.exp, math.sin, math.cos, math.tan))
_asin, _acos, _atan, _atan2, _tanh = (_function(f) for f in (math.asin, math.acos, math.atan, math.atan2, math.tanh))
_cosh, _hypot, _pow, _fabs = _function(math.cosh), _function(math.hypot), _function(math.pow), math.fabs
_sinh = _function(math.sinh, lambda a: math.copysign(math.inf, a))


def _log(a):
  return -math.inf if a == 0.0 else math.log(a) if a > 0.0 else math.nan
)";

constexpr const char* knots_function = R"(

def _cubic_curve(knot, value, slope, parity, at):
  """A cubic between knots with given values and slopes; straight lines outside. parity 1: odd, 2: even, mirrored below 0."""
  if parity != 0 and at < 0.0:
    mirrored = _cubic_curve(knot, value, slope, parity, -at)
    return -mirrored if parity == 1 else mirrored
  if at < knot[0]:
    k, r = knot[0], at / knot[0] if parity else 0.0
    if parity == 1:
      return value[0] * (r * (3.0 - r * r) / 2.0) + slope[0] * (k * r * (r * r - 1.0) / 2.0)
    if parity == 2:
      return value[0] + slope[0] * ((at * at - k * k) / (2.0 * k))
    return value[0] + slope[0] * (at - k)
  if at >= knot[-1]:
    return value[-1] + slope[-1] * (at - knot[-1])
  i = 0
  while i < len(knot) - 2 and at >= knot[i + 1]:
    i += 1
  h = knot[i + 1] - knot[i]
  s = (at - knot[i]) / h
  r = 1.0 - s
  return r * r * (1.0 + 2.0 * s) * value[i] + s * s * (3.0 - 2.0 * s) * value[i + 1] + h * s * r * (r * slope[i] - s * slope[i + 1])
)";

constexpr const char* sine_function = R"(

def _cubic_curve_over_sine(knot, value, slope, parity, at):
  """The same divided by sin(at); an odd curve has a value at 0."""
  if parity == 1 and abs(at) < 1e-4 and abs(at) < knot[0]:
    k = knot[0]
    return (value[0] * (1.5 / k - 0.5 / (k * k * k) * at * at) + slope[0] * (-0.5 + 0.5 / (k * k) * at * at)) * (1.0 + at * at / 6.0)
  return _div(_cubic_curve(knot, value, slope, parity, at), _sin(at))
)";

constexpr const char* lines_function = R"(

def _straight_lines(x, y, at):
  """Straight lines between points, held outside."""
  if not at > x[0]:
    return y[0] if at <= x[0] else at
  if at >= x[-1]:
    return y[-1]
  i = 0
  while at >= x[i + 1]:
    i += 1
  return y[i] + (y[i + 1] - y[i]) * ((at - x[i]) / (x[i + 1] - x[i]))
)";

std::string quoted(const std::string& text) { return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace); }
std::string list(const std::string& name, const std::vector<double>& values) {
  return fmt::format("{} = [\n    {}]\n", name, number_list(values));
}
std::string comment(const std::vector<std::string>& lines) { return lines_text(lines, "# "); }

std::string curve_text(const ExportedCurve& curve, const std::string& name) {
  const std::string doc = fmt::format("{} [{}] of {} [{}]", shown(curve.name), shown(curve.unit), shown(curve.of), shown(curve.of_unit));
  std::string data, functions;
  const auto define = [&](const std::string& function, const std::string& words, const std::string& value) {
    functions += fmt::format("\n\ndef {}(at):\n  {}\n  return {}\n", function, quoted(words), value);
  };
  if (curve.has_knots()) {
    const int parity = curve.parity == Parity::odd ? 1 : curve.parity == Parity::even ? 2 : 0;
    data +=
        list("_" + name + "_knots", curve.knots) + list("_" + name + "_values", curve.value) + list("_" + name + "_slopes", curve.slope);
    const auto call = [&](const char* suffix) {
      return fmt::format("_cubic_curve{1}(_{0}_knots, _{0}_values, _{0}_slopes, {2}, at)", name, suffix, parity);
    };
    define(name, doc, call(""));
    if (curve.over_sine) define(name + "_over_sine", doc + ", divided by its sine", call("_over_sine"));
  }
  if (curve.grid) {
    const std::string grid = "_" + name + "_grid";
    data += list(grid, curve.grid->x);
    const auto add = [&](const std::string& suffix, const std::string& words, const std::vector<double>& values) {
      data += list(grid + suffix + "_values", values);
      define(name + suffix, words, fmt::format("_straight_lines({0}, {0}{1}_values, at)", grid, suffix));
    };
    if (!curve.has_knots()) add("", doc, curve.grid->value);
    add("_sigma", "its sigma: a 95 % band is the curve +- 1.96 of it", known_sigmas(*curve.grid));
  }
  return "\n" + data + functions;
}

std::string curves_text(const SourceParts& parts) {
  const auto any = [&](const auto& holds) { return std::any_of(parts.curves.begin(), parts.curves.end(), holds); };
  std::string out;
  if (any([](const ExportedCurve& c) { return c.has_knots(); })) out += knots_function;
  if (any([](const ExportedCurve& c) { return c.over_sine; })) out += sine_function;
  if (any([](const ExportedCurve& c) { return c.grid.has_value(); })) out += lines_function;
  for (std::size_t i = 0; i < parts.curves.size(); ++i) out += "\n" + curve_text(parts.curves[i], parts.curve_names[i]);
  return out;
}

std::string parameters_text(const SourceParts& parts) {
  std::string out = "\n# Value, sigma (None: not estimated) and unit; the functions below read the values.\nparameters = {\n";
  for (const ExportedParameter& p : parts.parameters) {
    out += fmt::format("    {}: {{\"value\": {}, \"sigma\": {}, \"unit\": {}}},\n", quoted(p.name), number_text(p.estimate.value),
                       p.estimate.sigma > 0.0 ? number_text(p.estimate.sigma) : "None", quoted(p.estimate.unit));
  }
  return out + "}\n";
}

std::string names_text(const char* list, const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + quoted(name);
  return fmt::format("{} = [{}]\n", list, out);
}

std::vector<std::string> names_of(const auto& items) {
  std::vector<std::string> out;
  for (const auto& item : items) out.emplace_back(item.name);
  return out;
}

/// All that x has: memory of effects behind the states of the system.
std::vector<std::string> state_names(const Model& model) {
  std::vector<std::string> out = names_of(model.system->spec().states);
  out.insert(out.end(), model.own_state_names.begin(), model.own_state_names.end());
  return out;
}

/// All that u has: what inputs were earlier, as u_late, behind the inputs of the system.
std::vector<std::string> input_names(const SourceParts& parts, const Model& model) {
  std::vector<std::string> out = names_of(model.system->spec().inputs);
  const std::vector<std::string> own = out;
  std::set<std::string> taken(own.begin(), own.end());
  for (const LateInputUse& late : parts.formulas.late) out.push_back(unique_name(own[late.input] + "_late", taken));
  return out;
}

std::string right_hand_side(const SourceParts& parts, const Model& model) {
  std::vector<std::string> parameters;
  for (const ExportedParameter& p : parts.parameters) parameters.push_back(fmt::format("parameters[{}][\"value\"]", quoted(p.name)));
  const LeafNames names = leaf_names(parts, model, parameters);
  const auto function = [&](const char* name, const char* result, const std::vector<int>& roots) {
    std::vector<std::string> targets;
    for (int i = 0; i < int_size(roots); ++i) targets.push_back(fmt::format("{}[{}]", result, i));
    return fmt::format("\n\ndef {}(x, u, t):\n  {} = [0.0] * {}\n{}  return {}\n", name, result, roots.size(),
                       statements(parts.formulas, roots, targets, names, python_language), result);
  };
  const SystemSpec& spec = model.system->spec();
  std::string out = "\n\n" + comment(signature_lines(parts, model)) + names_text("states", state_names(model)) +
                    names_text("inputs", input_names(parts, model)) + names_text("output_names", names_of(spec.outputs));
  out += function("rates", "dx", parts.formulas.rates) + function("outputs", "y", parts.formulas.outputs);
  for (const auto& [name, node] : parts.formulas.sample_times)
    out += "\n\ndef " + name + "(x, u, t):\n" + statements(parts.formulas, {node}, {"shift"}, names, python_language) + "  return shift\n";
  return out;
}

}  // namespace

std::string python_source(const Exported& exported) {
  const SourceParts parts = source_parts(exported);
  std::string out = comment(provenance(exported)) + comment({"Python 3, SI units and radians. Needs math alone."}) + functions_text;
  out += "\n" + parameters_text(parts) + curves_text(parts);
  if (parts.formulas.lack.empty()) return out + right_hand_side(parts, *exported.model);
  return out + "\n\n" + comment(formula_lines(parts, exported));
}

}  // namespace misfit
