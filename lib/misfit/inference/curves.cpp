#include "misfit/inference/curves.h"

#include <algorithm>
#include <cmath>

#include "misfit/core/display.h"
#include "misfit/core/error.h"
#include "misfit/core/text.h"
#include "misfit/core/units.h"
#include "misfit/math/covariance.h"
#include "misfit/model/provisional.h"

namespace misfit {
namespace {

/// A curve as weights on columns at one place: value = weights · θ + constant (constant from coefficients that are fixed).
struct Weights {
  Eigen::VectorXd on_columns;
  double value = 0.0;
};

std::vector<double> grid_over(double lowest, double highest, const std::string& unit) {
  const double range = highest - lowest;
  const double step = (unit == "rad" || unit == "radian") && range < 2.0 ? std::min(0.1 * kDegree, range / 20.0) : range / 200.0;
  const double margin = 0.1 * range;  // a little outside, drawn dashed with the widening band
  std::vector<double> x;
  double first = std::ceil((lowest - margin) / step) * step;
  if (lowest >= 0.0) first = std::max(first, 0.0);
  for (int i = 0; first + i * step <= highest + margin; ++i) x.push_back(first + i * step);
  return x;
}

/// What is constant is computed to a few last digits.
bool moves(double lowest, double highest) {
  constexpr double rounding = 1e-9;
  return highest - lowest > rounding * std::max(std::abs(highest), std::abs(lowest));
}

bool stands_still(const std::vector<double>& values) {
  const auto [lowest, highest] = std::minmax_element(values.begin(), values.end());
  return !values.empty() && !moves(*lowest, *highest);
}

/// A curve of a parity is the same on both sides of 0: what is visited there counts on the positive one.
double folded(double value, const Curve& curve) { return curve.spline.parity() == Parity::none ? value : std::abs(value); }

std::vector<double> folded(const RowMatrix& visited, const Curve& curve) {
  std::vector<double> out;
  for (const double value : visited.col(curve.quantity)) {
    if (std::isfinite(value)) out.push_back(folded(value, curve));
  }
  return out;
}

std::vector<double> counts_at(const std::vector<double>& x, const RowMatrix& visited, const Curve& curve) {
  std::vector<double> count(x.size(), 0.0);
  if (x.size() < 2 || visited.rows() == 0) return count;
  const double step = x[1] - x[0];
  for (Eigen::Index i = 0; i < visited.rows(); ++i) {
    const double cell = std::round((folded(visited(i, curve.quantity), curve) - x.front()) / step);
    if (cell >= 0.0 && cell < static_cast<double>(x.size())) count[static_cast<std::size_t>(cell)] += 1.0;
  }
  return count;
}

struct Combination {
  std::string name, of, unit;
  std::vector<DerivedCurve::Term> terms;

  [[nodiscard]] bool contains(const std::string& curve) const {
    return std::any_of(terms.begin(), terms.end(), [&](const auto& term) { return term.curve == curve; });
  }
};

/// The model's curves, then those that its system derives from them.
std::vector<Combination> combinations_of(const Model& model) {
  std::vector<Combination> out;
  for (const auto& curve : model.curves) out.push_back({curve.name, curve.of, curve.unit, {{curve.name, 0, [](double) { return 1.0; }}}});
  const std::vector<double> values = model.values();
  for (const auto& derived : model.system->derived_curves(values.data())) {
    const bool possible =
        std::all_of(derived.terms.begin(), derived.terms.end(), [&](const auto& term) { return model.find_curve(term.curve) != nullptr; });
    if (possible) out.push_back({derived.name, derived.of, derived.unit, derived.terms});
  }
  return out;
}

/// Calls add(parameter, weight): at x the term is the sum of weight times value over these parameters.
template <class Add>
void weigh(const Model& model, const DerivedCurve::Term& term, double x, const Add& add) {
  const Curve& curve = *model.find_curve(term.curve);
  const CurvePoint point = curve.spline.at(x);
  for (int j = 0; j < 4; ++j) add(curve.first + point.first + j, term.factor(x) * (term.derivative == 0 ? point.w : point.d)[j]);
}

std::vector<double> values_at(const Model& model, const Combination& c, const std::vector<double>& x) {
  std::vector<double> out(x.size(), 0.0);
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (const auto& term : c.terms)
      weigh(model, term, x[i], [&](int parameter, double w) { out[i] += w * model.parameters[parameter].value; });
  }
  return out;
}

/// About 40 of those of the curve's grid.
std::vector<double> few_places(const Curve& curve) {
  constexpr std::size_t count = 40;
  const std::vector<double> all = grid_over(curve.spline.lowest(), curve.spline.highest(), curve.of_unit);
  const std::size_t step = std::max<std::size_t>(all.size() / count, 1);
  std::vector<double> out;
  for (std::size_t i = 0; i < all.size(); i += step) out.push_back(all[i]);
  return out;
}

/// Curves of a model with bands from the joint covariance of its free parameters.
class CurveBands {
 public:
  CurveBands(const Model& model, const Eigen::MatrixXd& covariance, const RowMatrix& visited)
      : model_(model), covariance_(covariance), visited_(visited), column_of_(model.parameters.size(), -1) {
    int column = 0;
    for (const int parameter : model.free_parameters()) column_of_[parameter] = column++;
  }

