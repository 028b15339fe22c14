#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "misfit/model/model.h"
#include "misfit/model/recorded_inputs.h"

namespace misfit {

/// Rows are computed in multiples of this many columns, so that the compiler need not treat a remainder: columns beyond those in use hold
/// garbage.
inline constexpr int kRowPadding = 4;
[[nodiscard]] constexpr int padded(int width) { return (width + kRowPadding - 1) / kRowPadding * kRowPadding; }

/// The free parameters that act within one sample, in the order they were met ("touched columns"): slot s is column `column[s]`.
class Slots {
 public:
  Slots() { slot_of_.fill(-1); }
  [[nodiscard]] int count() const { return count_; }
  [[nodiscard]] int column(int slot) const { return column_[slot]; }
  int slot(int column) {
    auto& known = slot_of_[column];
    if (known < 0) {
      known = count_;
      column_[count_++] = column;
    }
    return known;
  }
  /// Whether a slot remembered from before, perhaps from other Slots, is that column here.
  [[nodiscard]] bool holds(int slot, int column) const { return slot < count_ && column_[slot] == column; }
  void clear() {
    for (int s = 0; s < count_; ++s) slot_of_[column_[s]] = -1;
    count_ = 0;
  }

 private:
  std::array<int, kMaxColumns> column_{};
  std::array<int, kMaxColumns> slot_of_{};
  int count_ = 0;
};

/// Derivative rows: columns 0 … states−1 for the state, then one column per slot. Fixed stride.
inline constexpr std::ptrdiff_t kRowStride = padded(kMaxStates + kMaxColumns);

/// Derivatives of the state, states() rows of kRowStride: D = [∂x | ∂ by slots].
struct SlotRows {
  Slots& slots;
  double* D;
};

/// State, inputs and time at which a model is evaluated.
struct Instant {
  const double* x;
  InputsAt u;
  double t;
};

/// The assembled right-hand side x' = f(x, u, t; p) and outputs y = h(x, u, t; p) with first derivatives, by the chain rule over effects
/// that are each linearised on their own (lib/misfit/README.md (1) to (5); its index spaces: 8.3). One object per thread: it holds scratch
/// memory, so that nothing allocates. Order: base quantities → effects on quantity ports → derived quantities → effects on dynamic ports
/// and own states → x'.
class Evaluator {
 public:
  /// Keeps pointers into `model`, which must outlive it.
  explicit Evaluator(const Model& model);

  /// All parameters, in the order of Model::parameters.
  void set_parameters(const double* values);
  [[nodiscard]] const Model& model() const { return *model_; }
  [[nodiscard]] int states() const { return n_; }
  [[nodiscard]] int outputs() const { return ny_; }
  [[nodiscard]] int columns() const { return columns_; }
  /// Places of predict() and linearise_outputs(): the outputs, the shift of the time at which all are taken, and, where effects shift the
  /// time of one output, that of each.
  [[nodiscard]] int sensor_ports() const { return shifts_apart_ ? 2 * ny_ + 1 : ny_ + 1; }
  [[nodiscard]] bool shifts_time() const { return shifts_time_; }    ///< some effect shifts the time at which outputs are taken
  [[nodiscard]] bool shifts_apart() const { return shifts_apart_; }  ///< some effect shifts that of one output alone
  /// The shift of output o [s], by what predict() has written.
  [[nodiscard]] double time_shift(const double* y, int o) const { return y[ny_] + (shifts_apart_ ? y[ny_ + 1 + o] : 0.0); }

