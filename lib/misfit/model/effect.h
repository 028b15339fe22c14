#pragma once

// How to add an effect: one file models/<group>/<key>.cpp like models/parachute/pitch_damping.cpp, and one line in a study.
//
// The formula names what it reads and what it adds to: enums Quantity, Port, Coefficient, Constant and State list the names of the arrays
// `quantities`, `ports`, `coefficients`, `constants` and `states` in their order, in.q[wind_speed], F[pitching_moment]. Where two arrays
// share a name, one of the enumerators says of which it is: P_y_port. An enum that differs from its array does not compile.
//
// The formula is called with numbers, with Jets for derivatives, and with symbols (formula/symbol.h) to be exported. Where it needs the
// number behind value_of(…) for more than a comparison, `static constexpr bool traceable = false;` says so, and it is not exported.
//
// What this interface cannot express: forces that depend on accelerations (declare them as a change of `inertia`, a quantity port); jumps
// of the state; delays of states. A delayed input is exact, by in.late(…); a delayed state has to be approximated by own states of the
// effect, as in models/generic/sensor_delay.cpp.

#include <array>
#include <cstddef>
#include <iterator>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "misfit/core/lists.h"
#include "misfit/formula/symbol.h"
#include "misfit/math/bspline.h"
#include "misfit/math/scalar.h"
#include "misfit/model/index_names.h"
#include "misfit/model/limits.h"
#include "misfit/model/recorded_inputs.h"

namespace misfit {

class Registry;

enum class CoefficientKind {
  strength,  ///< with all strengths 0 the effect adds nothing, whatever its shapes are
  shape      ///< any other: a frequency, a clock angle, a time constant
};

/// A name under which an effect reads a quantity or adds to a port. What it stands for in a model is said by the study, else it is the
/// quantity or port of the same name, else the system's default for the role. An optional role that the system lacks reads 0, or what is
/// added to it is ignored. Unit "*" (generic effects): any unit. A unit with the name of another role in braces depends on what that one
/// stands for: "{level}/s" for a port that has to be the rate of the level.
struct Role {
  const char* name = "";
  const char* unit = "";
  bool optional = false;
  bool positive = false;  ///< the formula divides by it or takes its root: never 0 in use. At all others it must be regular at 0
  /// Of an optional role: the name of the one that it completes (the lateral part of a rate). Where a study binds that one alone, this one
  /// is not bound.
  const char* completes = "";
  /// Of `displacement` and `other`: it may also stand for an input of the same unit: play after an actuator, heat to measured surroundings.
  bool input_too = false;
  /// Of `port`: what acts on it may also act on a parameter that is a port (a drift, a period; of states and inputs: varying_parameter).
  bool parameter_too = false;
  /// The coefficient that is the delay with which it is read (Reads::late()): it must then stand for an input of the system.
  const char* late_by = "";
  /// Of generic effects: units of the kinds of quantities that it is never looked for at ("K": at no temperature).
  std::span<const char* const> never = {};
};

/// At which values of a shape discovery tests an effect; from the best of them its refit begins.
struct ScanSpec {
  double from = 0.0, to = 0.0;  ///< [unit], or shares of what `over` names
  int count =
      0;  ///< values, ends included; −1: a frequency or a spacing, is_frequency(); 0: not scanned: allowed for fixed and shared shapes only
  /// What `from` and `to` are shares of, where sizes are not known beforehand. "level" (a role): of its operating range, 0 its lower, 1 its
  /// upper end; in equal ratios "|level|": of its largest size, "|level|/step": of that per sampling interval, "+-level": of half its
  /// range, "0 level": of its value nearest to 0, "step": of the sampling interval, "1/step": of the rate. "": plain numbers.
  const char* over = "";
  /// It is the width over which a corner or a step is rounded, in the quantity that `over` names. It is then scanned and estimated no
  /// narrower than sqrt(π/2) times the filter's standard error of that quantity: the filter linearises at one point, and of a corner that
  /// is sharper than its state is known it would find too small a strength.
  bool smooths = false;
  /// In a system of more states the first value alone is tested, and a fixed shape stays fixed: estimated at each of the many places there,
  /// it would cost minutes. 0: in any system all of them.
  int most_states = 0;

