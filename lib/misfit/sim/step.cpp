#include "misfit/sim/step.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

#include "misfit/core/lists.h"
#include "misfit/core/text.h"
#include "misfit/core/units.h"
#include "misfit/core/watch.h"

namespace misfit {
namespace {

// Classical Runge–Kutta: where each stage stands, and its weight.
constexpr std::array<double, 4> stage_at = {0.0, 0.5, 0.5, 1.0};
constexpr std::array<double, 4> stage_weight = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};

constexpr std::ptrdiff_t row_at(int i) { return i * kRowStride; }

/// kRowPadding columns of a row at once.
using Block = Eigen::Array<double, kRowPadding, 1>;
Eigen::Map<const Block> block(const double* at) { return Eigen::Map<const Block>(at); }
Eigen::Map<Block> block(double* at) { return Eigen::Map<Block>(at); }

}  // namespace

Stepper::Stepper(const Model& model) : evaluator_(model), n_(model.states()), nu_(model.inputs()) {
  for (const auto& input : model.system->spec().inputs) holds_.push_back(input.hold);
  const auto& states = model.system->spec().states;
  for (int i = 0; i < int_size(states); ++i) {
    if (std::isfinite(states[i].lower) || std::isfinite(states[i].upper)) ranges_.push_back({i, states[i].lower, states[i].upper});
  }
  const auto size = n_ * kRowStride;
  L_.assign(size, 0.0);
  X_.assign(size, 0.0);
  Y_.assign(size, 0.0);
  sum_.assign(size, 0.0);
}

void Stepper::prepare(const double* x, const InputsAt& u, double t, double planned) {
  fastest_rate_ = evaluator_.fastest_rate(x, u, t);
  excess_ = std::max(fastest_rate_ - planned, 0.0);
  failure_.clear();
}

double Stepper::linearised_rate(const double* x, const Interval& interval, double fraction) {
  std::array<double, kMaxInputs> u{};
  std::array<double, kMaxStates> dx{};
  Slots slots;
  const InputsAt inputs = inputs_at(interval, fraction, u.data());
  evaluator_.linearise_rates({x, inputs, interval.t0 + fraction * (interval.t1 - interval.t0)}, slots, dx.data(), L_.data());
  double fastest = 0.0;
  for (int i = 0; i < n_; ++i) {
    for (int j = i; j < n_; ++j) {
      const double both = std::sqrt(std::abs(*(L_.data() + row_at(i) + j) * *(L_.data() + row_at(j) + i)));
      if (std::isfinite(both)) fastest = std::max(fastest, both);
    }
  }
  return fastest;
}

bool Stepper::finite(const double* x) const {
  return std::all_of(x, x + n_, [](double value) { return std::isfinite(value); });
}

/// A state at its bound no longer depends on where it came from.
void Stepper::keep_in_range(double* x, double* D, int width) const {
  for (const Range& range : ranges_) {
    if (x[range.state] >= range.lower && x[range.state] <= range.upper) continue;
    if (!std::isfinite(x[range.state])) continue;
    x[range.state] = x[range.state] < range.lower ? range.lower : range.upper;
    if (D != nullptr) std::fill_n(D + row_at(range.state), width, 0.0);
  }
}

/// Calls advance(share, implicit) for every step of an interval, until it returns false.
template <class Advance>
bool Stepper::for_each_part(const Interval& interval, const Advance& advance) const {
  static constexpr StepPart whole{};
  const int most_explicit = interval.parts.empty() ? 100 : 16;  // an implicit step costs about as much as sixteen explicit ones
  double from = 0.0;
  for (const StepPart& part : interval.parts.empty() ? std::span(&whole, 1) : interval.parts) {
    const int wanted = part.implicit ? 1 : pieces_of(interval, from, part);
    const bool implicit = part.implicit || wanted > most_explicit;
    const int pieces = implicit ? 1 : wanted;
    const double length = part.to - from;
    for (int k = 0; k < pieces; ++k) {
      look_at_watch();
      if (!advance(Share{from + length * k / pieces, k + 1 == pieces ? part.to : from + length * (k + 1) / pieces}, implicit)) return false;
    }
    from = part.to;
  }
  return true;
}

