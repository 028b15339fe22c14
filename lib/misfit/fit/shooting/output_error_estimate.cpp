#include "misfit/fit/shooting/output_error_estimate.h"

#include <algorithm>
#include <cmath>

#include "misfit/inference/curve_freedom.h"
#include "misfit/inference/curves.h"
#include "misfit/inference/identifiable.h"
#include "misfit/inference/short_record.h"

namespace misfit::output_error_parts {

double height_of(const LinearisedEstimate& end, const SimulatedRuns& search, const std::vector<Penalty>& penalties) {
  const Shooting& shooting = search.shooting;
  double height = log_prior(shooting.model(), penalties) - 0.5 * end.linearised.rss;
  for (std::size_t e = 0; e < search.experiments.size(); ++e) {
    for (std::size_t i = 0; i < search.experiments[e].samples(); ++i) {
      for (std::size_t o = 0; o < shooting.sigma().size(); ++o) height -= shooting.counts(e, i, o) ? std::log(shooting.sigma()[o]) : 0.0;
    }
  }
  return any_chosen(penalties) ? marginal_loglik(end.linearised, penalties, height) : height;
}

Eigen::MatrixXd describe_estimates(const LinearisedEstimate& end, const SimulatedRuns& search, const DescribedWith& with,
                                   FittedModel& out) {
  const RowMatrix visited = visited_quantities(out.model, search.experiments, with.states);
  const Eigen::MatrixXd& plain = end.smoothed.covariance;
  const Eigen::Index columns = out.model.theta().size();
  if (!with.coloured) {
    describe(out.model, plain.topLeftCorner(columns, columns), visited, out.fit);
    return plain;
  }
  const double degrees = end.degrees();
  const ColouredCovariance coloured = residual_covariance(residual_rows(search), plain, out.model.outputs(), degrees);
  Eigen::MatrixXd covariance = with_uncertain_roughness(end.linearised, with.penalties, 1.0, coloured.excess);
  out.plain_covariance = with_uncertain_roughness(end.linearised, with.penalties, 1.0).topLeftCorner(columns, columns);
  describe(out.model, out.plain_covariance, visited, out.fit);
  keep_plain_sigmas(out.fit);
  describe(out.model, covariance.topLeftCorner(columns, columns), visited, out.fit);
  describe_roughness(out.model, roughness_paths(end.linearised, with.penalties, 1.0), out.fit);
  describe_freedom(out.model, end.linearised, with.penalties, 1.0, out.fit);
  out.fit.facts["covariance"] = in_words(coloured);
  if (degrees >= kFewestDegrees && degrees < kShortRecord && !out.model.noise_is_given())
    add_student_intervals(std::min(degrees, coloured.degrees), out.fit);
  const auto& outputs = out.model.system->spec().outputs;
  for (std::size_t o = 0; o < outputs.size(); ++o) out.fit.noise.at(outputs[o].name).sigma *= std::sqrt(coloured.squared_correlations[o]);
  return covariance;
}

void add_remarks(const EndedSearch& search, const Eigen::MatrixXd& covariance, FittedModel& out) {
  Fit& fit = out.fit;
  const std::vector<Signals>& experiments = search.runs.experiments;
  const double edf = search.end.smoothed.edf;
  const Eigen::MatrixXd of_parameters = covariance.topLeftCorner(out.model.theta().size(), out.model.theta().size());
  const InputTable inputs = input_table(experiments.front(), out.model);
  const std::vector<std::string> scales =
      scale_uncertainties(out.model, out.initial_states.front().data(), inputs.at(0), experiments.front().t.front());
  fit.warnings.insert(fit.warnings.end(), scales.begin(), scales.end());
  warn_of_collinearity(out.model, of_parameters, fit);
  warn_of_other_trims(fit);
  warn_of_other_noise(out.model, fit);
  warn_of_unknown_noise(search.runs, edf, fit);
  fit.warnings.insert(fit.warnings.end(), search.other_maxima.begin(), search.other_maxima.end());
  const double unknowns = edf / static_cast<double>(out.model.outputs());
  classify_motion(out.model, {search.setting, experiments, unknowns, search.regression_says_driven}, fit);
  reject_prior_conflicts(out.model, of_parameters, fit);
  if (search.end.degrees() < kFewestDegrees && !out.model.noise_is_given()) withhold_sigmas(too_few(search.end.linearised.count, edf), fit);
}

}  // namespace misfit::output_error_parts
