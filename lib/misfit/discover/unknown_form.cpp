#include "misfit/discover/unknown_form.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "misfit/core/lists.h"
#include "misfit/core/text.h"
#include "misfit/diagnose/features.h"
#include "misfit/math/decompositions.h"
#include "misfit/math/statistics.h"
#include "misfit/model/registry.h"

namespace misfit {
namespace {

/// The role that names what its coefficient is a curve of.
const char* role_of_curve(const EffectSpec& spec) {
  for (const CoefficientSpec& c : spec.coefficients) {
    if (const int role = spec.curve_role(c); role >= 0) return spec.quantities[role].name;
  }
  return "";
}

/// Of the place that such an effect acts on.
PortKind kind_of(const EffectSpec& spec) {
  const std::string_view role = spec.ports.front().name;
  return role == "output" ? PortKind::sensor : role == "parameter" ? PortKind::quantity : PortKind::dynamic;
}

std::map<std::string, std::string> roles_at(const EffectSpec& spec, const std::string& place, const std::string& quantity) {
  return {{spec.ports.front().name, place}, {role_of_curve(spec), quantity}};
}

/// It is of a quantity of the system: not of time, nor of the past of an input.
bool can_be_read(const UnknownCurve& curve, const SystemSpec& system) { return index_of(system.quantities, curve.quantity) >= 0; }

/// An effect of unknown form describes it. What changes a parameter reads states, inputs as they were recorded, and what depends on no
/// parameter (Assembler::check_order).
bool can_be_added(const UnknownCurve& curve, const SystemSpec& system) {
  if (!can_be_read(curve, system)) return false;
  const bool changes = curve.kind == PortKind::quantity, is_input = index_of(system.inputs, curve.quantity) >= 0;
  return !changes || is_input || index_of(system.quantities, curve.quantity) < system.base_quantities;
}

/// All columns in units of their lengths.
Eigen::MatrixXd normalised(Eigen::MatrixXd columns) {
  for (Eigen::Index i = 0; i < columns.cols(); ++i) {
    const double length = columns.col(i).norm();
    if (length > 0.0) columns.col(i) /= length;
  }
  return columns;
}

/// 1 − R² of each column on all others; 1 for one that is 0.
Eigen::VectorXd independence(const Eigen::MatrixXd& columns) {
  constexpr double rounding = 1e-10;
  const Eigen::MatrixXd unit = normalised(columns);
  Eigen::MatrixXd products = unit.transpose() * unit;
  products.diagonal().array() += rounding;
  const Eigen::MatrixXd inverse = symmetric_inverse(products);
  return inverse.diagonal().cwiseInverse().cwiseMin(1.0);
}

/// The hats with 1, q, q² and q³ beside them, which are splines, too, where hats with few samples under them are left out.
Eigen::MatrixXd with_powers(const Eigen::MatrixXd& hats, const Eigen::VectorXd& q) {
  constexpr int powers = 4;
  Eigen::MatrixXd out(hats.rows(), hats.cols() + powers);
  out.leftCols(hats.cols()) = hats;
  const double size = std::max(q.cwiseAbs().maxCoeff(), std::numeric_limits<double>::min());
  for (int n = 0; n < powers; ++n) out.col(hats.cols() + n) = (q / size).array().pow(n);
  return out;
}

Eigen::MatrixXd without_column(const Eigen::MatrixXd& columns, Eigen::Index gone) {
  Eigen::MatrixXd out(columns.rows(), columns.cols() - 1);
  out << columns.leftCols(gone), columns.rightCols(columns.cols() - gone - 1);
  return out;
}

/// nullptr: there are none.
const Features* features_named(const std::vector<Features>& features, const std::string& quantity) {
  const auto of = std::find_if(features.begin(), features.end(), [&](const Features& f) { return f.quantity == quantity; });
  return of == features.end() ? nullptr : &*of;
}

/// Of the hats that are three sigmas from 0, and of two on either side of each; all, where none is.
std::vector<double> centres_where_it_acts(const UnknownCurve& curve) {
  constexpr double clearly = 3.0;
  constexpr std::ptrdiff_t beside = 2;
  const auto count = std::ssize(curve.centre);
  std::vector<bool> kept(curve.centre.size(), false);
  for (std::ptrdiff_t i = 0; i < std::min<std::ptrdiff_t>(count, curve.result.amplitude.size()); ++i) {
    if (!(std::abs(curve.result.amplitude[i]) > clearly * curve.result.sigma[i])) continue;
    for (std::ptrdiff_t k = std::max<std::ptrdiff_t>(i - beside, 0); k <= std::min(i + beside, count - 1); ++k) kept[k] = true;
  }
  std::vector<double> out;
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    if (kept[i]) out.push_back(curve.centre[i]);
  }
  return out.size() < 2 ? curve.centre : out;
}

/// The narrow knots, and the wide ones that none of them is near.
std::vector<double> with_those_beyond(const std::vector<double>& narrow, const std::vector<double>& wide) {
  if (narrow.size() < 2) return narrow;
  double apart = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < narrow.size(); ++i) apart = std::min(apart, narrow[i] - narrow[i - 1]);
  std::vector<double> out = narrow;
  for (const double knot : wide) {
    const bool near = std::any_of(narrow.begin(), narrow.end(), [&](double n) { return std::abs(n - knot) < 1.5 * apart; });
    if (!near) out.push_back(knot);
  }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

Eigen::MatrixXd columns_of_parameters(const FilterEstimate& estimate) {
  Eigen::MatrixXd out(counted_rows(estimate), int_size(estimate.model.free_parameters()));
  Eigen::Index at = 0;
  for (const FilterJacobian& jacobian : estimate.jacobians) {
    out.middleRows(at, jacobian.r.size()) = jacobian.J;
    at += jacobian.r.size();
  }
  return out;
}

Eigen::MatrixXd beside(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  Eigen::MatrixXd out(a.rows(), a.cols() + b.cols());
  out << a, b;
  return out;
}

std::vector<int> parameters_in_columns(const FilterEstimate& estimate, const Eigen::MatrixXd& columns) {
  constexpr double described_below = 0.01;
  std::vector<int> free = estimate.model.free_parameters(), out;
  Eigen::MatrixXd own = columns_of_parameters(estimate);
  while (!free.empty()) {
    const Eigen::VectorXd alone = independence(own);
    const Eigen::VectorXd with = independence(beside(own, columns)).head(own.cols());
    Eigen::Index best = -1;
    for (Eigen::Index i = 0; i < own.cols(); ++i) {
      const Parameter& p = estimate.model.parameters[free[i]];
      const bool described = with[i] < described_below && !(alone[i] < described_below);
      if (described && p.curve < 0 && !p.prior_sigma && (best < 0 || with[i] < with[best])) best = i;
    }
    if (best < 0) break;
    out.push_back(free[best]);
    free.erase(free.begin() + best);
    own = without_column(own, best);
  }
  return out;
}

std::vector<EffectPlace> effects_of_unknown_form(const UnknownCurve& unexplained, const std::vector<UnknownCurve>& screened,
                                                 const SystemSpec& system, const Registry& registry) {
  if (!unexplained.memory.empty()) return {};
  std::vector<const UnknownCurve*> curves;
  for (const UnknownCurve& curve : screened) {
    const bool same_place = curve.kind == unexplained.kind && curve.port == unexplained.port;
    const bool same_quantity = curve.quantity == unexplained.quantity || curve.quantity == unexplained.other;
    if (same_place && same_quantity && can_be_added(curve, system)) curves.push_back(&curve);
  }
  std::stable_sort(curves.begin(), curves.end(), [](const UnknownCurve* a, const UnknownCurve* b) { return a->log_p < b->log_p; });
  std::vector<EffectPlace> out;
  for (const UnknownCurve* curve : curves) {
    for (const std::string& key : registry.effect_keys()) {
      const EffectSpec& spec = registry.effect(key).spec();
      if (!spec.has_unknown_form() || kind_of(spec) != curve->kind) continue;
      out.push_back({key, roles_at(spec, curve->port, curve->quantity)});
    }
  }
  return out;
}

std::vector<Candidate> candidates_of_unknown_form(const ScoreWork& work, const Effect& effect, double families) {
  const EffectSpec& spec = effect.spec();
  const SystemSpec& system = work.estimate.model.system->spec();
  std::map<int, std::vector<Features>> features;  // by the number of their hats
  const std::vector<Features>& usual = features[hats_of_unknown_curves] = features_of(work.estimate, work.force, hats_of_unknown_curves);
  std::vector<UnknownCurve> narrow = narrow_curves(work);
  families += static_cast<double>(narrow.size());
  std::vector<UnknownCurve> curves = with_narrow_ones(unknown_curves(work), std::move(narrow));
  std::erase_if(curves, [&](const UnknownCurve& curve) { return curve.kind != kind_of(spec) || !can_be_added(curve, system); });
  std::stable_sort(curves.begin(), curves.end(), [](const UnknownCurve& a, const UnknownCurve& b) { return a.log_p < b.log_p; });
  std::vector<Candidate> out;
  for (const UnknownCurve& curve : curves) {
    std::vector<Features>& all = features[curve.hats];
    if (all.empty()) all = features_of(work.estimate, work.force, curve.hats);
    const Features* hats = features_named(all, curve.quantity);
    if (hats == nullptr) continue;
    const Eigen::MatrixXd f = with_powers(hats->f, work.force.quantities().col(curve.quantity_index));
    const Eigen::MatrixXd ahead = with_powers(hats->ahead, work.force.quantities_ahead().col(curve.quantity_index));
    const Eigen::MatrixXd columns = work.force.columns_at(curve.kind, curve.index, f, ahead);
    Candidate c;
    c.effect = spec.key;
    c.roles = roles_at(spec, curve.port, curve.quantity);
    c.family = CandidateFamily::unknown;
    c.ports = {curve.port};
    c.score = c.predicted_drop = curve.result.chi2;
    c.dof = curve.result.dof;
    const Features* wide = curve.hats == hats_of_unknown_curves ? nullptr : features_named(usual, curve.quantity);
    if (wide != nullptr) c.knots = with_those_beyond(centres_where_it_acts(curve), wide->centre);
    c.p_value = sidak(curve.p_value, families);
    for (const int p : parameters_in_columns(work.estimate, columns)) {
      const Parameter& held = work.estimate.model.parameters[p];
      c.fixed_in_model[held.name] = {held.value, 0.0, held.unit};
    }
    out.push_back(std::move(c));
  }
  return out;
}

}  // namespace misfit
