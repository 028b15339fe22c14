#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace misfit {

/// A number that can be reported: with sigma and unit.
struct Estimate {
  double value = 0.0;
  double sigma = 0.0;  ///< 0: not estimated
  std::string unit;
  std::optional<std::pair<double, double>> interval = std::nullopt;  ///< 95 %, where it is not value ± 1.96 sigma
};

/// A curve with its band, on a grid of its argument.
struct CurveEstimate {
  std::string name;       ///< "C_m"
  std::string of;         ///< quantity: "alpha_T"
  std::string of_unit;    ///< SI unit of the quantity: "rad"
  std::string unit;       ///< of the value: "-"
  std::vector<double> x;  ///< [of_unit]
  std::vector<double> value;
  std::vector<double> sigma;
  std::vector<double> count;  ///< samples (bin or grid cell) behind the value; 0: outside the visited range
  bool informative = true;    ///< false: the method cannot give this curve from these data; `why` says why
  std::string why;
  bool trimmed = false;  ///< the system's static curve: its stable zero is the fit's trim
};

/// A curve at each of several values of a roughness, that of another curve perhaps.
struct CurvesByRoughness {
  std::string name, of, of_unit, unit;      ///< as of CurveEstimate
  std::vector<double> x;                    ///< [of_unit]
  std::vector<std::vector<double>> values;  ///< roughness → x → [unit]
};

/// What another roughness of a curve would make of it and of the curves derived from it, all other unknowns following, by the fit's
/// linearisation (inference/roughness.h roughness_paths()).
struct RoughnessPath {
  std::string curve;                   ///< whose roughness it is
  std::string unit;                    ///< of the roughness
  double used = 0.0;                   ///< with which the fit was made
  bool chosen = false;                 ///< from the data; false: the study gives it
  std::vector<double> roughness;       ///< rising, in steps of equal ratio
  std::vector<double> log_likelihood;  ///< marginal one, less that with `used`
  std::vector<CurvesByRoughness> curves;
};

enum class FitStatus { converged, not_converged, declined, failed };
inline constexpr std::array<const char*, 4> fit_status_names = {"converged", "not_converged", "declined", "failed"};
[[nodiscard]] std::string to_string(FitStatus status);

/// [samples] A prediction so far ahead shows what acts slowly or comes late, which one of a single sample hardly does.
inline constexpr int kFarAhead = 32;

/// One channel of one experiment against the model.
struct ChannelPrediction {
  std::string experiment, channel, unit;
  std::vector<double> t, measured, predicted, sigma;  ///< SI; NaN = missing; sigma of measured − predicted under the model
  std::vector<bool> held_out;                         ///< validation part
  /// Of the residuals that enter the fit: RMS [SI], and that over the standard deviation of the same measurements, missing where these do
  /// not vary.
  std::optional<double> rms = {}, nrmse = {};
  std::vector<double> ahead = {};  ///< of filter_error: predicted kFarAhead samples ahead; NaN: not there
};

/// "1.1 % of the motion", two digits.
[[nodiscard]] std::string share_of_motion_in_words(double nrmse);

/// What every method returns. An empty `predictions` means the method does not predict motion.
struct Fit {
  std::string method;  ///< EstimatorInfo::name
  FitStatus status = FitStatus::failed;
  std::string message;                ///< why it stopped, in words
  std::vector<std::string> warnings;  ///< what a reader must know before believing it
  /// Of these, in short, what makes the model doubtful: a clause of each parameter that ends at a bound other than 0, is not determined at
  /// all, or is a time beyond the recording. Missing in an older file.
  std::optional<std::vector<std::string>> doubts;
  std::map<std::string, Estimate> parameters;  ///< free parameters (curve coefficients as NAME[i]) and derived numbers, SI
  std::vector<std::string> names;              ///< order of `covariance`
  Eigen::MatrixXd covariance;
  std::map<std::string, double> plain_sigmas;  ///< by parameter, and "trim": sigma had the residuals been white; empty: not distinguished
  std::map<std::string, Estimate> noise, force;
  std::optional<double> loglik, validation_loglik;
  std::optional<Estimate> trim;                         ///< [rad]
  std::map<std::string, Estimate> rms, validation_rms;  ///< per channel
  std::vector<CurveEstimate> curves;
  std::vector<RoughnessPath> roughness;
  std::vector<ChannelPrediction> predictions;
  std::map<std::string, std::string> facts;  ///< further findings in words, for fit.json ("telescoped_sum": "…")
  bool driven = false;                       ///< the motion is driven by something the model does not have
  bool coloured = false;                     ///< the residuals are clearly not white, as a warning says
  bool driven_untested = false;              ///< `driven` could not be tested: other methods judge for themselves; not in fit.json
  double seconds = 0.0;
  int linearisations = 0;

  /// A warning that begins with `clause`, one of its doubts.
  void add_doubt(const std::string& clause, const std::string& more = "");
  /// Has it a result, be it that the iterations stopped before the maximum?
  [[nodiscard]] bool usable() const { return status == FitStatus::converged || status == FitStatus::not_converged; }
  /// What it says of that to other methods; nullopt where it could not test it.
  [[nodiscard]] std::optional<bool> says_driven() const { return driven_untested ? std::nullopt : std::optional(driven); }
};

/// Writes fit.json, curves.csv and one prediction.csv into `dir`; several experiments: prediction_NAME.csv beside; curves with a
/// roughness: roughness.json.
void write_fit(const std::filesystem::path& dir, const Fit& fit);
[[nodiscard]] Fit read_fit(const std::filesystem::path& dir);

}  // namespace misfit
