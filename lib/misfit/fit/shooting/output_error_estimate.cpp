#include "misfit/fit/shooting/output_error_estimate.h"

#include <algorithm>
#include <cmath>

#include "misfit/inference/curve_freedom.h"
#include "misfit/inference/curves.h"
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

}  // namespace misfit::output_error_parts