  /// A frequency [Hz], scanned in steps of 1/(4T). Where `over` is set, the way after which something recurs, "displacement" (a role) or
  /// "speed dt" (the integral of a role): `from` and `to` are then the fewest and the most periods over all of the way.
  [[nodiscard]] constexpr bool is_frequency() const { return count < 0; }
  [[nodiscard]] constexpr bool is_in_time() const { return is_frequency() && over[0] == '\0'; }
  [[nodiscard]] constexpr bool is_scanned() const { return count != 0; }
};

/// A shape that can be read off the measurements of the output that the effect reads, instead of being scanned.
enum class OfMeasurements {
  none,
  step,   ///< resolution: all measurements are whole multiples of it apart
  level,  ///< the measured value nearest to 0
};

/// A number the effect owns; where the study says so, a curve of any quantity.
struct CoefficientSpec {
  const char* name = "";
  CoefficientKind kind = CoefficientKind::strength;
  double value = 0.0;  ///< start when the study gives none [unit]
  const char* unit =
      "-";  ///< may name roles: "{port}/{rate}" (role_units.h); value, bounds and scale are then numbers in the units so found
  double lower = 0.0, upper = 0.0;
  double scale = 1.0;  ///< typical size [unit]: for steps, random starts and "how big is it"
  const char* doc = "";
  Parity parity = Parity::none;  ///< as a curve: symmetry about 0
  const char* curve_of =
      "";  ///< default: a curve of this quantity, or of what this role stands for, unless the study gives a number; "" = a number
  bool over_sine = false;  ///< as a curve: enters divided by the sine of its quantity (regular at 0), see CubicSpline::over_sine
  bool fixed = false;      ///< not fitted unless the study frees it: a smoothing width, an origin of time
  ScanSpec scan{};
  /// Of a shape that is the drift of another coefficient in time, or along a role: the name of that one. Fixed at 0 unless the study frees
  /// it, or discovery, where that raises the likelihood clearly.
  const char* drift_of = "";
  OfMeasurements measured_as = OfMeasurements::none;  ///< discovery refuses a `step` of which the measurements are no multiples
  /// Of a strength that has only this one value besides 0: an output is delayed as a whole, or not at all. Discovery fixes the strength at
  /// it where the data allow that, and refuses the effect where they want a part of it. 0: any strength is possible.
  double whole = 0.0;
  const char* whole_of = "";       ///< role of an input: `whole` is then relative to the model's gain from it to the first port
  const char* calibrated_as = "";  ///< camera parameter whose calibration sigma is the prior of this strength, if there is a calibration
  double prior_sigma = 0.0;        ///< as a candidate: Gaussian about 0 where there is no calibration [unit]; 0: no prior
  /// Of a strength: discovery does not look below it, where another effect says the same better (a late sensor is a sensor_delay).
  double lower_as_candidate = -std::numeric_limits<double>::infinity();
  /// Of a strength that is a time: discovery looks within so many sampling intervals of 0, since what the outputs' slope in time says of an
  /// offset holds for a few of them, and each is predicted from as many away. 0: as far as its bounds.
  double steps_as_candidate = 0.0;
  double own_sigma = 0.0;  ///< in every fit: Gaussian about the value [unit]; 0: no prior
  /// It is the coefficient of this name, number or curve, of another effect in the model: for effects that change what another one adds (a
  /// wake that weakens the static moment). InputError where no effect of the model has it. Declared as a shape; name, unit and doc count,
  /// value and bounds only in the worked examples and the tests of all effects.
  bool shared = false;
};

/// A state of the effect itself: z' = drift [unit/s], plus, where the effect has a diffusion, white noise of spectral density diffusion².
struct OwnStateSpec {
  const char* name = "";
  const char* unit = "-";
  double initial = 0.0;
};

/// A worked example: all inputs given, outputs computed by hand or from a source. Every coefficient is non-zero in at least one.
struct Example {
  std::vector<double> constants = {}, quantities = {}, coefficients = {}, states = {};
  double t = 0.0;
  std::vector<double> ports = {}, drifts = {};  ///< expected
  const char* source = "";
  /// Where the past of an input is read (Role::late_by): how it ran, straight between these times.
  std::vector<double> past_times = {}, past_values = {};

