// Derivatives of the assembled right-hand side: the chain rule over effects that are each linearised on their own.

#include <algorithm>
#include <cmath>

#include "misfit/model/evaluator.h"

namespace misfit {
namespace {

double* row_of(std::vector<double>& rows, int i) { return rows.data() + i * kRowStride; }
const double* row_of(const std::vector<double>& rows, int i) { return rows.data() + i * kRowStride; }

void add_scaled(double weight, const double* from, int count, double* to) {
  for (int i = 0; i < count; ++i) to[i] += weight * from[i];
}

}  // namespace

/// row += weight · dq/d(state, slots). In the common case (no effect on quantity ports, no free constant) quantities depend on the state
/// alone.
void Evaluator::chain_quantity(double weight, int quantity, int slots, double* row) const {
  if (!general_ && quantity < nq_) {
    add_scaled(weight, q_x_.data() + static_cast<std::ptrdiff_t>(quantity) * nx_, nx_, row);
    return;
  }
  const double* from = row_of(q_rows_, quantity);
  add_scaled(weight, from, n_ + slots, row);
}

/// Numbers that the effect reads (order of gather()), with the curves behind its coefficients, and its outputs' derivatives by them.
void Evaluator::linearise_effect(const Use& use, const Point& at, Linearisation& l) const {
  double* v = l.values.data();
  for (int i = 0; i < use.nq; ++i) {
    const int quantity = use.quantity[i];
    *v++ = quantity < 0 ? 0.0 : q_[quantity];
  }
  for (int i = 0; i < use.nc; ++i) {
    const std::size_t index = i;
    if (use.curve[index] < 0) {
      *v++ = p_[use.parameter[index]];
      continue;
    }
    const Curve& curve = model_->curves[use.curve[index]];
    const double place = q_[curve.quantity];
    l.points[index] = curve.over_sine ? curve.spline.over_sine(place) : curve.spline.at(place);
    const CurvePoint& point = l.points[index];
    const double* c = p_.data() + curve.first + point.first;
    *v++ = point.w[0] * c[0] + point.w[1] * c[1] + point.w[2] * c[2] + point.w[3] * c[3];
    l.slope[index] = point.d[0] * c[0] + point.d[1] * c[1] + point.d[2] * c[2] + point.d[3] * c[3];
  }
  for (int i = 0; i < use.nz; ++i) *v++ = own_states(at)[use.first_state + i];
  for (int i = 0; i < use.nk; ++i) *v++ = p_[use.constant[i]];
  use.effect->linearise(reads(use, l.values.data(), at.t), l.out.data(), l.J.data(), free_constants_);
}

/// row += derivatives of one output of the effect by the state and the slots.
void Evaluator::chain_effect(const Use& use, const Linearisation& l, int output, Slots& slots, double* row) const {
  const double* j = l.J.data() + static_cast<std::ptrdiff_t>(output) * use.width;
  for (int i = 0; i < use.nq; ++i, ++j) {
    const int quantity = use.quantity[i];
    if (quantity >= 0 && *j != 0.0) chain_quantity(*j, quantity, slots.count(), row);
  }
  for (int i = 0; i < use.nc; ++i, ++j) {
    const std::size_t index = i;
    if (*j == 0.0) continue;
    if (use.curve[index] < 0) {
      const int column = column_of_[use.parameter[index]];
      if (column >= 0) row[n_ + slots.slot(column)] += *j;
      continue;
    }
    const Curve& curve = model_->curves[use.curve[index]];
    chain_quantity(*j * l.slope[index], curve.quantity, slots.count(), row);
    const int first = curve.first + l.points[index].first;
    for (int w = 0; w < 4; ++w) {
      const int column = column_of_[first + w];
      if (column >= 0) row[n_ + slots.slot(column)] += *j * l.points[index].w[w];
    }
  }
  for (int i = 0; i < use.nz; ++i, ++j) row[nx_ + use.first_state + i] += *j;
  if (!free_constants_) return;
  for (int i = 0; i < use.nk; ++i, ++j) {
    const int column = column_of_[use.constant[i]];
    if (column >= 0 && *j != 0.0) row[n_ + slots.slot(column)] += *j;
  }
}

/// Adds an effect's outputs to the ports with derivative rows rows[port·kRowStride + …], and sets its own states' drifts and rows. Rows
/// are kept zero beyond the slots in use: a slot that is met for the first time needs no clearing.
void Evaluator::add_linear(const Use& use, const Point& at, Slots& slots, const Targets& to) {
  Linearisation& l = linearisation_;
  linearise_effect(use, at, l);
  for (int o = 0; o < use.ports && to.rows != nullptr; ++o) {
    const int port = use.port[o];
    if (port < 0) continue;
    to.ports[port] += l.out[o];
    chain_effect(use, l, o, slots, to.rows + port * kRowStride);
  }
  for (int o = use.ports; o < use.outputs && to.drift_rows != nullptr; ++o) {
    const int state = use.first_state + o - use.ports;
    to.drifts[state] = l.out[o];
    chain_effect(use, l, o, slots, to.drift_rows + state * kRowStride);
  }
}

void Evaluator::base_and_derived_linear(const Point& at, Slots& slots) {
  if (!general_) {
    system_->linearise_quantities(at, needed_, q_.data(), {q_x_.data(), nullptr, nullptr});
    return;
  }
  const int width = n_ + columns_;
  const auto rows_from_blocks = [&](bool with_ports) {
    for (int i = 0; i < nq_; ++i) {
      if (!is_needed(needed_, i)) continue;
      double* row = row_of(q_rows_, i);
      std::fill(row, row + width, 0.0);
      std::copy_n(q_x_.data() + static_cast<std::ptrdiff_t>(i) * nx_, nx_, row);
      for (int P = 0; with_ports && P < np_; ++P) add_scaled(q_P_[i * np_ + P], row_of(P_rows_, P), n_ + slots.count(), row);
      for (int k = 0; free_constants_ && k < nk_; ++k) {
        const int column = column_of_[k];
        const double weight = q_k_[i * nk_ + k];
        if (column >= 0 && weight != 0.0) row[n_ + slots.slot(column)] += weight;
      }
    }
  };
  std::fill(P_.begin(), P_.begin() + np_, 0.0);
  double* k = free_constants_ ? q_k_.data() : nullptr;
  system_->linearise_quantities(at, needed_, q_.data(), {q_x_.data(), q_P_.data(), k});
  rows_from_blocks(false);
  if (!quantity_effects_) return;
  for (int P = 0; P < np_; ++P) std::fill_n(row_of(P_rows_, P), width, 0.0);
  for (const auto& use : quantity_) add_linear(use, at, slots, {.ports = P_.data(), .rows = P_rows_.data()});
  system_->linearise_quantities(at, needed_, q_.data(), {q_x_.data(), q_P_.data(), k});
  rows_from_blocks(true);
}

void Evaluator::linearise_rates(const Instant& instant, Slots& slots, double* dx, double* D) {
  if (linearise_rates_sparsely(instant, slots, dx, D)) {
    for (int i = 0; i < n_; ++i) std::fill_n(D + i * kRowStride + n_, columns_, 0.0);
    for (const Entry& entry : slot_entries_) D[entry.row * kRowStride + n_ + entry.slot] += entry.value;
    return;
  }
  const Point at = point(instant);
  base_and_derived_linear(at, slots);
  std::fill(F_.begin(), F_.begin() + nf_, 0.0);
  const int width = n_ + columns_;
  for (int i = 0; i < nf_; ++i) std::fill_n(row_of(F_rows_, i), width, 0.0);
  for (int i = nx_; i < n_; ++i) std::fill_n(D + i * kRowStride, width, 0.0);
  double* own_rows = D + nx_ * kRowStride;
  for (const auto& use : dynamic_) add_linear(use, at, slots, {F_.data(), F_rows_.data(), dx + nx_, own_rows});
  if (own_elsewhere_) own_drifts_linear(at, slots, dx + nx_, own_rows);

  RateDerivatives d{r_x_.data(), quantity_effects_ ? r_P_.data() : nullptr, r_F_.data(), free_constants_ ? r_k_.data() : nullptr};
  system_->linearise_rates(at, F_.data(), dx, d);
  for (int i = 0; i < nx_; ++i) {
    double* row = D + i * kRowStride;
    std::copy_n(r_x_.data() + static_cast<std::ptrdiff_t>(i) * nx_, nx_, row);
    std::fill(row + nx_, row + n_ + slots.count(), 0.0);
    for (int f = 0; f < nf_; ++f) {
      const double weight = r_F_[i * nf_ + f];
      if (weight != 0.0) add_scaled(weight, row_of(F_rows_, f), n_ + slots.count(), row);
    }
    for (int P = 0; quantity_effects_ && P < np_; ++P) {
      const double weight = r_P_[i * np_ + P];
      if (weight != 0.0) add_scaled(weight, row_of(P_rows_, P), n_ + slots.count(), row);
    }
    for (int k = 0; free_constants_ && k < nk_; ++k) {
      const int column = column_of_[k];
      const double weight = r_k_[i * nk_ + k];
      if (column >= 0 && weight != 0.0) {
        const int before = slots.count();
        const int slot = slots.slot(column);
        if (slot >= before) clear_new_slot(slot, i, D);
        row[n_ + slot] += weight;
      }
    }
  }
}

/// A constant that only the rates know was met after earlier rows were written.
void Evaluator::clear_new_slot(int slot, int rows, double* D) const {
  for (int i = 0; i <= rows; ++i) D[i * kRowStride + n_ + slot] = 0.0;
}

void Evaluator::own_drifts_linear(const Point& at, Slots& slots, double* drifts, double* own_rows) {
  const auto drift = [&](const Use& use) { add_linear(use, at, slots, {.drifts = drifts, .drift_rows = own_rows}); };
  for (const auto& use : quantity_) {
    if (use.nz > 0) drift(use);
  }
  if (std::any_of(sensor_.begin(), sensor_.end(), [](const Use& use) { return use.nz > 0; })) {
    outputs_as_quantities(at, slots);
    for (const auto& use : sensor_) {
      if (use.nz > 0) drift(use);
    }
  }
}

/// Predicted outputs before sensor effects, as quantities nq … nq + ny − 1 with rows.
void Evaluator::outputs_as_quantities(const Point& at, Slots& slots) {
  const OutputDerivatives d{y_x_.data(), outputs_read_ports_ ? y_P_.data() : nullptr, free_constants_ ? y_k_.data() : nullptr};
  system_->linearise_outputs(at, q_.data() + nq_, d);
  for (int i = 0; i < ny_; ++i) {
    double* row = row_of(q_rows_, nq_ + i);
    std::fill_n(row, n_ + columns_, 0.0);
    std::copy_n(y_x_.data() + static_cast<std::ptrdiff_t>(i) * nx_, nx_, row);
    for (int P = 0; outputs_read_ports_ && P < np_; ++P) {
      const double weight = y_P_[i * np_ + P];
      if (weight != 0.0) add_scaled(weight, row_of(P_rows_, P), n_ + slots.count(), row);
    }
    for (int k = 0; free_constants_ && k < nk_; ++k) {
      const int column = column_of_[k];
      const double weight = y_k_[i * nk_ + k];
      if (column >= 0 && weight != 0.0) row[n_ + slots.slot(column)] += weight;
    }
  }
}

/// No effect on a sensor, none on what an output is a formula of, and no free constant: outputs depend on the state alone.
void Evaluator::linearise_outputs_simply(const Point& at, const Slots& slots, double* y, double* D) {
  system_->linearise_outputs(at, y, {.x = y_x_.data()});
  for (int i = 0; i <= ny_; ++i) {
    double* row = D + i * kRowStride;
    for (int x = 0; x < n_; ++x) row[x] = i < ny_ && x < nx_ ? y_x_[i * nx_ + x] : 0.0;
    std::fill_n(row + n_, slots.count(), 0.0);
  }
  y[ny_] = 0.0;
}

void Evaluator::linearise_outputs(const Instant& instant, Slots& slots, double* y, double* D) {
  const Point at = point(instant);
  if (sensor_.empty() && !free_constants_ && !outputs_read_ports_) {
    linearise_outputs_simply(at, slots, y, D);
    return;
  }
  if (!sensor_.empty() || outputs_read_ports_) base_and_derived_linear(at, slots);
  outputs_as_quantities(at, slots);
  const int width = n_ + columns_;
  for (int i = 0; i < ny_; ++i) {
    y[i] = q_[nq_ + i];
    std::copy_n(row_of(q_rows_, nq_ + i), width, D + i * kRowStride);
  }
  for (int i = ny_; i < sensor_ports(); ++i) {
    y[i] = 0.0;
    std::fill_n(D + i * kRowStride, width, 0.0);
  }
  for (const auto& use : sensor_) add_linear(use, at, slots, {.ports = y, .rows = D});
}

}  // namespace misfit
