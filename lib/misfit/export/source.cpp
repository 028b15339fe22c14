#include "misfit/export/source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "misfit/core/lists.h"
#include "misfit/core/shown.h"
#include "misfit/core/unique_name.h"
#include "misfit/core/units.h"
#include "misfit/data/estimators.h"

namespace misfit {
namespace {

std::string in_unit(const std::string& name, const std::string& unit) { return fmt::format("{} [{}]", shown(name), shown(plain_si(unit))); }

std::string held(const InputSpec& input) {
  std::string out = input.hold == Hold::zero_order     ? "; held between samples"
                    : input.hold == Hold::band_limited ? "; a cubic spline between samples"
                                                       : "; straight between samples";
  if (input.delay > 0.0) out += fmt::format("; as recorded {} s earlier", number_text(input.delay));
  return out;
}

std::string bounds_of(const StateSpec& state) {
  std::string out;
  if (std::isfinite(state.lower)) out += fmt::format("; set back to {} after each step", number_text(state.lower));
  if (std::isfinite(state.upper)) out += fmt::format("; at most {}", number_text(state.upper));
  return out;
}

/// To which time each output belongs, where it is not t.
std::vector<std::string> sample_time_lines(const SourceParts& parts, const SystemSpec& spec) {
  const auto shifted = [&](const std::string& by) {
    const auto& all = parts.formulas.sample_times;
    return std::any_of(all.begin(), all.end(), [&](const auto& time) { return time.first == by; });
  };
  std::vector<std::string> out;
  const std::string common = shifted(all_sample_times) ? std::string("t + ") + all_sample_times : "t";
  for (int i = 0; i < int_size(spec.outputs); ++i) {
    const std::string own = sample_time_of(spec.outputs[i].name);
    if (shifted(own) || shifted(all_sample_times))
      out.push_back(fmt::format("y[{}] belongs to the time {}{}.", i, common, shifted(own) ? " + " + own : ""));
  }
  return out;
}

}  // namespace

SourceParts source_parts(const Exported& exported) {
  SourceParts out;
  out.curves = curves_of(exported);
  out.parameters = parameters_of(exported);
  std::set<std::string> taken;
  for (const ExportedCurve& curve : out.curves) out.curve_names.push_back(unique_name("curve_" + identifier(curve.name), taken));
  for (const ExportedParameter& p : out.parameters) out.parameter_names.push_back(unique_name(identifier(p.name), taken));
  if (exported.model) {
    out.formulas = model_formulas(*exported.model);
  } else {
    out.formulas.lack = exported.fit.method + " solves for curves in bins: it has no model with a right-hand side";
  }
  return out;
}

LeafNames leaf_names(const SourceParts& parts, const Model& model, const std::vector<std::string>& parameter_texts) {
  LeafNames out;
  for (int i = 0; i < parts.formulas.states; ++i) out.leaves.push_back(fmt::format("x[{}]", i));
  for (int i = 0; i < parts.formulas.inputs; ++i) out.leaves.push_back(fmt::format("u[{}]", i));
  out.leaves.emplace_back("t");
  std::size_t plain = 0;  // parameters_of() leaves coefficients of curves out
  for (const Parameter& p : model.parameters) out.leaves.push_back(p.curve >= 0 ? "" : parameter_texts[plain++]);
  for (std::size_t i = 0; i < model.curves.size(); ++i)
    out.curves.push_back(parts.curve_names[i] + (model.curves[i].over_sine ? "_over_sine" : ""));
  return out;
}

std::vector<std::string> signature_lines(const SourceParts& parts, const Model& model) {
  const SystemSpec& spec = model.system->spec();
  std::vector<std::string> out;
  for (int i = 0; i < int_size(spec.states); ++i)
    out.push_back(fmt::format("x[{}]  {}{}", i, in_unit(spec.states[i].name, spec.states[i].unit), bounds_of(spec.states[i])));
  for (int i = 0; i < int_size(model.own_states); ++i)
    out.push_back(fmt::format("x[{}]  {}, memory of an effect; begins at {}", int_size(spec.states) + i,
                              in_unit(model.own_state_names[i], model.own_state_units[i]), number_text(model.own_states[i].initial)));
  for (int i = 0; i < int_size(spec.inputs); ++i)
    out.push_back(fmt::format("u[{}]  {}{}", i, in_unit(spec.inputs[i].name, spec.inputs[i].unit), held(spec.inputs[i])));
  for (int i = 0; i < int_size(parts.formulas.late); ++i) {
    const LateInputUse& late = parts.formulas.late[i];
    out.push_back(fmt::format("u[{}]  {} as it was {} s ({}) earlier", int_size(spec.inputs) + i,
                              in_unit(spec.inputs[late.input].name, spec.inputs[late.input].unit),
                              number_text(model.parameters[late.delay].value), shown(model.parameters[late.delay].name)));
  }
  for (int i = 0; i < int_size(spec.outputs); ++i)
    out.push_back(fmt::format("y[{}]  {}", i, in_unit(spec.outputs[i].name, spec.outputs[i].unit)));
  out.emplace_back("t     time of the recording [s]");
  out.push_back(fmt::format("Without noise, and without the random force that {} estimates.", random_force_estimator().name));
  const std::vector<std::string> times = sample_time_lines(parts, spec);
  out.insert(out.end(), times.begin(), times.end());
  return out;
}

std::vector<std::string> formula_lines(const SourceParts& parts, const Exported& exported) {
  std::vector<std::string> out{"No right-hand side: " + parts.formulas.lack + "."};
  if (!exported.model) return out;
  const SystemSpec& spec = exported.model->system->spec();
  if (!spec.formula.empty()) out.push_back(shown(spec.key) + ": " + shown(spec.formula, 1000));
  for (const BoundEffect& bound : exported.model->effects)
    out.push_back(shown(bound.name) + ": " + shown(bound.effect->spec().formula, 1000));
  return out;
}

std::string number_list(const std::vector<double>& values) {
  constexpr std::size_t per_line = 6;
  std::string out;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) out += i % per_line == 0 ? ",\n    " : ", ";
    out += number_text(values[i]);
  }
  return out;
}

std::string lines_text(const std::vector<std::string>& lines, const std::string& before) {
  std::string out;
  for (const std::string& line : lines) out += before + line + "\n";
  return out;
}

std::vector<double> known_sigmas(const CurveEstimate& grid) {
  std::vector<double> out = grid.sigma;
  out.resize(grid.x.size(), 0.0);
  for (double& sigma : out) sigma = std::isfinite(sigma) ? sigma : 0.0;
  return out;
}

}  // namespace misfit
