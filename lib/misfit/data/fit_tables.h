#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "misfit/data/fit.h"

namespace misfit {

/// A file of curves and the numbers (into Fit::curves) of the curves it holds: they share quantity and units.
struct CurveFile {
  std::string name;
  std::vector<std::size_t> curves;
};

/// curves.csv holds the curves of the static curve's quantity (of the first curve's if none is static); another quantity or unit of the
/// value gets curves_QUANTITY.csv, and curves_QUANTITY_2.csv should it differ in the unit of the value only.
[[nodiscard]] std::vector<CurveFile> curve_files(const std::vector<CurveEstimate>& curves);

/// `curve,OF[unit],value[unit],sigma[unit],count`; angles in degrees, missing values empty. Atomic; RunError as write_atomically.
void write_curves(const std::filesystem::path& path, const std::vector<CurveEstimate>& curves, const CurveFile& file);

/// Fills x, value, sigma and count of the curves of `file`, whose names and units are known already (fit.json). InputError naming file,
/// line and text if the file is not of the form above or names a curve that fit.json does not.
void read_curves(const std::filesystem::path& path, std::vector<CurveEstimate>& curves, const CurveFile& file);

/// A file of predictions: the channels of one experiment.
struct PredictionFile {
  std::string name, experiment;
  std::vector<std::size_t> channels;  ///< into Fit::predictions
};

/// prediction.csv for the first experiment, prediction_EXPERIMENT.csv for each other.
[[nodiscard]] std::vector<PredictionFile> prediction_files(const std::vector<ChannelPrediction>& predictions);

/// `t[s]`, then NAME_measured, NAME_predicted, NAME_sigma and, where there is one, NAME_ahead (predicted kFarAhead samples ahead) per
/// channel with units (angles in degrees), then held_out (0 or 1).
/// RunError if the channels of one experiment are not on one time base.
void write_predictions(const std::filesystem::path& path, const std::vector<ChannelPrediction>& predictions, const PredictionFile& file);

/// Fills t, measured, predicted, sigma, ahead and held_out of the channels of `file`.
void read_predictions(const std::filesystem::path& path, std::vector<ChannelPrediction>& predictions, const PredictionFile& file);

}  // namespace misfit
