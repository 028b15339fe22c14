// The common case of the right-hand side's derivatives, written for speed: see Evaluator::linearise_rates_simply.

#include <algorithm>
#include <array>
#include <utility>

#include "misfit/model/evaluator.h"

namespace misfit {

/// Whether the slots remembered of a curve are still those of its four parameters: slots may have been cleared, or be another object.
bool Evaluator::slots_hold(const CurveState& state, int first, const Slots& slots) const {
  if (state.slots_for != first) return false;
  for (int w = 0; w < 4; ++w) {
    const int column = column_of_[first + w];
    if (column >= 0 && !slots.holds(state.slots[w], column)) return false;
  }
  return true;
}

void Evaluator::find_slots(CurveState& state, int first, Slots& slots) const {
  for (int w = 0; w < 4; ++w) {
    const int column = column_of_[first + w];
    state.slots[w] = column < 0 ? -1 : slots.slot(column);
  }
  state.slots_for = first;
}

void Evaluator::evaluate_curves(Slots& slots) {
  for (int k : dynamic_curves_) {
    CurveState& state = curve_[k];
    const Curve& curve = model_->curves[k];
    const double at = q_[state.quantity];
    if (state.twin >= 0 && curve.spline.covers(at)) {
      state.point = curve_[state.twin].point;
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

/// Order of the numbers as in gather(): quantities, coefficients, own states, constants. A quantity that is absent stays 0.
void Evaluator::plan_effect(const Use& use) {
  const int width = use.nq + use.nc + use.nz + (constants_in_rates_ ? use.nk : 0);
  Plan plan{use.effect, width, use.nq, use.nc, use.nz, use.first_state, {}, {}, {}, {}, {}, {}, use.input, {}};
  plan.values.assign(use.nq + use.nc + use.nz + use.nk, 0.0);
  for (int i = 0; i < use.nq; ++i) {
    const int quantity = use.quantity[i];
    if (quantity >= 0) plan.quantities.push_back({i, quantity});
  }
  for (int i = 0; i < use.nc; ++i) {
    const int curve = use.curve[i], parameter = use.parameter[i];
    if (curve >= 0) {
      plan.curves.push_back({use.nq + i, curve});
      continue;
    }
    plan.numbers.push_back({use.nq + i, parameter});
    const int column = column_of_[parameter];
    if (column >= 0) plan.columns.push_back({use.nq + i, column});
  }
  for (int i = 0; i < use.nk; ++i) {
    const int place = use.nq + use.nc + use.nz + i, constant = use.constant[i];
    plan.numbers.push_back({place, constant});
    const int column = column_of_[constant];
    if (constants_in_rates_ && column >= 0) plan.constants.push_back({place, column});
  }
  for (int o = 0; o < use.ports; ++o) {
    const int port = use.port[o];
    if (port >= 0) plan.outputs.push_back({o, port});
  }
  for (int i = 0; i < use.nz; ++i) plan.outputs.push_back({use.ports + i, nf_ + use.first_state + i});
  plans_.push_back(std::move(plan));
}

void Evaluator::fill_numbers() {
  for (auto& plan : plans_) {
    for (const Link& link : plan.numbers) plan.values[link.place] = p_[link.other];
  }
}

template <int NX>
void Evaluator::add_entries(Plan& plan, const Point& at, Slots& slots, double* drifts) {
  std::array<double, kMaxWidth> out;
  std::array<double, std::size_t{kMaxWidth} * kMaxWidth> J;
  double* values = plan.values.data();
  for (const Link& link : plan.quantities) values[link.place] = q_[link.other];
  for (const Link& link : plan.curves) values[link.place] = curve_[link.other].value;
  const double* coefficients = values + plan.nq;
  double* states = values + plan.nq + plan.nc;
  for (int i = 0; i < plan.nz; ++i) states[i] = own_states(at)[plan.first_state + i];
  plan.effect->linearise({values, coefficients, states, states + plan.nz, at.t, {&inputs_, plan.input.data()}}, out.data(), J.data(),
                         constants_in_rates_);
  for (const Link& output : plan.outputs) {
    const double value = out[output.place];
    if (output.other < nf_) {
      F_[output.other] += value;
    } else {
      drifts[output.other - nf_] = value;
    }
    chain_output<NX>(plan, output.other, J.data() + static_cast<std::ptrdiff_t>(output.place) * plan.width, slots);
  }
}

/// A quantity moves with free constants of the system as well.
void Evaluator::chain_constants(double weight, int quantity, int row, Slots& slots) {
  for (const Link& k : free_constants_in_rates_) {
    const double slope = q_k_[quantity * nk_ + k.place];
    if (slope != 0.0) entries_.push_back({row, slots.slot(k.other), weight * slope});
  }
}

/// One output's derivatives `j` by what its effect reads → by the states, into force_x_, and by parameters, as entries.
template <int NX>
void Evaluator::chain_output(const Plan& plan, int row, const double* j, Slots& slots) {
  const int nx = NX > 0 ? NX : nx_;
  // Kept out of memory so that the loop does not wait for its own stores.
  std::array<double, (NX > 0 ? NX : kMaxStates)> sum;
  std::fill_n(sum.begin(), nx, 0.0);
  const auto chain = [&](double weight, int quantity) {
    const double* from = q_x_.data() + static_cast<std::ptrdiff_t>(quantity) * nx;
    for (int x = 0; x < nx; ++x) sum[x] += weight * from[x];
  };
  for (const Link& link : plan.quantities) {
    chain(j[link.place], link.other);
    if (constants_in_rates_) chain_constants(j[link.place], link.other, row, slots);
  }
  for (const Link& link : plan.constants) entries_.push_back({row, slots.slot(link.other), j[link.place]});
  for (const Link& link : plan.columns) entries_.push_back({row, slots.slot(link.other), j[link.place]});
  for (const Link& link : plan.curves) {
    const CurveState& curve = curve_[link.other];
    chain(j[link.place] * curve.slope, curve.quantity);
    if (constants_in_rates_) chain_constants(j[link.place] * curve.slope, curve.quantity, row, slots);
    if (curve.free) curve_entries_.push_back({row, link.other, j[link.place]});
  }
  double* by_x = force_x_.data() + static_cast<std::ptrdiff_t>(row) * n_;
  for (int x = 0; x < nx; ++x) by_x[x] += sum[x];
  const double* by_own = j + plan.nq + plan.nc;
  for (int i = 0; i < plan.nz; ++i) by_x[nx + plan.first_state + i] += by_own[i];
}

template <int NX, int N>
void Evaluator::linearise_rates_simply(const Point& at, Slots& slots, double* dx, double* D) {
  const int nx = NX > 0 ? NX : nx_;
  const int n = N > 0 ? N : n_;
  system_->linearise_quantities(at, needed_, q_.data(), {q_x_.data(), nullptr, constants_in_rates_ ? q_k_.data() : nullptr});
  evaluate_curves(slots);
  for (int f = 0; f < nf_; ++f) F_[f] = 0.0;
  for (double& value : force_x_) value = 0.0;
  entries_.clear();
  curve_entries_.clear();
  for (auto& plan : plans_) add_entries<NX>(plan, at, slots, dx + nx);
  system_->linearise_rates(at, F_.data(), dx, {r_x_.data(), nullptr, r_F_.data(), constants_in_rates_ ? r_k_.data() : nullptr});

  slot_entries_.clear();
  for (int i = 0; i < n; ++i) {
    std::array<double, (N > 0 ? N : kMaxStates)> sum;
    for (int x = 0; x < n; ++x) sum[x] = i < nx && x < nx ? r_x_[i * nx + x] : 0.0;
    // A state takes `weight` times a force; a memory's drift stands for itself.
    const int forces = i < nx ? nf_ : 1;
    for (int f = 0; f < forces; ++f) {
      const double weight = i < nx ? r_F_[i * nf_ + f] : 1.0;
      const int from = i < nx ? f : nf_ + i - nx;
      if (weight == 0.0) continue;
      const double* by_x = force_x_.data() + static_cast<std::ptrdiff_t>(from) * n;
      for (int x = 0; x < n; ++x) sum[x] += weight * by_x[x];
      take_entries(weight, from, i);
    }
    for (const Link& k : free_constants_in_rates_) {
      const double slope = i < nx ? r_k_[i * nk_ + k.place] : 0.0;
      if (slope != 0.0) slot_entries_.push_back({i, slots.slot(k.other), slope});
    }
    double* row = D + i * kRowStride;
    for (int x = 0; x < n; ++x) row[x] = sum[x];
  }
}

void Evaluator::take_entries(double weight, int from, int to) {
  for (const Entry& entry : entries_) {
    if (entry.row == from) slot_entries_.push_back({to, entry.slot, weight * entry.value});
  }
  for (const CurveEntry& entry : curve_entries_) {
    if (entry.row != from) continue;
    const CurveState& curve = curve_[entry.curve];
    const double factor = weight * entry.value;
    const CurvePoint& point = *curve.point;
    for (std::size_t w = 0; w < 4; ++w) {
      if (curve.slots[w] >= 0) slot_entries_.push_back({to, curve.slots[w], factor * point.w[w]});
    }
  }
}

bool Evaluator::linearise_rates_sparsely(const Instant& instant, Slots& slots, double* dx, double* D) {
  if (general_rates_ || own_elsewhere_) return false;
  const Point at = point(instant);
  // The number of states of the usual systems is given to the compiler, and that there is no memory besides; 0: any.
  if (nx_ == 2) {
    n_ == 2 ? linearise_rates_simply<2, 2>(at, slots, dx, D) : linearise_rates_simply<2, 0>(at, slots, dx, D);
  } else if (nx_ == 4) {
    n_ == 4 ? linearise_rates_simply<4, 4>(at, slots, dx, D) : linearise_rates_simply<4, 0>(at, slots, dx, D);
  } else {
    linearise_rates_simply<0, 0>(at, slots, dx, D);
  }
  return true;
}

}  // namespace misfit
