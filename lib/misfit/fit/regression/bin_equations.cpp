#include "misfit/fit/regression/bin_equations.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "misfit/model/evaluator.h"

namespace misfit {
namespace {

/// A curve whose coefficients are all c is then c everywhere: no symmetry that would turn its sign below 0.
void flatten(Curve& curve) {
  std::vector<double> knots(curve.spline.breakpoints().size());
  for (std::size_t i = 0; i < knots.size(); ++i) knots[i] = static_cast<double>(i);
  curve.spline = CubicSpline(knots, Parity::none);
}

/// Parameters behind a coefficient, curve or number; empty if the model has none of that name.
std::vector<int> coefficients_of(Model& model, const std::string& name) {
  std::vector<int> out;
  for (auto& curve : model.curves) {
    if (curve.name != name) continue;
    for (int i = 0; i < curve.spline.size(); ++i) out.push_back(curve.first + i);
    flatten(curve);
  }
  const int number = model.find_parameter(name);
  if (out.empty() && number >= 0) out.push_back(number);
  return out;
}

bool find_level(const Model& model, const Signals& signals, BinForm& form) {
  const auto& spec = model.system->spec();
  for (std::size_t o = 0; o < spec.outputs.size() && o < signals.measured.size(); ++o) {
    for (std::size_t j = 0; j < spec.states.size(); ++j) {
      if (spec.outputs[o].observes < 0 || spec.states[j].rate_of != spec.outputs[o].observes) continue;
      form.output = o;
      form.level = spec.outputs[o].observes;
      form.rate = static_cast<int>(j);
      return true;
    }
  }
  return false;
}

void list_known(const Model& model, BinForm& form) {
  const auto own = [&](int i) {
    const auto in = [i](const std::vector<int>& list) { return std::find(list.begin(), list.end(), i) != list.end(); };
    return in(form.static_coefficients) || in(form.damping_coefficients);
  };
  for (int i : model.free_parameters()) {
    const Parameter& p = model.parameters[i];
    const std::string name = p.curve >= 0 ? model.curves[p.curve].name : p.name;
    const bool listed = !form.taken_as_known.empty() && form.taken_as_known.back() == name;
    if (!own(i) && !listed) form.taken_as_known.push_back(name);
  }
}

}  // namespace

std::optional<BinForm> bin_form(const Model& model, const Signals& signals, std::string& why) {
  const auto& spec = model.system->spec();
  const std::string system = "system '" + spec.key + "'";
  if (spec.static_curve.empty() || spec.damping_curve.empty()) {
    why = system + " names no static and damping curve for it to solve for";
    return std::nullopt;
  }
  BinForm form{model, 0, 0, 1, 0, {}, {}, {}};
  if (!find_level(model, signals, form) || spec.states.size() != 2) {
    why = system + " is not one equation of motion of a measured level: it needs two states, the level, shown by a channel, and its rate";
    return std::nullopt;
  }
  const Curve* static_curve = model.find_curve(spec.static_curve);
  const Curve* damping_curve = model.find_curve(spec.damping_curve);
  form.static_coefficients = coefficients_of(form.model, spec.static_curve);
  form.damping_coefficients = coefficients_of(form.model, spec.damping_curve);
  if (static_curve == nullptr || form.damping_coefficients.empty()) {
    why = "the model has no " + (static_curve == nullptr ? "curve " + spec.static_curve : "coefficient " + spec.damping_curve) +
          ": its effects must include a static moment and a damping";
    return std::nullopt;
  }
  if (damping_curve != nullptr && damping_curve->quantity != static_curve->quantity) {
    why = "curves " + spec.static_curve + " and " + spec.damping_curve + " are functions of different quantities (" + static_curve->of +
          ", " + damping_curve->of + "); a bin needs one";
    return std::nullopt;
  }
  form.quantity = static_curve->quantity;
  list_known(model, form);
  return form;
}

ReconstructedStates stencil_states(const BinForm& form, const Signals& signals, Stencils stencils, bool average) {
  std::vector<double> level = signals.measured[form.output].values;
  for (std::size_t i = 0; i < level.size(); ++i) {
    if (signals.held_out(i)) level[i] = std::numeric_limits<double>::quiet_NaN();
  }
  if (average) level = average_of_three(signals.t, level);
  const StencilMotion motion = stencil_motion(signals.t, level, stencils);
  const Eigen::Index samples = signals.samples();
  ReconstructedStates out;
  out.x = RowMatrix::Zero(samples, form.model.states());
  out.dx = out.x;
  out.ok.assign(signals.samples(), false);
  out.shown.assign(form.model.states(), false);
  out.shown[form.level] = out.shown[form.rate] = true;
  for (std::size_t i = signals.exclude; i < signals.samples(); ++i) {
    if (!std::isfinite(motion.level[i])) continue;
    const Eigen::Index row = i;
    out.ok[i] = true;
    out.x(row, form.level) = motion.level[i];
    out.x(row, form.rate) = out.dx(row, form.level) = motion.rate[i];
    out.dx(row, form.rate) = motion.acceleration[i];
  }
  add_own_states(form.model, signals, out);
  return out;
}

std::vector<BinEquation> bin_equations(const BinForm& form, const Signals& signals, const ReconstructedStates& states) {
  Evaluator evaluator(form.model);
  const InputTable inputs = input_table(signals, form.model);
  std::vector<double> dx(form.model.states()), quantities(form.model.system->spec().quantities.size());
  const auto with = [&](double static_value, double damping_value) {
    std::vector<double> values = form.model.values();
    for (int i : form.static_coefficients) values[i] = static_value;
    for (int i : form.damping_coefficients) values[i] = damping_value;
    return values;
  };
  const std::vector<double> neither = with(0.0, 0.0), static_one = with(1.0, 0.0), damping_one = with(0.0, 1.0);
  std::vector<BinEquation> equations;
  for (std::size_t i = 0; i < signals.samples(); ++i) {
    if (!states.ok[i]) continue;
    const double* x = states.x.row(i).data();
    const auto acceleration = [&](const std::vector<double>& values) {
      evaluator.set_parameters(values.data());
      evaluator.rates(x, inputs.at(i), signals.t[i], dx.data());
      return dx[form.rate];
    };
    const double known = acceleration(neither);
    BinEquation e;
    e.static_gain = acceleration(static_one) - known;
    e.damping_gain = acceleration(damping_one) - known;
    e.known = known;
    e.y = states.dx(i, form.rate) - known;
    evaluator.quantities(x, inputs.at(i), signals.t[i], quantities.data());
    e.x = quantities[form.quantity];
    e.t = signals.t[i];
    e.sample = i;
    if (std::isfinite(e.x) && std::isfinite(e.y) && std::isfinite(e.static_gain) && std::isfinite(e.damping_gain)) equations.push_back(e);
  }
  return equations;
}

}  // namespace misfit
