#include "misfit/discover/alias.h"

#include <algorithm>
#include <cmath>

#include "misfit/core/display.h"
#include "misfit/core/lists.h"
#include "misfit/core/text.h"
#include "misfit/math/statistics.h"

namespace misfit {

void report_sensor_aliases(const std::vector<ScreeningResult>& screening, const ScoreTest& score, Discovery& out) {
  if (out.candidates.empty() || !out.candidates.front().accepted || out.candidates.front().family == "sensor") return;
  for (const auto& s : screening) {
    if (s.candidate_model->family != "sensor" || !s.candidate_model->has_priors || !s.runs) continue;
    const ScoreResult free = score.test(s.columns);
    constexpr double min_share = 0.4;  // of the accepted effect's chi2
    if (free.chi2 < min_share * out.candidates.front().score) continue;
    std::string numbers, allowed;
    for (std::size_t i = 0; i < s.candidate_model->strengths.size(); ++i) {
      const Parameter& p = s.candidate_model->model.parameters[s.candidate_model->strengths[i]];
      const Eigen::Index k = i;
      numbers += (i == 0 ? "" : ", ") + p.name + " = " + in_display_unit(free.amplitude[k], p.unit, free.sigma[k]);
      if (s.candidate_model->priors.precision[k] > 0.0)
        allowed += (allowed.empty() ? "" : ", ") + in_display_unit(1.0 / std::sqrt(s.candidate_model->priors.precision[k]), p.unit);
    }
    out.sentences.push_back(s.candidate_model->effect + " with " + numbers + " would imitate part of it (predicted drop " +
                            format_value(free.chi2) + "), but the calibration allows only sigmas of " + allowed);
  }
}

std::optional<UnknownCurve> remaining_lack_of_fit(const FilterEstimate& with, const CandidateModel& candidate_model, double drop,
                                                  const DiscoverOptions& options) {
  const ScoreTest score(with);
  const ForceSensitivity force(with);
  const ScoreWork work{with, score, force, options.threads};
  const std::vector<int>& read = candidate_model.quantities;
  std::vector<UnknownCurve> after = unknown_curves(work);
  const double tests = static_cast<double>(after.size());
  std::erase_if(after, [&](const UnknownCurve& curve) { return place_of(read, curve.quantity_index) < 0; });
  std::vector<UnknownCurve> surfaces = unknown_surfaces(work, read);
  const double all_tests = tests + static_cast<double>(surfaces.size());
  std::move(surfaces.begin(), surfaces.end(), std::back_inserter(after));
  std::optional<UnknownCurve> worst;
  for (auto& curve : after) {
    curve.p_value = sidak(curve.p_value, all_tests);
    constexpr double min_share = 0.2;  // of the candidate's drop
    if (curve.p_value > options.p_accept || curve.result.chi2 - 2.0 * curve.result.dof < min_share * drop) continue;
    if (!worst || curve.log_p < worst->log_p) worst = curve;
  }
  return worst;
}

}  // namespace misfit
