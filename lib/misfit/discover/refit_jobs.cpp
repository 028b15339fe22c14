#include "misfit/discover/refit_jobs.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <type_traits>

#include "misfit/core/watch.h"
#include "misfit/fit/filter/estimate_bytes.h"
#include "misfit/jobs/ranks.h"

namespace misfit {

template <class Bytes, class Data>
  requires std::is_same_v<std::remove_const_t<Data>, Estimate>
void fields(Bytes& bytes, Data& estimate) {
  auto& [value, sigma, unit, interval] = estimate;
  bytes(value, sigma, unit, interval);
}

namespace {

/// From where the effects were screened to the noise of the estimate.
OneStep step_from_elsewhere(const RefitWork& work, const ScoreTest& score, const ScreeningResult& effect) {
  const FilterEstimate& there = *work.screened;
  OneStep step = one_step({there, work.experiments, work.registry, work.threads}, score, effect);
  double counted = 0.0;
  for (const FilterTrace& trace : there.traces) counted += static_cast<double>(trace.counted);
  const double left = std::exp(-0.5 * step.drop / std::max(counted, 1.0));  // share of the residuals' RMS
  step.noise = work.without.noise;
  step.noise.force *= left;
  for (double& force : step.noise.further_forces) force *= left;
  return step;
}

SteppedRefit stepped(const RefitWork& work, const ScoreTest& score, const ScreeningResult& effect) {
  try {
    if (work.afresh || work.rest != nullptr) return {effect.result.chi2, refit(work, effect)};
    const OneStep step = work.screened == nullptr ? one_step(work, score, effect) : step_from_elsewhere(work, score, effect);
    return {step.drop, refit(work, effect, step)};
  } catch (const TimeLimitReached& spent) {
    return {effect.result.chi2, unfinished(effect, spent.what())};
  }
}

}  // namespace

std::string pack(const SteppedRefit& result, const ScreeningResult& effect) {
  const auto& [ok, out_of_time, why, drop, estimate, request, parameters, free, fixed, partial, moved, holds, also] = result.refit;
  static_cast<void>(request);  // the candidate model's, moved
  ByteWriter bytes;
  bytes(effect.candidate_model->effect, effect.candidate_model->roles, result.predicted_drop, ok, out_of_time, why, drop, parameters, free,
        fixed, partial, moved.has_value(), moved.value_or(std::map<std::string, std::string>{}), holds, also);
  if (ok) write_estimate(bytes, estimate);
  return bytes.take();
}

SteppedRefit unpack_refit(std::string_view bytes, const RefitWork& work, const ScreeningResult& effect) {
  ByteReader reader(bytes);
  SteppedRefit out;
  std::string name;
  std::map<std::string, std::string> roles, moved;
  bool has_moved = false;
  reader(name, roles, out.predicted_drop, out.refit.ok, out.refit.out_of_time, out.refit.why, out.refit.drop, out.refit.parameters,
         out.refit.free, out.refit.fixed, out.refit.partial, has_moved, moved, out.refit.holds, out.refit.also);
  if (name != effect.candidate_model->effect || roles != effect.candidate_model->roles)
    throw RunError("a stored refit is of '" + name + "' and not of '" + effect.candidate_model->effect + "'");
  out.refit.request = effect.candidate_model->request;
  Model model = start_model(work.without, effect, work.registry);
  if (has_moved) {
    out.refit.request.effects.back().roles = moved;
    out.refit.moved = std::move(moved);
    model = with_the_same_values(assemble(out.refit.request, work.registry), model);
  }
  if (out.refit.ok) out.refit.estimate = read_estimate(reader, model, work.experiments);
  if (!reader.at_end()) throw RunError("a stored refit of '" + name + "' is too long");
  return out;
}

std::optional<std::vector<SteppedRefit>> refit_all(const RefitWork& work, const ScoreTest& score,
                                                   const std::vector<const ScreeningResult*>& effects, const RefitJobs& jobs) {
  const int within = effects.size() > 1 || ranks_started() > 1 ? 1 : work.threads;
  RefitWork each = work;
  each.threads = within;
  const auto one = [&](std::size_t k) { return stepped(each, score, *effects[k]); };
  std::vector<SteppedRefit> out;
  if (!jobs.stored) {
    out.resize(effects.size());
    if (!run_jobs(
            out.size(), work.threads, [&](std::size_t k) { out[k] = one(k); }, jobs.progress, jobs.stop))
      return std::nullopt;
    return out;
  }
  StoredJobs all = *jobs.stored;
  all.count = effects.size();
  all.threads = work.threads;
  const auto results = run_stored_jobs(
      all, [&](std::size_t k) { return pack(one(k), *effects[k]); }, jobs.progress, jobs.stop);
  if (!results) return std::nullopt;
  for (std::size_t k = 0; k < effects.size(); ++k) out.push_back(unpack_refit(results->result(k), work, *effects[k]));
  std::ignore = ranks().agree(true);  // all have read them: the next jobs of a rank are written over these
  return out;
}

}  // namespace misfit
