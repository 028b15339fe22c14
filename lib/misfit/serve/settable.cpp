#include "misfit/serve/settable.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "misfit/core/display.h"
#include "misfit/core/error.h"
#include "misfit/core/toml_text.h"
#include "misfit/core/units.h"
#include "misfit/model/provisional.h"
#include "misfit/page/json_text.h"
#include "misfit/page/read_if.h"
#include "misfit/workflow/estimate/estimate.h"
#include "misfit/workflow/session/study_change.h"

namespace misfit::serve {
namespace {

using page::json_list;
using page::json_string;

template <class List>
bool has_name(const List& list, const std::string& name) {
  return std::any_of(list.begin(), list.end(), [&](const auto& one) { return one.name == name; });
}

/// The number with which `text` begins, which goes on behind it.
double number_of(std::string_view& text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  double out = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  if (error != std::errc() || !std::isfinite(out)) throw InputError("value: a number is expected");
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return out;
}

void expect_end(std::string_view text) {
  if (!text.empty()) throw InputError("value: nothing is expected behind the number");
}

std::string interval_of(std::string_view value) {
  const double from = number_of(value), to = number_of(value);
  expect_end(value);
  return fmt::format("[{}, {}]", from, to);
}

std::string roughness_of(std::string_view value) {
  if (value == "auto") return "auto";
  const double roughness = number_of(value);
  expect_end(value);
  if (roughness < 0.0) throw InputError("value: a roughness of at least 0 is expected");
  return fmt::format("{:.6g}", roughness);
}

}  // namespace

Settable settable_of(const Session& session) {
  ModelRequest request = session.model.request;
  const std::filesystem::path camera = session.folder.file("camera.json");
  if (const auto calibration = page::read_if(camera, [&] { return read_calibration(camera); }))
    add_camera(*calibration, session.registry, request);  // what it has calibrated is estimated, too
  const Model model = provisional_model(request, session.registry);
  Settable out;
  for (const misfit::Parameter& p : model.parameters) {
    if (p.curve < 0) out.parameters.push_back({.name = p.name, .unit = p.unit, .free = p.free, .value = in_display_unit(p.value, p.unit)});
  }
  const auto names = parameter_names(request, session.registry);
  for (const misfit::Curve& c : model.curves) {
    out.parameters.push_back({c.name, c.unit, model.parameters[c.first].free, ""});
    out.curves.push_back({c.name, curve_in_study(session.study, names, c.name), roughness_unit(c),
                          c.roughness ? fmt::format("{:.6g}", *c.roughness) : "auto"});
  }
  const std::vector<ExperimentStudy>& all = session.study.experiments;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const bool holds_a_file_out = k + 1 < all.size() && is_held_out_file(all, k + 1);
    if (!holds_a_file_out && !is_held_out_file(all, k)) out.experiments.push_back(all[k].name);
  }
  return out;
}

std::string json_of(const Settable& settable) {
  std::vector<std::string> parameters, curves, experiments;
  for (const auto& p : settable.parameters)
    parameters.push_back(fmt::format(R"({{"name":{},"label":{},"unit":{},"free":{},"value":{}}})", json_string(p.name),
                                     page::json_words(p.name), page::json_words(plain_si(p.unit)), p.free, page::json_words(p.value)));
  for (const auto& c : settable.curves)
    curves.push_back(fmt::format(R"({{"name":{},"label":{},"unit":{},"roughness":{}}})", json_string(c.name), page::json_words(c.name),
                                 page::json_words(c.unit), json_string(c.roughness)));
  for (const std::string& name : settable.experiments) experiments.push_back(json_string(name));
  return fmt::format(R"({{"parameters":{},"curves":{},"experiments":{}}})", json_list(parameters), json_list(curves),
                     json_list(experiments));
}

std::string setting_of(const Settable& settable, const std::string& what, const std::string& name, const std::string& value) {
  const auto& experiments = settable.experiments;
  if (what == "free" && has_name(settable.parameters, name)) {
    if (value != "true" && value != "false") throw InputError("value: true or false is expected");
    return fmt::format("parameters.{}.free={}", toml_key(name), value == "true");
  }
  const auto curve = std::find_if(settable.curves.begin(), settable.curves.end(), [&](const auto& one) { return one.name == name; });
  if (what == "roughness" && curve != settable.curves.end())
    return fmt::format("curves.{}.roughness={}", toml_key(curve->in_study), roughness_of(value));
  if (what == "validation" && std::find(experiments.begin(), experiments.end(), name) != experiments.end())
    return fmt::format("experiment.{}.validation={}", toml_key(name), interval_of(value));
  throw InputError("what, name: \"free\" of a parameter, \"roughness\" of a curve or \"validation\" of an experiment is expected");
}

}  // namespace misfit::serve
