// The common case of the right-hand side's derivatives, written for speed: see Evaluator::linearise_rates_simply.

#include <array>

#include "misfit/model/evaluator.h"

namespace misfit {

/// Whether the slots remembered of a curve are still those of its four parameters: slots may have been cleared, or be another object.
bool Evaluator::slots_hold(const CurveState& state, int first, const Slots& slots) const {
  if (state.slots_for != first) return false;
  for (int w = 0; w < 4; ++w) {
    const int column = column_of_[static_cast<std::size_t>(first + w)];
    if (column >= 0 && !slots.holds(state.slots[static_cast<std::size_t>(w)], column)) return false;
  }
  return true;
}

void Evaluator::find_slots(CurveState& state, int first, Slots& slots) const {
  for (int w = 0; w < 4; ++w) {
    const int column = column_of_[static_cast<std::size_t>(first + w)];
    state.slots[static_cast<std::size_t>(w)] = column < 0 ? -1 : slots.slot(column);
  }
  state.slots_for = first;
}

void Evaluator::evaluate_curves(Slots& slots) {
  for (int k : dynamic_curves_) {
    CurveState& state = curve_[static_cast<std::size_t>(k)];
    const Curve& curve = model_->curves[static_cast<std::size_t>(k)];
    const double at = q_[static_cast<std::size_t>(state.quantity)];
    if (state.twin >= 0 && curve.spline.covers(at)) {
      state.point = curve_[static_cast<std::size_t>(state.twin)].point;
    } else {
      if (curve.over_sine) {
        state.own = curve.spline.over_sine(at);
      } else {
        curve.spline.evaluate(at, state.own);
      }
      state.point = &state.own;
    }
    const CurvePoint& point = *state.point;
    const int first = curve.first + point.first;
    const double* c = p_.data() + first;
    state.value = (point.w[0] * c[0] + point.w[1] * c[1]) + (point.w[2] * c[2] + point.w[3] * c[3]);
    state.slope = (point.d[0] * c[0] + point.d[1] * c[1]) + (point.d[2] * c[2] + point.d[3] * c[3]);
    if (state.free && !slots_hold(state, first, slots)) find_slots(state, first, slots);
  }
}

template <int NX>
void Evaluator::add_entries(const Use& use, const double* own, double t, Slots& slots, double* drifts) {
  const int nx = NX > 0 ? NX : nx_;
  std::array<double, kMaxWidth> values;
  std::array<double, kMaxWidth> out;
  std::array<double, static_cast<std::size_t>(kMaxWidth * kMaxWidth)> J;
  double* v = values.data();
  for (int i = 0; i < use.nq; ++i) {
    const int quantity = use.quantity[static_cast<std::size_t>(i)];
    *v++ = quantity < 0 ? 0.0 : q_[static_cast<std::size_t>(quantity)];
  }
  for (int i = 0; i < use.nc; ++i) {
    const auto index = static_cast<std::size_t>(i);
    *v++ = use.curve[index] >= 0 ? curve_[static_cast<std::size_t>(use.curve[index])].value
                                 : p_[static_cast<std::size_t>(use.parameter[index])];
  }
  for (int i = 0; i < use.nz; ++i) *v++ = own[use.first_state + i];
  for (int i = 0; i < use.nk; ++i) *v++ = p_[static_cast<std::size_t>(use.constant[static_cast<std::size_t>(i)])];
  use.effect->linearise(reads(use, values.data(), t), out.data(), J.data(), false);

  for (int o = 0; o < use.outputs; ++o) {
    int row = 0;
    if (o < use.ports) {
      row = use.port[static_cast<std::size_t>(o)];
      if (row < 0) continue;
      F_[static_cast<std::size_t>(row)] += out[static_cast<std::size_t>(o)];
    } else {
      const int state = use.first_state + o - use.ports;
      drifts[state] = out[static_cast<std::size_t>(o)];
      row = nf_ + state;
    }
    std::array<double, (NX > 0 ? NX : kMaxStates)>
        sum{};  // by the system's states; kept out of memory so that the loop does not wait for its own stores
    const double* j = J.data() + static_cast<std::ptrdiff_t>(o) * use.width;
    const auto chain = [&](double weight, int quantity) {
      const double* from = q_x_.data() + static_cast<std::ptrdiff_t>(quantity) * nx;
      for (int x = 0; x < nx; ++x) sum[static_cast<std::size_t>(x)] += weight * from[x];
    };
    for (int i = 0; i < use.nq; ++i, ++j) {
      if (use.quantity[static_cast<std::size_t>(i)] >= 0) chain(*j, use.quantity[static_cast<std::size_t>(i)]);
    }
    for (int i = 0; i < use.nc; ++i, ++j) {
      const auto index = static_cast<std::size_t>(i);
      if (use.curve[index] < 0) {
        const int column = column_of_[static_cast<std::size_t>(use.parameter[index])];
        if (column >= 0) entries_.push_back({row, slots.slot(column), *j});
        continue;
      }
      const CurveState& curve = curve_[static_cast<std::size_t>(use.curve[index])];
      chain(*j * curve.slope, curve.quantity);
      if (curve.free) curve_entries_.push_back({row, use.curve[index], *j});
    }
    double* by_x = force_x_.data() + static_cast<std::ptrdiff_t>(row) * n_;
    for (int x = 0; x < nx; ++x) by_x[x] += sum[static_cast<std::size_t>(x)];
    for (int i = 0; i < use.nz; ++i, ++j) by_x[nx + use.first_state + i] += *j;
  }
}

template <int NX>
void Evaluator::linearise_rates_simply(const Point& at, Slots& slots, double* dx, double* D) {
  const int nx = NX > 0 ? NX : nx_;
  system_->linearise_quantities(at, P_.data(), needed_, q_.data(), {q_x_.data(), nullptr, nullptr});
  evaluate_curves(slots);
  for (int f = 0; f < nf_; ++f) F_[static_cast<std::size_t>(f)] = 0.0;
  for (double& value : force_x_) value = 0.0;
  entries_.clear();
  curve_entries_.clear();
  for (const auto& use : dynamic_) add_entries<NX>(use, at.x + nx, at.t, slots, dx + nx);
  system_->linearise_rates(at, P_.data(), F_.data(), dx, {r_x_.data(), nullptr, r_F_.data(), nullptr});

  slot_entries_.clear();
  for (int i = 0; i < n_; ++i) {
    double* row = D + static_cast<std::ptrdiff_t>(i) * kRowStride;
    for (int x = 0; x < n_; ++x) row[x] = i < nx && x < nx ? r_x_[static_cast<std::size_t>(i * nx + x)] : 0.0;
    // A state takes `weight` times a force; a memory's drift stands for itself.
    const int forces = i < nx ? nf_ : 1;
    for (int f = 0; f < forces; ++f) {
      const double weight = i < nx ? r_F_[static_cast<std::size_t>(i * nf_ + f)] : 1.0;
      const int from = i < nx ? f : nf_ + i - nx;
      if (weight == 0.0) continue;
      const double* by_x = force_x_.data() + static_cast<std::ptrdiff_t>(from) * n_;
      for (int x = 0; x < n_; ++x) row[x] += weight * by_x[x];
      take_entries(weight, from, i);
    }
  }
}

void Evaluator::take_entries(double weight, int from, int to) {
  for (const Entry& entry : entries_) {
    if (entry.row == from) slot_entries_.push_back({to, entry.slot, weight * entry.value});
  }
  for (const CurveEntry& entry : curve_entries_) {
    if (entry.row != from) continue;
    const CurveState& curve = curve_[static_cast<std::size_t>(entry.curve)];
    const double factor = weight * entry.value;
    for (std::size_t w = 0; w < 4; ++w) {
      if (curve.slots[w] >= 0) slot_entries_.push_back({to, curve.slots[w], factor * curve.point->w[w]});
    }
  }
}

bool Evaluator::linearise_rates_sparsely(const double* x, const double* u, double t, Slots& slots, double* dx, double* D) {
  if (general_ || own_elsewhere_) return false;
  const Point at{x, u, t, p_.data()};
  // The number of states of the usual systems is given to the compiler; 0: any.
  if (nx_ == 2) {
    linearise_rates_simply<2>(at, slots, dx, D);
  } else if (nx_ == 4) {
    linearise_rates_simply<4>(at, slots, dx, D);
  } else {
    linearise_rates_simply<0>(at, slots, dx, D);
  }
  return true;
}

}  // namespace misfit
