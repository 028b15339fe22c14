#include <fmt/format.h>

#include <algorithm>

#include "misfit/core/lists.h"
#include "misfit/core/shown.h"
#include "misfit/export/source.h"

namespace misfit {
namespace {

constexpr Language c_language{.choose = [](const std::string& condition, const std::string& yes,
                                           const std::string& no) { return "(" + condition + " ? " + yes + " : " + no + ")"; },
                              .divide = [](const std::string& a, const std::string& b) { return "(" + a + " / " + b + ")"; },
                              .both = " && ",
                              .either = " || ",
                              .function_prefix = "",
                              .declare = "const double ",
                              .end = ";"};

/// A cubic between knots; outside: lib/misfit/README.md, 4.2.
constexpr const char* knots_function = R"(
// A cubic between knots with given values and slopes; straight lines outside. parity 1: odd, 2: even, mirrored below 0.
static double cubic_curve(int n, const double *knot, const double *value, const double *slope, int parity, double at) {
  if (parity != 0 && at < 0.0) {
    const double mirrored = cubic_curve(n, knot, value, slope, parity, -at);
    return parity == 1 ? -mirrored : mirrored;
  }
  if (at < knot[0]) {
    const double k = knot[0], r = at / k;
    if (parity == 1) return value[0] * (r * (3.0 - r * r) / 2.0) + slope[0] * (k * r * (r * r - 1.0) / 2.0);
    if (parity == 2) return value[0] + slope[0] * ((at * at - k * k) / (2.0 * k));
    return value[0] + slope[0] * (at - k);
  }
  if (at >= knot[n - 1]) return value[n - 1] + slope[n - 1] * (at - knot[n - 1]);
  int i = 0;
  while (i < n - 2 && at >= knot[i + 1]) ++i;
  const double h = knot[i + 1] - knot[i], s = (at - knot[i]) / h, r = 1.0 - s;
  return r * r * (1.0 + 2.0 * s) * value[i] + s * s * (3.0 - 2.0 * s) * value[i + 1] + h * s * r * (r * slope[i] - s * slope[i + 1]);
}
)";

constexpr const char* sine_function = R"(
// The same divided by sin(at); an odd curve has a value at 0.
static double cubic_curve_over_sine(int n, const double *knot, const double *value, const double *slope, int parity, double at) {
  if (parity == 1 && fabs(at) < 1e-4 && fabs(at) < knot[0]) {
    const double k = knot[0];
    return (value[0] * (1.5 / k - 0.5 / (k * k * k) * at * at) + slope[0] * (-0.5 + 0.5 / (k * k) * at * at)) * (1.0 + at * at / 6.0);
  }
  return cubic_curve(n, knot, value, slope, parity, at) / sin(at);
}
)";

constexpr const char* lines_function = R"(
// Straight lines between points, held outside.
static double straight_lines(int n, const double *x, const double *y, double at) {
  if (!(at > x[0])) return at <= x[0] ? y[0] : at;
  if (at >= x[n - 1]) return y[n - 1];
  int i = 0;
  while (at >= x[i + 1]) ++i;
  return y[i] + (y[i + 1] - y[i]) * ((at - x[i]) / (x[i + 1] - x[i]));
}
)";

/// A line comment must not end with a backslash.
std::string comment(std::vector<std::string> lines) {
  for (std::string& line : lines) std::replace(line.begin(), line.end(), '\\', '/');
  return lines_text(lines, "// ");
}

std::string array(const std::string& name, const std::vector<double>& values) {
  return fmt::format("static const double {}[{}] = {{\n    {}}};\n", name, values.size(), number_list(values));
}