  void rates(const double* x, const InputsAt& u, double t, double* dx);
  /// dx and its derivative rows D[i·kRowStride + …] for i < states(): ∂/∂x, then ∂/∂(slot). New slots may be added.
  void linearise_rates(const Instant& instant, Slots& slots, double* dx, double* D);
  /// The same for the inner loop: D gets the columns ∂/∂x only, and B the (few) derivatives by slots. False, with nothing done, where the
  /// model needs full rows (effects on quantity ports).
  bool linearise_rates_sparsely(const Instant& instant, Slots& slots, double* dx, double* D);
  /// ∂(dx_row)/∂(slot) of the last linearise_rates_sparsely(); several entries of one place add up.
  struct Entry {
    int row, slot;
    double value;
  };
  [[nodiscard]] const std::vector<Entry>& slot_entries() const { return slot_entries_; }
  /// Whether every output is a state as it stands (OutputSpec::observes, no effect on a sensor port), so that nothing need be evaluated.
  [[nodiscard]] bool outputs_are_states() const { return !observed_.empty(); }
  /// State that output o is; only if outputs_are_states().
  [[nodiscard]] int observed(int o) const { return observed_[o]; }

  /// y and the shifts of the times at which they are taken [s] (sensor_ports() values).
  void predict(const double* x, const InputsAt& u, double t, double* y);
  /// The same with derivative rows for each of the sensor_ports() values.
  void linearise_outputs(const Instant& instant, Slots& slots, double* y, double* D);

  /// Fastest rate of the system and its effects at this state, jumps at their steepest [1/s].
  [[nodiscard]] double fastest_rate(const double* x, const InputsAt& u, double t);
  /// Why rates() is not finite at this state, in words: see System::explain(). Empty if it is not known.
  [[nodiscard]] std::string explain(const double* x, const InputsAt& u, double t);
  /// Noise intensity of each own state [unit/sqrt(s)] (states() − the system's, in their order); zeros for deterministic memory.
  void diffusion(const double* x, const InputsAt& u, double t, double* intensity);
  /// Value of every quantity at a state (for maps, figures and simulated tables).
  void quantities(const double* x, const InputsAt& u, double t, double* q);

 private:
  struct Use {  // one bound effect, flattened
    const Effect* effect;
    int width, outputs, ports, nq, nc, nz, nk, first_state;
    std::array<int, kMaxWidth> quantity, port, constant, parameter, curve;
    std::array<int, kMaxWidth> input;  // of the system, by the quantity that is it; -1: a quantity that is none
  };
  void flatten();
  void flatten_effect(const BoundEffect& bound);
  [[nodiscard]] double response_of(const Use& use, const Point& at);
  [[nodiscard]] bool rates_move_with_constants() const;
  [[nodiscard]] double curve_value(const Curve& curve, double at) const;
  void gather(const Use& use, const double* own, double* values) const;
  Reads<double, double> reads(const Use& use, const double* values, double t) const;
  struct Linearisation {                               // of one effect at the present quantities, by the numbers that it reads
    std::array<double, kMaxWidth> values, out, slope;  // slope: of the curve behind a coefficient
    std::array<double, std::size_t{kMaxWidth} * kMaxWidth> J;
    std::array<CurvePoint, kMaxWidth> points;
  };
  struct Targets {  // to which an effect adds: ports, and the drifts of its own states, with rows of kRowStride; nullptr: nobody reads them
    double *ports = nullptr, *rows = nullptr, *drifts = nullptr, *drift_rows = nullptr;
  };
  [[nodiscard]] Point point(const Instant& at) {
    inputs_ = at.u;
    return {at.x, at.u.values, at.t, p_.data(), P_.data()};
  }
  [[nodiscard]] const double* own_states(const Point& at) const { return at.x + nx_; }
  void add_value(const Use& use, const Point& at, double* targets, double* drifts);
  void linearise_effect(const Use& use, const Point& at, Linearisation& l) const;
  void chain_effect(const Use& use, const Linearisation& l, int output, Slots& slots, double* row) const;
  void add_linear(const Use& use, const Point& at, Slots& slots, const Targets& to);
  // The common case, nothing on quantity ports: quantities depend on the state and on free constants alone, and derivatives by parameters
  // are kept as a short list of entries instead of rows.
  struct Link {
    int place, other;  // place among the numbers that an effect reads (or writes), and what stands there
  };
  struct Plan {  // a dynamic effect in that case: only what is present, and in `values` already what stays the same over a run
    const Effect* effect;
    int width, nq, nc, nz, first_state;
    std::vector<Link> quantities, curves;  // place → quantity, curve
    std::vector<Link> numbers, columns;    // place → parameter; those that are free coefficients: place → column
    std::vector<Link> constants;           // place → column of free constants that it reads
    std::vector<Link> outputs;             // place among the outputs → row of force_x_
    std::array<int, kMaxWidth> input;      // Use::input
    std::vector<double> values;
  };
  struct CurveEntry {  // value times the four weights of a curve, at its four slots
    int row, curve;
    double value;
  };
  struct CurveState {  // a curve at the present quantities
    const CurvePoint* point = nullptr;
    CurvePoint own;
    double value = 0.0, slope = 0.0;
    int quantity = 0, twin = -1;
    bool free = false;   // some coefficient is free; a fixed one among them has slot −1
    int slots_for = -1;  // first coefficient that `slots` belong to
    std::array<int, 4> slots{};
  };
  template <int NX, int N>
  void linearise_rates_simply(const Point& at, Slots& slots, double* dx, double* D);
  void take_entries(double weight, int from, int to);
  template <int NX>
  void add_entries(Plan& plan, const Point& at, Slots& slots, double* drifts);
  template <int NX>
  void chain_output(const Plan& plan, int row, const double* j, Slots& slots);
  void chain_constants(double weight, int quantity, int row, Slots& slots);
  void plan_effect(const Use& use);
  void fill_numbers();
  void evaluate_curves(Slots& slots);
  [[nodiscard]] bool slots_hold(const CurveState& state, int first, const Slots& slots) const;
  void find_slots(CurveState& state, int first, Slots& slots) const;
  void find_twins();
  void base_and_derived(const Point& at);
  void own_drifts(const Point& at, double* drifts);
  void own_drifts_linear(const Point& at, Slots& slots, double* drifts, double* own_rows);
  void base_and_derived_linear(const Point& at, Slots& slots);
  void outputs_as_quantities(const Point& at, Slots& slots);
  void linearise_outputs_simply(const Point& at, const Slots& slots, double* y, double* D);
  void clear_new_slot(int slot, int rows, double* D) const;
  void chain_quantity(double weight, int quantity, int slots, double* row) const;

