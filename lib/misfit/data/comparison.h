#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "misfit/data/fit.h"
#include "misfit/data/motion.h"

namespace misfit {

/// What one method says, side by side with the others.
struct MethodSummary {
  std::string method;
  FitStatus status = FitStatus::failed;
  std::string message;
  bool driven = false;
  std::optional<Estimate> trim;             ///< [rad]
  std::map<std::string, Estimate> slopes;   ///< static curve → slope at the trim [1/rad]
  std::map<std::string, Estimate> at_trim;  ///< other informative curves of the same quantity → value at the trim [curve's unit]
  std::map<std::string, Estimate> rms, validation_rms;
  std::optional<double> loglik, validation_loglik;
  std::map<std::string, Estimate> parameters;  ///< scalars; curves are compared as curves
};

/// Two curves of the same name and quantity on the range that both visited, or a curve and the points of a reference.
struct CurveDifference {
  std::string curve, of, of_unit, unit;
  std::string a, b;             ///< methods, or method and name of the reference
  bool reference = false;       ///< b is a reference
  double from = 0.0, to = 0.0;  ///< compared range [of_unit]
  std::size_t points = 0;
  double rms_sigmas = 0.0;  ///< rms of (a − b)/sqrt(sigma_a² + sigma_b²)
  double max_sigmas = 0.0;  ///< largest |a − b| in combined sigmas …
  double at = 0.0;          ///< … where [of_unit] …
  Estimate difference;      ///< … and a − b there with its combined sigma [unit]
};

/// trim of a − trim of b.
struct TrimDifference {
  std::string a, b;
  bool reference = false;
  Estimate difference;   ///< [rad], sigma combined as of independent errors
  double sigmas = 0.0;   ///< |difference| / sigma; NaN if neither has a sigma
  std::string sentence;  ///< "the trim of output_error is 1.9 ± 0.4 deg below static_test (4.6 sigma)"
};

/// A scalar parameter of a − that of b.
struct ParameterDifference {
  std::string parameter, a, b;  ///< a, b: methods
  Estimate difference;          ///< sigma combined as of independent errors
  double sigmas = 0.0;          ///< |difference| / sigma
  std::string sentence;  ///< where that is above 3: "k of equation_error is 0.073 ± 0.002 1/s below that of output_error (30 sigma): …"
};

/// What was left out of a comparison.
struct NotCompared {
  std::string what, why;
};

/// Everything compare.json holds. Combined sigmas treat the two errors as independent; methods that read the same data share part of their
/// errors, so that a difference between methods is, if anything, more significant than it looks, one against a reference is as it stands.
struct Comparison {
  std::vector<MethodSummary> methods;
  std::vector<CurveDifference> curves;
  std::vector<TrimDifference> trims;
  std::vector<ParameterDifference> parameters;
  std::vector<NotCompared> not_compared;
  std::map<std::string, Estimate> reference_trims;  ///< name → trim [rad]
  std::optional<SimulatedMotion> motion;            ///< missing: no fitted model with its random force
};

/// compare.json:
/// {"methods":{METHOD:{"status","message","driven","trim_deg","slopes","at_trim","rms","validation_rms","loglik","validation_loglik",
/// "parameters"}},"curves":[…],"references":[…],"trims":[…],"parameters":[…],"reference_trims_deg":{…},"not_compared":[…],"simulated_motion":{…}};
/// null for what is not known, angles of curves in degrees.
void write_comparison(const std::filesystem::path& path, const Comparison& comparison);

/// The other way; InputError with the file's name if it is not of that form.
[[nodiscard]] Comparison read_comparison(const std::filesystem::path& path);

}  // namespace misfit
