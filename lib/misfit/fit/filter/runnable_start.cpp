#include "misfit/fit/filter/runnable_start.h"

#include <algorithm>

namespace misfit {
namespace {

/// Free numbers that are strengths of an effect's own.
std::vector<int> strengths_of(const BoundEffect& bound, const Model& model) {
  std::vector<int> out;
  const auto& coefficients = bound.effect->spec().coefficients;
  for (std::size_t c = 0; c < bound.coefficients.size(); ++c) {
    const int at = bound.coefficients[c].parameter;
    if (at < 0 || coefficients[c].shared || coefficients[c].kind != CoefficientKind::strength) continue;
    if (model.parameters[at].free) out.push_back(at);
  }
  return out;
}

void set(Parameter& p, double value) { p.value = std::clamp(value, p.lower, p.upper); }

/// False: there is nothing to damp with.
bool damp(double sign, Model& model) {
  bool any = false;
  if (const Curve* curve = model.find_curve(model.system->spec().damping_curve); curve != nullptr) {
    for (int i = 0; i < curve->spline.size(); ++i) {
      Parameter& p = model.parameters[curve->first + i];
      if (p.free) set(p, sign * curve->scale);
      any = any || p.free;
    }
  }
  for (const BoundEffect& bound : model.effects) {
    if (!bound.effect->spec().dissipative) continue;
    for (int at : strengths_of(bound, model)) {
      set(model.parameters[at], model.parameters[at].scale);
      any = true;
    }
  }
  return any;
}

/// Every free coefficient of a curve at 0, or at the bound next to it: a model whose curves hold the motion nowhere is lost within a second
/// whatever its damping; without them the damping and the random force follow it.
Model with_curves_at_zero(Model model) {
  for (Parameter& p : model.parameters) {
    if (p.free && p.curve >= 0) set(p, 0.0);
  }
  return model;
}

void append_words(std::string& words, const std::string& more) { words += (words.empty() || more.empty() ? "" : ", ") + more; }

}  // namespace

std::vector<int> free_strengths(const Model& model) {
  std::vector<int> out;
  for (const BoundEffect& bound : model.effects) {
    const std::vector<int> own = strengths_of(bound, model);
    out.insert(out.end(), own.begin(), own.end());
  }
  return out;
}

RunnableStart with_strengths_off(const Model& model) {
  RunnableStart out{model, ""};
  for (int at : free_strengths(model)) {
    Parameter& p = out.model.parameters[at];
    const double before = p.value;
    set(p, 0.0);
    if (p.value != before) append_words(out.words, p.name + " = 0");
  }
  return out;
}

std::vector<RunnableStart> runnable_starts(const Model& model) {
  const RunnableStart as_given{model, ""}, off = with_strengths_off(model);
  std::vector<RunnableStart> out;
  const auto add = [&](RunnableStart start) {
    const std::vector<double> values = start.model.values();
    const bool known = values == model.values() ||
                       std::any_of(out.begin(), out.end(), [&](const RunnableStart& other) { return other.model.values() == values; });
    if (!known) out.push_back(std::move(start));
  };
  const auto add_damped = [&](RunnableStart start, double sign) {
    if (!damp(sign, start.model)) return;
    append_words(start.words, "damping at its typical size");
    add(std::move(start));
  };
  add_damped(as_given, -1.0);
  add(off);
  add_damped(off, -1.0);
  add_damped(off, 1.0);
  RunnableStart flat{with_curves_at_zero(off.model), off.words};
  append_words(flat.words, "curves at 0");
  add(flat);
  add_damped(flat, -1.0);
  return out;
}

}  // namespace misfit
