#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace misfit {

/// One parameter of the set-up as it was perturbed.
struct PerturbedParameter {
  std::string name, unit;    ///< SI unit
  double value = 0.0;        ///< nominal [unit]
  double sigma = 0.0;        ///< of its error [unit]
  std::string distribution;  ///< of its errors: "normal, 3 sigma = 0.1524 m"
  std::string group;         ///< "calibration" where it goes together with others; empty: independent
};

/// Which part of a variance comes from one parameter, or from a group of correlated ones, at first order.
struct VarianceShare {
  std::string name;
  double share = 0.0, sigma = 0.0;  ///< of the variance [-]; sigma: from the finite number of runs
  double effect = 0.0;              ///< change of the number per one sigma of the parameter [unit of the number]; NaN for a group
};

/// One number of the fit over the runs, SI.
struct SpreadNumber {
  std::string name, unit;                     ///< "trim", "slope of C_m", "C_m_alphadot at the trim", or a parameter's name
  double nominal = 0.0, nominal_sigma = 0.0;  ///< of the fit of the study as it is; sigma from its residuals, 0: not known
  double mean = 0.0, sigma = 0.0;             ///< over the runs; NaN where fewer than one, two have it
  std::size_t count = 0;                      ///< runs that have it
  std::vector<VarianceShare> shares;          ///< empty: too few runs, or it does not vary
  double rest = 0.0;                          ///< of the variance: parameters acting together, or beyond second order
};

/// One curve over the runs, on the nominal fit's grid, SI.
struct SpreadCurve {
  std::string name, of, of_unit, unit;
  std::vector<double> x, nominal, mean, sigma;  ///< NaN where fewer than one, two runs reach
  std::vector<double> count;                    ///< runs that reach this x
  bool informative = true;                      ///< as the nominal fit says; `why` says why not
  std::string why;
  bool trimmed = false;  ///< its zero is the trim
};

/// The Monte-Carlo over the set-up.
struct Uncertainty {
  std::string method;
  std::size_t runs = 0, failed = 0;
  unsigned long seed = 0;
  std::map<std::string, std::size_t> failures;  ///< reason → runs
  std::vector<PerturbedParameter> perturbed;
  std::vector<SpreadNumber> numbers;  ///< the trim first, where there is one
  std::vector<SpreadCurve> curves;
  std::vector<std::string> notes;  ///< what a reader must know, in sentences

  [[nodiscard]] const SpreadNumber* find(const std::string& name) const;
};

/// uncertainty.json (all of it) and uncertainty.csv into `dir`; the latter: `curve,OF[unit],mean[unit],sigma[unit],low[unit],high[unit],
/// nominal[unit],runs`, low and high being mean ∓ 3 sigma. Curves of another quantity or unit: uncertainty_QUANTITY.csv. Returns the names
/// of the files.
std::vector<std::string> write_uncertainty(const std::filesystem::path& dir, const Uncertainty& uncertainty);
/// From DIR/uncertainty.json.
[[nodiscard]] Uncertainty read_uncertainty(const std::filesystem::path& dir);

}  // namespace misfit