  /// The past as recorded inputs of which number 0 is that input.
  [[nodiscard]] RecordedInputs past() const { return {past_times, {Hold::first_order}, past_values}; }
};

/// Everything the outside may know of an effect; views of the static declarations of its struct.
struct EffectSpec {
  std::string key, formula, symbols, valid, size, source, excludes;  ///< the six fixed lines ("Not" is `excludes`)
  std::vector<Role> quantities, ports;
  std::vector<std::string> constants;  ///< parameters of the system it reads as plain numbers
  std::vector<CoefficientSpec> coefficients;
  std::vector<OwnStateSpec> states;
  std::string specialises;   ///< key of the generic effect it coincides with: that one is not proposed beside it
  bool dissipative = false;  ///< never adds power at the port's conjugate rate

  /// Index of the role in `quantities` that names what the coefficient is a curve of; −1: none does.
  [[nodiscard]] int curve_role(const CoefficientSpec& coefficient) const;
  /// A force or an error of unknown form: one of its coefficients is a curve of what one of its roles stands for.
  [[nodiscard]] bool has_unknown_form() const;
  /// In the order of the fields.
  void set_texts(const std::array<const char*, 7>& texts);
};

/// From where Reads::late() takes the past of inputs.
struct Past {
  const InputsAt* inputs = nullptr;       ///< nullptr: inputs have always had their present values
  const int* input = nullptr;             ///< number of the system's input, for each quantity of the effect
  const formula::Symbol* late = nullptr;  ///< instead of values where the formula is exported: a symbol, for each quantity of the effect
};

/// What a formula reads. T: double, a Jet or a symbol; K: double where all constants are fixed, else T.
template <class T, class K>
struct Reads {
  const T* q;                                                           ///< quantities, order of `quantities`
  const T* c;                                                           ///< coefficients, order of `coefficients`
  const T* z;                                                           ///< own states, order of `states`
  const K* k;                                                           ///< constants, order of `constants`
  std::conditional_t<std::is_same_v<T, formula::Symbol>, T, double> t;  ///< [s]
  Past past = {};

  /// The input that a quantity is (Role::late_by) as it was `delay` ago [its unit]: recorded_inputs.h.
  [[nodiscard]] T late(int quantity, const T& delay) const {
    if constexpr (std::is_same_v<T, formula::Symbol>) {
      return past.late == nullptr ? q[quantity] : past.late[quantity];
    } else {
      return late_number(quantity, delay);
    }
  }