std::string curve_text(const ExportedCurve& curve, const std::string& name) {
  std::string out =
      "\n" + comment({fmt::format("{} [{}] of {} [{}]", shown(curve.name), shown(curve.unit), shown(curve.of), shown(curve.of_unit))});
  if (curve.has_knots()) {
    out += array(name + "_knots", curve.knots) + array(name + "_values", curve.value) + array(name + "_slopes", curve.slope);
    const auto function = [&](const char* suffix) {
      return fmt::format("double {0}{1}(double at) {{ return cubic_curve{1}({2}, {0}_knots, {0}_values, {0}_slopes, {3}, at); }}\n", name,
                         suffix, curve.knots.size(),
                         curve.parity == Parity::odd    ? 1
                         : curve.parity == Parity::even ? 2
                                                        : 0);
    };
    out += function("");
    if (curve.over_sine) out += function("_over_sine");
  }
  if (!curve.grid) return out;
  const std::string grid = name + "_grid";
  out += array(grid, curve.grid->x);
  const auto function = [&](const std::string& suffix, const std::vector<double>& values) {
    out += array(grid + suffix + "_values", values);
    out += fmt::format("double {0}{1}(double at) {{ return straight_lines({2}, {3}, {3}{1}_values, at); }}\n", name, suffix,
                       curve.grid->x.size(), grid);
  };
  if (!curve.has_knots()) function("", curve.grid->value);
  out += comment({"Its sigma: a 95 % band is the curve +- 1.96 of it."});
  function("_sigma", known_sigmas(*curve.grid));
  return out;
}

std::string curves_text(const SourceParts& parts) {
  const auto any = [&](const auto& holds) { return std::any_of(parts.curves.begin(), parts.curves.end(), holds); };
  std::string out;
  if (any([](const ExportedCurve& c) { return c.has_knots(); })) out += knots_function;
  if (any([](const ExportedCurve& c) { return c.over_sine; })) out += sine_function;
  if (any([](const ExportedCurve& c) { return c.grid.has_value(); })) out += lines_function;
  for (std::size_t i = 0; i < parts.curves.size(); ++i) out += curve_text(parts.curves[i], parts.curve_names[i]);
  return out;
}

std::string parameters_text(const SourceParts& parts) {
  std::string out;
  for (std::size_t i = 0; i < parts.parameters.size(); ++i) {
    const ExportedParameter& p = parts.parameters[i];
    const std::string sigma = p.estimate.sigma > 0.0 ? ", sigma " + number_text(p.estimate.sigma) : p.free ? "" : ", not estimated";
    out += fmt::format("const double p_{} = {};  ", parts.parameter_names[i], number_text(p.estimate.value));
    out += comment({fmt::format("[{}]{}", shown(p.estimate.unit), sigma)});
  }
  return out.empty() ? out : "\n" + comment({"Parameters."}) + out;
}

std::string right_hand_side(const SourceParts& parts, const Model& model) {
  std::vector<std::string> parameters;
  for (const std::string& name : parts.parameter_names) parameters.push_back("p_" + name);
  const LeafNames names = leaf_names(parts, model, parameters);
  const auto function = [&](const char* name, const char* result, const std::vector<int>& roots) {
    std::vector<std::string> targets;
    for (int i = 0; i < int_size(roots); ++i) targets.push_back(fmt::format("{}[{}]", result, i));
    return fmt::format("\nvoid {}(const double *x, const double *u, double t, double *{}) {{\n  (void)x, (void)u, (void)t;\n{}}}\n", name,
                       result, statements(parts.formulas, roots, targets, names, c_language));
  };
  std::string out = "\n" + comment(signature_lines(parts, model));
  out += fmt::format("enum {{ n_states = {}, n_inputs = {}, n_outputs = {} }};\n", parts.formulas.states, parts.formulas.inputs,
                     int_size(parts.formulas.outputs));
  out += function("rates", "dx", parts.formulas.rates) + function("outputs", "y", parts.formulas.outputs);
  for (const auto& [name, node] : parts.formulas.sample_times) {
    out += "\ndouble " + name + "(const double *x, const double *u, double t) {\n  double shift;\n  (void)x, (void)u, (void)t;\n" +
           statements(parts.formulas, {node}, {"shift"}, names, c_language) + "  return shift;\n}\n";
  }
  return out;
}

}  // namespace

std::string c_source(const Exported& exported) {
  const SourceParts parts = source_parts(exported);
  std::string out = comment(provenance(exported));
  out += comment({"C99, SI units and radians. Compile with -lm."}) + "#include <math.h>\n";
  out += parameters_text(parts) + curves_text(parts);
  if (parts.formulas.lack.empty()) return out + right_hand_side(parts, *exported.model);
  return out + "\n" + comment(formula_lines(parts, exported));
}

}  // namespace misfit
