#include "misfit/data/study_keys.h"

#include <numbers>

#include "misfit/core/toml_document.h"
#include "misfit/core/toml_text.h"
#include "misfit/data/estimators.h"
#include "misfit/math/camera.h"

namespace misfit {
namespace {

using config::Key;
using config::KeyGroup;
using Type = config::KeyType;

constexpr double degree = std::numbers::pi / 180.0;
constexpr double most_runs = 100'000'000, most_block = 10'000'000, most_excluded = 1'000'000'000;

const std::vector<std::string> markers{"ring", "bright", "dark"};

std::string text_list(const std::vector<std::string>& texts) {
  std::vector<std::string> values;
  for (const std::string& text : texts) values.push_back(toml_string(text));
  return toml_list(values);
}

KeyGroup study_group() {
  return {"study",
          "What the study is called and how it is estimated.",
          {{.name = "name", .meaning = "Title of the report.", .otherwise = "name of the folder"},
           {.name = "question", .meaning = "Question that the study is to answer; stands below the title.", .fallback = "\"\""},
           {.name = "methods",
            .type = Type::texts,
            .meaning = "Estimators, in this order of work; filter_error serves diagnose and discover and is run there if it is not named.",
            .fallback = text_list(default_estimators()),
            .choices = estimator_names()},
           {.name = "seed", .type = Type::integer, .meaning = "Of all random numbers.", .fallback = "1", .least = 0}}};
}

KeyGroup system_group() {
  return {"system",
          "The skeleton of the model: one that the program brings (kind), or one declared as text (file).",
          {{.name = "kind", .meaning = "Name of a system of the program.", .otherwise = "file is given instead"},
           {.name = "file",
            .type = Type::file,
            .meaning = "Declared system (TOML); its keys: misfit help system.",
            .otherwise = "kind is given instead"},
           {.name = "OPTION",
            .type = Type::flag,
            .meaning = "Option of the system, as induced_angle = false of parachute_planar.",
            .otherwise = "as the system says",
            .any = true}}};
}

Key rig(const char* name, const char* unit, const char* meaning) {
  return {.name = name,
          .type = Type::number_with_sigma,
          .meaning = std::string(meaning) + ".",
          .unit = unit,
          .otherwise = "required where a camera is used",
          .least = 0.0,
          .above = true};
}

KeyGroup geometry_group() {
  return {"geometry",
          "Constants of the system, and the rig that the camera looks at. A constant is fixed unless [parameters] frees it; sigma is "
          "then its prior.",
          {rig("R", "m", "Swivel to apex"),
           rig("R_cp", "m", "Swivel to centre of pressure"),
           rig("V", "m/s", "Free-stream speed"),
           rig("l_b", "m", "Backshell face to camera, along x"),
           rig("l_s", "m", "Swivel to camera, along x"),
           rig("l_p", "m", "Static rig: backshell face to pivot, along x"),
           rig("R1", "m", "Static rig: pivot to reference point 1"),
           rig("R2", "m", "Static rig: pivot to reference point 2"),
           rig("R3", "m", "Static rig: pivot to reference point 3"),
           {.name = "CONSTANT",
            .type = Type::number_with_sigma,
            .meaning = "Any constant of the system (list below).",
            .unit = "of the constant",
            .otherwise = "required, unless the system has a default",
            .any = true}}};
}

std::vector<Key> sweep_keys() {
  const std::vector<std::string> optional{"camera_roll", "image_centre", "pixel_aspect", "lens_k1", "camera_distance"};
  return {{.name = "sweep",
           .type = Type::file,
           .meaning = "Table of the static sweep: angle of the rig and pixels of its three points.",
           .otherwise = "none"},
          {.name = "sweep_images",
           .type = Type::file,
           .meaning = "Instead of sweep: table of angles and image or video files.",
           .otherwise = "none"},
          {.name = "sweep_marker",
           .type = Type::file,
           .meaning = "Marker of the three points in these pictures.",
           .otherwise = "that of [video]",
           .choices = markers,
           .form = "as marker of [video]",
           .needs = {"sweep_images"}},
          {.name = "sweep_points",
           .type = Type::numbers,
           .meaning = "About where points 1, 2, 3 are in the first picture: column, row of each.",
           .unit = "px",
           .otherwise = "predicted from [geometry]",
           .form = "list of 6 numbers",
           .needs = {"sweep_images"}},
          {.name = "model",
           .type = Type::choice,
           .meaning = "Projection.",
           .fallback = "\"pinhole\"",
           .choices = {"pinhole", "plane_by_plane"}},
          {.name = "offer",
           .type = Type::texts,
           .meaning = "Optional parameters among which the calibration selects by a significance test.",
           .otherwise = "all of them",
           .choices = optional,
           .needs = {"sweep", "sweep_images"}},
          {.name = "take_in",
           .type = Type::texts,
           .meaning = "Optional parameters that the calibration estimates whatever the test says.",
           .otherwise = "none",
           .choices = optional,
           .needs = {"sweep", "sweep_images"}}};
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
    keys.push_back({.name = camera_parameter_names[i],
                    .type = Type::number_with_sigma,
                    .meaning = std::string(meanings[i]) + "; where there is no sweep.",
                    .unit = camera_parameter_units[i],
                    .otherwise = i < 2 ? "required without a sweep" : "0"});
  }
  return keys;
}

KeyGroup camera_group() {
  KeyGroup group{
      "camera",
      "The camera, calibrated from a static sweep or given as numbers (h_c and K at least). Needed where an experiment has a track "
      "or video.",
      sweep_keys()};
  for (const Key& key : camera_number_keys()) group.keys.push_back(key);
  return group;
}

KeyGroup video_group() {
  return {"video",
          "How a video is read and what is followed in it.",
          {{.name = "fields",
            .type = Type::choice,
            .meaning = "Interlacing: order of the two fields of a frame; auto finds it from the pictures.",
            .fallback = "\"auto\"",
            .choices = {"auto", "progressive", "top_first", "bottom_first"}},
           {.name = "check_fields",
            .type = Type::flag,
            .meaning = "false: fields holds even if the pictures contradict it.",
            .fallback = "true"},
           {.name = "marker",
            .type = Type::file,
            .meaning = "What is followed: a ring, a bright or dark spot, or a picture cut from a frame.",
            .fallback = "\"ring\"",
            .choices = markers,
            .form = R"("ring", "bright", "dark" or a file ending in .png)"},
           {.name = "start",
            .type = Type::numbers,
            .meaning = "About where the marker is in the first frame: column, row.",
            .unit = "px",
            .otherwise = "searched",
            .form = "list of 2 numbers"},
           {.name = "region",
            .type = Type::numbers,
            .meaning = "Where the marker is looked for: left, top, right, bottom.",
            .unit = "px",
            .otherwise = "whole frame",
            .form = "list of 4 numbers"}}};
}

KeyGroup experiment_group() {
  return {"experiment",
          "One recording. Exactly one of data, track and video is needed.",
          {{.name = "name", .meaning = "Part of file names and headings.", .otherwise = "name of the file"},
           {.name = "data", .type = Type::file, .meaning = "Table (CSV) of time, inputs and outputs.", .otherwise = "none"},
           {.name = "track", .type = Type::file, .meaning = "Table (CSV) of the marker's pixels.", .otherwise = "none"},
           {.name = "video", .type = Type::file, .meaning = "Video in which the marker is followed.", .otherwise = "none"},
           {.name = "columns",
            .type = Type::table,
            .meaning = "Signal = header of its column: { t = \"t_s\", y = \"y_V\" }.",
            .otherwise = "headers are called as the signals"},
           {.name = "exclude",
            .type = Type::integer,
            .meaning = "Samples at the beginning that do not count: a transient of the rig.",
            .fallback = "0",
            .least = 0,
            .most = most_excluded},
           {.name = "validation",
            .type = Type::file,
            .meaning = "What is held out of the estimation: the end of the recording, an interval [s], or a recording of its own.",
            .otherwise = "nothing is held out",
            .form = "\"last 25 %\", [t0, t1] or a file ending in .csv"}},
          true};
}

KeyGroup columns_group() {
  return {"experiment.columns",
          "Which column of the file is which signal.",
          {{.name = "SIGNAL",
            .meaning = "Header of the column; units behind it in brackets, as y[deg].",
            .otherwise = "the signal's name",
            .any = true}}};
}

std::vector<KeyGroup> effect_groups() {
  return {
      {"effects.NAME",
       "An effect of the program (misfit effects lists them), by the name that the model is to have for it.",
       {{.name = "kind", .meaning = "Key of the effect.", .otherwise = "NAME"},
        {.name = "start",
         .type = Type::table,
         .meaning = "Parameter = value to start from, where [parameters] gives none.",
         .otherwise = "as the effect says"},
        {.name = "ROLE",
         .meaning = "Quantity that the effect reads, or port that it adds to, in place of the one of that name.",
         .otherwise = "quantity or port of the same name, else the system's choice",
         .any = true}}},
      {"effects.NAME.start",
       "Values to start from.",
       {{.name = "PARAMETER",
         .type = Type::number,
         .meaning = "Start of the estimation.",
         .unit = "of the parameter",
         .otherwise = "as the effect says",
         .any = true}}},
      {"effects.NAME",
       "An effect that the study declares by a formula.",
       {{.name = "formula", .meaning = "What the effect adds to the port, as \"-c*x*abs(x)\"; units are checked.", .otherwise = "required"},
        {.name = "port", .meaning = "Port that it adds to, as dx/dt.", .otherwise = "required"},
        {.name = "strengths",
         .type = Type::texts,
         .meaning = "Parameters that, all 0, switch the effect off.",
         .otherwise = "those in which the formula is linear"},
        {.name = "parameters", .type = Type::table, .meaning = "Parameters of the formula.", .otherwise = "none"},
        {.name = "start",
         .type = Type::table,
         .meaning = "Parameter = value to start from, where [parameters] gives none.",
         .otherwise = "as the parameters say"}},
       false,
       "formula"},
      {"effects.NAME.parameters.NAME", "A parameter of a declared effect.", declared_parameter_keys(true)}};
}

KeyGroup parameters_group() {
  return {"parameters.NAME",
          "A parameter of the model: a coefficient, a constant of [geometry], or a curve as a whole. EFFECT.PARAMETER, in quotation marks, "
          "where two effects have one of the same name.",
          {{.name = "free", .type = Type::flag, .meaning = "Estimated, or kept at its value.", .otherwise = "as the effect or system says"},
           {.name = "value",
            .type = Type::number,
            .meaning = "Start of the estimation, or the value where it is fixed.",
            .unit = "of the parameter",
            .otherwise = "as the effect or system says"},
           {.name = "bounds",
            .type = Type::numbers,
            .meaning = "[lower, upper]: limits of the estimate.",
            .unit = "of the parameter",
            .otherwise = "as the effect or system says",
            .form = "list of 2 numbers"},
           {.name = "sigma",
            .type = Type::number,
            .meaning = "Standard deviation of a Gaussian prior about the value.",
            .unit = "of the parameter",
            .otherwise = "none, or that of [geometry] or the calibration",
            .least = 0.0,
            .above = true}}};
}

KeyGroup curves_group() {
  return {"curves.NAME",
          "A coefficient as a function of a quantity: a cubic B-spline with a roughness penalty.",
          {{.name = "of", .meaning = "Quantity that it depends on, as alpha_T.", .otherwise = "required"},
           {.name = "knots",
            .type = Type::numbers,
            .meaning = "Breakpoints of the spline, increasing, at least two; auto: 17 over the range that the data visit.",
            .unit = "deg for angles, else that of the quantity",
            .fallback = "\"auto\"",
            .form = "\"auto\" or list of numbers"},
           {.name = "roughness",
            .type = Type::number,
            .meaning = "Smoothing parameter, weight of the integral of the squared second derivative; auto: by marginal likelihood.",
            .unit = "of quantity^3/curve^2",
            .fallback = "\"auto\"",
            .least = 0.0,
            .form = "\"auto\" or number"},
           {.name = "table",
            .type = Type::file,
            .meaning = "CSV with a column of the quantity and one of the curve: where the estimation starts, or what is simulated.",
            .otherwise = "none"}}};
}

std::vector<KeyGroup> initial_groups() {
  return {{"initial",
           "The state at the first sample of each experiment.",
           {{.name = "STATE",
             .type = Type::other,
             .meaning = "free: estimated in every experiment; shared: one value for all experiments; a number: fixed.",
             .unit = "of the state",
             .otherwise = "as the system says (most: free)",
             .form = R"("free", "shared", number or table)",
             .any = true}}},
          {"initial.NAME",
           "The same with a value to start from.",
           {{.name = "kind",
             .type = Type::choice,
             .meaning = "As above.",
             .otherwise = "as the system says",
             .choices = {"free", "shared", "fixed"}},
            {.name = "value",
             .type = Type::number,
             .meaning = "Start of the estimation, or the value where it is fixed.",
             .unit = "of the state",
             .otherwise = "none; required where it is fixed"}}}};
}

KeyGroup reference_group() {
  return {"reference",
          "Curves from elsewhere, drawn and compared, never fitted.",
          {{.name = "CURVE",
            .type = Type::file,
            .meaning = "CSV with a column of the quantity and one of the curve.",
            .otherwise = "none",
            .any = true}}};
}

const std::vector<std::string> readings{"3 sigma", "2 sigma", "sigma", "uniform"};

KeyGroup uncertainty_group() {
  return {"uncertainty",
          "Monte Carlo over geometry, camera and mass; bootstrap, profiles, random starts (misfit uncertainty).",
          {{.name = "runs", .type = Type::integer, .meaning = "Monte Carlo runs.", .fallback = "1000", .least = 1, .most = most_runs},
           {.name = "perturb",
            .type = Type::table,
            .meaning = "What is perturbed and how far: { V = \"0.5 m/s\", P_y = \"10 px\" }.",
            .otherwise = "nothing"},
           {.name = "readings",
            .type = Type::choice,
            .meaning = "What these numbers are: of a normal distribution, or the bounds of a uniform one. One for all, or a table.",
            .otherwise = "\"3 sigma\"",
            .choices = readings,
            .form = R"("3 sigma", "2 sigma", "sigma", "uniform" or table)"},
           {.name = "camera",
            .type = Type::choice,
            .meaning = "calibration: the camera's parameters too, with their joint covariance.",
            .otherwise = "not perturbed, but for what perturb names",
            .choices = {"calibration"}},
           {.name = "recalibrate",
            .type = Type::flag,
            .meaning = "The camera is calibrated again in every run, from the sweep with the perturbed geometry.",
            .fallback = "false"},
           {.name = "bootstrap",
            .type = Type::integer,
            .meaning = "Replicas of the block bootstrap, for every method.",
            .otherwise = "no bootstrap",
            .least = 2,
            .most = most_runs},
           {.name = "block",
            .type = Type::integer,
            .meaning = "Samples of a block of the bootstrap.",
            .otherwise = "from the residuals' autocorrelation",
            .least = 1,
            .most = most_block},
           {.name = "starts",
            .type = Type::integer,
            .meaning = "Random starts of every method that has a likelihood.",
            .otherwise = "none",
            .least = 1,
            .most = most_runs},
           {.name = "profile", .type = Type::texts, .meaning = "Parameters whose profile likelihood is computed.", .otherwise = "none"}}};
}

std::vector<KeyGroup> perturbation_groups() {
  return {{"uncertainty.perturb",
           "How far each is perturbed.",
           {{.name = "NAME",
             .type = Type::number,
             .meaning = "A name of [geometry] or [camera], a parameter, or P_y, P_z: an offset of all pixels.",
             .unit = "of the number",
             .otherwise = "not perturbed",
             .least = 0.0,
             .above = true,
             .any = true}}},
          {"uncertainty.readings",
           "Where not all are read alike.",
           {{.name = "NAME",
             .type = Type::choice,
             .meaning = "Of an entry of perturb.",
             .fallback = "\"3 sigma\"",
             .choices = readings,
             .any = true}}}};
}

KeyGroup sliding_bin_group() {
  const auto angle = [](const char* name, const char* meaning, const char* fallback) {
    return Key{.name = name,
               .type = Type::number,
               .meaning = meaning,
               .unit = "rad",
               .fallback = fallback,
               .least = 0.0,
               .most = 30.0 * degree,
               .above = true};
  };
  return {"sliding_bin",
          "Bins of the method sliding_bin.",
          {angle("width", "Width of a bin.", "\"1.5 deg\""), angle("step", "By which the bin slides.", "\"0.1 deg\"")}};
}

std::vector<KeyGroup> simulate_groups() {
  const auto seconds = [](const char* name, const char* meaning, const char* fallback) {
    return Key{.name = name, .type = Type::number, .meaning = meaning, .unit = "s", .fallback = fallback, .least = 0.0, .above = true};
  };
  return {{"simulate",
           "What misfit simulate makes; without this section, the motion of the fitted model.",
           {seconds("duration", "Length of the motion.", "10"),
            seconds("step", "Sampling interval; by default that of video, 1/59.94 s.", "0.016683350016683352"),
            {.name = "initial", .type = Type::table, .meaning = "State = value at the start.", .otherwise = "every state 0"},
            {.name = "noise",
             .type = Type::table,
             .meaning = "Output = standard deviation of white noise added to it.",
             .otherwise = "no noise"}}},
          {"simulate.initial",
           "Where the motion starts.",
           {{.name = "STATE", .type = Type::number, .meaning = "Value at t = 0.", .unit = "of the state", .otherwise = "0", .any = true}}},
          {"simulate.noise",
           "Measurement noise of the simulation.",
           {{.name = "OUTPUT",
             .type = Type::number,
             .meaning = "Standard deviation.",
             .unit = "of the output",
             .otherwise = "0",
             .least = 0.0,
             .any = true}}}};
}

std::vector<KeyGroup> all_groups() {
  std::vector<KeyGroup> out{study_group(), system_group(),     geometry_group(), camera_group(),
                            video_group(), experiment_group(), columns_group()};
  const auto add = [&](const std::vector<KeyGroup>& groups) { out.insert(out.end(), groups.begin(), groups.end()); };
  add(effect_groups());
  add({parameters_group(), curves_group()});
  add(initial_groups());
  add({reference_group()});
  add({uncertainty_group()});
  add(perturbation_groups());
  add({sliding_bin_group()});
  add(simulate_groups());
  return out;
}

}  // namespace

