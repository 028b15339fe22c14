// References
//   [JSBSim] JSBSim Reference Manual, 2.5 (functions, tables), and class FGTable: a table of one variable has in <tableData> one line
//   "key value" each, keys increasing; straight lines between them, held outside. JSBSim computes in feet, pounds and radians, and converts
//   lengths and areas of <metrics> by their attribute `unit`.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "misfit/core/error.h"
#include "misfit/core/text.h"
#include "misfit/export/exported.h"
#include "misfit/export/expression.h"

namespace misfit {
namespace {

/// A curve of which misfit knows what JSBSim multiplies it with, beside dynamic pressure, area and chord: the moment is their product.
struct Term {
  const char* curve;
  const char* function;
  const char* doc;
  const char* rate;  ///< property [rad/s], then with chord/(2 V); nullptr: none
};
constexpr std::array<Term, 3> terms{
    {{"C_m", "aero/moment/Cm", "static pitching moment", nullptr},
     {"C_mq", "aero/moment/Cmq", "pitch damping, with the rate of rotation", "velocities/q-aero-rad_sec"},
     {"C_m_alphadot", "aero/moment/Cm_alphadot", "damping, with the rate of the angle of attack", "aero/alphadot-rad_sec"}}};

/// A comment must not contain "--".
std::string comment_text(std::string text) {
  for (std::size_t at = 0; (at = text.find("--", at)) != std::string::npos;) text.replace(at, 2, "- -");
  return text;
}

struct Points {
  std::vector<double> x, value;
};

double at(const ExportedCurve& curve, const Model& model, double x) {
  const Curve& own = *model.find_curve(curve.name);
  const CurvePoint point = own.spline.at(x);
  double out = 0.0;
  for (int j = 0; j < 4; ++j) out += point.w[j] * model.parameters[own.first + point.first + j].value;
  return out;
}

/// The curve each quarter of a degree over its knots (those of bins as they are), and mirrored below 0: a total angle of attack is never
/// negative, aero/alpha-rad is.
Points points_of(const ExportedCurve& curve, const Exported& exported) {
  Points out;
  if (curve.has_knots()) {
    const double low = curve.parity == Parity::none ? curve.knots.front() : 0.0, high = curve.knots.back();
    const int intervals = std::max(1, static_cast<int>(std::ceil((high - low) / (0.25 * std::numbers::pi / 180.0))));
    for (int i = 0; i <= intervals; ++i) out.x.push_back(i == intervals ? high : low + (high - low) * i / intervals);
    for (const double x : out.x) out.value.push_back(at(curve, *exported.model, x));
  } else {
    for (std::size_t i = 0; i < curve.grid->x.size(); ++i) {
      if (!std::isfinite(curve.grid->value[i])) continue;
      out.x.push_back(curve.grid->x[i]);
      out.value.push_back(curve.grid->value[i]);
    }
  }
  const bool one_sided = !out.x.empty() && out.x.front() >= 0.0;
  if (!one_sided) return out;
  Points both;
  for (std::size_t i = out.x.size(); i-- > 0;) {
    if (out.x[i] == 0.0) continue;
    both.x.push_back(-out.x[i]);
    both.value.push_back(curve.name == "C_m" ? -out.value[i] : out.value[i]);
  }
  both.x.insert(both.x.end(), out.x.begin(), out.x.end());
  both.value.insert(both.value.end(), out.value.begin(), out.value.end());
  return both;
}

std::string table_text(const Points& points) {
  std::string out =
      "          <table>\n            <independentVar lookup=\"row\">aero/alpha-rad</independentVar>\n            <tableData>\n";
  for (std::size_t i = 0; i < points.x.size(); ++i) out += fmt::format("              {:.17g} {:.17g}\n", points.x[i], points.value[i]);
  return out + "            </tableData>\n          </table>\n";
}

/// `coefficient`: a table over the angle, or a value.
std::string function_text(const Term& term, const std::string& coefficient) {
  std::string out =
      fmt::format("      <function name=\"{}\">\n        <description>{}</description>\n        <product>\n", term.function, term.doc);
  std::vector<const char*> factors = {"aero/qbar-psf", "metrics/Sw-sqft", "metrics/cbarw-ft"};
  if (term.rate != nullptr) factors.insert(factors.end(), {"aero/ci2vel", term.rate});
  for (const char* property : factors) out += fmt::format("          <property>{}</property>\n", property);
  return out + coefficient + "        </product>\n      </function>\n";
}

/// Of JSBSim's <metrics>, as the estimate assumes them.
std::string metrics_words(const Exported& exported) {
  std::string out;
  const std::vector<ExportedParameter> parameters = parameters_of(exported);
  const auto add = [&](const char* name, const char* element, const char* unit) {
    const auto found = std::find_if(parameters.begin(), parameters.end(), [&](const ExportedParameter& p) { return p.name == name; });
    if (found == parameters.end()) return;
    out += fmt::format("  In <metrics>: <{0} unit=\"{1}\">{2:.17g}</{0}>\n", element, unit, found->estimate.value);
  };
  add("S", "wingarea", "M2");
  add("D", "chord", "M");
  return out;
}

/// The functions of the file, by the names of the coefficients that they write.
std::map<std::string, std::string> functions_of(const Exported& exported) {
  std::map<std::string, std::string> out;
  const auto term_of = [](const std::string& name) {
    return std::find_if(terms.begin(), terms.end(), [&](const Term& t) { return name == t.curve; });
  };
  for (const ExportedCurve& curve : curves_of(exported)) {
    const auto term = term_of(curve.name);
    if (term == terms.end() || curve.of_unit != "rad") continue;
    if (!curve.has_knots() && exported.model) continue;  // derived: it is in the others already
    if (curve.grid && !curve.grid->informative) continue;
    out[curve.name] = function_text(*term, table_text(points_of(curve, exported)));
  }
  for (const ExportedParameter& p : exported.model ? parameters_of(exported) : std::vector<ExportedParameter>{}) {
    const auto term = term_of(p.name);
    if (term == terms.end() || p.estimate.unit != "-") continue;
    out[p.name] = function_text(*term, fmt::format("          <value>{:.17g}</value>\n", p.estimate.value));
  }
  return out;
}

}  // namespace

std::vector<std::string> effects_not_in_jsbsim(const Exported& exported) {
  std::vector<std::string> out;
  if (!exported.model) return out;
  const Model& model = *exported.model;
  const auto functions = functions_of(exported);
  const auto is_written = [&](const BoundCoefficient& c) {
    return (c.curve >= 0 && functions.contains(model.curves[c.curve].name)) ||
           (c.parameter >= 0 && functions.contains(model.parameters[c.parameter].name));
  };
  for (const BoundEffect& bound : model.effects) {
    if (std::none_of(bound.coefficients.begin(), bound.coefficients.end(), is_written)) out.push_back(bound.name);
  }
  return out;
}

std::string jsbsim_text(const Exported& exported) {
  std::string functions;
  for (const auto& [name, text] : functions_of(exported)) functions += text;
  if (functions.empty()) {
    throw InputError(
        "the model has no coefficient of a pitching moment (C_m, C_mq, C_m_alphadot of an angle) to write for JSBSim; "
        "--to json, csv, c and python write all curves");
  }
  std::string head;
  for (const std::string& line : provenance(exported)) head += "  " + line + "\n";
  const std::vector<std::string> others = effects_not_in_jsbsim(exported);
  if (!others.empty()) head += "  Effects of the model that are not in this file: " + join_words(others) + "\n";
  return "<?xml version=\"1.0\"?>\n<!--\n" + comment_text(head + metrics_words(exported)) +
         "  alpha_T stands for aero/alpha-rad [rad]; a moment in pounds times feet, positive increases it. Outside of the table JSBSim "
         "holds "
         "the last value.\n-->\n<aerodynamics>\n    <axis name=\"PITCH\">\n" +
         functions + "    </axis>\n</aerodynamics>\n";
}

}  // namespace misfit