/// Into how many explicit steps a part is divided: without a plan as the fastest rate asks, with one only where the rate has far outgrown
/// it. Where those were too many, one implicit step is made: a search that tries a fast parameter must not cost a thousand
/// times as much there.
int Stepper::pieces_of(const Interval& interval, double from, const StepPart& part) const {
  constexpr double most = 1000.0, far_beyond = 1.0;
  const bool planned = !interval.parts.empty();
  const double rate = planned ? interval.rate + excess_ : fastest_rate_;
  const double product = rate * std::abs((part.to - from) * (interval.t1 - interval.t0));
  if (product <= (planned ? far_beyond : kLargestProduct) || (planned && excess_ == 0.0)) return 1;
  const double wanted = std::ceil(product / kLargestProduct);
  return static_cast<int>(std::clamp(std::isfinite(wanted) ? wanted : 1.0, 1.0, most));
}

InputsAt Stepper::inputs_at(const Interval& interval, double fraction, double* u) const {
  for (int i = 0; i < nu_; ++i) u[i] = input_within(holds_[i], interval.u0, interval.u1, i, fraction, interval.t1 - interval.t0).value;
  InputsAt out{u, interval.u0.record, interval.t0, interval.t1};
  out.before = interval.u0.before;
  return out;
}

void Stepper::explicit_step(double* x, const Interval& interval, const Share& share) {
  const double h = (share.to - share.from) * (interval.t1 - interval.t0);
  std::array<double, kMaxStates> stage, sum, dx{};
  std::array<double, kMaxInputs> u{};
  std::copy_n(x, n_, sum.begin());
  std::copy_n(x, n_, stage.begin());
  for (std::size_t s = 0; s < 4; ++s) {
    if (s > 0) {
      for (int i = 0; i < n_; ++i) stage[i] = x[i] + h * stage_at[s] * dx[i];
    }
    const double fraction = share.from + stage_at[s] * (share.to - share.from);
    const InputsAt inputs = inputs_at(interval, fraction, u.data());
    evaluator_.rates(stage.data(), inputs, interval.t0 + fraction * (interval.t1 - interval.t0), dx.data());
    for (int i = 0; i < n_; ++i) sum[i] += h * stage_weight[s] * dx[i];
  }
  std::copy_n(sum.begin(), n_, x);
  if (!ranges_.empty()) keep_in_range(x, nullptr, 0);
}

/// solve(radau, h, stages) over the share.
template <class Solve>
bool Stepper::implicit_step(const Interval& interval, const Share& share, const Solve& solve) {
  if (!radau_) radau_ = std::make_unique<RadauStep>(evaluator_);
  const double length = share.to - share.from;
  RadauInputs at;
  for (std::size_t s = 0; s < at.t.size(); ++s) {
    const double fraction = share.from + RadauStep::stage_at[s] * length;
    at.t[s] = interval.t0 + fraction * (interval.t1 - interval.t0);
    at.u[s] = inputs_at(interval, fraction, at.values[s].data());
  }
  return solve(*radau_, length * (interval.t1 - interval.t0), at);
}

/// The same; where Newton's iteration does not converge, in halves, up to 64 of them: parameters that a search tries.
template <class Solve>
bool Stepper::implicit_steps(const Interval& interval, const Share& share, const Solve& solve) {
  constexpr int most_pieces = 64;
  int pieces = 1;
  for (int k = 0; k < pieces;) {
    const double length = (share.to - share.from) / pieces;
    if (implicit_step(interval, {share.from + length * k, share.from + length * (k + 1)}, solve)) {
      ++k;
      continue;
    }
    if (2 * pieces > most_pieces) return false;
    pieces *= 2;
    k *= 2;
  }
  return true;
}

bool Stepper::solve_implicitly(RadauStep& radau, double* x, double h, const RadauInputs& at) const {
  if (!radau.step(x, h, at)) return false;
  if (!ranges_.empty()) keep_in_range(x, nullptr, 0);
  return true;
}

bool Stepper::advance(double* x, const Interval& interval, double from, const StepPart& part) {
  look_at_watch();
  const Share share{from, part.to};
  if (part.implicit)
    return implicit_step(interval, share,
                         [&](RadauStep& radau, double h, const RadauInputs& at) { return solve_implicitly(radau, x, h, at); });
  explicit_step(x, interval, share);
  return finite(x);
}