std::span<const KeyGroup> study_keys() {
  static const std::vector<KeyGroup> groups = all_groups();
  return groups;
}

std::vector<Key> declared_parameter_keys(bool free) {
  return {{.name = "unit", .meaning = "SI, as \"m/s\"; \"-\" if it has none.", .otherwise = "required"},
          {.name = "value",
           .type = Type::number,
           .meaning = free ? "Start of the estimation." : "Value; without one [geometry] or [parameters] must give it.",
           .unit = "of the entry",
           .otherwise = free ? "0, or the bound nearest to it" : "required of the study"},
          {.name = "bounds",
           .type = Type::numbers,
           .meaning = "[lower, upper]: limits of the value.",
           .unit = "of the entry",
           .otherwise = "none",
           .form = "list of 2 numbers"},
          {.name = "free", .type = Type::flag, .meaning = "Estimated, or kept at its value.", .fallback = free ? "true" : "false"},
          {.name = "sigma",
           .type = Type::number,
           .meaning = "Standard deviation of a Gaussian prior about the value.",
           .unit = "of the entry",
           .otherwise = "no prior",
           .least = 0.0,
           .above = true},
          {.name = "scale",
           .type = Type::number,
           .meaning = "Typical size: for steps of the search and random starts.",
           .unit = "of the entry",
           .otherwise = "size of the value, else sigma, else 1",
           .least = 0.0,
           .above = true},
          {.name = "doc", .meaning = "What it is.", .fallback = "\"\""}};
}

}  // namespace misfit
