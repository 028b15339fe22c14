#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "misfit/data/folded_angle.h"
#include "misfit/formula/symbol.h"
#include "misfit/model/limits.h"

namespace misfit {

enum class Initial {
  free,    ///< unknown, in every experiment another one
  shared,  ///< unknown, the same in all experiments
  fixed    ///< StateSpec::start
};

struct StateSpec {
  std::string name, unit;
  int rate_of = -1;    ///< index of the state whose time derivative this one is; −1: none
  double scale = 1.0;  ///< typical size [unit]: how uncertain it is before anything is measured
  Initial initial = Initial::free;
  double start = std::numeric_limits<double>::quiet_NaN();  ///< initial value, where one is given: to start from, or fixed [unit]
  /// What it cannot leave (a level that is never negative): the step map sets it back to the bound after every step.
  double lower = -std::numeric_limits<double>::infinity(), upper = std::numeric_limits<double>::infinity();
};

/// How an input runs between its samples: constant, as a straight line, or as a cubic spline through all of them, close to the signal
/// without content above half the sampling rate that has these samples (Pintelon and Schoukens, System Identification: A Frequency Domain
/// Approach (2001): the zero-order-hold and the band-limited assumption).
enum class Hold { zero_order, first_order, band_limited };
struct InputSpec {
  std::string name, unit, doc;
  Hold hold = Hold::first_order;
  double delay = 0.0;  ///< [s] the system sees what was recorded this much earlier (signals_from)
};

/// A named function of state, input, time and quantity ports. The first `base_quantities` of a system do not depend on quantity ports.
struct QuantitySpec {
  std::string name, unit, doc;
  std::vector<std::string> inputs = {};  ///< inputs without which it cannot be computed
  bool carries_sign = false;  ///< may be negative: curves of it need no division by its sine (CoefficientSpec::over_sine is ignored)
  bool explains = true;       ///< a coordinate of the motion: maps and unknown curves are drawn over it
  bool of_sensor = false;     ///< depends on constants of the sensor (ConstantSpec::of_sensor); all others must not
  std::string rate_of = {};   ///< quantity whose derivative in time it is; a state's is in StateSpec
};

struct PortSpec {
  std::string name, unit, doc;
  /// Dynamic ports: quantity whose product with it is power; others: what is changed; of a mere factor (or a constant), what that moves.
  std::string conjugate = {};
  std::string multiplies = {};  ///< of what acts in one equation through one state or input: that; with a conjugate along a straight line
};

/// A parameter of the system: geometry, mass, flow. Fixed unless a study frees it.
struct ConstantSpec {
  std::string name, unit, doc;
  double lower = 0.0, upper = 0.0;  ///< inclusive
  bool required = true;
  double value = 0.0;  ///< when not required
  /// Acts on the outputs, and on quantities of the sensor, alone: where it is free, the rates keep their fast derivatives.
  bool of_sensor = false;
  bool free = false;         ///< unless a study says otherwise
  double prior_sigma = 0.0;  ///< Gaussian about the value [unit]; 0: no prior
  bool strength = false;     ///< the rates are linear in it: a regression finds it
  double scale = 0.0;        ///< typical size [unit]; 0: that of the value, else prior_sigma, else 1
};

struct OutputSpec {
  std::string name, unit;
  int observes = -1;   ///< index of the state it is; −1: a function
  double noise = 0.0;  ///< typical white measurement noise [unit], a start only
  /// Another function than the state, input or quantity of its name, or called as a dynamic port: only roles of sensors mean the output.
  bool namesake = false;
};

/// Sensor ports behind the outputs: shifts of the time at which all outputs are taken, and at which one is [s].
inline constexpr const char* all_sample_times = "sample_time";
[[nodiscard]] inline std::string sample_time_of(const std::string& output) { return std::string(all_sample_times) + "_" + output; }

/// A curve that is a combination of the model's own: Σ factor(x) · d^order curve / dx^order.
struct DerivedCurve {
  struct Term {
    std::string curve;
    int derivative = 0;
    std::function<double(double x)> factor;
  };
  std::string name, of, unit, doc;
  std::vector<Term> terms;
};

/// Another form of the same physics, for methods that need it: kind and flags.
struct SystemForm {
  std::string kind;
  std::map<std::string, bool> flags;
};

/// A quantity whose statistics are compared between measured and simulated motion.
struct ComparedQuantity {
  std::string name;
  bool distribution_only = false;  ///< without its autocorrelation and spectrum: an unbounded rate, say
};

/// The quantity that is an input as it was recorded, before effects on the port of its name change it.
[[nodiscard]] inline std::string as_recorded(const std::string& input) { return input + "_given"; }

struct SystemSpec {
  std::string key, doc, formula, source;
  std::vector<std::string> shown_units;  ///< inside units of what is shown in others: shown_in(), at most one of every SI unit
  bool angles_in_radians = false;        ///< angles and their rates are shown in radians: their units are in_radians()
  std::vector<StateSpec> states;
  std::vector<InputSpec> inputs;
  std::vector<std::string> equation_inputs;  ///< inputs that the system's own equations need
  std::vector<QuantitySpec> quantities;
  int base_quantities = 0;
  std::vector<PortSpec> quantity_ports, dynamic_ports;
  std::vector<std::string>
      ports_in_outputs;  ///< quantity ports that some output's formula reads: direct feedthrough of an input, a quantity
  std::vector<ConstantSpec> constants;
  std::vector<OutputSpec> outputs;                       ///< each is also a sensor port of the same name; then their times
  std::map<std::string, std::string> roles;              ///< default quantity or port of generic roles: "rate", "level", "port", "output"
  std::map<std::string, std::string> coefficient_names;  ///< effect's coefficient → name it has in this system ("C_mq" → "C_m_alphadot")
  std::vector<std::string> force_ports;                  ///< dynamic ports of the random force that drives the motion, in fixed axes
  std::vector<std::string> includes;                     ///< effects that its equations have by themselves: refused beside it
  std::vector<int> readable_states;                      ///< states that System::read_states() gives
  SystemForm regression;                    ///< form in which sliding_bin is stated ([1] of lib/misfit/README.md, Eq. 8); empty kind: none
  std::string static_curve, damping_curve;  ///< coefficients that sliding_bin solves for; empty: none
  FoldedAngle folded_angle = {};            ///< for the points of [reference]
  std::vector<ComparedQuantity> compared_quantities = {};  ///< of measured and simulated motion, beside the channels
  double fastest_rate = 0.0;                               ///< [1/s], of the system without effects
  bool rate_given = false;  ///< by the one who wrote the system: at least so many steps, whatever the plan finds
};

/// Row-major blocks of first derivatives; a null pointer means "not wanted".
struct QuantityDerivatives {
  double* x = nullptr;  ///< quantities × states
  double* P = nullptr;  ///< quantities × quantity ports
  double* k = nullptr;  ///< quantities × constants
};
struct RateDerivatives {
  double* x = nullptr;  ///< states × states, at fixed F
  double* P = nullptr;  ///< states × quantity ports
  double* F = nullptr;  ///< states × dynamic ports: B of x' = f0 + B F
  double* k = nullptr;  ///< states × constants
};
struct OutputDerivatives {
  double* x = nullptr;  ///< outputs × states
  double* P = nullptr;  ///< outputs × quantity ports; asked for only where there are SystemSpec::ports_in_outputs
  double* k = nullptr;  ///< outputs × constants
};

/// Where a system is evaluated. T, K: double, or Jets where derivatives by states and ports, by constants, are taken; all three symbols
/// where its formulas are read.
template <class T, class K, class U = double>
struct PointOf {
  const T* x;            ///< states
  const U* u;            ///< inputs
  U t;                   ///< [s]
  const K* k;            ///< constants
  const T* P = nullptr;  ///< what effects add on the quantity ports; null: nothing, for outputs
};
using Point = PointOf<double, double>;
using SymbolPoint = PointOf<formula::Symbol, formula::Symbol, formula::Symbol>;

/// Bit of a quantity in `needed`; the last bit stands for all quantities from the 64th on.
[[nodiscard]] constexpr std::uint64_t needed_bit(int quantity) { return std::uint64_t{1} << (quantity < 63 ? quantity : 63); }
[[nodiscard]] constexpr bool is_needed(std::uint64_t needed, int quantity) { return (needed & needed_bit(quantity)) != 0U; }

/// The skeleton of a model. `needed` says which quantities are read by somebody (needed_bit()): others may be left 0.
class System {
 public:
  virtual ~System() = default;
  [[nodiscard]] virtual const SystemSpec& spec() const = 0;
  /// Curves in the meaning people compare (the paper's C_m_alphadot), from this model's own; `k` are the constants.
  [[nodiscard]] virtual std::vector<DerivedCurve> derived_curves(const double* /*k*/) const { return {}; }

