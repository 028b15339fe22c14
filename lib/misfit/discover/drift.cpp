#include "misfit/discover/drift.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "misfit/core/display.h"
#include "misfit/core/lists.h"
#include "misfit/inference/standard_error.h"

namespace misfit {
namespace {

/// Parameters of the last effect's own coefficients that are drifts, with the names of what drifts.
struct Drift {
  int parameter;
  const char* of;
  bool in_time;  ///< else along a quantity that the effect reads
};

/// Its unit is one per a role's: 1/{of}.
bool is_along_a_role(const CoefficientSpec& c) { return std::string_view(c.unit).find("/{") != std::string_view::npos; }

std::vector<Drift> drifts_of(const Model& model) {
  std::vector<Drift> out;
  const BoundEffect& bound = model.effects.back();
  const auto& coefficients = bound.effect->spec().coefficients;
  for (std::size_t c = 0; c < coefficients.size(); ++c) {
    const int parameter = bound.coefficients[c].parameter;
    if (coefficients[c].drift_of[0] != '\0' && parameter >= 0)
      out.push_back({parameter, coefficients[c].drift_of, !is_along_a_role(coefficients[c])});
  }
  return out;
}

}  // namespace

std::vector<int> fixed_drifts(const Model& model) {
  std::vector<int> out;
  for (const Drift& drift : drifts_of(model)) {
    const Parameter& p = model.parameters[drift.parameter];
    if (!p.free && p.value == 0.0) out.push_back(drift.parameter);
  }
  return out;
}

std::string drifts_in_words(const Model& model, const Eigen::MatrixXd& covariance) {
  std::string out;
  for (const Drift& drift : drifts_of(model)) {
    const Parameter& p = model.parameters[drift.parameter];
    if (!p.free) continue;
    const double sigma = standard_error_of(model, covariance, drift.parameter).value_or(0.0);
    out += (out.empty() ? "its " : ", its ") + std::string(drift.of) + (drift.in_time ? " drifts by " : " changes by ") +
           in_display_unit(p.value, p.unit, sigma);
  }
  return out;
}

}  // namespace misfit
