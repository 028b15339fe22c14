#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "misfit/core/files.h"
#include "misfit/core/toml_text.h"
#include "misfit/core/version.h"
#include "misfit/inference/gaps.h"
#include "misfit/workflow/estimate/estimate.h"

namespace misfit {
namespace {

constexpr double degree = 3.14159265358979323846 / 180.0;

std::string list_of(const std::vector<std::string>& names) {
  std::string out;
  for (const auto& name : names) out += (out.empty() ? "" : ", ") + toml_string(name);
  return "[" + out + "]";
}

std::string numbers_of(const std::vector<double>& values, double scale) {
  std::string out;
  for (double v : values) out += (out.empty() ? "" : ", ") + fmt::format("{}", v * scale);
  return "[" + out + "]";
}

/// As seen from resolved.toml, which can be run where it lies.
std::string path_of(const Session& session, const std::filesystem::path& file) {
  return toml_string(std::filesystem::relative(file, session.folder.path()).generic_string());
}

void add_head(const Session& session, std::string& text) {
  const Study& study = session.study;
  text +=
      fmt::format("# Written by misfit {} ({}): the study with all defaults and everything chosen from the data.\n", version(), commit());
  text += fmt::format("[study]\nname = {}\nquestion = {}\nmethods = {}\nseed = {}\n", toml_string(study.name), toml_string(study.question),
                      list_of(session.methods()), study.seed);
  text += "\n[system]\n";
  text += study.system_file ? fmt::format("file = {}\n", path_of(session, *study.system_file))
                            : fmt::format("kind = {}\n", toml_string(session.model.request.system));
  for (const auto& [name, flag] : session.model.request.options.flags) text += fmt::format("{} = {}\n", toml_key(name), flag);
}

std::string number_of(const config::Number& number) {
  return number.sigma ? fmt::format("{{ value = {}, sigma = {} }}", number.value, *number.sigma) : fmt::format("{}", number.value);
}

void add_geometry(const Session& session, const Prepared& prepared, std::string& text) {
  if (!session.study.geometry) return;
  text += "\n[geometry]\n";
  for (const auto& name : session.study.geometry->keys()) {
    const auto& all = prepared.model.parameters;
    const auto constant = std::find_if(all.begin(), all.end(), [&](const Parameter& p) { return p.name == name; });
    const std::string unit = constant != all.end() ? constant->unit : name == "V" ? "m/s" : "m";  // what is not the system's is the rig's
    text +=
        fmt::format("{} = {}  # {}\n", toml_key(name), number_of(*session.study.geometry->number(name, unit, true)), toml_comment(unit));
  }
}

std::string marker_name(const Session& session, const MarkerStudy& marker) {
  return marker.picture ? path_of(session, *marker.picture) : toml_string(marker.kind);
}

/// [video], if any experiment starts from one.
void add_video(const Session& session, std::string& text) {
  const auto& all = session.study.experiments;
  if (std::none_of(all.begin(), all.end(), [](const ExperimentStudy& e) { return e.video.has_value(); })) return;
  const VideoStudy& video = session.study.video;
  text += fmt::format("\n[video]\nfields = {}\ncheck_fields = {}\nmarker = {}\n", toml_string(video.fields), video.check_fields,
                      marker_name(session, video.marker));
  if (video.start) text += fmt::format("start = {}\n", numbers_of({video.start->column, video.start->row}, 1.0));
  if (video.region) text += fmt::format("region = {}\n", numbers_of({video.region->begin(), video.region->end()}, 1.0));
}

void add_camera(const Session& session, std::string& text) {
  const CameraStudy& camera = session.study.camera;
  if (!session.study.has_camera) return;
  text += fmt::format("\n[camera]\nmodel = {}\n", toml_string(camera.model));
  if (camera.from_sweep()) {
    text +=
        fmt::format("{} = {}\noffer = {}\ntake_in = {}\n", camera.sweep ? "sweep" : "sweep_images",
                    path_of(session, camera.sweep ? *camera.sweep : *camera.sweep_images), list_of(camera.offer), list_of(camera.take_in));
  }
  if (camera.sweep_images) text += fmt::format("sweep_marker = {}\n", marker_name(session, camera.sweep_marker));
  if (camera.sweep_points.size() == 3) {
    std::vector<double> flat;
    for (const PixelPoint& p : camera.sweep_points) flat.insert(flat.end(), {p.column, p.row});
    text += fmt::format("sweep_points = {}\n", numbers_of(flat, 1.0));
  }
  for (const auto& [name, number] : camera.given) text += fmt::format("{} = {}\n", toml_key(name), number_of(number));
}

void add_experiments(const Session& session, const Prepared& prepared, std::string& text) {
  for (const ExperimentStudy& study : session.study.experiments) {
    std::vector<const Signals*> parts;
    std::size_t samples = 0;
    for (const Signals& s : prepared.experiments) {
      if (!is_part_of(s, study.name)) continue;
      parts.push_back(&s);
      samples += s.samples();
    }
    if (parts.empty()) continue;
    const Signals& s = *parts.back();
    text += fmt::format("\n[[experiment]]  # {} samples, {:.6g} s to {:.6g} s\nname = {}\n{} = {}\nexclude = {}\n", samples,
                        parts.front()->t.front(), s.t.back(), toml_string(study.name),
                        study.track   ? "track"
                        : study.video ? "video"
                                      : "data",
                        path_of(session, study.track   ? *study.track
                                         : study.video ? *study.video
                                                       : *study.data),
                        study.exclude);
    if (s.validation_from < s.t.back())
      text += fmt::format("validation = [{}, {}]\n", s.validation_from, std::min(s.validation_to, s.t.back() + 1.0));
    if (study.columns.header_of.empty()) continue;
    std::string columns;
    for (const auto& [name, header] : study.columns.header_of)
      columns += fmt::format("{}{} = {}", columns.empty() ? "" : ", ", toml_key(name), toml_string(header));
    text += "columns = { " + columns + " }\n";
  }
}

/// What has no bounds gets no key.
std::string bounds_text(double lower, double upper) {
  return std::isfinite(lower) || std::isfinite(upper) ? fmt::format(", bounds = [{}, {}]", lower, upper) : std::string();
}

void add_parameter(const Parameter& p, std::string& text) {
  text += fmt::format("{} = {{ free = {}, value = {}{}", toml_key(p.name), p.free, p.value, bounds_text(p.lower, p.upper));
  if (p.prior_sigma) text += fmt::format(", sigma = {}", *p.prior_sigma);
  text += fmt::format(" }}  # {}\n", toml_comment(p.unit + "; " + p.doc));
}

void add_curve(const Session& session, const Curve& curve, std::string& text) {
  const bool angle = curve.of_unit == "rad";
  text += fmt::format("{} = {{ of = {}, knots = {}, roughness = {}", toml_key(curve.name), toml_string(curve.of),
                      numbers_of(curve.spline.breakpoints(), angle ? 1.0 / degree : 1.0),
                      curve.roughness ? fmt::format("{}", *curve.roughness) : "\"auto\"");
  const auto study = session.study.curves.find(curve.name);
  if (study != session.study.curves.end() && study->second.table) text += ", table = " + path_of(session, *study->second.table);
  text += fmt::format(" }}  # knots in {}\n", angle ? "deg" : toml_comment(curve.of_unit));
}

/// The request of the study where there is one: it holds for a curve as a whole.
void add_curve_parameter(const Session& session, const std::string& curve, std::string& text) {
  const auto found = session.model.request.parameters.find(curve);
  if (found == session.model.request.parameters.end()) return;
  const ParameterRequest& p = found->second;
  std::string entries;
  const auto add = [&](const std::string& entry) { entries += (entries.empty() ? "" : ", ") + entry; };
  if (p.free) add(fmt::format("free = {}", *p.free));
  if (p.value) add(fmt::format("value = {}", *p.value));
  if (p.lower && p.upper) add(fmt::format("bounds = [{}, {}]", *p.lower, *p.upper));
  if (p.sigma) add(fmt::format("sigma = {}", *p.sigma));
  text += fmt::format("{} = {{ {} }}\n", toml_key(curve), entries);
}

/// An effect that the study declares by a formula; false if it is none.
bool add_declared(const Session& session, const std::string& name, std::string& text) {
  const auto& all = session.study.effects;
  const auto found = std::find_if(all.begin(), all.end(), [&](const EffectStudy& e) { return e.name == name; });
  if (found == all.end() || !found->declared) return false;
  text += fmt::format("{} = {{ port = {}, formula = {}, strengths = [", toml_key(name), toml_string(found->declared->port),
                      toml_string(found->declared->formula));
  std::string parameters;
  bool any = false;
  for (const auto& c : session.registry.effect(name).spec().coefficients) {
    if (c.kind == CoefficientKind::strength) {
      text += (any ? ", " : "") + toml_string(c.name);
      any = true;
    }
    parameters += fmt::format("{}{} = {{ unit = {}, value = {}{}, scale = {}, free = {} }}", parameters.empty() ? "" : ", ", c.name,
                              toml_string(c.unit), c.value, bounds_text(c.lower, c.upper), c.scale, !c.fixed);
  }
  text += "], parameters = { " + parameters + " } }\n";
  return true;
}

/// [initial] for states whose first value is not simply free.
void add_initial(const Prepared& prepared, std::string& text) {
  std::string entries;
  for (const auto& state : prepared.model.state_specs) {
    const bool valued = std::isfinite(state.start);
    if (state.initial == Initial::free && !valued) continue;
    const char* kind = state.initial == Initial::free ? "free" : state.initial == Initial::shared ? "shared" : "fixed";
    entries += valued ? fmt::format("{} = {{ kind = \"{}\", value = {} }}  # {}\n", toml_key(state.name), kind, state.start,
                                    toml_comment(state.unit))
                      : fmt::format("{} = \"{}\"\n", toml_key(state.name), kind);
  }
  if (!entries.empty()) text += "\n[initial]\n" + entries;
}

void add_model(const Session& session, const Prepared& prepared, std::string& text) {
  text += "\n[effects]\n";
  for (const auto& effect : prepared.request.effects) {
    if (add_declared(session, effect.name, text)) continue;
    text += fmt::format("{} = {{ kind = {}", toml_key(effect.name), toml_string(effect.kind));
    for (const auto& [role, target] : effect.roles) text += fmt::format(", {} = {}", toml_key(role), toml_string(target));
    text += " }\n";
  }
  text += "\n[parameters]\n";
  for (const auto& p : prepared.model.parameters) {
    if (p.curve < 0) add_parameter(p, text);
  }
  for (const auto& curve : prepared.model.curves) add_curve_parameter(session, curve.name, text);
  text += "\n[curves]\n";
  for (const auto& curve : prepared.model.curves) add_curve(session, curve, text);
}

void add_uncertainty(const Study& study, std::string& text) {
  if (!study.uncertainty) return;
  const UncertaintyStudy& u = *study.uncertainty;
  text += fmt::format("\n[uncertainty]\nruns = {}\nrecalibrate = {}\n", u.runs, u.recalibrate);
  if (u.calibrated_camera) text += "camera = \"calibration\"\n";
  std::string perturb, readings;
  for (const PerturbStudy& p : u.perturb) {
    const char* comma = perturb.empty() ? "" : ", ";
    perturb += fmt::format("{}{} = {}", comma, toml_key(p.name), p.number.value);
    readings += fmt::format("{}{} = {}", comma, toml_key(p.name), toml_string(p.reading));
  }
  if (u.bootstrap > 0) text += fmt::format("bootstrap = {}\n", u.bootstrap);
  if (u.block > 0) text += fmt::format("block = {}\n", u.block);
  if (u.starts > 0) text += fmt::format("starts = {}\n", u.starts);
  if (!u.profile.empty()) text += "profile = " + list_of(u.profile) + "\n";
  text += "perturb = { " + perturb + " }  # in SI\nreadings = { " + readings + " }\n";
}

void add_rest(const Session& session, std::string& text) {
  const Study& study = session.study;
  if (!study.reference.empty()) text += "\n[reference]\n";
  for (const auto& [curve, file] : study.reference) text += fmt::format("{} = {}\n", toml_key(curve), path_of(session, file));
  if (study.bin_width > 0.0 || study.bin_step > 0.0) text += "\n[sliding_bin]\n";
  if (study.bin_width > 0.0) text += fmt::format("width = {}\n", study.bin_width);
  if (study.bin_step > 0.0) text += fmt::format("step = {}\n", study.bin_step);
  add_uncertainty(study, text);
}

}  // namespace

void write_resolved(const Session& session, const Prepared& prepared, const std::filesystem::path& dir) {
  std::string text;
  add_head(session, text);
  add_geometry(session, prepared, text);
  add_camera(session, text);
  add_experiments(session, prepared, text);
  add_video(session, text);
  add_model(session, prepared, text);
  add_initial(prepared, text);
  add_rest(session, text);
  if (text.find("\uFFFD") != std::string::npos)
    text = "# U+FFFD stands for bytes that are no UTF-8: TOML cannot name a file called so.\n" + text;
  write_atomically(dir / "resolved.toml", text);
}

}  // namespace misfit
