#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "misfit/core/lists.h"
#include "misfit/math/bspline.h"
#include "misfit/model/registry.h"

namespace misfit {

/// A curve as asked for. Knots in SI (radians for angles); empty: to be chosen from data before the model is assembled.
struct CurveRequest {
  std::string of;  ///< empty: the quantity of the coefficient's specification (`curve_of`)
  std::vector<double> knots;
  std::optional<double> roughness;  ///< nullopt: chosen from the data
  Source where;
};

/// What a study says of one parameter, in SI.
struct ParameterRequest {
  std::optional<bool> free;
  std::optional<double> value, lower, upper, sigma;  ///< sigma: Gaussian prior about `value`, which alone moves none
  Source where;
};

struct EffectRequest {
  std::string name, kind;
  std::map<std::string, std::string> roles;
  Source where;
};

/// Log-normal prior of the random force's strength on the ports of one dimension: log strength ~ N(log median, (sigma/median)²).
struct KnownForce {
  double median = 1.0, sigma = 1.0;  ///< SI
  std::string unit = {};             ///< of the ports; empty: all have one
};

/// A model as asked for: plain data, from a study or made in a test.
struct ModelRequest {
  std::string system;
  SystemOptions options;
  Source system_where;
  std::map<std::string, double> constants;        ///< SI
  std::map<std::string, double> constant_sigmas;  ///< where known
  std::map<std::string, Source> constants_where;
  std::vector<EffectRequest> effects;
  std::map<std::string, ParameterRequest> parameters;  ///< of a study: by the model's names
  std::map<std::string, CurveRequest> curves;          ///< by the coefficient's name in the model
  struct InitialRequest {
    std::optional<Initial> initial;
    std::optional<double> value;  ///< SI
    Source where;
  };
  std::map<std::string, InitialRequest> initial;  ///< of states of the system
  struct NoiseRequest {
    double sigma = 0.0;  ///< SI
    bool fixed = true;
    Source where;
    double frequency = 0.0;  ///< KnownNoise::frequency
  };
  std::map<std::string, NoiseRequest> noise;  ///< of outputs
  std::optional<double> force_time;           ///< of the random force [s], fixed; 0: white
  std::optional<KnownForce> force_strength;   ///< its prior
};

/// One row of the parameter table.
struct Parameter {
  std::string name, unit, doc;
  double value = 0.0, lower = 0.0, upper = 0.0, scale = 1.0;
  bool free = false;
  std::optional<double> prior_sigma{};  ///< Gaussian about prior_mean
  double prior_mean = 0.0;
  CoefficientKind kind = CoefficientKind::shape;
  int curve = -1;  ///< index into Model::curves for a curve's coefficient
};

/// A coefficient that is a curve: parameters first … first + spline.size() − 1.
struct Curve {
  std::string name, of, of_unit, unit;
  int quantity = -1;  ///< index of `of`
  CubicSpline spline;
  bool over_sine = false;
  int first = 0;
  std::optional<double> roughness;
  double scale = 1.0;
};

/// of^3/curve^2, in SI units: of λ in λ ∫ (d²C/dq²)² dq.
[[nodiscard]] std::string roughness_unit(const Curve& curve);

/// Where a bound coefficient takes its number: from a parameter or from a curve (the other is −1).
struct BoundCoefficient {
  int parameter = -1;
  int curve = -1;
};

enum class PortKind { quantity, dynamic, sensor };

/// An effect in its place: all names resolved to indices; −1 where an optional role is absent.
struct BoundEffect {
  const Effect* effect = nullptr;
  std::string name;
  PortKind kind = PortKind::dynamic;
  std::vector<int> quantities, ports, constants;
  std::vector<BoundCoefficient> coefficients;
  int first_state = 0;  ///< of its own states, counted after the system's
};

/// What is known of the white measurement noise of an output.
struct KnownNoise {
  double sigma = 0.0;      ///< [unit of the output]; 0: nothing
  bool fixed = false;      ///< fixed in every fit; else a start
  double frequency = 0.0;  ///< [Hz] about which coloured noise is looked for; 0: well above the motion
};

/// An input whose past an effect reads: Role::late_by.
struct LateInputUse {
  int effect = 0, quantity = 0;  ///< index into Model::effects; place among what it reads
  int input = 0, delay = 0;      ///< of the system; parameter
};

/// A system, its effects and the parameter table. Sensor ports are the outputs, in order, then `sample_time`; predicted outputs can be read
/// as quantities by effects on sensor ports: index = system's quantities + output.
struct Model {
  std::shared_ptr<const System> system;
  std::vector<BoundEffect> effects;
  std::vector<Parameter> parameters;  ///< system constants first, in the order of the system
  std::vector<Curve> curves;
  /// States of the system with what the study says of their initial values; own states of effects are not among them.
  std::vector<StateSpec> state_specs;
  std::vector<KnownNoise> known_noise;  ///< per output
  std::optional<double> force_time;     ///< correlation time of the random force [s], fixed; 0: white
  std::optional<KnownForce> force_strength;
  std::vector<OwnStateSpec> own_states;
  std::vector<std::string> own_state_names;  ///< "effect.state"
  std::vector<std::string> own_state_units;

  [[nodiscard]] int system_states() const { return int_size(system->spec().states); }
  [[nodiscard]] int states() const { return system_states() + int_size(own_states); }
  [[nodiscard]] int outputs() const { return int_size(system->spec().outputs); }
  [[nodiscard]] int inputs() const { return int_size(system->spec().inputs); }
  [[nodiscard]] int input_of_quantity(int quantity) const;  ///< the input of its name; −1: it is none
  [[nodiscard]] std::vector<LateInputUse> late_inputs() const;
  [[nodiscard]] bool noise_is_given() const;               ///< of every output: nothing of it is estimated
  [[nodiscard]] std::vector<double> values() const;        ///< of all parameters
  [[nodiscard]] std::vector<int> free_parameters() const;  ///< index into `parameters` of each column
  [[nodiscard]] Eigen::VectorXd theta() const;             ///< values of the free parameters, in that order
  void set_theta(const Eigen::VectorXd& theta);
  [[nodiscard]] std::vector<double> values_at(const Eigen::VectorXd& theta) const;  ///< values() with these of the free parameters
  [[nodiscard]] int find_parameter(const std::string& name) const;                  ///< −1 if there is none
  [[nodiscard]] const Curve* find_curve(const std::string& name) const;
  [[nodiscard]] std::vector<std::string> needed_inputs() const;  ///< inputs that some quantity read by somebody needs
};

/// Resolves names and checks units, bounds and sizes. InputError with the place in the study, what is allowed and the nearest name. Every
/// curve must have knots by now. A coefficient is called by its own name, or EFFECT.NAME where two effects of the model would share it.
[[nodiscard]] Model assemble(const ModelRequest& request, const Registry& registry);

/// Curves of the model that still need knots (name → quantity), before assembling: from `request.curves` and the effects' defaults. The
/// name is that of `request.curves` if the curve stands there, else that in the model; parameter_names() knows both.
[[nodiscard]] std::map<std::string, std::string> curves_without_knots(const ModelRequest& request, const Registry& registry);

/// Unit of every parameter and curve by its name in the model to be, before assembling: to read values that a study writes with units.
[[nodiscard]] std::map<std::string, std::string> parameter_units(const ModelRequest& request, const Registry& registry);

/// What a study may call every parameter and curve of the model to be → its name in the model, which is among them.
[[nodiscard]] std::map<std::string, std::string> parameter_names(const ModelRequest& request, const Registry& registry);

}  // namespace misfit