  const Model* model_;
  const System* system_;
  int n_, nx_, ny_, nf_, np_, nq_, nk_, columns_;
  std::uint64_t needed_ = 0;
  InputsAt inputs_;  // of the last point()
  bool shifts_time_ = false, shifts_apart_ = false, quantity_effects_ = false, free_constants_ = false, general_ = false;
  bool outputs_read_ports_ = false;            // and some effect adds to a quantity port
  bool general_rates_ = false;                 // as general_, of the rates: constants of the sensor may be free
  bool constants_in_rates_ = false;            // some free constant acts on the rates
  std::vector<Link> free_constants_in_rates_;  // constant → column
  std::vector<Use> quantity_, dynamic_, sensor_;
  std::vector<Plan> plans_;     // of dynamic_
  std::vector<int> observed_;   // state of each output; empty: outputs are to be evaluated
  std::vector<int> column_of_;  // of every parameter; −1 fixed
  std::vector<double> p_;
  std::array<double, kMaxQuantities> q_{};
  std::array<double, kMaxPorts> P_{}, F_{};
  std::vector<double> q_rows_, P_rows_, F_rows_;  // kRowStride each
  std::vector<int> dynamic_curves_;               // those that dynamic effects read
  std::vector<CurveState> curve_;                 // per curve of the model
  std::vector<Entry> entries_;                    // row: dynamic port, or number of dynamic ports + own state
  std::vector<Entry> slot_entries_;               // row: state
  std::vector<CurveEntry> curve_entries_;
  std::vector<double> force_x_;  // (dynamic ports + own states) × states
  bool own_elsewhere_ = false;   // an effect on a quantity or sensor port has memory
  Linearisation linearisation_;  // of the effect at hand
  std::vector<double> q_x_, q_P_, q_k_, r_x_, r_P_, r_F_, r_k_, y_x_, y_P_, y_k_;
};

}  // namespace misfit