  virtual void quantities(const Point& at, std::uint64_t needed, double* q) const = 0;
  virtual void linearise_quantities(const Point& at, std::uint64_t needed, double* q, const QuantityDerivatives& d) const = 0;
  virtual void rates(const Point& at, const double* F, double* dx) const = 0;
  virtual void linearise_rates(const Point& at, const double* F, double* dx, const RateDerivatives& d) const = 0;
  virtual void outputs(const Point& at, double* y) const = 0;
  virtual void linearise_outputs(const Point& at, double* y, const OutputDerivatives& d) const = 0;
  /// Fastest rate of the system without effects, at this state [1/s].
  [[nodiscard]] virtual double fastest_rate(const Point& /*at*/) const { return spec().fastest_rate; }
  /// Why rates() is not finite here, in words: the part of the formula, the states and parameters in it. Empty if it is finite or not
  /// known.
  [[nodiscard]] virtual std::string explain(const Point& /*at*/, const double* /*F*/) const { return {}; }
  /// quantities(), rates() and outputs() over symbols, inside of formula::trace(), where traceable() says so.
  [[nodiscard]] virtual bool traceable() const { return false; }
  virtual void trace_quantities(const SymbolPoint& /*at*/, formula::Symbol* /*q*/) const {}
  virtual void trace_rates(const SymbolPoint& /*at*/, const formula::Symbol* /*F*/, formula::Symbol* /*dx*/) const {}
  virtual void trace_outputs(const SymbolPoint& /*at*/, formula::Symbol* /*y*/) const {}
  /// The inverse of outputs() for SystemSpec::readable_states: fills those entries of x. False where the outputs have no such state.
  virtual bool read_states(const double* /*y*/, const double* /*k*/, double* /*x*/) const { return false; }
};

/// Options of a system as a study gives them: flags and numbers (SI).
struct SystemOptions {
  std::map<std::string, bool> flags;
  std::map<std::string, double> numbers;
};

/// What the registry knows of a kind of system before it is made.
struct SystemType {
  std::string key;
  std::vector<std::string> flags;  ///< names that [system] may set
  std::function<std::unique_ptr<System>(const SystemOptions&)> make;
};

}  // namespace misfit
