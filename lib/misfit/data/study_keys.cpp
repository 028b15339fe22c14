#include "misfit/data/study_keys.h"

#include "misfit/core/text.h"
#include "misfit/core/toml_document.h"
#include "misfit/core/toml_text.h"
#include "misfit/core/units.h"
#include "misfit/data/bin_size.h"
#include "misfit/data/estimators.h"
#include "misfit/data/study.h"
#include "misfit/math/camera.h"

namespace misfit {
namespace {

using config::Key;
using config::KeyGroup;
using Type = config::KeyType;

constexpr double max_runs = 100'000'000, max_block = 10'000'000, max_excluded = 1'000'000'000;

const std::vector<std::string> markers{"ring", "bright", "dark"};
const std::vector<std::string> followed{"auto", "moving", "ring", "bright", "dark", "aruco"};

/// Defaults are those of the structs that hold what was read (data/study.h): each stands there alone.
const char* flag_text(bool flag) { return flag ? "true" : "false"; }

// A key is a line of attributes and a line of meaning.
// clang-format off

KeyGroup study_group() {
  return {"study", "What the study is called and how it is estimated.",
     {{.name = "name", .otherwise = "name of the folder", .meaning = "Title of the report."},
      {.name = "question", .fallback = "\"\"", .meaning = "Question that the study is to answer; stands below the title."},
      {.name = "methods", .type = Type::texts, .fallback = toml_texts(default_estimators()),
       .choices = estimator_names(),
       .meaning = std::string("Estimators, in this order of work; ") + random_force_estimator().name +
          " serves diagnose and discover and is run there if it is not named."},
      {.name = "seed", .type = Type::integer, .fallback = std::to_string(Study{}.seed), .least = 0, .meaning = "Of all random numbers."}}};
}

KeyGroup system_group() {
  return {"system", "The skeleton of the model: one that the program brings (kind), or one declared as text (file).",
     {{.name = "kind", .otherwise = "file is given instead", .meaning = "Name of a system of the program."},
      {.name = "file", .type = Type::file, .otherwise = "kind is given instead",
       .meaning = "Declared system (TOML); its keys: misfit help system."},
      {.name = "hold", .type = Type::table, .otherwise = "as the file says",
       .meaning = "Input = what it is between its samples, in place of what the file says: { u = \"zero_order\" }."},
      {.name = "OPTION", .type = Type::flag, .otherwise = "as the system says", .any = true,
       .meaning = "Option of the system, as induced_angle = false of parachute_planar."}}};
}

KeyGroup hold_group() {
  return {"system.hold", "What the inputs of a declared system (file) are between their samples.",
     {{.name = "INPUT", .type = Type::choice, .otherwise = "as the file says", .choices = hold_names(), .any = true,
       .meaning = "Constant until the next sample, straight to it, or a cubic spline (sampled behind an anti-aliasing filter)."}}};
}

Key rig(const char* name, const char* unit, const char* meaning) {
  return {.name = name, .type = Type::number_with_sigma, .unit = unit, .otherwise = "required where a camera is used", .least = 0.0,
     .above = true,
     .meaning = std::string(meaning) + "."};
}

KeyGroup geometry_group() {
  return {"geometry",
     "Constants of the system, and the rig that the camera looks at. A constant is fixed unless [parameters] frees it; sigma is then its "
     "prior.",
     {rig("R", "m", "Swivel to apex"), rig("R_cp", "m", "Swivel to centre of pressure"), rig("V", "m/s", "Free-stream speed"),
      rig("l_b", "m", "Backshell face to camera, along x"), rig("l_s", "m", "Swivel to camera, along x"),
      rig("l_p", "m", "Static rig: backshell face to pivot, along x"), rig("R1", "m", "Static rig: pivot to reference point 1"),
      rig("R2", "m", "Static rig: pivot to reference point 2"), rig("R3", "m", "Static rig: pivot to reference point 3"),
      {.name = "CONSTANT", .type = Type::number_with_sigma, .unit = "of the constant",
       .otherwise = "required, unless the system has a default", .any = true,
       .meaning = "Any constant of the system (list below)."}}};
}

std::vector<Key> sweep_keys() {
  const std::vector<std::string> optional{"camera_roll", "image_centre", "pixel_aspect", "lens_k1", "camera_distance"};
  return {{.name = "sweep", .type = Type::file, .otherwise = "none",
       .meaning = "Table of the static sweep: angle of the rig and pixels of its three points."},
      {.name = "sweep_images", .type = Type::file, .otherwise = "none",
       .meaning = "Instead of sweep: table of angles and image or video files."},
      {.name = "sweep_marker", .type = Type::file, .otherwise = "that of [video], for auto and moving a ring", .choices = markers,
       .form = R"("ring", "bright", "dark" or a file ending in .png)",
       .needs = {"sweep_images"},
       .meaning = "Marker of the three points in these pictures."},
      {.name = "sweep_points", .type = Type::numbers, .unit = "px", .otherwise = "predicted from [geometry]", .form = "list of 6 numbers",
       .needs = {"sweep_images"},
       .meaning = "About where points 1, 2, 3 are in the first picture: column, row of each."},
      {.name = "model", .type = Type::choice, .fallback = "\"pinhole\"", .choices = {"pinhole", "plane_by_plane"},
       .meaning = "Projection."},
      {.name = "offer", .type = Type::texts, .otherwise = "all of them", .choices = optional, .needs = {"sweep", "sweep_images"},
       .meaning = "Optional parameters among which the calibration selects by a significance test."},
      {.name = "free", .type = Type::texts, .otherwise = "none", .choices = optional, .needs = {"sweep", "sweep_images"},
       .formerly = "take_in",
       .meaning = "Optional parameters that the calibration estimates whatever the test says."}};
}

std::vector<Key> camera_number_keys() {
  const std::array<const char*, 8> meanings = {"Height of the camera above the swivel",
                                               "Scale at the backshell face; the focal length in pixels is l_b K",
                                               "Rotation of the image about the optical axis",
                                               "Image centre: added to P_y",
                                               "Image centre: added to P_z",
                                               "Relative stretch of P_y",
                                               "Radial distortion: P (1 + lens_k1 r^2), r = |P|/(l_b K)",
                                               "Correction of the distance from camera to rig, added to l_b and l_s in every depth"};
  std::vector<Key> keys;
  for (std::size_t i = 0; i < camera_parameter_names.size(); ++i) {
    keys.push_back({.name = camera_parameter_names[i], .type = Type::number_with_sigma, .unit = camera_parameter_units[i],
                    .otherwise = i < 2 ? "required without a sweep" : "0",
                    .meaning = std::string(meanings[i]) + "; where there is no sweep."});
  }
  return keys;
}

KeyGroup camera_group() {
  KeyGroup group{"camera",
     "The camera, calibrated from a static sweep or given as numbers (h_c and K at least). Needed where an experiment has a track or "
     "video.",
     sweep_keys()};
  for (const Key& key : camera_number_keys()) group.keys.push_back(key);
  return group;
}

/// Of [video], and of each of its markers.
std::vector<Key> followed_keys() {
  return {
      {.name = "marker", .type = Type::file, .fallback = "\"auto\"", .choices = followed,
       .form = R"("auto", "moving", "ring", "bright", "dark", "aruco" or a file ending in .png)",
       .meaning = "What is followed: the one object that moves before a ground that stands still, by its outline; a ring; a bright or dark "
                  "spot; the ArUco tag `id`; or a picture cut from a frame. auto: a ring where the first frames show one, else moving."},
      {.name = "id", .type = Type::integer, .otherwise = "required for aruco", .least = 0, .most = 99,
       .meaning = "Which tag of [video.aruco] dictionary is followed, by its centre."},
      {.name = "start", .type = Type::numbers, .unit = "px", .otherwise = "searched", .form = "list of 2 numbers",
       .meaning = "About where the marker is in the first frame: column, row."},
      {.name = "region", .type = Type::numbers, .unit = "px", .otherwise = "whole frame", .form = "list of 4 numbers",
       .meaning = "Where the marker is looked for: left, top, right, bottom."}};
}

KeyGroup chessboard_group() {
  return {"video.chessboard",
     "A chessboard in the plane of the motion, seen whole in some frames at least. x_m goes along its rows or columns, whichever is nearer to the "
     "right of the picture; x_m and y_m are 0 at its lower left inner corner, or at [video] origin.",
     {{.name = "columns", .type = Type::integer, .otherwise = "required", .least = 4, .most = 100, .meaning = "Squares side by side."},
      {.name = "rows", .type = Type::integer, .otherwise = "required", .least = 4, .most = 100, .meaning = "Squares one above the other."},
      {.name = "square", .type = Type::number, .unit = "m", .otherwise = "required", .least = 0.0, .above = true,
       .meaning = "Side of one square."}}};
}

KeyGroup point_group() {
  return {"video.points.NAME",
     "A place in the plane of the motion that is known. Four or more, not on one line; from twelve on the distortion of the lens is estimated too, "
     "where it is significant.",
     {{.name = "pixel", .type = Type::numbers, .unit = "px", .otherwise = "that of tag", .form = "list of 2 numbers",
       .meaning = "Where it is in the picture: column, row."},
      {.name = "tag", .type = Type::integer, .otherwise = "none", .least = 0, .most = 99,
       .meaning = "Instead of pixel: it is the centre of this ArUco tag."},
      {.name = "place", .type = Type::numbers, .unit = "m", .otherwise = "required", .form = "list of 2 numbers",
       .meaning = "Its x_m and y_m."}}};
}

KeyGroup aruco_group() {
  return {"video.aruco", "ArUco tags: what they are, and which one gives places in metres.",
     {{.name = "dictionary", .type = Type::choice, .fallback = "\"4x4\"", .choices = {"4x4", "5x5", "6x6", "7x7"},
       .meaning = "Cells of a tag inside its black border: OpenCV's DICT_4X4_50, _100, … (ids 0 to 99, which are the same in all of a size)."},
      {.name = "plane", .type = Type::integer, .otherwise = "none", .least = 0, .most = 99, .needs = {"side"},
       .meaning = "Id of a tag that stands still in the plane of the motion; x_m goes along its lower edge, and x_m and y_m are 0 at its centre, or "
                  "at [video] origin."},
      {.name = "side", .type = Type::number, .unit = "m", .otherwise = "none", .least = 0.0, .above = true, .needs = {"plane"},
       .meaning = "Side of the tag's black square."}}};
}

std::vector<KeyGroup> video_groups() {
  KeyGroup video{"video", "How a video is read and what is followed in it.",
     {{.name = "fields", .type = Type::choice, .fallback = "\"auto\"", .choices = {"auto", "progressive", "top_first", "bottom_first"},
       .meaning = "Interlacing: order of the two fields of a frame; auto finds it from the pictures."},
      {.name = "check_fields", .type = Type::flag, .fallback = flag_text(VideoStudy{}.check_fields),
       .meaning = "false: fields holds even if the pictures contradict it."},
      {.name = "length", .type = Type::number, .unit = "m", .otherwise = "none: no metres",
       .meaning = "A length that is known in the picture, in the plane of the motion: with it a film gives x_m and y_m."},
      {.name = "length_ends", .type = Type::numbers, .unit = "px", .otherwise = "none", .form = "list of 4 numbers",
       .meaning = "Its two ends in the picture: column, row, column, row."},
      {.name = "origin", .type = Type::numbers, .unit = "px", .otherwise = "the picture's middle; of a chessboard or tag as it says", .form = "list of 2 numbers",
       .meaning = "Where x_m and y_m are 0: column, row. x_m goes to the right, y_m upwards. Not with points, which say it."},
      {.name = "chessboard", .type = Type::table, .otherwise = "none",
       .meaning = "A chessboard that stands still in the plane of the motion: places in metres, also of a camera that looks obliquely."},
      {.name = "points", .type = Type::table, .otherwise = "none",
       .meaning = "The same by four or more places that are known, each a table [video.points.NAME]."},
      {.name = "aruco", .type = Type::table, .otherwise = "none", .meaning = "ArUco tags in the picture; the same by one of them."},
      {.name = "markers", .type = Type::table, .otherwise = "the one above",
       .meaning = "Several that are followed, each a table [video.markers.NAME]. Outputs read x_px_NAME, y_px_NAME, x_m_NAME and y_m_NAME."}}};
  const std::vector<Key> followed_alone = followed_keys();
  video.keys.insert(video.keys.begin() + 2, followed_alone.begin(), followed_alone.end());
  KeyGroup marker{"video.markers.NAME", "One of several markers.", followed_keys()};
  marker.keys.front().fallback = "";
  marker.keys.front().otherwise = "that of [video]";
  return {video, marker, chessboard_group(), point_group(), aruco_group()};
}

KeyGroup experiment_group() {
  return {"experiment", "One recording. Exactly one of data, track and video is needed.",
     {{.name = "name", .otherwise = "name of the file", .meaning = "Part of file names and headings."},
      {.name = "data", .type = Type::file, .otherwise = "none", .meaning = "Recording of time, inputs and outputs: CSV, MAT, HDF5, NPY, NPZ, ULog (.ulg), DataFlash (.bin)."},
      {.name = "track", .type = Type::file, .otherwise = "none", .meaning = "Table (CSV) of the marker's pixels."},
      {.name = "video", .type = Type::file, .otherwise = "none", .meaning = "Video in which a marker, or what moves, is followed. A system with outputs x_px, y_px (column and row), or x_m, y_m, reads them; "
                  "any other reads angles through [camera]."},
      {.name = "columns", .type = Type::table, .otherwise = "headers are called as the signals",
       .meaning = "Signal = header of its column (of a video: x_px, y_px, x_m or y_m), { t = \"t_s\", y = \"y_V\" }, or channel of a log: { y = \"topic.field\" }. In a log, "
                  "the rows are the times of all outputs and of held inputs, or those of `t`; what was done is noted."},
      {.name = "exclude", .type = Type::integer, .fallback = std::to_string(ExperimentStudy{}.exclude), .least = 0, .most = max_excluded,
       .meaning = "Samples at the beginning that do not count: a transient of the rig."},
      {.name = "validation", .type = Type::file, .otherwise = "nothing is held out",
       .form = "\"last 25 %\", [t0, t1] or a file (.csv, .mat, .ulg, …)",
       .meaning = "What is held out of the estimation: the end of the recording, an interval [s], or a recording of its own."}}, true};
}

KeyGroup columns_group() {
  return {"experiment.columns", "Which column of the file is which signal.",
     {{.name = "SIGNAL", .otherwise = "the signal's name", .any = true,
       .meaning = "Header of the column; its unit behind it in brackets, y[deg], else at the end of its name, y_deg."}}};
}

std::vector<KeyGroup> effect_groups() {
  return {{"effects.NAME", "An effect of the program (misfit effects lists them), by the name that the model is to have for it.",
       {{.name = "kind", .otherwise = "NAME", .meaning = "Key of the effect."},
        {.name = "start", .type = Type::table, .otherwise = "as the effect says",
         .meaning = "Parameter = value to start from, where [parameters] gives none."},
        {.name = "free", .type = Type::texts, .otherwise = "as the effect says", .meaning = "Parameters that are estimated, where [parameters] does not say."},
        {.name = "fixed", .type = Type::texts, .otherwise = "as the effect says", .meaning = "Parameters that keep their value, where [parameters] does not say."},
        {.name = "ROLE", .otherwise = "quantity or port of the same name, else the system's choice", .any = true,
         .meaning = "Quantity that the effect reads, or port that it adds to, in place of the one of that name."}}},
      {"effects.NAME.start", "Values to start from.",
       {{.name = "PARAMETER", .type = Type::number, .unit = "of the parameter", .otherwise = "as the effect says", .any = true,
         .meaning = "Start of the estimation. Where none is given for a free frequency, sector, delay, edge or time constant, a scan of it is made."}}},
      {"effects.NAME", "An effect that the study declares by a formula.",
       {{.name = "formula", .otherwise = "required",
         .meaning = "What the effect adds to the port, as \"-c*x*abs(x)\"; units are checked."},
        {.name = "port", .otherwise = "required", .meaning = "Port that it adds to: dx/dt, or an input, quantity or parameter that it changes."},
        {.name = "strengths", .type = Type::texts, .otherwise = "those in which the formula is linear",
         .meaning = "Parameters that, all 0, switch the effect off."},
        {.name = "parameters", .type = Type::table, .otherwise = "none", .meaning = "Parameters of the formula."},
        {.name = "start", .type = Type::table, .otherwise = "as the parameters say",
         .meaning = "Parameter = value to start from, where [parameters] gives none."},
        {.name = "free", .type = Type::texts, .otherwise = "as the parameters say", .meaning = "Parameters that are estimated, where [parameters] does not say."},
        {.name = "fixed", .type = Type::texts, .otherwise = "as the parameters say", .meaning = "Parameters that keep their value, where [parameters] does not say."}}, false, "formula"},
      {"effects.NAME.parameters.NAME", "A parameter of a declared effect.",
       declared_parameter_keys(true)}};
}

KeyGroup parameters_group() {
  KeyGroup group{"parameters.NAME",
     "A parameter of the model: a coefficient, a constant of [geometry], or a curve as a whole. EFFECT.PARAMETER, in quotation marks, "
     "where two effects have one of the same name.",
     {{.name = "free", .type = Type::flag, .otherwise = "as the effect or system says", .meaning = "Estimated, or kept at its value."},
      {.name = "value", .type = Type::number, .unit = "of the parameter", .otherwise = "as the effect or system says",
       .meaning = "Start of the estimation, or the value where it is fixed; with sigma the mean of the prior, without it no prior moves."},
      {.name = "bounds", .type = Type::numbers, .unit = "of the parameter", .otherwise = "as the effect or system says",
       .form = "list of 2 numbers",
       .meaning = "[lower, upper]: limits of the estimate."},
      {.name = "sigma", .type = Type::number, .unit = "of the parameter", .otherwise = "none, or that of [geometry] or the calibration",
       .least = 0.0, .above = true,
       .meaning = "Standard deviation of a Gaussian prior about the value."}}};
  group.dotted = true;
  return group;
}

KeyGroup curves_group() {
  return {"curves.NAME", "A coefficient as a function of a quantity: a cubic B-spline with a roughness penalty.",
     {{.name = "of", .otherwise = "that of a coefficient that is a curve by itself, as C_m",
       .meaning = "Quantity that it depends on, as alpha_T; needed with knots or a table."},
      {.name = "knots", .type = Type::numbers, .unit = "of the quantity as shown: deg for angles, deg/s for their rates", .fallback = "\"auto\"",
       .form = "\"auto\" or list of numbers",
       .meaning = "Breakpoints of the spline, increasing, at least two; auto: 17 over the range that the data visit."},
      {.name = "roughness", .type = Type::number, .unit = "of quantity^3/curve^2", .fallback = "\"auto\"", .least = 0.0,
       .form = "\"auto\" or number",
       .meaning = "Smoothing parameter, weight of the integral of the squared second derivative; auto: by marginal likelihood."},
      {.name = "table", .type = Type::file, .otherwise = "none",
       .meaning = "CSV with a column of the quantity and one of the curve: where the estimation starts, or what is simulated."}}};
}

std::vector<KeyGroup> initial_groups() {
  return {{"initial", "The state at the first sample of each experiment.",
       {{.name = "STATE", .type = Type::other, .unit = "of the state", .otherwise = "as the system says (most: free)",
         .form = R"("free", "shared", number or table)", .any = true,
         .meaning = std::string("free: estimated in every experiment; shared: one value for all experiments, in ") +
                    random_force_estimator().name + " one each; a number: fixed."}}},
      {"initial.NAME", "The same with a value to start from.",
       {{.name = "kind", .type = Type::choice, .otherwise = "as the system says", .choices = {"free", "shared", "fixed"},
         .meaning = "As above."},
        {.name = "value", .type = Type::number, .unit = "of the state", .otherwise = "none; required where it is fixed",
         .meaning = "Start of the estimation, or the value where it is fixed."}}}};
}

std::vector<KeyGroup> noise_groups() {
  return {{"noise", "What is known of the measurement noise; an output that is not named here: estimated, with a start from the data.",
       {{.name = "OUTPUT", .type = Type::other, .unit = "of the output", .otherwise = "estimated", .form = "number or table", .any = true,
         .meaning = "A number: the standard deviation of its white noise, fixed in every method that weighs outputs by it."}}},
      {"noise.NAME", "The same, fixed or as a start.",
       {{.name = "value", .type = Type::number, .unit = "of the output", .otherwise = "required where there is no frequency", .least = 0.0,
         .above = true, .meaning = "Standard deviation."},
        {.name = "fixed", .type = Type::flag, .fallback = flag_text(NoiseStudy{}.fixed), .meaning = "Fixed there, or estimated from there."},
        {.name = "frequency", .type = Type::number, .unit = "Hz", .otherwise = "well above the motion", .least = 0.0, .above = true,
         .meaning = std::string("Middle of a band of coloured noise in the output, as waves, hum or a mast that sways make it: ") +
                    random_force_estimator().name + " estimates it from half of this to 3.3 times, beside white noise that is not fixed."}}}};
}

std::vector<KeyGroup> force_groups() {
  return {{"force", std::string("The random force of ") + random_force_estimator().name + ", an Ornstein-Uhlenbeck process on every port.",
     {{.name = "correlation_time", .type = Type::number, .unit = "s", .otherwise = "estimated", .least = 0.0,
         .meaning = "Fixed at this; 0: a white force (a memory of 0.3 samples)."},
        {.name = "strength", .type = Type::table, .otherwise = "no prior",
         .meaning = "A log-normal prior of its standard deviation on the ports of one unit."}}},
      {"force.strength", "The prior of the random force's strength: its logarithm is normal about log(value) with a standard deviation of sigma/value.",
       {{.name = "value", .type = Type::number, .unit = "of the ports (named where they have several)", .otherwise = "required", .least = 0.0,
         .above = true, .meaning = "Median."},
        {.name = "sigma", .type = Type::number, .unit = "of the value", .otherwise = "required", .least = 0.0, .above = true,
         .meaning = "Standard deviation where it is much smaller than the value."}}}};
}

KeyGroup reference_group() {
  return {"reference", "Curves from elsewhere, drawn and compared, never fitted.",
     {{.name = "CURVE", .type = Type::file, .otherwise = "none", .any = true,
       .meaning = "CSV with a column of the quantity and one of the curve."}}};
}

const std::vector<std::string> distributions{"3 sigma", "2 sigma", "sigma", "uniform"};

KeyGroup uncertainty_group() {
  return {"uncertainty", "Monte Carlo over geometry, camera and mass; bootstrap, profiles, random starts (misfit uncertainty).",
     {{.name = "runs", .type = Type::integer, .fallback = "1000", .least = 1, .most = max_runs, .meaning = "Monte Carlo runs."},
      {.name = "perturb", .type = Type::table, .otherwise = "nothing",
       .meaning = "What is perturbed and how far: { V = \"0.5 m/s\", P_y = \"10 px\" }."},
      {.name = "distribution", .type = Type::choice, .otherwise = toml_string(PerturbStudy{}.distribution), .choices = distributions,
       .form = R"("3 sigma", "2 sigma", "sigma", "uniform" or table)", .formerly = "readings",
       .meaning = "Distribution of the errors whose size perturb gives: normal, the size being 3, 2 or 1 standard deviations, or uniform "
                  "within ± the size. One for all, or a table."},
      {.name = "camera", .type = Type::choice, .otherwise = "not perturbed, but for what perturb names", .choices = {"calibration"},
       .meaning = "calibration: the camera's parameters too, with their joint covariance."},
      {.name = "recalibrate", .type = Type::flag, .fallback = flag_text(UncertaintyStudy{}.recalibrate),
       .meaning = "The camera is calibrated again in every run, from the sweep with the perturbed geometry."},
      {.name = "bootstrap", .type = Type::integer, .otherwise = "no bootstrap", .least = 2, .most = max_runs,
       .meaning = "Replicas of the block bootstrap, for every method."},
      {.name = "block", .type = Type::integer, .otherwise = "from the residuals' autocorrelation", .least = 1, .most = max_block,
       .meaning = "Samples of a block of the bootstrap."},
      {.name = "starts", .type = Type::integer, .otherwise = "none", .least = 1, .most = max_runs,
       .meaning = "Random starts of every method that has a likelihood."},
      {.name = "profile", .type = Type::texts, .otherwise = "none", .meaning = "Parameters whose profile likelihood is computed."}}};
}

std::vector<KeyGroup> perturbation_groups() {
  return {{"uncertainty.perturb", "How far each is perturbed.",
       {{.name = "NAME", .type = Type::number, .unit = "of the number", .otherwise = "not perturbed", .least = 0.0, .above = true,
         .any = true,
         .meaning = "A name of [geometry] or [camera], a parameter, or P_y, P_z: an offset of all pixels."}}},
      {"uncertainty.distribution", "Where not all have the same distribution.",
       {{.name = "NAME", .type = Type::choice, .fallback = toml_string(PerturbStudy{}.distribution), .choices = distributions, .any = true,
         .meaning = "Of an entry of perturb."}}}};
}

KeyGroup sliding_bin_group() {
  const auto angle = [](const char* name, const char* meaning, double fallback) {
    return Key{.name = name, .type = Type::number, .unit = "rad", .fallback = toml_string(format_value(fallback / kDegree) + " deg"),
               .least = 0.0, .most = 30.0 * kDegree, .above = true, .meaning = meaning};
  };
  const std::string method = estimators::sliding_bin.name;
  return {method, "Bins of the method " + method + ".",
     {angle("width", "Width of a bin.", BinSize{}.width), angle("step", "By which the bin slides.", BinSize{}.step)}};
}

std::vector<KeyGroup> time_groups() {
  return {{"fit", "How long estimating may take.",
       {{.name = "time_limit", .type = Type::number, .unit = "s",
         .otherwise = "none for a fit; for a refit of discover 10 times as long as the fit before it, at least 60 s", .least = 0.0,
         .above = true,
         .meaning = "Of every fit and refit: then it ends with the best values until then, and is not called converged."}}},
      {"discover", "How long a search for missing effects may take.",
       {{.name = "time_limit", .type = Type::number, .unit = "s",
         .otherwise = "10 times that of a refit", .least = 0.0, .above = true,
         .meaning = "Of one round: then it ends with what was found, and what was not tested is named."}}}};
}

std::vector<KeyGroup> simulate_groups() {
  const auto seconds = [](const char* name, const char* meaning, const char* fallback) {
    return Key{.name = name, .type = Type::number, .unit = "s", .fallback = fallback, .least = 0.0, .above = true,
               .meaning = meaning};
  };
  return {{"simulate", "What misfit simulate makes; without this section, the motion of the fitted model.",
       {seconds("duration", "Length of the motion.", "10"),
        seconds("step", "Sampling interval; by default that of video, 1/59.94 s.", "0.016683350016683352"),
        {.name = "initial", .type = Type::table, .otherwise = "every state 0", .meaning = "State = value at the start."},
        {.name = "noise", .type = Type::table, .otherwise = "no noise",
         .meaning = "Output = standard deviation of white noise added to it."}}},
      {"simulate.initial", "Where the motion starts.",
       {{.name = "STATE", .type = Type::number, .unit = "of the state", .otherwise = "0", .any = true, .meaning = "Value at t = 0."}}},
      {"simulate.noise", "Measurement noise of the simulation.",
       {{.name = "OUTPUT", .type = Type::number, .unit = "of the output", .otherwise = "0", .least = 0.0, .any = true,
         .meaning = "Standard deviation."}}}};
}

// clang-format on

std::vector<KeyGroup> all_groups() {
  std::vector<KeyGroup> out{study_group(), system_group(), hold_group(), geometry_group(), camera_group()};
  const auto add = [&](const std::vector<KeyGroup>& groups) { out.insert(out.end(), groups.begin(), groups.end()); };
  add(video_groups());
  add({experiment_group(), columns_group()});
  add(effect_groups());
  add({parameters_group(), curves_group()});
  add(initial_groups());
  add(noise_groups());
  add(force_groups());
  add({reference_group()});
  add({uncertainty_group()});
  add(perturbation_groups());
  add({sliding_bin_group()});
  add(time_groups());
  add(simulate_groups());
  return out;
}

}  // namespace

std::vector<std::string> hold_names() { return {"zero_order", "first_order", "band_limited"}; }

std::span<const KeyGroup> study_keys() {
  static const std::vector<KeyGroup> groups = all_groups();
  return groups;
}

// clang-format off
std::vector<Key> declared_parameter_keys(bool free) {
  return {{.name = "unit", .otherwise = "required", .meaning = "SI, as \"m/s\"; \"-\" if it has none."},
      {.name = "value", .type = Type::number, .unit = "of the entry",
       .otherwise = free ? "0, or the bound nearest to it" : "required of the study",
       .meaning = free ? "Start of the estimation." : "Value; without one [geometry] or [parameters] must give it."},
      {.name = "bounds", .type = Type::numbers, .unit = "of the entry", .otherwise = "none", .form = "list of 2 numbers",
       .meaning = "[lower, upper]: limits of the value."},
      {.name = "free", .type = Type::flag, .fallback = free ? "true" : "false", .meaning = "Estimated, or kept at its value."},
      {.name = "sigma", .type = Type::number, .unit = "of the entry", .otherwise = "no prior", .least = 0.0, .above = true,
       .meaning = "Standard deviation of a Gaussian prior about the value."},
      {.name = "scale", .type = Type::number, .unit = "of the entry", .otherwise = "size of the value, else sigma, else 1", .least = 0.0,
       .above = true,
       .meaning = "Typical size: for steps of the search and random starts."},
      {.name = "doc", .fallback = "\"\"", .meaning = "What it is."}};
}
// clang-format on

}  // namespace misfit
