#include "misfit/data/study_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>

#include "misfit/core/shown.h"
#include "misfit/core/units.h"
#include "misfit/math/camera.h"

namespace misfit::study_parts {

namespace fs = std::filesystem;
using config::DescribedSection;
using config::Section;

DescribedSection described(const Section& section, std::string_view key, std::string_view path) {
  const auto table = section.table(key);
  return {table ? *table : Section::parse("", section.file().string()), config::group_of(study_keys(), path.empty() ? key : path)};
}

std::optional<fs::path> existing_file(const Section& section, std::string_view key, const fs::path& folder) {
  const auto name = section.text(key);
  if (!name) return std::nullopt;
  if (name->find('\0') != std::string::npos) section.fail(key, "'" + shown(*name) + "': a file name cannot hold the character NUL");
  const fs::path path = (folder / *name).lexically_normal();
  std::error_code error;
  if (!name->empty() && fs::is_regular_file(path, error)) return path;
  if (!name->empty() && fs::exists(path, error)) section.fail(key, "'" + shown(*name) + "' is no file");
  const fs::path where = path.has_parent_path() ? path.parent_path() : ".";
  std::vector<std::string> names;
  for (fs::directory_iterator it(where, error), end; !error && it != end; it.increment(error)) {
    if (it->is_regular_file(error)) names.push_back(it->path().filename().string());
  }
  const std::string nearest = nearest_name(path.filename().string(), names);
  section.fail(key, "no such file '" + shown(*name) + "' in " + shown(where.string()) +
                        (nearest.empty() ? "" : " — did you mean '" + shown(nearest) + "'?"));
}

config::Number number_as_written(const Section& section, std::string_view key) {
  if (!section.is_text(key)) return *section.number(key, "");
  config::Number out;
  out.where = section.where(key);
  try {
    const Quantity quantity = parse_quantity(section.text(key).value_or(""));
    out.value = quantity.value;
    out.unit = quantity.unit;
  } catch (const InputError& error) {
    section.fail(key, error.what());
  }
  return out;
}

namespace {

void check_camera(const Section& section, const CameraStudy& camera) {
  if (camera.sweep && camera.sweep_images) section.fail("sweep_images", "the sweep is either a table of positions (sweep) or of pictures");
  if (camera.from_sweep() && !camera.given.empty()) {
    section.fail(camera.given.begin()->first, "a camera is either calibrated from sweep or given; remove one of the two");
  }
  if (!camera.from_sweep() && (camera.given.count("h_c") == 0 || camera.given.count("K") == 0))
    section.fail("", "sweep = \"FILE\" (or sweep_images), or both h_c and K, are needed");
}

/// Absent or "auto"; another text is refused.
bool is_auto(const Section& section, std::string_view key) {
  if (section.has(key) && !section.is_text(key)) return false;
  (void)section.choice(key, {"auto"});
  return true;
}

}  // namespace

void read_camera(const Section& root, Study& study) {
  study.has_camera = root.has("camera");
  if (!study.has_camera) return;
  const DescribedSection section = described(root, "camera");
  CameraStudy& camera = study.camera;
  camera.sweep = existing_file(section, "sweep", study.folder);
  read_sweep_images(section, study);
  camera.model = *section.choice("model");
  camera.offer = section.texts("offer").value_or(section.description().key("offer").choices);
  camera.free = section.texts("free").value_or(std::vector<std::string>{});
  for (const char* name : camera_parameter_names) {
    if (const auto number = section.number(name)) camera.given[name] = *number;
  }
  section.finish();
  check_camera(section, camera);
}

namespace {

FormulaStudy read_formula(const DescribedSection& section) {
  FormulaStudy out;
  out.formula = *section.text("formula");
  out.where = section.where_text("formula");
  const auto port = section.text("port");
  if (!port) section.fail("port", "a formula adds to a port: name it, as port = \"dx2/dt\"");
  out.port = *port;
  out.strengths = section.texts("strengths").value_or(std::vector<std::string>{});
  out.parameters = section.table("parameters");
  return out;
}

InitialStudy read_one_initial(const Section& initial, const std::string& key) {
  InitialStudy out;
  out.where = initial.where(key);
  const auto is_kind = [](const std::string& text) { return text == "free" || text == "shared"; };
  if (initial.is_table(key)) {
    const DescribedSection table = described(initial, key, "initial.NAME");
    out.kind = table.choice("kind").value_or("");
    if (table.has("value")) out.value = number_as_written(table, "value");
    table.finish();
    if (out.kind == "fixed" && !out.value) table.fail("value", "a fixed initial state needs a value");
  } else if (initial.is_text(key) && is_kind(*initial.text(key))) {
    out.kind = *initial.text(key);
  } else {
    out.value = number_as_written(initial, key);
    out.kind = "fixed";
  }
  return out;
}

}  // namespace

namespace {

/// A value with its sigma, both above 0.
config::Number read_strength(const Section& force) {
  const DescribedSection table = described(force, "strength", "force.strength");
  std::map<std::string, config::Number> read;
  for (const char* key : {"value", "sigma"}) {
    if (!table.has(key)) continue;
    const config::Number number = number_as_written(table, key);
    if (!(number.value > 0.0))
      table.fail(key, fmt::format("{} must be above 0: the logarithm of the strength has a normal prior", number.value));
    read[key] = number;
  }
  table.finish();
  for (const char* key : {"value", "sigma"}) {
    if (!read.contains(key)) table.fail(key, "is missing: a prior has a value and a sigma");
  }
  config::Number out = read["value"];
  const config::Number& sigma = read["sigma"];
  if (!sigma.unit.empty() && !parse_unit(sigma.unit).same_dimension(parse_unit(out.unit)))
    table.fail("sigma", fmt::format("[{}] is no unit of the value, [{}]", sigma.unit, out.unit));
  out.sigma = sigma.value;
  out.where = force.where("strength");
  return out;
}

}  // namespace

void read_force(const Section& root, Study& study) {
  if (!root.has("force")) return;
  const DescribedSection force = described(root, "force");
  study.force_time = force.value("correlation_time");
  if (force.has("strength")) study.force_strength = read_strength(force);
  force.finish();
}

void read_noise_table(const DescribedSection& table, NoiseStudy& out) {
  out.frequency = table.value("frequency");
  out.fixed = *table.flag("fixed") && !out.frequency;
  if (out.frequency && table.has("fixed") && *table.flag("fixed"))
    table.fail("fixed", "is true beside a frequency: what is white and what is coloured is estimated together");
  if (table.has("value")) {
    out.sigma = number_as_written(table, "value");
  } else if (!out.frequency) {
    table.finish();  // a key that is none comes first
    table.fail("value", "is missing: a standard deviation");
  }
  table.finish();
}

void read_noise(const Section& root, Study& study) {
  const auto noise = root.table("noise");
  if (!noise) return;
  for (const std::string& output : noise->keys()) {
    NoiseStudy& out = study.noise[output];
    out.where = noise->where(output);
    if (noise->is_table(output)) {
      const DescribedSection table = described(*noise, output, "noise.NAME");
      read_noise_table(table, out);
      if (!table.has("value")) continue;
    } else {
      out.sigma = number_as_written(*noise, output);
    }
    if (!(out.sigma.value > 0.0)) noise->fail(output, fmt::format("{} must be above 0: a standard deviation", out.sigma.value));
  }
  noise->finish();
}

void read_initial(const Section& root, Study& study) {
  const auto initial = root.table("initial");
  if (!initial) return;
  for (const std::string& key : initial->keys()) study.initial[key] = read_one_initial(*initial, key);
  initial->finish();
}

namespace {

/// Of every effect: any other key is a role, which is a text; what is none and looks like one of these is mistyped.
const std::vector<std::string>& keys_of_effects() {
  static const std::vector<std::string> keys = {"kind", "formula", "start", "free", "fixed"};
  return keys;
}

std::string read_role(const DescribedSection& section, const std::string& key) {
  if (!section.is_text(key) && !nearest_name(key, keys_of_effects()).empty()) section.fail_unknown(key, keys_of_effects());
  return section.text(key).value_or("");
}

/// Starts, formula or kind and roles of one effect.
EffectStudy read_effect(const DescribedSection& section, const std::string& name) {
  EffectStudy effect;
  effect.name = name;
  if (section.has("formula")) effect.declared = read_formula(section);
  effect.kind = effect.declared ? name : section.text("kind").value_or(name);
  for (const std::string& key : section.keys()) {
    const std::vector<std::string>& others = keys_of_effects();
    const bool is_role = !effect.declared && std::find(others.begin(), others.end(), key) == others.end();
    if (is_role) effect.roles[key] = read_role(section, key);
  }
  if (section.has("start")) {
    const DescribedSection start = described(section, "start", "effects.NAME.start");
    for (const std::string& parameter : start.keys()) effect.start[parameter] = number_as_written(start, parameter);
    start.finish();
  }
  effect.free = section.texts("free").value_or(std::vector<std::string>{});
  effect.fixed = section.texts("fixed").value_or(std::vector<std::string>{});
  section.finish();
  return effect;
}

}  // namespace

void read_effects(const Section& root, Study& study) {
  const auto effects = root.table("effects");
  if (!effects) return;
  for (const std::string& key : effects->keys()) {
    if (!effects->is_table(key)) effects->fail(key, "an effect is a table, as " + key + " = {}");
    const Section table = *effects->table(key);
    study.effects.push_back(
        read_effect({table, config::group_of(study_keys(), "effects.NAME", table.has("formula") ? "formula" : "")}, key));
    study.effects.back().where = effects->where(key);
  }
  effects->finish();
}

/// What is said of one parameter, or, under the first part of a name with a point ("coulomb_friction.friction", which TOML without quotes
/// reads as a table in a table), of those of one effect.
void read_parameter(const std::string& name, const DescribedSection& section, const Source& where, Study& study) {
  const std::vector<std::string> known = section.description().names();
  bool of_an_effect = false;
  for (const std::string& entry : section.keys()) {
    if (std::find(known.begin(), known.end(), entry) != known.end()) continue;
    if (!section.is_table(entry)) section.fail(entry, "unknown key" + suggest(entry, known));
    read_parameter(name + "." + entry, described(section, entry, "parameters.NAME"), section.where(entry), study);
    of_an_effect = true;
  }
  if (of_an_effect) {
    section.finish();
    return;
  }
  ParameterStudy parameter;
  parameter.free = section.flag("free");
  parameter.where = where;
  parameter.section = section;
  if (!study.parameters.emplace(name, std::move(parameter)).second)
    throw InputError(where, "[parameters] " + shown(name) + " is there twice, with quotation marks and without: write it once");
}

void read_parameters(const Section& root, Study& study) {
  const auto parameters = root.table("parameters");
  if (!parameters) return;
  for (const std::string& key : parameters->keys())
    read_parameter(key, described(*parameters, key, "parameters.NAME"), parameters->where(key), study);
  parameters->finish();
}

void read_curves(const Section& root, Study& study) {
  const auto curves = root.table("curves");
  if (!curves) return;
  for (const std::string& key : curves->keys()) {
    const DescribedSection section = described(*curves, key, "curves.NAME");
    CurveStudy curve;
    curve.where = curves->where(key);
    curve.of = section.text("of").value_or("");
    if (curve.of.empty() && (section.has("of") || section.has("knots") || section.has("table")))
      section.fail("of", "the quantity that the curve depends on is needed, as of = \"alpha_T\"");
    if (!is_auto(section, "knots")) curve.knots = section.quantities("knots");
    const auto falls = [](const config::Number& a, const config::Number& b) {
      return a.unit.empty() == b.unit.empty() && !(a.value < b.value);
    };
    if (curve.knots &&
        (curve.knots->size() < 2 || std::adjacent_find(curve.knots->begin(), curve.knots->end(), falls) != curve.knots->end()))
      section.fail("knots", "at least two knots are needed, each above the one before");
    if (!is_auto(section, "roughness")) curve.roughness = section.value("roughness");
    curve.table = existing_file(section, "table", study.folder);
    section.finish();
    study.curves[key] = std::move(curve);
  }
  curves->finish();
}

void read_reference(const Section& root, Study& study) {
  const auto reference = root.table("reference");
  if (!reference) return;
  for (const std::string& curve : reference->keys()) study.reference[curve] = *existing_file(*reference, curve, study.folder);
  reference->finish();
}

namespace {

void check_samples(const Section& section, const SimulateStudy& simulate) {
  constexpr double most = 1e7;
  const double samples = simulate.duration / simulate.step + 1.0;
  if (samples <= most) return;
  const char* key = section.has("duration") ? "duration" : "step";
  section.fail(key,
               fmt::format("duration / step = {:.4g} s / {:.4g} s makes {:.4g} samples; at most {:.0e} are possible: a shorter duration "
                           "or a longer step is needed",
                           simulate.duration, simulate.step, samples, most));
}

}  // namespace

void read_simulate(const Section& root, Study& study) {
  if (!root.has("simulate")) return;
  const DescribedSection section = described(root, "simulate");
  SimulateStudy simulate;
  simulate.duration = *section.value("duration");
  simulate.step = *section.value("step");
  check_samples(section, simulate);
  const DescribedSection initial = described(section, "initial", "simulate.initial");
  for (const std::string& state : initial.keys()) simulate.initial[state] = number_as_written(initial, state);
  initial.finish();
  const DescribedSection noise = described(section, "noise", "simulate.noise");
  for (const std::string& output : noise.keys()) {
    simulate.noise[output] = number_as_written(noise, output);
    if (simulate.noise[output].value < 0.0)
      noise.fail(output, fmt::format("{} is below 0: the standard deviation of white noise is expected", simulate.noise[output].value));
  }
  noise.finish();
  section.finish();
  study.simulate = simulate;
}

}  // namespace misfit::study_parts
