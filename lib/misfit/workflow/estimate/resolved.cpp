// resolved.toml: the study as parsed, with every default (data/study_keys.h) and every value chosen from data or model set in it.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "misfit/core/files.h"
#include "misfit/core/toml_document.h"
#include "misfit/core/toml_text.h"
#include "misfit/core/units.h"
#include "misfit/core/version.h"
#include "misfit/data/study_edit.h"
#include "misfit/data/study_keys.h"
#include "misfit/inference/gaps.h"
#include "misfit/workflow/estimate/estimate.h"
#include "misfit/workflow/session/study_change.h"

namespace misfit {
namespace {

class Resolved {
 public:
  Resolved(const Session& session, const Prepared& prepared)
      : session_(session), prepared_(prepared), document_(text_for_folder(session.study, session.folder.path(), OddPaths::replace)) {}

  std::string run() {
    document_.put_first("study");
    document_.set({"study", "name"}, toml_string(session_.study.name));
    document_.set({"study", "methods"}, toml_texts(session_.methods()));
    document_.set({"study", "seed"}, std::to_string(session_.study.seed));
    fill_defaults(study_keys(), document_);
    if (session_.study.camera.from_sweep()) document_.set({"camera", "offer"}, toml_texts(session_.study.camera.offer));
    set_experiments();
    for (const Parameter& p : prepared_.model.parameters) {
      if (p.curve < 0) set_parameter(p);
    }
    for (const Curve& curve : prepared_.model.curves) set_curve(curve);
    for (const StateSpec& state : prepared_.model.state_specs) set_initial(state);
    const std::string head =
        fmt::format("# Written by misfit {} ({}): the study with all defaults and everything chosen from the data.\n", version(), commit());
    return head + document_.text([this](const TomlPath& path, const std::string& value) { return comment(path, value); });
  }

 private:
  /// Held out: of a recording that is held out as a whole, and so in a file of its own, the study says it already.
  void set_experiments() {
    const std::vector<ExperimentStudy>& all = session_.study.experiments;
    int number = -1;
    for (std::size_t e = 0; e < all.size(); ++e) {
      if (!is_held_out_file(all, e)) set_experiment(all[e], ++number);
    }
  }

  void set_experiment(const ExperimentStudy& study, int number) {
    TomlPath path{"experiment"};
    if (document_.is_array(path)) path.push_back(std::to_string(number));
    const auto part = [&](const char* key) {
      TomlPath out = path;
      out.emplace_back(key);
      return out;
    };
    document_.set(part("name"), toml_string(study.name));
    std::vector<const Signals*> parts;
    std::size_t samples = 0;
    for (const Signals& s : prepared_.experiments) {
      if (!is_part_of(s, study.name)) continue;
      parts.push_back(&s);
      samples += s.samples();
    }
    if (parts.empty()) return;
    const Signals& last = *parts.back();
    comments_[part("name")] = fmt::format("{} samples, {:.6g} s to {:.6g} s", samples, parts.front()->t.front(), last.t.back());
    if (last.validation_from < last.t.back())
      document_.set(part("validation"),
                    toml_list({toml_number(last.validation_from), toml_number(std::min(last.validation_to, last.t.back() + 1.0))}));
  }

  /// Where the study writes it: under a name that it has for it, or, without quotation marks, under the parts of a name with a point.
  TomlPath path_of(const std::string& in_model) const {
    const std::string parameter = name_in_study(session_.study, names_, in_model);
    TomlPath path{"parameters", parameter};
    for (std::size_t point = parameter.find('.'); point != std::string::npos; point = parameter.find('.', point + 1)) {
      const TomlPath nested{"parameters", parameter.substr(0, point), parameter.substr(point + 1)};
      if (document_.has(nested)) path = nested;
    }
    return path;
  }

  void set_parameter(const Parameter& p) {
    TomlPath path = path_of(p.name);
    comments_[path] = p.unit + "; " + p.doc;
    const auto set = [&](const char* key, const std::string& value) {
      path.emplace_back(key);
      document_.set(path, value);
      path.pop_back();
    };
    set("free", p.free ? "true" : "false");
    set("value", toml_number(p.value));
    if (std::isfinite(p.lower) && std::isfinite(p.upper)) set("bounds", toml_list({toml_number(p.lower), toml_number(p.upper)}));
    if (p.prior_sigma && p.prior_mean == p.value) set("sigma", toml_number(*p.prior_sigma));
  }

  /// In the unit that is shown, as a bare number is read; with the SI unit where no such number reads back to it.
  static std::string knot_text(double knot, const std::string& unit) {
    const double shown = convert_difference(1.0, display_unit(unit), unit), near = knot / shown;
    for (const double bare : {near, std::nextafter(near, INFINITY), std::nextafter(near, -INFINITY)}) {
      if (shown * bare == knot) return toml_number(bare);
    }
    return toml_string(toml_number(knot) + " " + plain_si(unit));
  }

  void set_curve(const Curve& curve) {
    std::vector<std::string> knots;
    for (const double knot : curve.spline.breakpoints()) knots.push_back(knot_text(knot, curve.of_unit));
    const std::string name = curve_in_study(session_.study, names_, curve.name);
    document_.set({"curves", name, "of"}, toml_string(curve.of));
    document_.set({"curves", name, "knots"}, toml_list(knots));
    document_.set({"curves", name, "roughness"}, curve.roughness ? toml_number(*curve.roughness) : "\"auto\"");
    comments_[{"curves", name}] = "knots in " + display_unit(curve.of_unit);
  }

  /// What is neither given nor simply free.
  void set_initial(const StateSpec& state) {
    const bool valued = std::isfinite(state.start);
    if (state.initial == Initial::free && !valued) return;
    const char* kind = state.initial == Initial::free ? "\"free\"" : state.initial == Initial::shared ? "\"shared\"" : "\"fixed\"";
    comments_[{"initial", state.name}] = state.unit;
    if (!valued) return document_.set({"initial", state.name}, kind);
    document_.set({"initial", state.name, "kind"}, kind);
    document_.set({"initial", state.name, "value"}, toml_number(state.start));
  }

  /// Unit and meaning of what the model has chosen; the unit of a bare number that the study gives.
  std::string comment(const TomlPath& path, const std::string& value) const {
    const auto own = comments_.find(path);
    if (own != comments_.end()) return own->second;
    if (value.find('"') != std::string::npos || value.find_first_of("0123456789") == std::string::npos) return "";
    const auto& all = prepared_.model.parameters;
    const auto parameter = std::find_if(all.begin(), all.end(), [&](const Parameter& p) { return p.name == path.back(); });
    if (path.front() == "geometry" && parameter != all.end()) return parameter->unit;
    const config::Key* key = find_key(study_keys(), path);
    return key == nullptr || key->unit.starts_with("of ") ? "" : key->unit;
  }

  const Session& session_;
  const Prepared& prepared_;
  std::map<std::string, std::string> names_ = parameter_names(prepared_.request, session_.registry);
  TomlDocument document_;
  std::map<TomlPath, std::string> comments_;
};

}  // namespace

void write_resolved(const Session& session, const Prepared& prepared, const std::filesystem::path& dir) {
  std::string text = Resolved(session, prepared).run();
  if (text.find("\uFFFD") != std::string::npos)
    text = "# U+FFFD stands for bytes that are no UTF-8: TOML cannot name a file called so.\n" + text;
  write_atomically(dir / "resolved.toml", text);
}

}  // namespace misfit
