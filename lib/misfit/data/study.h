#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "misfit/core/config.h"
#include "misfit/data/image.h"
#include "misfit/data/track.h"

namespace misfit {

/// What is followed in pictures: "auto", "moving", "ring", "bright", "dark", "aruco", or a picture cut from a frame.
struct MarkerStudy {
  std::string kind;  ///< one of these; "picture" if `picture` is given
  std::optional<std::filesystem::path> picture = {};
  std::optional<int> id = {};  ///< of "aruco", and of it alone: which tag
};

/// [camera]: calibrated from a static sweep, or given as numbers.
struct CameraStudy {
  std::optional<std::filesystem::path> sweep;         ///< calibrate from it …
  std::optional<std::filesystem::path> sweep_images;  ///< … or from pictures: a table of angles and image or video files (data/sweep.h)
  MarkerStudy sweep_marker;                           ///< of the three points in them; default that of [video]
  std::vector<PixelPoint> sweep_points;               ///< about where points 1, 2, 3 are in the first picture; empty: from the geometry
  std::string model;                                  ///< "pinhole" or "plane_by_plane"
  std::map<std::string, config::Number> given;        ///< … or h_c, K and any other camera parameter, with sigma where known
  std::vector<std::string> offer;                     ///< optional parameters that calibrate may select; default all
  std::vector<std::string> free;                      ///< optional parameters that calibrate must free whatever the test says

  [[nodiscard]] bool from_sweep() const { return sweep || sweep_images; }
};

/// A length that is known between two places of a picture, in the plane in which what is followed moves.
struct KnownLength {
  PixelPoint from, to;  ///< [px]
  double metres = 0.0;
};

/// [video.chessboard]: a board that stands still in the plane in which what is followed moves.
struct ChessboardStudy {
  int columns = 0, rows = 0;  ///< squares
  double square = 0.0;        ///< [m] side of one
};

/// [video.points.NAME]: a place of that plane that is known, and where it is in the picture.
struct KnownPoint {
  std::string name;
  std::optional<PixelPoint> at;  ///< [px], or …
  std::optional<int> tag;        ///< … at the centre of the ArUco tag of this id
  double x = 0.0, y = 0.0;       ///< [m]
};

/// [video.aruco]: which tags are in the picture.
struct ArucoStudy {
  std::string dictionary;        ///< "4x4", …
  std::optional<int> plane;      ///< id of the tag that stands still in that plane …
  std::optional<double> side{};  ///< … and the side of its black square [m]
};

/// [video.markers.NAME]: one of several that are followed in a video.
struct NamedMarker {
  std::string name;
  MarkerStudy marker;
  std::optional<PixelPoint> start;              ///< as in VideoStudy
  std::optional<std::array<double, 4>> region;  ///< as in VideoStudy
};

/// [video]: how a video is read and what is followed in it.
struct VideoStudy {
  std::string fields;        ///< "auto", "progressive", "top_first", "bottom_first"
  bool check_fields = true;  ///< false: `fields` holds even if the pictures contradict it
  MarkerStudy marker;
  std::optional<PixelPoint> start;                 ///< about where the marker is in the first frame [px]
  std::optional<std::array<double, 4>> region;     ///< left, top, right, bottom [px]: where it is looked for
  std::optional<KnownLength> length = {};          ///< for x_m and y_m
  std::optional<PixelPoint> origin = {};           ///< of x_m and y_m; the picture's middle without
  std::vector<NamedMarker> markers = {};           ///< several, each with channels of its own name; empty: the one above
  std::optional<ChessboardStudy> chessboard = {};  ///< one of these at most, or `length`: what x_m and y_m are known by
  std::vector<KnownPoint> points = {};             ///< four or more, or none
  ArucoStudy aruco = {};

