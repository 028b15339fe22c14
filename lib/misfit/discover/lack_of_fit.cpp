#include "misfit/discover/lack_of_fit.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "misfit/core/display.h"
#include "misfit/core/lists.h"
#include "misfit/core/text.h"
#include "misfit/math/statistics.h"
#include "misfit/model/memory.h"

namespace misfit {

void report_sensor_imitations(const std::vector<ScreeningResult>& screening, const ScoreTest& score, Discovery& out) {
  if (out.candidates.empty() || !out.candidates.front().accepted || out.candidates.front().family == CandidateFamily::sensor) return;
  for (const auto& s : screening) {
    if (s.candidate_model->family != CandidateFamily::sensor || !s.candidate_model->has_priors || !s.runs) continue;
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

namespace {

/// Quantities whose curves and surfaces tell whether an effect is what is missing: those that it reads. Lags, delays and what a sensor does
/// follow the whole motion, and could stand for much of it, as could a force whose frequency was looked for: for them every quantity, and
/// time; so for several effects that are to explain all between them.
std::vector<int> quantities_that_tell(const CandidateModel& candidate_model, int effects) {
  const bool remembers = has_memory(candidate_model.model.effects.back().effect->spec());
  const bool sensor = candidate_model.family == CandidateFamily::sensor && !candidate_model.has_priors;
  const bool periodic = candidate_model.frequency >= 0;
  if (!remembers && !sensor && !periodic && effects == 1) return candidate_model.quantities;
  std::vector<int> all = candidate_model.quantities;
  for (int q = 0; q < int_size(candidate_model.model.system->spec().quantities); ++q) all.push_back(q);
  all.push_back(kTime);
  return all;
}

void append(std::vector<UnknownCurve>& list, std::vector<UnknownCurve> more) {
  std::move(more.begin(), more.end(), std::back_inserter(list));
}

/// The most significant, corrected for these tests, of those that are worth enough. `linear`: the effect's memory is, so that another rate
/// of its own state makes it another effect; else that is the shape of its corners.
std::optional<UnknownCurve> worst_left(std::vector<UnknownCurve> after, double tests, bool linear, const Added& added,
                                       const DiscoverOptions& options) {
  std::optional<UnknownCurve> worst;
  for (auto& curve : after) {
    curve.p_value = sidak(curve.p_value, tests);
    const double share = curve.memory.empty() || !linear ? added.least_share : least_share_of_all;
    if (curve.p_value > options.p_accept || curve.worth() < share * added.drop) continue;
    if (!worst || curve.order() < worst->order()) worst = curve;
  }
  return worst;
}

/// What score tests in a refitted model need.
class ScoresIn {
 public:
  ScoresIn(const FilterEstimate& with, const DiscoverOptions& options)
      : score_(with),
        force_(sensitivity_of_forces_and_parameters(with)),
        work_{
            .estimate = with, .score = score_, .force = force_, .threads = options.threads, .calibrated = options.calibration != nullptr} {}
  ScoresIn(const ScoresIn&) = delete;
  ScoresIn& operator=(const ScoresIn&) = delete;
  ScoresIn(ScoresIn&&) = delete;
  ScoresIn& operator=(ScoresIn&&) = delete;
  ~ScoresIn() = default;
  [[nodiscard]] const ScoreWork& work() const { return work_; }

 private:
  ScoreTest score_;
  ForceSensitivity force_;
  ScoreWork work_;
};

}  // namespace

std::optional<UnknownCurve> remaining_lack_of_fit(const FilterEstimate& with, const CandidateModel& candidate_model, const Added& added,
                                                  const DiscoverOptions& options) {
  const ScoresIn scores(with, options);
  const ScoreWork& work = scores.work();
  const std::vector<int> read = quantities_that_tell(candidate_model, added.effects);
  std::vector<UnknownCurve> after = unknown_curves(work);
  const std::size_t of_anything = after.size();
  std::erase_if(after, [&](const UnknownCurve& curve) { return place_of(read, curve.quantity_index) < 0; });
  const std::size_t left_out = of_anything - after.size();
  append(after, unknown_surfaces(work, read));
  append(after, unknown_own_rates(work, added.effects));
  const auto tests = static_cast<double>(after.size() + left_out);
  return worst_left(std::move(after), tests, candidate_model.lags, added, options);
}

std::optional<UnknownCurve> mostly_left(const FilterEstimate& with, std::vector<UnknownCurve> screened, const DiscoverOptions& options) {
  constexpr double most_left = 0.5;
  if (screened.empty()) return std::nullopt;
  const ScoresIn scores(with, options);
  const std::vector<UnknownCurve> after = unknown_curves(scores.work());
  std::sort(screened.begin(), screened.end(), [](const UnknownCurve& a, const UnknownCurve& b) { return a.order() < b.order(); });
  const auto is_left = [&](const UnknownCurve& curve) {
    const auto same = std::find_if(after.begin(), after.end(), [&](const UnknownCurve& c) { return is_of_the_same(c, curve); });
    return same != after.end() && sidak(same->p_value, static_cast<double>(after.size())) < options.p_accept &&
           same->worth() > most_left * curve.worth();
  };
  const auto left = std::find_if(screened.begin(), screened.end(), is_left);
  return left == screened.end() ? std::nullopt : std::optional(*left);
}

}  // namespace misfit
