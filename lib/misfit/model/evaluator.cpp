#include "misfit/model/evaluator.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "misfit/core/lists.h"

namespace misfit {
namespace {

constexpr std::size_t at_least_one(int n) { return n > 0 ? n : 1; }

}  // namespace

Evaluator::Evaluator(const Model& model) : model_(&model), system_(model.system.get()), p_(model.values()) {
  const SystemSpec& spec = system_->spec();
  n_ = model.states();
  nx_ = model.system_states();
  ny_ = model.outputs();
  nf_ = int_size(spec.dynamic_ports);
  np_ = int_size(spec.quantity_ports);
  nq_ = int_size(spec.quantities);
  nk_ = int_size(spec.constants);
  flatten();
  const auto size = [](int rows, int columns) { return at_least_one(rows * columns); };
  q_rows_.assign(size(nq_ + ny_, kRowStride), 0.0);
  P_rows_.assign(size(np_, kRowStride), 0.0);
  F_rows_.assign(size(nf_ + sensor_ports(), kRowStride), 0.0);
  force_x_.assign(size(nf_ + n_ - nx_, n_), 0.0);
  q_x_.assign(size(nq_, nx_), 0.0);
  q_P_.assign(size(nq_, np_), 0.0);
  q_k_.assign(size(nq_, nk_), 0.0);
  r_x_.assign(size(nx_, nx_), 0.0);
  r_P_.assign(size(nx_, np_), 0.0);
  r_F_.assign(size(nx_, nf_), 0.0);
  r_k_.assign(size(nx_, nk_), 0.0);
  y_x_.assign(size(ny_, nx_), 0.0);
  y_P_.assign(size(ny_, np_), 0.0);
  y_k_.assign(size(ny_, nk_), 0.0);
}

void Evaluator::flatten() {
  const std::vector<int> free = model_->free_parameters();
  columns_ = int_size(free);
  column_of_.assign(model_->parameters.size(), -1);
  for (int c = 0; c < columns_; ++c) column_of_[free[c]] = c;
  for (int k = 0; k < nk_; ++k) free_constants_ = free_constants_ || column_of_[k] >= 0;
  for (const auto& bound : model_->effects) flatten_effect(bound);
  quantity_effects_ = !quantity_.empty();
  outputs_read_ports_ = quantity_effects_ && !system_->spec().ports_in_outputs.empty();
  general_ = quantity_effects_ || free_constants_;
  general_rates_ = quantity_effects_;
  constants_in_rates_ = rates_move_with_constants();
  for (int k = 0; constants_in_rates_ && k < nk_; ++k) {
    const int column = column_of_[k];
    if (column >= 0) free_constants_in_rates_.push_back({k, column});
  }
  find_twins();
  for (const auto& use : dynamic_) plan_effect(use);
  fill_numbers();
  const auto& outputs = system_->spec().outputs;
  const bool observed = std::all_of(outputs.begin(), outputs.end(), [](const OutputSpec& output) { return output.observes >= 0; });
  if (!observed || !sensor_.empty() || outputs_read_ports_) return;
  for (const auto& output : outputs) observed_.push_back(output.observes);
}

/// Whether a free constant acts on the rates: one that is not of the sensor, or one of the sensor that some effect on the motion reads.
bool Evaluator::rates_move_with_constants() const {
  const SystemSpec& spec = system_->spec();
  bool sensor_free = false;
  const auto free = [&](int k) { return column_of_[k] >= 0; };
  for (int k = 0; k < nk_; ++k) {
    if (!free(k)) continue;
    if (!spec.constants[k].of_sensor) return true;
    sensor_free = true;
  }
  const auto of_sensor = [&](int quantity) { return quantity >= 0 && quantity < nq_ && spec.quantities[quantity].of_sensor; };
  for (const auto& bound : model_->effects) {
    if (!sensor_free || bound.kind == PortKind::sensor) continue;
    for (int k : bound.constants) {
      if (free(k)) return true;
    }
    for (int quantity : bound.quantities) {
      if (of_sensor(quantity)) return true;
    }
    for (const auto& c : bound.coefficients) {
      if (c.curve >= 0 && of_sensor(model_->curves[c.curve].quantity)) return true;
    }
  }
  return false;
}

/// Curves of one quantity over the same knots share their weights inside them; what dynamic effects read is evaluated once per right-hand
/// side.
void Evaluator::find_twins() {
  const auto& curves = model_->curves;
  curve_.resize(curves.size());
  std::size_t max_entries = 0;
  for (const auto& use : dynamic_) {
    for (int i = 0; i < use.nc; ++i) {
      const int curve = use.curve[i];
      if (curve >= 0 && std::find(dynamic_curves_.begin(), dynamic_curves_.end(), curve) == dynamic_curves_.end())
        dynamic_curves_.push_back(curve);
    }
    const std::size_t outputs = use.outputs;
    max_entries += outputs * use.nc;
  }
  entries_.reserve(max_entries);
  curve_entries_.reserve(max_entries);
  slot_entries_.reserve(4 * max_entries * n_);
  std::sort(dynamic_curves_.begin(), dynamic_curves_.end());
  for (int k : dynamic_curves_) {
    const Curve& curve = curves[k];
    CurveState& state = curve_[k];
    state.quantity = curve.quantity;
    for (int i = 0; i < curve.spline.size(); ++i) state.free = state.free || column_of_[curve.first + i] >= 0;
    for (int earlier : dynamic_curves_) {
      const Curve& other = curves[earlier];
      const bool alike =
          earlier < k && other.quantity == curve.quantity && !curve.over_sine && !other.over_sine && curve.spline.same_inside(other.spline);
      if (alike && state.twin < 0) state.twin = earlier;
    }
  }
  for (const auto* list : {&quantity_, &sensor_}) {
    for (const auto& use : *list) own_elsewhere_ = own_elsewhere_ || use.nz > 0;
  }
}

void Evaluator::flatten_effect(const BoundEffect& bound) {
  const EffectSpec& spec = bound.effect->spec();
  Use use{};
  use.effect = bound.effect;
  use.nq = int_size(spec.quantities);
  use.nc = int_size(spec.coefficients);
  use.nz = int_size(spec.states);
  use.nk = int_size(spec.constants);
  use.ports = int_size(spec.ports);
  use.outputs = use.ports + use.nz;
  use.width = use.nq + use.nc + use.nz + (free_constants_ ? use.nk : 0);
  use.first_state = bound.first_state;
  const auto note = [&](int quantity) {
    if (quantity >= 0 && quantity < nq_) needed_ |= needed_bit(quantity);
  };
  for (std::size_t i = 0; i < bound.quantities.size(); ++i) {
    note(use.quantity[i] = bound.quantities[i]);
    use.input[i] = model_->input_of_quantity(bound.quantities[i]);
  }
  std::copy(bound.ports.begin(), bound.ports.end(), use.port.begin());
  std::copy(bound.constants.begin(), bound.constants.end(), use.constant.begin());
  for (std::size_t i = 0; i < bound.coefficients.size(); ++i) {
    use.parameter[i] = bound.coefficients[i].parameter;
    use.curve[i] = bound.coefficients[i].curve;
    if (use.curve[i] >= 0) note(model_->curves[use.curve[i]].quantity);
  }
  auto& list = bound.kind == PortKind::quantity ? quantity_ : bound.kind == PortKind::dynamic ? dynamic_ : sensor_;
  list.push_back(use);
  if (bound.kind != PortKind::sensor) return;
  for (const int port : bound.ports) {
    shifts_time_ = shifts_time_ || port >= ny_;
    shifts_apart_ = shifts_apart_ || port > ny_;
  }
}

void Evaluator::set_parameters(const double* values) {
  std::copy(values, values + p_.size(), p_.begin());
  fill_numbers();
}

double Evaluator::curve_value(const Curve& curve, double at) const {
  const CurvePoint point = curve.over_sine ? curve.spline.over_sine(at) : curve.spline.at(at);
  const double* c = p_.data() + curve.first + point.first;
  return point.w[0] * c[0] + point.w[1] * c[1] + point.w[2] * c[2] + point.w[3] * c[3];
}

/// Quantities, coefficients, own states, constants, in this order (the order of the seeds in EffectOf).
void Evaluator::gather(const Use& use, const double* own, double* values) const {
  double* v = values;
  for (int i = 0; i < use.nq; ++i) {
    const int quantity = use.quantity[i];
    *v++ = quantity < 0 ? 0.0 : q_[quantity];
  }
  for (int i = 0; i < use.nc; ++i) {
    const int curve = use.curve[i];
    if (curve < 0) {
      *v++ = p_[use.parameter[i]];
    } else {
      const Curve& c = model_->curves[curve];
      *v++ = curve_value(c, q_[c.quantity]);
    }
  }
  for (int i = 0; i < use.nz; ++i) *v++ = own[use.first_state + i];
  for (int i = 0; i < use.nk; ++i) *v++ = p_[use.constant[i]];
}

Reads<double, double> Evaluator::reads(const Use& use, const double* values, double t) const {
  return {values, values + use.nq, values + use.nq + use.nc, values + use.nq + use.nc + use.nz, t, {&inputs_, use.input.data()}};
}

void Evaluator::add_value(const Use& use, const Point& at, double* targets, double* drifts) {
  std::array<double, kMaxWidth> values;
  std::array<double, kMaxWidth> out;
  gather(use, own_states(at), values.data());
  use.effect->evaluate(reads(use, values.data(), at.t), out.data());
  for (int o = 0; o < use.ports; ++o) {
    const int port = use.port[o];
    if (port >= 0) targets[port] += out[o];
  }
  for (int i = 0; i < use.nz; ++i) drifts[use.first_state + i] = out[use.ports + i];
}

void Evaluator::base_and_derived(const Point& at) {
  std::fill(P_.begin(), P_.begin() + np_, 0.0);
  if (quantity_effects_) {
    system_->quantities(at, needed_, q_.data());
    std::array<double, kMaxStates> drifts{};
    for (const auto& use : quantity_) add_value(use, at, P_.data(), drifts.data());
  }
  system_->quantities(at, needed_, q_.data());
}

void Evaluator::rates(const double* x, const InputsAt& u, double t, double* dx) {
  const Point at = point({x, u, t});
  base_and_derived(at);
  std::fill(F_.begin(), F_.begin() + nf_, 0.0);
  for (const auto& use : dynamic_) add_value(use, at, F_.data(), dx + nx_);
  if (own_elsewhere_) own_drifts(at, dx + nx_);
  system_->rates(at, F_.data(), dx);
}

/// Memory of effects on quantity and sensor ports drifts as well.
void Evaluator::own_drifts(const Point& at, double* drifts) {
  std::array<double, kMaxPorts + kMaxSensorPorts> unused{};
  for (const auto& use : quantity_) {
    if (use.nz > 0) add_value(use, at, unused.data(), drifts);
  }
  if (std::any_of(sensor_.begin(), sensor_.end(), [](const Use& use) { return use.nz > 0; })) {
    system_->outputs(at, q_.data() + nq_);
    for (const auto& use : sensor_) {
      if (use.nz > 0) add_value(use, at, unused.data(), drifts);
    }
  }
}

void Evaluator::predict(const double* x, const InputsAt& u, double t, double* y) {
  const Point at = point({x, u, t});
  if (outputs_read_ports_ || !sensor_.empty()) base_and_derived(at);
  system_->outputs(at, y);
  std::fill(y + ny_, y + sensor_ports(), 0.0);
  if (sensor_.empty()) return;
  std::copy(y, y + ny_, q_.begin() + nq_);
  std::array<double, kMaxStates> drifts{};
  for (const auto& use : sensor_) add_value(use, at, y, drifts.data());
}

void Evaluator::quantities(const double* x, const InputsAt& u, double t, double* q) {
  const std::uint64_t needed = needed_;
  needed_ = ~std::uint64_t{0};
  const Point at = point({x, u, t});
  base_and_derived(at);
  needed_ = needed;
  std::copy(q_.begin(), q_.begin() + nq_, q);
}

/// How fast the quantity of the role `rate` changes per unit of the effect's first port: ∂q/∂x · ∂x'/∂F.
double Evaluator::response_of(const Use& use, const Point& at) {
  const auto& roles = use.effect->spec().quantities;
  const auto rate = std::find_if(roles.begin(), roles.end(), [](const Role& role) { return std::string_view(role.name) == "rate"; });
  const int quantity = rate == roles.end() ? -1 : use.quantity[rate - roles.begin()], port = use.port.front();
  if (quantity < 0 || quantity >= nq_ || port < 0) return 1.0;
  std::array<double, kMaxStates> dx{};
  std::fill(F_.begin(), F_.begin() + nf_, 0.0);
  system_->linearise_quantities(at, needed_, q_.data(), {q_x_.data(), q_P_.data(), nullptr});
  system_->linearise_rates(at, F_.data(), dx.data(), {r_x_.data(), nullptr, r_F_.data(), nullptr});
  double response = 0.0;
  for (int i = 0; i < nx_; ++i) response += q_x_[quantity * nx_ + i] * r_F_[i * nf_ + port];
  return std::abs(response);
}

double Evaluator::fastest_rate(const double* x, const InputsAt& u, double t) {
  const Point at = point({x, u, t});
  base_and_derived(at);
  system_->outputs(at, q_.data() + nq_);
  double fastest = system_->fastest_rate(at);
  std::array<double, kMaxWidth> values;
  for (const auto* list : {&quantity_, &dynamic_, &sensor_}) {
    for (const auto& use : *list) {
      gather(use, x + nx_, values.data());
      const double response = use.effect->responds() && list == &dynamic_ ? response_of(use, at) : 1.0;
      fastest = std::max(fastest, use.effect->fastest_rate(reads(use, values.data(), t), response));
    }
  }
  return fastest;
}

std::string Evaluator::explain(const double* x, const InputsAt& u, double t) {
  std::array<double, kMaxStates> dx{};
  rates(x, u, t, dx.data());
  return system_->explain(point({x, u, t}), F_.data());
}

void Evaluator::diffusion(const double* x, const InputsAt& u, double t, double* intensity) {
  const Point at = point({x, u, t});
  base_and_derived(at);
  system_->outputs(at, q_.data() + nq_);
  std::array<double, kMaxWidth> values;
  for (const auto* list : {&quantity_, &dynamic_, &sensor_}) {
    for (const auto& use : *list) {
      if (use.nz == 0) continue;
      gather(use, x + nx_, values.data());
      use.effect->diffusion(reads(use, values.data(), t), intensity + use.first_state);
    }
  }
}

}  // namespace misfit
