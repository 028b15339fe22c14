#include "misfit/data/comparison.h"

#include "misfit/core/text.h"
#include "misfit/data/motion_json.h"

namespace misfit {

template <class Archive>
void fields(Archive& json, MaybeConst<MethodSummary> auto& m) {
  json("status", NameOf(m.status, fit_status_names)), json("message", m.message), json("driven", m.driven);
  json("trim_deg", Formed(m.trim, display_fields)), json("slopes", m.slopes), json("at_trim", m.at_trim);
  json("rms", m.rms), json("validation_rms", m.validation_rms), json("loglik", m.loglik);
  json("validation_loglik", m.validation_loglik), json("parameters", m.parameters);
}

template <class Archive>
void fields(Archive& json, MaybeConst<CurveDifference> auto& d) {
  const double factor = json.factor("of_unit", d.of_unit);
  json("curve", d.curve), json("of", d.of), json("of_unit", DisplayUnit(d.of_unit)), json("a", d.a), json("b", d.b);
  json("from", Scaled(d.from, factor)), json("to", Scaled(d.to, factor)), json("points", d.points);
  json("rms_sigmas", d.rms_sigmas), json("max_sigmas", d.max_sigmas), json("at", Scaled(d.at, factor));
  json("difference", d.difference);
  if constexpr (Archive::reading) d.unit = d.difference.unit;
}

template <class Archive>
void fields(Archive& json, MaybeConst<TrimDifference> auto& d) {
  json("a", d.a), json("b", d.b), json("reference", d.reference);
  json("difference_deg", Formed(d.difference, display_fields)), json("sigmas", d.sigmas);
  json("sentence", d.sentence);
}

template <class Archive>
void fields(Archive& json, MaybeConst<ParameterDifference> auto& d) {
  json("parameter", d.parameter), json("a", d.a), json("b", d.b), json("difference", d.difference);
  json("sigmas", d.sigmas), json("sentence", d.sentence);
}

template <class Archive>
void fields(Archive& json, MaybeConst<NotCompared> auto& n) {
  json("what", n.what), json("why", n.why);
}

/// Curves against curves and curves against references are two arrays.
template <class Archive>
void fields(Archive& json, MaybeConst<Comparison> auto& c) {
  std::vector<CurveDifference> between, references;
  for (const CurveDifference& d : c.curves) (d.reference ? references : between).push_back(d);
  json("methods", Named(c.methods, &MethodSummary::method)), json("curves", between), json("references", references);
  json("trims", c.trims), json("parameters", c.parameters);
  json("reference_trims_deg", Formed(c.reference_trims, display_fields)), json("not_compared", c.not_compared);
  json("simulated_motion", c.motion);
  if constexpr (Archive::reading) {
    for (CurveDifference& d : references) d.reference = true;
    c.curves = std::move(between);
    c.curves.insert(c.curves.end(), references.begin(), references.end());
  }
}

void write_comparison(const std::filesystem::path& path, const Comparison& comparison) { write_json(path, comparison); }

Comparison read_comparison(const std::filesystem::path& path) { return read_json<Comparison>(path); }

std::string p_in_words(const SimulatedMotion& motion) {
  const double least = 1.0 / static_cast<double>(motion.runs - motion.failed + 1);
  constexpr double rounding = 1e-9;
  return motion.runs == 0 || motion.p_value > least + rounding ? p_equals(motion.p_value) : "p ≤ " + format_value(least);
}

}  // namespace misfit
