#include "misfit/workflow/assess/without.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "misfit/core/text.h"
#include "misfit/core/watch.h"
#include "misfit/discover/discover.h"
#include "misfit/discover/refit.h"
#include "misfit/jobs/interrupt.h"
#include "misfit/workflow/estimate/estimate.h"

namespace misfit {

std::optional<Without> model_without(Session& session, const std::string& effect) {
  stop_if_interrupted();
  const auto work = filter_work(session);
  if (!work->estimate) return std::nullopt;
  const Watch watch("the model without " + effect, session.fit_limit(), session.options.listener.progress_of("discover"));
  return without_effect({*work->estimate, work->prepared.request, session.registry, work->prepared.experiments}, effect,
                        session.options.threads);
}

std::optional<Without> needless(Session& session, const std::string& effect, double families) {
  const auto work = filter_work(session);
  if (!work->estimate || !may_leave(*work->estimate, effect)) return std::nullopt;
  auto out = model_without(session, effect);
  return out && may_be_chance(out->drop, out->parameters, families) ? std::move(out) : std::nullopt;
}

std::string why_too_little(const std::optional<double>& drop, const std::optional<double>& held_out_gain, int parameters, double families) {
  const auto tenths = [](double value) { return format_value(std::round(10.0 * value) / 10.0); };
  constexpr double moved = 0.05;  // of the log-likelihood: a fit that is no better ends where it began, and says nothing of the effect
  if (drop && *drop < moved) return "its fit finds nothing better than the model without it, and may have failed";
  if (drop && may_be_chance(*drop, parameters, families)) {
    return fmt::format("what it gains may be chance (drop {} with {}, {} among {:g} that were tried)", tenths(*drop),
                       counted(static_cast<std::size_t>(parameters), "parameter", "parameters"),
                       p_equals(chance_of(*drop, parameters, families)), families);
  }
  if (const double least = least_held_out_gain(parameters); held_out_gain && !(*held_out_gain > least)) {
    return fmt::format("what is held out is {} with it (log-likelihood {:+.1f}; more than {} is asked for {})",
                       *held_out_gain < 0.0 ? "predicted worse" : "hardly predicted better", *held_out_gain, tenths(least),
                       counted(static_cast<std::size_t>(parameters), "parameter", "parameters"));
  }
  return "";
}

std::optional<FreedWidth> width_of(Session& session, const std::string& effect) {
  stop_if_interrupted();
  const auto work = filter_work(session);
  if (!work->estimate) return std::nullopt;
  const Watch watch("the width of " + effect, session.fit_limit(), session.options.listener.progress_of("discover"));
  return freed_width(*work->estimate, work->prepared.experiments, effect, session.options.threads);
}

namespace {

Discovery discover_in(Session& session, const Without& without, DiscoverOptions options) {
  stop_if_interrupted();
  const std::optional<Calibration> calibration = calibrate_stage(session);
  const auto work = filter_work(session);
  options.threads = session.options.threads;
  options.calibration = calibration ? &*calibration : nullptr;
  options.refit_limit = session.asked_limit().value_or(usual_refit_limit(session.options, work->fit.seconds));
  return discover({without.estimate, without.request, session.registry, work->prepared.experiments}, options);
}

}  // namespace

Discovery search_without(Session& session, const Without& without) {
  DiscoverOptions options;
  options.progress = session.progress("discover");
  options.stop = &interrupted();
  return discover_in(session, without, std::move(options));
}

std::optional<Candidate> in_its_place(Session& session, const Without& without, const Candidate& other) {
  const auto same = [&](const Candidate& c) { return c.effect == other.effect && c.roles == other.roles; };
  DiscoverOptions options;
  options.only = other.effect;
  options.refit_best_of = same;
  const Watch watch(other.effect + " in the place of another", 0.0, session.options.listener.progress_of("discover"));
  const Discovery found = discover_in(session, without, std::move(options));
  const auto candidate = std::find_if(found.candidates.begin(), found.candidates.end(), same);
  return candidate == found.candidates.end() || !candidate->actual_drop ? std::nullopt : std::optional(*candidate);
}

}  // namespace misfit
