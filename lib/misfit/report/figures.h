#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "misfit/data/attitude.h"
#include "misfit/data/calibration.h"
#include "misfit/data/fit.h"
#include "misfit/data/reference.h"
#include "misfit/data/track.h"
#include "misfit/report/figure.h"

namespace misfit::report {

// Each builder turns data into a Figure and computes nothing but what drawing needs (counts per bin, the autocorrelation of given
// residuals). Method k of `fits` has colour palette(k) in every figure. Angles are drawn in degrees.

/// One curve of all methods with 1-sigma bands on one axis (as Figs. 5, 7, 9, 10 of the paper, lib/misfit/README.md [1]), the points of the
/// references with error bars and, for the static moment, every trim ± sigma as a diamond on the zero line. Dashed: outside the visited
/// range (count 0). Grey dotted, "not informative" in the legend: the method says that it cannot give the curve from these data. Only
/// curves of the quantity `of`; fits that declined or failed are noted.
[[nodiscard]] Figure curve_figure(const std::string& curve, const std::string& of, const std::vector<Fit>& fits,
                                  const std::vector<Reference>& references);

/// Every curve that fits or references have, with its quantity, in order of first appearance.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> curve_names(const std::vector<Fit>& fits,
                                                                           const std::vector<Reference>& references);

/// Interval of time [s].
struct Interval {
  double from = 0.0, to = 0.0;
};

/// Measured and predicted motion with measured − predicted below, in ± 1 sigma of the prediction (Fig. 6). `zoom`: that part only. The
/// validation part is drawn in another colour.
[[nodiscard]] Figure motion_figure(const std::string& method, const ChannelPrediction& channel, const std::optional<Interval>& zoom);

/// A channel as measured, and as two models predict it kFarAhead samples ahead (ChannelPrediction::ahead): the one whose errors fall most
/// from `before` to `after`, the model with `added` in it, over the 400 samples in which they do. nullopt: the squares of none fall by a
/// fifth.
[[nodiscard]] std::optional<Figure> change_ahead_figure(const Fit& before, const Fit& after, const std::string& added);

/// An interval of about `length` seconds in the middle third of the record where most samples are finite.
[[nodiscard]] Interval typical_interval(const std::vector<double>& t, const std::vector<double>& values, double length);

/// The part of a series that is drawn by itself, so that one sees how samples follow each other: a typical_interval() of about `samples`
/// usual steps. nullopt: the series is not twice as long, or has gaps wherever one looks.
[[nodiscard]] std::optional<Interval> part_to_draw(const std::vector<double>& t, const std::vector<double>& values, std::size_t samples);

/// Autocorrelation of the residuals of one channel over their predicted sigma (estimation part), with the ± 1.96/sqrt(n) band that white
/// residuals keep to at 95 % of the lags. `max_lag` samples.
[[nodiscard]] Figure autocorrelation_figure(const std::string& method, const ChannelPrediction& channel, std::size_t max_lag = 60);

/// Histogram of the residuals of one channel over their predicted sigma (estimation part) with the density of the standard normal
/// distribution. Residuals beyond ± 5 are counted in a note.
[[nodiscard]] Figure residual_histogram_figure(const std::string& method, const ChannelPrediction& channel);

/// P_y, P_z and sigma of a track over time, with its losses.
[[nodiscard]] Figure track_figure(const std::string& experiment, const Track& track);

/// theta and psi against time, points as read and the three-point average (Fig. 8).
[[nodiscard]] Figure orientation_figure(const std::string& experiment, const Attitude& attitude, const Interval& part);
/// The path of the axis, psi to the right and theta up: the camera's image turned by half a turn (in the image y is to the left and z
/// down).
[[nodiscard]] Figure path_figure(const std::string& experiment, const Attitude& attitude);
/// alpha_T and phi over the whole record.
[[nodiscard]] Figure history_figure(const std::string& experiment, const Attitude& attitude);
/// How many samples per 0.5 deg of alpha_T.
[[nodiscard]] Figure histogram_figure(const std::string& experiment, const Attitude& attitude);

/// Measured and predicted pixels of the reference points against the angle of the rig, coordinate by coordinate.
[[nodiscard]] Figure calibration_figure(const Calibration& calibration);
/// measured − predicted per point and coordinate; points set aside as outliers are grey.
[[nodiscard]] Figure calibration_residual_figure(const Calibration& calibration);

}  // namespace misfit::report