bool Stepper::step(double* x, const Interval& interval) {
  std::array<double, kMaxStates> start;
  std::copy_n(x, n_, start.begin());
  const auto solve = [&](RadauStep& radau, double h, const RadauInputs& at) { return solve_implicitly(radau, x, h, at); };
  const bool solved = for_each_part(interval, [&](const Share& share, bool implicit) {
    if (implicit) return implicit_steps(interval, share, solve);
    explicit_step(x, interval, share);
    return true;
  });
  if (solved && finite(x)) return true;
  note_failure(start.data(), interval);
  return false;
}

/// Goes through the interval again, to the step at which it fails.
void Stepper::note_failure(const double* x, const Interval& interval) {
  std::array<double, kMaxStates> at{};
  std::copy_n(x, n_, at.begin());
  static_cast<void>(for_each_part(interval, [&](const Share& share, bool implicit) {
    const std::array<double, kMaxStates> before = at;
    const auto solve = [&](RadauStep& radau, double h, const RadauInputs& inputs) { return solve_implicitly(radau, at.data(), h, inputs); };
    if (implicit ? implicit_steps(interval, share, solve) : advance(at.data(), interval, share.from, {share.to, false})) return true;
    if (!explain_step(before.data(), interval, share)) {
      failure_ = "at t = " + format_value(interval.t0 + share.from * (interval.t1 - interval.t0)) +
                 " s: " + (implicit ? "the equations of an implicit step have no solution" : "a state grows beyond all numbers");
    }
    return false;
  }));
}

/// Says where the rates leave the finite numbers in the stages of an explicit step; false if they do not.
bool Stepper::explain_step(const double* x, const Interval& interval, const Share& share) {
  const double h = (share.to - share.from) * (interval.t1 - interval.t0);
  std::array<double, kMaxStates> stage{}, dx{};
  std::array<double, kMaxInputs> u{};
  for (const double weight : stage_at) {
    for (int i = 0; i < n_; ++i) stage[i] = x[i] + h * weight * dx[i];
    const double fraction = share.from + weight * (share.to - share.from), t = interval.t0 + fraction * (interval.t1 - interval.t0);
    const InputsAt inputs = inputs_at(interval, fraction, u.data());
    evaluator_.rates(stage.data(), inputs, t, dx.data());
    if (finite(stage.data()) && finite(dx.data())) continue;
    failure_ = "at t = " + format_value(t) + " s: ";
    const std::string why = evaluator_.explain(stage.data(), inputs, t);
    const auto& states = evaluator_.model().state_specs;
    for (std::size_t i = 0; why.empty() && i < states.size(); ++i)
      failure_ += (i == 0 ? "" : ", ") + states[i].name + " = " + format_value(stage[i]) +
                  (states[i].unit == "-" ? "" : " " + plain_si(states[i].unit));
    failure_ += why;
    return true;
  }
  return false;
}

/// One stage on rows of ∂/∂(x0, slots), L = [A | B], B as entries if sparse:  K = A X + [0 | B];  sum += h w K;  next = D + h a K (rows of
/// the next stage's state). The first stage starts the sum from D, the last one leaves it in D. Columns go in blocks of kRowPadding.
template <int N>
void Stepper::advance_rows(const Stage& of, const double* X, double* next, double* D) {
  const auto& [h, stage, width, sparse] = of;
  const int n = N > 0 ? N : n_;
  const bool first = stage == 0, last = stage + 1 == stage_at.size();
  const double to_sum = h * stage_weight[stage];
  const double to_next = last ? 0.0 : h * stage_at[stage + 1];
  const double* sum_before = first ? D : sum_.data();
  double* sum = last ? D : sum_.data();
  constexpr std::size_t rows = N > 0 ? N : kMaxStates;
  std::array<double, rows * rows> A;
  for (int i = 0; i < n; ++i) {
    double* row = L_.data() + row_at(i);
    for (int j = 0; j < n; ++j) A[i * n + j] = row[j];
    if (!sparse) std::fill_n(row, n, 0.0);  // what is left is [0 | B]
  }
  std::array<Block, rows> x;
  for (int c = 0; c < width; c += kRowPadding) {
    for (int j = 0; j < n; ++j) x[j] = block(X + row_at(j) + c);
    for (int i = 0; i < n; ++i) {
      const std::ptrdiff_t at = row_at(i) + c;
      Block K = A[i * n + 0] * x[0];
      for (int j = 1; j < n; ++j) K += A[i * n + j] * x[j];
      if (!sparse) K += block(L_.data() + at);
      if (!last) block(next + at) = block(D + at) + to_next * K;
      block(sum + at) = block(sum_before + at) + to_sum * K;
    }
  }
  if (!sparse) return;
  for (const Evaluator::Entry& entry : evaluator_.slot_entries()) {
    const std::ptrdiff_t at = row_at(entry.row) + n + entry.slot;
    sum[at] += to_sum * entry.value;
    if (!last) next[at] += to_next * entry.value;
  }
}