  [[nodiscard]] CurveEstimate evaluate(const Combination& c) const {
    const Curve* lead = model_.find_curve(c.terms.front().curve);
    CurveEstimate out;
    out.name = c.name;
    out.of = c.of;
    out.unit = c.unit;
    out.of_unit = lead->of_unit;
    out.x = grid_over(lead->spline.lowest(), lead->spline.highest(), lead->of_unit);
    out.count = counts_at(out.x, visited_, *lead);
    for (double x : out.x) {
      Weights w{Eigen::VectorXd::Zero(covariance_.rows()), 0.0};
      for (const auto& term : c.terms) {
        weigh(model_, term, x, [&](int parameter, double weight) {
          w.value += weight * model_.parameters[parameter].value;
          if (column_of_[parameter] >= 0) w.on_columns[column_of_[parameter]] += weight;
        });
      }
      out.value.push_back(w.value);
      out.sigma.push_back(standard_error_of_sum(covariance_, w.on_columns));
    }
    return out;
  }

 private:
  const Model& model_;
  const Eigen::MatrixXd& covariance_;
  const RowMatrix& visited_;
  std::vector<int> column_of_;
};

/// Quantities where the model, at its starting values and without its open curves, carries the states that no channel shows; nothing where
/// that leaves the finite numbers.
RowMatrix quantities_of_carried_states(const Model& model, const std::vector<Signals>& experiments,
                                       std::vector<ReconstructedStates> states) {
  Stepper stepper(model);
  for (std::size_t e = 0; e < experiments.size(); ++e) {
    const Eigen::Index first = std::find(states[e].ok.begin(), states[e].ok.end(), true) - states[e].ok.begin();
    if (first == std::ssize(states[e].ok)) continue;
    const Eigen::VectorXd begin = states[e].x.row(first);
    const InputTable inputs = input_table(experiments[e], model);
    const RowMatrix run =
        run_states({stepper, experiments[e], inputs}, {static_cast<std::size_t>(first), experiments[e].samples(), begin.data()});
    if (run.rows() + first < states[e].x.rows()) return {};
    for (Eigen::Index j = 0; j < model.system_states(); ++j) {
      if (!states[e].shown[j]) states[e].x.col(j).tail(run.rows()) = run.col(j);
    }
  }
  return visited_quantities(model, experiments, states);
}

}  // namespace

RowMatrix visited_quantities(const Model& model, const Signals& signals, const ReconstructedStates& states) {
  Evaluator evaluator(model);
  const InputTable inputs = input_table(signals, model);
  const Eigen::Index count = std::count(states.ok.begin(), states.ok.end(), true);
  RowMatrix out(count, model.system->spec().quantities.size());
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < states.ok.size(); ++i) {
    if (!states.ok[i]) continue;
    evaluator.quantities(states.x.row(i).data(), inputs.at(i), signals.t[i], out.row(row++).data());
  }
  return out;
}

RowMatrix visited_quantities(const Model& model, const std::vector<Signals>& experiments, const std::vector<ReconstructedStates>& states) {
  RowMatrix out = visited_quantities(model, experiments.front(), states.front());
  for (std::size_t e = 1; e < experiments.size(); ++e) {
    const RowMatrix more = visited_quantities(model, experiments[e], states[e]);
    out.conservativeResize(out.rows() + more.rows(), out.cols());
    out.bottomRows(more.rows()) = more;
  }
  return out;
}

std::vector<double> choose_knots(std::vector<double> visited, int intervals, const std::string& curve) {
  constexpr double samples_per_interval = 30.0;
  constexpr double tail = 0.001;
  std::erase_if(visited, [](double value) { return !std::isfinite(value); });
  std::sort(visited.begin(), visited.end());
  if (static_cast<double>(visited.size()) < 2.0 * samples_per_interval) {
    throw RunError("curve " + curve + ": only " + std::to_string(visited.size()) +
                   " samples show its quantity; at least 60 are needed to choose knots");
  }
  const auto at = [&](double fraction) { return visited[static_cast<std::size_t>(fraction * static_cast<double>(visited.size() - 1))]; };
  double low = at(tail);
  const double high = at(1.0 - tail);
  if (!moves(low, high)) throw RunError("curve " + curve + ": its quantity does not move, it is " + format_value(low) + " throughout");
  const int pieces = std::clamp(static_cast<int>(static_cast<double>(visited.size()) / samples_per_interval), 2, intervals);
  if (low >= 0.0) low = std::max(low, (high - low) / (2.0 * pieces));
  std::vector<double> knots;
  for (int i = 0; i <= pieces; ++i) knots.push_back(low + (high - low) * i / pieces);
  return knots;
}

