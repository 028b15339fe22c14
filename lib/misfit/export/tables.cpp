#include <fmt/format.h>

#include <cmath>

#include "misfit/core/file_name.h"
#include "misfit/data/json_fields.h"
#include "misfit/export/exported.h"
#include "misfit/export/expression.h"

namespace misfit {
namespace {

Json numbers(const std::vector<double>& values) {
  Json out = Json::array();
  for (const double value : values) out.push_back(json_number(value));
  return out;
}

const char* name_of(Parity parity) { return parity == Parity::odd ? "odd" : parity == Parity::even ? "even" : "none"; }

Json json_of(const ExportedCurve& curve) {
  Json out{{"name", curve.name}, {"of", curve.of}, {"of_unit", curve.of_unit}, {"unit", curve.unit}};
  if (curve.has_knots()) {
    out["parity"] = name_of(curve.parity);
    out["knots"] = {
        {"x", numbers(curve.knots)}, {"value", numbers(curve.value)}, {"slope", numbers(curve.slope)}, {"sigma", numbers(curve.sigma)}};
  }
  if (!curve.grid) return out;
  const CurveEstimate& grid = *curve.grid;
  out["grid"] = {{"x", numbers(grid.x)}, {"value", numbers(grid.value)}, {"sigma", numbers(grid.sigma)}, {"count", numbers(grid.count)}};
  out["informative"] = grid.informative;
  if (!grid.why.empty()) out["why"] = grid.why;
  return out;
}

Json covariance_of(const Fit& fit) {
  Json units = Json::array();
  for (const std::string& name : fit.names) {
    const auto found = fit.parameters.find(name);
    units.push_back(found == fit.parameters.end() ? "" : found->second.unit);
  }
  return {{"names", fit.names}, {"units", units}, {"matrix", JsonWriter::json_of(fit.covariance)}};
}

/// A field of a CSV file: in quotation marks where it must be.
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\n\r#") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + "\"";
}
std::string field(double value) { return std::isfinite(value) ? number_text(value) : ""; }

std::string header(const std::string& name, const std::string& unit) { return field(unit.empty() ? name : name + "[" + unit + "]"); }

std::string parameters_csv(const Exported& exported) {
  std::string out = "name,value,sigma,unit,free\n";
  for (const ExportedParameter& p : parameters_of(exported)) {
    const std::string sigma = p.estimate.sigma > 0.0 ? field(p.estimate.sigma) : "";
    out += fmt::format("{},{},{},{},{}\n", field(p.name), field(p.estimate.value), sigma, field(p.estimate.unit), p.free ? 1 : 0);
  }
  return out;
}

std::string covariance_csv(const Fit& fit) {
  std::string out = "name";
  for (const std::string& name : fit.names) out += "," + field(name);
  for (Eigen::Index i = 0; i < fit.covariance.rows(); ++i) {
    out += "\n" + field(fit.names[i]);
    for (Eigen::Index j = 0; j < fit.covariance.cols(); ++j) out += "," + field(fit.covariance(i, j));
  }
  return out + "\n";
}

/// Rows of x, value, then the further columns; a sigma of 0 is "not estimated".
std::string curve_csv(const ExportedCurve& curve, const std::vector<double>& x, const std::vector<double>& value,
                      const std::vector<std::pair<std::string, const std::vector<double>*>>& further) {
  std::string out = header(curve.of, curve.of_unit) + "," + header("value", curve.unit);
  for (const auto& [name, values] : further) out += "," + name;
  for (std::size_t i = 0; i < x.size(); ++i) {
    out += "\n" + field(x[i]) + "," + field(value[i]);
    for (const auto& [name, values] : further) out += "," + (i < values->size() ? field((*values)[i]) : "");
  }
  return out + "\n";
}

}  // namespace

std::string json_text(const Exported& exported) {
  const Fit& fit = exported.fit;
  Json out{{"study", exported.study}, {"rung", exported.rung}, {"program", exported.program}};
  if (exported.model) out["system"] = exported.model->system->spec().key;
  out["method"] = fit.method;
  out["status"] = to_string(fit.status);
  out["parameters"] = Json::object();
  for (const ExportedParameter& p : parameters_of(exported)) {
    Json parameter = JsonWriter::json_of(p.estimate);
    parameter["free"] = p.free;
    out["parameters"][p.name] = std::move(parameter);
  }
  out["covariance"] = covariance_of(fit);
  out["curves"] = Json::array();
  for (const ExportedCurve& curve : curves_of(exported)) out["curves"].push_back(json_of(curve));
  out["noise"] = JsonWriter::json_of(fit.noise);
  out["force"] = JsonWriter::json_of(fit.force);
  return out.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::map<std::string, std::string> csv_texts(const Exported& exported) {
  std::map<std::string, std::string> out{{"parameters.csv", parameters_csv(exported)}};
  if (exported.fit.covariance.rows() == std::ssize(exported.fit.names) && !exported.fit.names.empty())
    out["covariance.csv"] = covariance_csv(exported.fit);
  for (const ExportedCurve& curve : curves_of(exported)) {
    const std::string stem = file_name_for(curve.name);
    const std::string unit = curve.unit.empty() ? "" : "[" + curve.unit + "]";
    if (curve.has_knots())
      out[stem + "_knots.csv"] =
          curve_csv(curve, curve.knots, curve.value, {{"slope", &curve.slope}, {field("sigma" + unit), &curve.sigma}});
    if (curve.grid)
      out[stem + "_grid.csv"] =
          curve_csv(curve, curve.grid->x, curve.grid->value, {{field("sigma" + unit), &curve.grid->sigma}, {"count", &curve.grid->count}});
  }
  return out;
}

}  // namespace misfit