 private:
  [[nodiscard]] T late_number(int quantity, const T& delay) const {
    if (past.inputs == nullptr || past.inputs->record == nullptr) return q[quantity];
    const LateInput then = late_input(*past.inputs, past.input[quantity], t, value_of(delay));
    return T(then.value) + then.by_delay * (delay - T(value_of(delay)));
  }
};
using SymbolReads = Reads<formula::Symbol, formula::Symbol>;

/// An effect behind a virtual call. Outputs are ordered ports first, then drifts of own states; they are set, not added.
class Effect {
 public:
  virtual ~Effect() = default;
  [[nodiscard]] virtual const EffectSpec& spec() const = 0;
  [[nodiscard]] virtual std::vector<Example> examples() const = 0;
  virtual void evaluate(const Reads<double, double>& in, double* out) const = 0;
  /// J: row-major outputs × (quantities + coefficients + own states [+ constants if `constants_too`]).
  virtual void linearise(const Reads<double, double>& in, double* out, double* J, bool constants_too) const = 0;
  /// Fastest rate (inverse time constant, circular frequency) of what it adds [1/s]: integrators keep rate × step < 0.5. 0: none.
  /// `response`: derivative of the rate of change of the quantity `rate` by the first port, from the system's equations (1/inertia); used
  /// only where responds() is true.
  [[nodiscard]] virtual double fastest_rate(const Reads<double, double>& in, double response) const = 0;
  [[nodiscard]] virtual bool responds() const { return false; }
  /// Noise intensity of each own state [unit/sqrt(s)]; zeros for deterministic memory.
  virtual void diffusion(const Reads<double, double>& in, double* out) const = 0;
  /// evaluate() over symbols, inside of formula::trace(). False, with nothing done, where the formula cannot be read that way.
  virtual bool trace(const SymbolReads& /*in*/, formula::Symbol* /*out*/) const { return false; }
};

/// Turns a struct with a templated formula into an Effect. Required: `static constexpr` texts formula, symbols, valid, size, source,
/// excludes; array `ports`; `template <class T, class K> static void add(const Reads<T, K>& in, T* F)`, or with own states `add(in, F,
/// drift)`; `static std::vector<Example> examples()`. Optional: arrays `quantities`, `constants`, `coefficients`, `states`; enums Quantity,
/// Port, Coefficient, Constant, State with the names of the arrays' entries, to index with; `specialises`, `dissipative`;
/// `fastest_rate(const Reads<double, double>&)` or `fastest_rate(const Reads<double, double>&, double response)`, `diffusion(const
/// Reads<double, double>&, double*)`.
template <class E>
class EffectOf final : public Effect {
 public:
  explicit EffectOf(const char* key);

  [[nodiscard]] const EffectSpec& spec() const override { return spec_; }
  [[nodiscard]] std::vector<Example> examples() const override { return E::examples(); }

  void evaluate(const Reads<double, double>& in, double* out) const override { call<double, double>(in, out); }

  bool trace(const SymbolReads& in, formula::Symbol* out) const override {
    if constexpr (requires { requires !E::traceable; })
      return false;
    else
      call<formula::Symbol, formula::Symbol>(in, out);
    return true;
  }

  void linearise(const Reads<double, double>& in, double* out, double* J, bool constants_too) const override {
    if (constants_too && NK > 0) {
      differentiate<NQ + NC + NZ + NK>(in, out, J);
    } else {
      differentiate<NQ + NC + NZ>(in, out, J);
    }
  }

  [[nodiscard]] double fastest_rate(const Reads<double, double>& in, double response) const override {
    if constexpr (requires { E::fastest_rate(in, response); }) return E::fastest_rate(in, response);
    if constexpr (requires { E::fastest_rate(in); }) return E::fastest_rate(in);
    return 0.0;
  }
  [[nodiscard]] bool responds() const override {
    return requires(const Reads<double, double>& in) { E::fastest_rate(in, 1.0); };
  }

  void diffusion(const Reads<double, double>& in, double* out) const override {
    if constexpr (requires { E::diffusion(in, out); }) {
      E::diffusion(in, out);
    } else {
      for (int i = 0; i < NZ; ++i) out[i] = 0.0;
    }
  }

