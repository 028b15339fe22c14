#include "misfit/show/verdict_evidence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "misfit/core/text.h"
#include "misfit/data/estimators.h"
#include "misfit/show/rows.h"

namespace misfit {
namespace {
constexpr double significant = 0.01;
}  // namespace

const Fit* leading_fit(const std::vector<Fit>& fits) {
  const Fit* last = nullptr;
  for (const Fit& fit : fits) {
    if (!fit.usable()) continue;
    if (fit.method == random_force_estimator().name) return &fit;
    if (last == nullptr || !fit.rms.empty()) last = &fit;
  }
  return last;
}

std::string why_nothing_is_known(const Fit& fit) {
  const bool known = std::any_of(fit.parameters.begin(), fit.parameters.end(), [](const auto& p) { return p.second.sigma > 0.0; });
  if (!fit.parameters.empty() && !known)
    return "these data are too few to estimate the model, none of whose parameters has a standard error";
  const bool compared = std::any_of(fit.predictions.begin(), fit.predictions.end(), [](const auto& p) { return p.nrmse.has_value(); });
  const bool follows = std::any_of(fit.predictions.begin(), fit.predictions.end(), [](const auto& p) { return p.nrmse && *p.nrmse < 1.0; });
  return compared && !follows ? "the fitted model predicts the motion no better than its mean does" : "";
}

std::string map_in_doubt(const Diagnosis* diagnosis) {
  if (diagnosis == nullptr || diagnosis->maps.empty() || diagnosis->maps.front().p_corrected > significant) return "";
  const ForceMap& map = diagnosis->maps.front();
  return fmt::format("all the same, the missing {} against {} is significant ({})", map.port, map.quantity, p_equals(map.p_corrected));
}

std::string motion_in_doubt(const Comparison* comparison) {
  if (comparison == nullptr || !comparison->motion || comparison->motion->p_value > significant) return "";
  return fmt::format(
      "but the fitted model does not make the statistics of the measured motion ({}): something slow or rare, which one "
      "sample hardly shows, may be missing",
      p_in_words(*comparison->motion));
}

std::vector<std::string> no_longer_determined(const Rung& first, const Rung& last) {
  constexpr double known = 3.0;  // sigmas
  std::vector<std::string> out;
  if (!first.estimates || !last.estimates) return out;
  for (const auto& [name, before] : *first.estimates) {
    const auto found = last.estimates->find(name);
    if (found == last.estimates->end() || !(std::abs(before.value) > known * before.sigma) || !(before.sigma > 0.0)) continue;
    const Estimate& now = found->second;
    if (!(now.sigma > std::abs(now.value)) || !(now.sigma > std::abs(before.value))) continue;
    out.push_back(name + " is no longer determined beside what was added: " + shown(now));
  }
  return out;
}

}  // namespace misfit