  /// Do pixels become metres by a map of the plane (data/track_facts.h), and not by one scale?
  [[nodiscard]] bool has_plane() const { return chessboard || !points.empty() || aruco.plane; }
  [[nodiscard]] std::vector<std::string> marker_names() const;
};

struct ExperimentStudy {
  std::string name;
  std::optional<std::filesystem::path> track, video, data;  ///< exactly one
  ColumnMap columns;
  std::optional<config::Section> columns_section;  ///< where they stand, for messages
  enum class Validation { none, last_fraction, interval } validation = Validation::none;
  double fraction = 0.0;        ///< last_fraction: 0.25 for "last 25 %"
  double from = 0.0, to = 0.0;  ///< interval [s]
  long exclude = 0;             ///< initial samples
  Source where;
};

/// An effect that the study itself declares: `port` and a formula.
struct FormulaStudy {
  std::string formula, port;
  Source where;                               ///< of the formula's first character
  std::vector<std::string> strengths;         ///< coefficients that switch it off; empty: from the formula
  std::optional<config::Section> parameters;  ///< NAME = { unit, value, bounds, … }: its coefficients
};

/// One line of [effects].
struct EffectStudy {
  std::string name;                             ///< key in the study: "bearing"
  std::string kind;                             ///< effect's key: "coulomb_friction"; default = name
  std::map<std::string, std::string> roles;     ///< role → quantity or port, as bound by the study
  std::map<std::string, config::Number> start;  ///< parameter → value to start from, as written (unit checked by the model)
  std::vector<std::string> free, fixed;         ///< parameters that are estimated, or kept, unlike the effect says itself
  Source where;
  std::optional<FormulaStudy> declared;
};

/// [initial] NAME: what is known of the state at the first sample.
struct InitialStudy {
  std::string kind;                     ///< "free", "shared", "fixed"; empty: as the system says
  std::optional<config::Number> value;  ///< as written (unit checked by the model)
  Source where;
};

/// [noise] OUTPUT: what is known of its white measurement noise.
struct NoiseStudy {
  config::Number sigma;  ///< as written (unit checked by the model)
  bool fixed = true;     ///< false: where the estimation starts
  /// [Hz] Where coloured noise of it is looked for: the middle of a band of waves, hum, sway. Then a sigma need not be given: 0.
  std::optional<double> frequency;
  Source where;
};

struct ParameterStudy {
  std::optional<bool> free;
  std::optional<config::Section> section;  ///< holds value, bounds, sigma with the unit that the model will name
  Source where;
};

struct CurveStudy {
  std::string of;                                    ///< quantity; empty: that of the effect's specification
  std::optional<std::vector<config::Number>> knots;  ///< without a unit: in that which is shown (display_unit()); nullopt = "auto"
  std::optional<double> roughness;                   ///< nullopt = "auto"; unit of the weight: see inference/roughness.h
  std::optional<std::filesystem::path> table;  ///< CSV with columns `of` and the curve's name: values to start from, or to simulate with
  Source where;
};

/// [simulate]: what `misfit simulate` makes when the study has no experiment to take times and initial state from.
struct SimulateStudy {
  double duration = 0.0;                          ///< [s]
  double step = 0.0;                              ///< [s]
  std::map<std::string, config::Number> initial;  ///< state → value as written (unit checked by the model)
  std::map<std::string, config::Number> noise;    ///< output → sigma of white noise added, as written
};

/// One entry of [uncertainty] perturb.
struct PerturbStudy {
  std::string name;       ///< what is perturbed: of the geometry, the camera, the model, or P_y, P_z
  config::Number number;  ///< how far, as written (unit checked by whoever knows it); positive
  /// The number is "3 sigma", "2 sigma" or one "sigma" of a normal distribution, or ± the bounds of a "uniform" one.
  std::string distribution = "3 sigma";
};

/// [uncertainty]: the Monte-Carlo over the set-up, block bootstrap, profiles and random starts.
struct UncertaintyStudy {
  long runs = 0;
  std::vector<PerturbStudy> perturb;  ///< in file order
  bool calibrated_camera = false;     ///< camera = "calibration": its free parameters too, with their joint covariance
  long bootstrap = 0;                 ///< runs of the block bootstrap of every method asked for; 0: none
  long block = 0;                     ///< its blocks [samples]; 0: from the residuals
  std::vector<std::string> profile;   ///< parameters whose profile likelihood is wanted
  long starts = 0;                    ///< random starts of every method that has a likelihood; 0: none
  bool recalibrate = false;           ///< the camera is calibrated again in every run, from the sweep with the perturbed geometry
  Source where, where_camera, where_profile;
};

/// [system] hold: one of those of an input of a declared system.
struct HoldStudy {
  std::string hold;
  Source where;
};

/// A study as written. Everything that can be checked without the model has been checked.
struct Study {
  std::filesystem::path file, folder;
  std::string name, question;
  std::vector<std::string> methods;  ///< names of data/estimators.h
  unsigned long seed = 1;
  std::string system_kind;  ///< or …
  std::optional<std::filesystem::path> system_file;
  std::map<std::string, config::Number> system_numbers;
  std::map<std::string, bool> system_flags;  ///< "induced_angle"
  std::map<std::string, Source> system_where;
  std::map<std::string, HoldStudy> system_hold;  ///< input → what it is between its samples, in place of what the file says
  std::optional<config::Section> geometry;       ///< read key by key by whoever knows the units (rig and system); finish() after that
  CameraStudy camera;
  VideoStudy video;
  bool has_camera = false;
  std::vector<ExperimentStudy> experiments;
  std::vector<EffectStudy> effects;  ///< in file order
  std::map<std::string, ParameterStudy> parameters;
  std::map<std::string, InitialStudy> initial;
  std::map<std::string, NoiseStudy> noise;
  std::optional<double> force_time;              ///< [force] correlation_time [s], fixed; 0: white
  std::optional<config::Number> force_strength;  ///< [force] strength: its prior, with sigma
  std::map<std::string, CurveStudy> curves;
  std::map<std::string, std::filesystem::path> reference;  ///< curve → file
  std::optional<SimulateStudy> simulate;
  std::optional<UncertaintyStudy> uncertainty;
  std::optional<double> fit_time_limit, discover_time_limit;  ///< time_limit of [fit], [discover] [s]
  double bin_width = 0.0;                                     ///< [sliding_bin] width [rad]; 0: that of BinSize
  double bin_step = 0.0;                                      ///< [sliding_bin] step [rad]; 0: that of BinSize
  std::string text;                                           ///< the file's content, for hashing and resolved.toml
};

/// Reads and checks DIR/study.toml. Relative paths are taken from the study's folder, and every file named must exist.
[[nodiscard]] Study read_study(const std::filesystem::path& path);

}  // namespace misfit