 private:
  static consteval int quantities() {
    if constexpr (requires { E::quantities; }) return int_size(E::quantities);
    return 0;
  }
  static consteval int coefficients() {
    if constexpr (requires { E::coefficients; }) return int_size(E::coefficients);
    return 0;
  }
  static consteval int constants() {
    if constexpr (requires { E::constants; }) return int_size(E::constants);
    return 0;
  }
  static consteval int states() {
    if constexpr (requires { E::states; }) return int_size(E::states);
    return 0;
  }
  static constexpr int NQ = quantities();
  static constexpr int NP = int_size(E::ports);
  static constexpr int NC = coefficients();
  static constexpr int NK = constants();
  static constexpr int NZ = states();
  static constexpr int NO = NP + NZ;
  static_assert(
      requires { E::examples(); }, "add a worked example to the effect's struct: static std::vector<Example> examples()");
  static_assert(NQ + NC + NZ + NK <= kMaxWidth, "an effect reads at most kMaxWidth numbers (model/limits.h): make two effects of it");
  static_assert(index_names::quantities_match<E>(), "give enum Quantity the names of `quantities`, in their order");
  static_assert(index_names::ports_match<E>(), "give enum Port the names of `ports`, in their order");
  static_assert(index_names::coefficients_match<E>(), "give enum Coefficient the names of `coefficients`, in their order");
  static_assert(index_names::constants_match<E>(), "give enum Constant the names of `constants`, in their order");
  static_assert(index_names::states_match<E>(), "give enum State the names of `states`, in their order");

  template <class T, class K>
  static void call(const Reads<T, K>& in, T* out) {
    if constexpr (NZ > 0) {
      E::template add<T, K>(in, out, out + NP);
    } else {
      E::template add<T, K>(in, out);
    }
  }

  template <int W>
  static void differentiate(const Reads<double, double>& in, double* out, double* J) {
    if constexpr (W == 0) {
      call<double, double>(in, out);
    } else {
      using T = Jet<W>;
      std::array<T, W> seeds;
      for (int i = 0; i < NQ; ++i) seeds[i] = T(in.q[i], i);
      for (int i = 0; i < NC; ++i) seeds[NQ + i] = T(in.c[i], NQ + i);
      for (int i = 0; i < NZ; ++i) seeds[NQ + NC + i] = T(in.z[i], NQ + NC + i);
      std::array<T, NO> results;
      const T* s = seeds.data();
      if constexpr (W > NQ + NC + NZ) {
        for (int i = 0; i < NK; ++i) seeds[NQ + NC + NZ + i] = T(in.k[i], NQ + NC + NZ + i);
        call<T, T>({s, s + NQ, s + NQ + NC, s + NQ + NC + NZ, in.t, in.past}, results.data());
      } else {
        call<T, double>({s, s + NQ, s + NQ + NC, in.k, in.t, in.past}, results.data());
      }
      for (int o = 0; o < NO; ++o) {
        out[o] = results[o].a;
        for (int i = 0; i < W; ++i) J[o * W + i] = results[o].v[i];
      }
    }
  }

  EffectSpec spec_;
};

template <class E>
EffectOf<E>::EffectOf(const char* key) {
  spec_.set_texts({key, E::formula, E::symbols, E::valid, E::size, E::source, E::excludes});
  if constexpr (NQ > 0) spec_.quantities.assign(std::begin(E::quantities), std::end(E::quantities));
  spec_.ports.assign(std::begin(E::ports), std::end(E::ports));
  if constexpr (NK > 0) spec_.constants.assign(std::begin(E::constants), std::end(E::constants));
  if constexpr (NC > 0) spec_.coefficients.assign(std::begin(E::coefficients), std::end(E::coefficients));
  if constexpr (NZ > 0) spec_.states.assign(std::begin(E::states), std::end(E::states));
  if constexpr (requires { E::specialises; }) spec_.specialises = E::specialises;
  if constexpr (requires { E::dissipative; }) spec_.dissipative = E::dissipative;
}

}  // namespace misfit

/// The last line of an effect's file. The stem of the file must be `key`: CMake's generated list calls misfit_register_<stem>.
#define MISFIT_EFFECT(key, Type)                          \
  void misfit_register_##key(misfit::Registry& registry); \
  void misfit_register_##key(misfit::Registry& registry) { registry.add(std::make_unique<misfit::EffectOf<Type>>(#key)); }