void choose_all_knots(ModelRequest& request, const Registry& registry, const std::vector<Signals>& experiments, int intervals) {
  const auto open = curves_without_knots(request, registry);
  if (open.empty()) return;
  const Model model = provisional_model(request, registry);
  const auto names = parameter_names(request, registry);
  std::vector<ReconstructedStates> states;
  for (const auto& experiment : experiments) states.push_back(reconstruct_states(model, experiment));
  const RowMatrix shown = visited_quantities(model, experiments, states);
  RowMatrix carried;  // where the model takes states that no channel shows: only if a curve is over these
  for (const auto& [name, of] : open) {
    const Curve& curve = *model.find_curve(names.at(name));
    std::vector<double> visited = folded(shown, curve);
    if (stands_still(visited)) {
      if (carried.size() == 0) carried = quantities_of_carried_states(model, experiments, states);
      if (carried.size() > 0) visited = folded(carried, curve);
    }
    request.curves[name].of = of;
    request.curves[name].knots = choose_knots(std::move(visited), intervals, name);
  }
}

void describe(const Model& model, const Eigen::MatrixXd& covariance, const RowMatrix& visited, Fit& fit) {
  const std::vector<int> free = model.free_parameters();
  fit.names.clear();
  fit.covariance = covariance;
  for (Eigen::Index c = 0; c < std::ssize(free); ++c) {
    const Parameter& p = model.parameters[free[c]];
    fit.names.push_back(p.name);
    fit.parameters[p.name] = {p.value, standard_error(covariance, c), p.unit};
  }
  const CurveBands bands(model, covariance, visited);
  fit.curves.clear();
  for (const Combination& combination : combinations_of(model)) fit.curves.push_back(bands.evaluate(combination));
  for (auto& curve : fit.curves) {
    curve.trimmed = curve.name == model.system->spec().static_curve;
    if (curve.trimmed) fit.trim = stable_zero(curve);
  }
}

namespace {

RoughnessPath path_of(const Model& model, const RoughnessPoints& points) {
  const Curve& own = model.curves[points.curve];
  RoughnessPath out{own.name, roughness_unit(own), points.used, points.chosen, points.lambda, points.log_likelihood, {}};
  for (const Combination& c : combinations_of(model)) {
    const Curve& lead = *model.find_curve(c.terms.front().curve);
    if (c.contains(own.name)) out.curves.push_back({c.name, c.of, lead.of_unit, c.unit, few_places(lead), {}});
  }
  Model there = model;
  const Eigen::Index free = model.theta().size();
  for (const Eigen::VectorXd& theta : points.theta) {
    there.set_theta(theta.head(free));
    auto next = out.curves.begin();
    for (const Combination& c : combinations_of(there)) {
      if (!c.contains(own.name)) continue;
      next->values.push_back(values_at(there, c, next->x));
      ++next;
    }
  }
  return out;
}

}  // namespace

void describe_roughness(const Model& model, const std::vector<RoughnessPoints>& paths, Fit& fit) {
  fit.roughness.clear();
  for (const RoughnessPoints& points : paths) fit.roughness.push_back(path_of(model, points));
}

void keep_plain_sigmas(Fit& fit) {
  for (const auto& name : fit.names) fit.plain_sigmas[name] = fit.parameters.at(name).sigma;
  if (fit.trim) fit.plain_sigmas["trim"] = fit.trim->sigma;
}

namespace {

/// What a unit of the static curve does to the rates at one state.
class GainOfCurve {
 public:
  GainOfCurve(const Model& model, const Curve& curve, const Instant& at)
      : evaluator_(model), values_(model.values()), curve_(curve), at_(at) {}

  /// With constant `k` moved by `shift`: the largest row.
  [[nodiscard]] double with(std::size_t k, double shift) {
    const double before = values_[k];
    values_[k] += shift;
    const std::vector<double> on = rates_at(1.0), off = rates_at(0.0);
    values_[k] = before;
    double largest = 0.0;
    for (std::size_t i = 0; i < on.size(); ++i) largest = std::max(largest, std::abs(on[i] - off[i]));
    return largest;
  }

 private:
  std::vector<double> rates_at(double level) {
    std::fill_n(values_.begin() + curve_.first, curve_.spline.size(), level);
    evaluator_.set_parameters(values_.data());
    std::vector<double> dx(evaluator_.states());
    evaluator_.rates(at_.x, at_.u, at_.t, dx.data());
    return dx;
  }