template <int N>
void Stepper::substep_linear(double* x, const Interval& interval, const Share& share, const SlotRows& by) {
  const int n = N > 0 ? N : n_;
  const auto& [from, to] = share;
  const auto& [slots, D] = by;
  const double h = (to - from) * (interval.t1 - interval.t0);
  std::array<double, (N > 0 ? N : kMaxStates)> stage, sum, dx{};
  std::array<double, kMaxInputs> u;
  InputsAt inputs;
  std::copy_n(x, n, stage.begin());
  std::copy_n(x, n, sum.begin());
  double* X = D;
  double* next = X_.data();
  for (std::size_t s = 0; s < stage_at.size(); ++s) {
    const double fraction = from + stage_at[s] * (to - from);
    if (s == 0 || stage_at[s] != stage_at[s - 1]) inputs = inputs_at(interval, fraction, u.data());
    if (s > 0) {
      for (int i = 0; i < n; ++i) stage[i] = x[i] + h * stage_at[s] * dx[i];
    }
    const int before = n + slots.count();
    const double t = interval.t0 + fraction * (interval.t1 - interval.t0);
    const bool sparse = evaluator_.linearise_rates_sparsely({stage.data(), inputs, t}, slots, dx.data(), L_.data());
    if (!sparse) evaluator_.linearise_rates({stage.data(), inputs, t}, slots, dx.data(), L_.data());
    const int width = n + slots.count();
    if (width > before) {  // columns met for the first time: nothing of them has moved the state yet
      const auto clear = [&](double* rows) {
        for (int i = 0; i < n; ++i) std::fill(rows + row_at(i) + before, rows + row_at(i) + width, 0.0);
      };
      clear(D);
      if (s > 0) {  // at the first stage X is D, and the sum is yet to begin
        clear(X);
        clear(sum_.data());
      }
    }
    advance_rows<N>({h, s, width, sparse}, X, next, D);
    X = next;
    next = X == X_.data() ? Y_.data() : X_.data();
    for (int i = 0; i < n; ++i) sum[i] += h * stage_weight[s] * dx[i];
  }
  std::copy_n(sum.begin(), n, x);
}

void Stepper::explicit_step_linear(double* x, const Interval& interval, const Share& share, const SlotRows& by) {
  // The number of states of the usual systems is given to the compiler; 0: any.
  switch (n_) {
    case 2:
      return substep_linear<2>(x, interval, share, by);
    case 3:
      return substep_linear<3>(x, interval, share, by);
    case 4:
      return substep_linear<4>(x, interval, share, by);
    case 6:
      return substep_linear<6>(x, interval, share, by);
    default:
      return substep_linear<0>(x, interval, share, by);
  }
}

bool Stepper::step_linear(double* x, const Interval& interval, Slots& slots, double* D) {
  slots.clear();
  std::array<double, kMaxStates> start;
  std::copy_n(x, n_, start.begin());
  for (int i = 0; i < n_; ++i) {
    double* row = D + i * kRowStride;
    for (int j = 0; j < n_; ++j) row[j] = i == j ? 1.0 : 0.0;
  }
  const auto keep = [&] {
    if (!ranges_.empty()) keep_in_range(x, D, n_ + slots.count());
  };
  const bool solved = for_each_part(interval, [&](const Share& share, bool implicit) {
    if (!implicit) {
      explicit_step_linear(x, interval, share, {slots, D});
      keep();
      return true;
    }
    return implicit_steps(interval, share, [&](RadauStep& radau, double h, const RadauInputs& at) {
      const bool fine = radau.step_linear(x, h, at, {slots, D});
      if (fine) keep();
      return fine;
    });
  });
  if (solved && finite(x)) return true;
  note_failure(start.data(), interval);
  return false;
}

}  // namespace misfit
