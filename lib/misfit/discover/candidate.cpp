#include "misfit/discover/candidate.h"

#include <algorithm>
#include <cmath>

#include "misfit/core/display.h"
#include "misfit/core/text.h"
#include "misfit/math/statistics.h"

namespace misfit {

Candidate named_candidate(const ScreeningResult& s, double families) {
  constexpr double described_below = 0.01;  // 1 − R² of the columns with those of the free parameters
  constexpr double rounding = 1e-6;         // what is left of the columns then is rounding
  constexpr double clearly_significant = 1e-4;
  const CandidateModel& candidate_model = *s.candidate_model;
  Candidate c;
  c.effect = candidate_model.effect;
  c.roles = candidate_model.roles;
  c.family = candidate_model.family;
  c.ports = candidate_model.port_names;
  c.score = c.predicted_drop = s.result.chi2;
  c.dof = s.result.dof;
  if (!s.runs) {
    c.why = "the model cannot be run with it";
    return c;
  }
  c.p_value = sidak(s.p_value, families);
  // Of a very significant effect even the 1 % that the free parameters cannot describe is seen in the data: it is tested.
  const bool could_be_imitated = s.result.independent < rounding || !(c.p_value < clearly_significant);
  c.absorbed = s.result.independent < described_below && could_be_imitated && !candidate_model.has_priors;
  for (std::size_t i = 0; i < candidate_model.strengths.size(); ++i) {
    const Parameter& p = candidate_model.model.parameters[candidate_model.strengths[i]];
    const Eigen::Index k = i;
    c.parameters[p.name] = {s.result.amplitude[k], s.result.sigma[k], p.unit};
  }
  for (std::size_t i = 0; i < s.cell.size(); ++i) {
    const int shape = i < candidate_model.shapes.size() ? candidate_model.shapes[i] : candidate_model.frequency;
    const Parameter& p = candidate_model.model.parameters[shape];
    c.parameters[p.name] = {s.cell[i], 0.0, p.unit};
  }
  if (c.absorbed) c.why = "already described by the free parameters (R² above 0.99)";
  return c;
}

std::string what_was_tried(const ScreeningResult& s) {
  std::string out = effect_at(s.candidate_model->effect, s.candidate_model->roles) + " (" + to_string(s.candidate_model->family) +
                    "): " + std::to_string(s.cells) + (s.cells == 1 ? " cell" : " cells") + ", " +
                    format_value(std::round(s.cells_effective)) + " effective tests";
  const FrequencyGrid& scanned = s.frequencies;
  if (scanned.count == 0) return out;
  const double last = scanned.at(scanned.count - 1);
  const bool cut_short = last + 2.0 * scanned.step < scanned.wanted;
  if (s.candidate_model->recurs_along) {
    const std::string unit = s.candidate_model->model.parameters[s.candidate_model->frequency].unit;
    out += ", every " + in_display_unit(1.0 / last, unit) + " to " + in_display_unit(1.0 / scanned.first, unit);
    if (cut_short) out += ", not down to " + in_display_unit(1.0 / scanned.wanted, unit) + ": too many samples";
    return out;
  }
  out += ", " + format_value(scanned.first) + " to " + format_value(last) + " Hz";
  if (cut_short) out += ", not up to " + format_value(scanned.wanted) + " Hz: too many unevenly spaced samples";
  return out;
}

Candidate unknown_candidate(const UnknownCurve& curve, double families, double p_accept) {
  Candidate c;
  c.effect = unknown_curve_key(curve.port, curve.quantity);
  c.family = CandidateFamily::unknown;
  c.ports = {curve.port};
  c.score = c.predicted_drop = curve.result.chi2;
  c.dof = curve.result.dof;
  c.p_value = sidak(curve.p_value, families);
  c.why = c.p_value < p_accept ? (curve.kind == PortKind::sensor     ? "an error that depends on "
                                  : curve.kind == PortKind::quantity ? "a change of " + curve.port + " with "
                                                                     : "a force that depends on ") +
                                     curve.quantity + ", of unknown form"
                               : "not significant: family-wise " + p_equals(c.p_value);
  return c;
}

void rank_candidates(std::vector<Candidate>& candidates) {
  std::stable_sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    if (a.accepted != b.accepted) return a.accepted;
    return a.actual_drop.has_value() && !b.actual_drop.has_value();
  });
  int rank = 0;
  for (Candidate& candidate : candidates) candidate.rank = ++rank;
}

}  // namespace misfit
