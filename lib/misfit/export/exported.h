#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "misfit/data/fit.h"
#include "misfit/model/model.h"

namespace misfit {

/// An estimate to be exported.
struct Exported {
  std::string study;           ///< its name, in words
  std::string rung;            ///< "rung 2, coulomb_friction added"; empty: the study's own model
  std::string program;         ///< "misfit 0.2.0 (1a2b3c4)"
  Fit fit;                     ///< SI and radians
  std::optional<Model> model;  ///< with the values of the estimate; nullopt: the method solves for curves in bins, without a model
};

/// A curve of an estimate. What cannot be had is empty.
struct ExportedCurve {
  std::string name, of, of_unit, unit;
  Parity parity = Parity::none;
  bool over_sine = false;                   ///< the model has it divided by the sine of its quantity
  std::vector<double> knots;                ///< [of_unit]; between them the cubic with these values and slopes
  std::vector<double> value, slope, sigma;  ///< at the knots; sigma NaN where it was not estimated
  std::optional<CurveEstimate> grid = {};   ///< with its band; where there are no knots: a derived curve, or bins
  [[nodiscard]] bool has_knots() const { return !knots.empty(); }
};

/// Those of the model in its order, then derived curves and those of bins.
[[nodiscard]] std::vector<ExportedCurve> curves_of(const Exported& exported);

/// A parameter that is no coefficient of a curve.
struct ExportedParameter {
  std::string name, doc;
  Estimate estimate;
  bool free = false;
};
/// Those of the model in its order (without one: as the fit has them).
[[nodiscard]] std::vector<ExportedParameter> parameters_of(const Exported& exported);

/// Its units as SI alone, without those in which the study has them shown.
void use_plain_units(Exported& exported);

/// The C99 file: curves as functions, and the right-hand side and outputs where they can be had (model_formulas()). Needs math.h alone.
[[nodiscard]] std::string c_source(const Exported& exported);
/// The same as a module of Python 3; needs math alone.
[[nodiscard]] std::string python_source(const Exported& exported);
/// Parameters with covariance, curves on their knots and on a grid.
[[nodiscard]] std::string json_text(const Exported& exported);
/// The same as tables, by file name: parameters.csv, covariance.csv, CURVE_knots.csv, CURVE_grid.csv.
[[nodiscard]] std::map<std::string, std::string> csv_texts(const Exported& exported);
/// Static moment and damping, curves or numbers, as JSBSim's <aerodynamics>. InputError where the model has neither.
[[nodiscard]] std::string jsbsim_text(const Exported& exported);
/// The effects of the model that it does not have.
[[nodiscard]] std::vector<std::string> effects_not_in_jsbsim(const Exported& exported);

/// Letters, digits and underscores of a text, not beginning with a digit: a name in C and Python, of the reserved words of neither.
[[nodiscard]] std::string identifier(const std::string& text);
/// "system dc_motor, method filter_error, …": lines that every file begins with.
[[nodiscard]] std::vector<std::string> provenance(const Exported& exported);

}  // namespace misfit