  Evaluator evaluator_;
  std::vector<double> values_;
  const Curve& curve_;
  Instant at_;
};

}  // namespace

std::vector<std::string> scale_uncertainties(const Model& model, const double* x, const InputsAt& u, double t) {
  constexpr double min_share = 1e-3;
  std::vector<std::string> out;
  const Curve* curve = model.find_curve(model.system->spec().static_curve);
  if (curve == nullptr) return out;
  GainOfCurve gain(model, *curve, {x, u, t});
  for (std::size_t k = 0; k < model.system->spec().constants.size(); ++k) {
    const Parameter& p = model.parameters[k];
    if (p.free || !p.prior_sigma) continue;
    const double nominal = gain.with(k, 0.0), moved = gain.with(k, *p.prior_sigma);
    const double share = std::abs(nominal / moved - 1.0);  // for the same motion the curve goes with the reciprocal
    if (!(nominal > 0.0) || !(moved > 0.0) || share < min_share) continue;
    out.push_back("the band of " + curve->name + " does not include the uncertainty of its scale: " + p.name + " = " +
                  format_value(p.value, *p.prior_sigma) + " " + plain_si(p.unit) + ", which is fixed, makes every " + curve->name +
                  " uncertain by " + format_value(std::round(1000.0 * share) / 10.0) + " % (1 sigma)");
  }
  return out;
}

void mark_not_informative(const Model& model, const std::string& curve, const std::string& why, Fit& fit) {
  const std::vector<double> values = model.values();
  std::vector<std::string> names{curve};
  for (const auto& derived : model.system->derived_curves(values.data())) {
    if (std::any_of(derived.terms.begin(), derived.terms.end(), [&](const auto& term) { return term.curve == curve; }))
      names.push_back(derived.name);
  }
  for (auto& estimate : fit.curves) {
    if (std::find(names.begin(), names.end(), estimate.name) == names.end()) continue;
    estimate.informative = false;
    estimate.why = why;
  }
}

namespace {

/// A zero with negative slope, between grid points `after` − 1 and `after`.
struct StableZero {
  std::size_t after = 0;
  double count = 0.0;
  Estimate at;
};

std::vector<StableZero> stable_zeros(const CurveEstimate& curve) {
  std::vector<StableZero> out;
  for (std::size_t i = 1; i < curve.x.size(); ++i) {
    const double a = curve.value[i - 1], b = curve.value[i];
    const double count = curve.count[i - 1] + curve.count[i];
    if (!(a > 0.0) || !(b <= 0.0) || !(curve.x[i - 1] > 0.0) || !(count > 0.0)) continue;
    const double step = curve.x[i] - curve.x[i - 1];
    const double fraction = a / (a - b);
    const double sigma = curve.sigma[i - 1] + fraction * (curve.sigma[i] - curve.sigma[i - 1]);
    out.push_back({i, count, {curve.x[i - 1] + fraction * step, sigma / ((a - b) / step), curve.of_unit}});
  }
  return out;
}

/// Does the curve leave 0 between two of its stable zeros, below and then above, by more than its band?
bool separated(const CurveEstimate& curve, const StableZero& a, const StableZero& b) {
  constexpr double sigmas = 3.0;
  bool below = false, above = false;
  for (std::size_t i = a.after; i < b.after; ++i) {
    below = below || curve.value[i] < -sigmas * curve.sigma[i];
    above = above || (below && curve.value[i] > sigmas * curve.sigma[i]);
  }
  return below && above;
}

}  // namespace

std::optional<Estimate> stable_zero(const CurveEstimate& curve) {
  const std::vector<StableZero> zeros = stable_zeros(curve);
  const auto most = std::max_element(zeros.begin(), zeros.end(), [](const auto& a, const auto& b) { return a.count < b.count; });
  return most == zeros.end() ? std::nullopt : std::optional(most->at);
}

void warn_of_other_trims(Fit& fit) {
  for (const auto& curve : fit.curves) {
    if (!curve.trimmed || !curve.informative) continue;
    std::vector<StableZero> apart;
    for (const auto& zero : stable_zeros(curve)) {
      if (apart.empty() || separated(curve, apart.back(), zero)) apart.push_back(zero);
    }
    if (apart.size() < 2) continue;
    std::string where;
    for (const auto& zero : apart) where += (where.empty() ? "" : ", ") + in_display_unit(zero.at.value, zero.at.unit, zero.at.sigma);
    fit.warnings.push_back(curve.name + " has " + std::to_string(apart.size()) + " stable zeros among the values visited: " + where +
                           "; the trim given is the one where the most samples were");
  }
}

}  // namespace misfit
