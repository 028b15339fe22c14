#include "misfit/export/exported.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <set>

#include "misfit/core/shown.h"
#include "misfit/core/units.h"
#include "misfit/data/curve_coefficient.h"
#include "misfit/math/covariance.h"

namespace misfit {
namespace {

/// Covariance of the coefficients of a curve; empty if it was not estimated.
Eigen::MatrixXd covariance_of(const Exported& exported, const Curve& curve) {
  const Fit& fit = exported.fit;
  const int size = curve.spline.size();
  if (fit.covariance.rows() != std::ssize(fit.names)) return {};
  std::vector<Eigen::Index> at;
  for (int i = 0; i < size; ++i) {
    const auto found = std::find(fit.names.begin(), fit.names.end(), exported.model->parameters[curve.first + i].name);
    if (found == fit.names.end()) return {};
    at.push_back(found - fit.names.begin());
  }
  return fit.covariance(at, at);
}

ExportedCurve curve_of_model(const Exported& exported, const Curve& curve) {
  ExportedCurve out{curve.name, curve.of, curve.of_unit, curve.unit, curve.spline.parity(), curve.over_sine, {}, {}, {}, {}};
  out.knots = curve.spline.breakpoints();
  const Eigen::MatrixXd covariance = covariance_of(exported, curve);
  const std::vector<double> parameters = exported.model->values();
  for (const double x : out.knots) {
    const CurvePoint point = curve.spline.at(x);
    const Eigen::Map<const Eigen::Vector4d> c(parameters.data() + curve.first + point.first);
    const Eigen::Map<const Eigen::Vector4d> w(point.w.data()), d(point.d.data());
    out.value.push_back(w.dot(c));
    out.slope.push_back(d.dot(c));
    out.sigma.push_back(covariance.size() == 0 ? std::numeric_limits<double>::quiet_NaN()
                                               : standard_error_of_sum(covariance.block<4, 4>(point.first, point.first), w));
  }
  return out;
}

const std::set<std::string>& reserved_words() {
  static const std::set<std::string> words = {
      "auto",   "break",  "case",   "char",     "const",   "continue", "default",  "do",       "double",   "else",   "enum",   "extern",
      "float",  "for",    "goto",   "if",       "inline",  "int",      "long",     "register", "restrict", "return", "short",  "signed",
      "sizeof", "static", "struct", "switch",   "typedef", "union",    "unsigned", "void",     "volatile", "while",  "and",    "as",
      "assert", "async",  "await",  "class",    "def",     "del",      "elif",     "except",   "finally",  "from",   "global", "import",
      "in",     "is",     "lambda", "nonlocal", "not",     "or",       "pass",     "raise",    "try",      "with",   "yield",  "main"};
  return words;
}

}  // namespace

std::vector<ExportedCurve> curves_of(const Exported& exported) {
  std::vector<ExportedCurve> out;
  if (exported.model) {
    for (const Curve& curve : exported.model->curves) out.push_back(curve_of_model(exported, curve));
  }
  for (const CurveEstimate& curve : exported.fit.curves) {
    const auto own = std::find_if(out.begin(), out.end(), [&](const ExportedCurve& c) { return c.name == curve.name; });
    if (own != out.end()) {
      own->grid = curve;
    } else if (!curve.x.empty()) {
      out.push_back({curve.name, curve.of, curve.of_unit, curve.unit, Parity::none, false, {}, {}, {}, {}, curve});
    }
  }
  return out;
}

std::vector<ExportedParameter> parameters_of(const Exported& exported) {
  std::vector<ExportedParameter> out;
  const auto& estimates = exported.fit.parameters;
  if (!exported.model) {
    for (const auto& [name, estimate] : estimates) {
      if (!is_curve_coefficient(name)) out.push_back({name, "", estimate, true});
    }
    return out;
  }
  for (const Parameter& p : exported.model->parameters) {
    if (p.curve >= 0) continue;
    const auto estimate = estimates.find(p.name);
    out.push_back({p.name, p.doc, estimate == estimates.end() ? Estimate{p.value, 0.0, p.unit} : estimate->second, p.free});
  }
  return out;
}

void use_plain_units(Exported& exported) {
  Fit& fit = exported.fit;
  for (auto* estimates : {&fit.parameters, &fit.noise, &fit.force}) {
    for (auto& [name, estimate] : *estimates) estimate.unit = plain_si(estimate.unit);
  }
  for (CurveEstimate& curve : fit.curves) {
    curve.unit = plain_si(curve.unit);
    curve.of_unit = plain_si(curve.of_unit);
  }
  if (!exported.model) return;
  for (Parameter& p : exported.model->parameters) p.unit = plain_si(p.unit);
  for (Curve& curve : exported.model->curves) {
    curve.unit = plain_si(curve.unit);
    curve.of_unit = plain_si(curve.of_unit);
  }
}

std::string identifier(const std::string& text) {
  std::string out;
  for (const char c : text) out += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  if (out.empty() || std::isdigit(static_cast<unsigned char>(out.front())) != 0) out.insert(out.begin(), '_');
  if (reserved_words().contains(out)) out += '_';
  return out;
}

std::vector<std::string> provenance(const Exported& exported) {
  std::vector<std::string> out{fmt::format("Study: {}{}", shown(exported.study), exported.rung.empty() ? "" : ", " + exported.rung)};
  if (exported.model) out.push_back("System: " + shown(exported.model->system->spec().key));
  out.push_back(fmt::format("Estimate: {}, {}", exported.fit.method, to_string(exported.fit.status)));
  out.push_back("Made by: " + exported.program);
  return out;
}

}  // namespace misfit
