#include <fmt/format.h>

#include "apps/stages.h"
#include "misfit/core/files.h"
#include "misfit/core/version.h"

namespace misfit {
namespace {

constexpr double degree = 3.14159265358979323846 / 180.0;

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (char c : text) {
    if (c == '"' || c == '\\') out.push_back('\\');
    out.push_back(c == '\n' ? ' ' : c);
  }
  return out + "\"";
}

std::string list_of(const std::vector<std::string>& names) {
  std::string out;
  for (const auto& name : names) out += (out.empty() ? "" : ", ") + quoted(name);
  return "[" + out + "]";
}

std::string numbers_of(const std::vector<double>& values, double scale) {
  std::string out;
  for (double v : values) out += (out.empty() ? "" : ", ") + fmt::format("{:.10g}", v * scale);
  return "[" + out + "]";
}

void add_head(const Session& session, std::string& text) {
  const Study& study = session.study;
  text +=
      fmt::format("# Written by misfit {} ({}): the study with all defaults and everything chosen from the data.\n", version(), commit());
  text += fmt::format("[study]\nname = {}\nquestion = {}\nmethods = {}\nseed = {}\n", quoted(study.name), quoted(study.question),
                      list_of(session.methods()), study.seed);
  text += fmt::format("\n[system]\nkind = {}\n", quoted(session.model.request.system));
  for (const auto& [name, flag] : session.model.request.options.flags) text += fmt::format("{} = {}\n", name, flag);
}

void add_experiments(const Session& session, const Prepared& prepared, std::string& text) {
  for (std::size_t e = 0; e < prepared.experiments.size(); ++e) {
    const Signals& s = prepared.experiments[e];
    const ExperimentStudy& study = session.study.experiments[e];
    const auto file = study.track ? *study.track : study.data ? *study.data : std::filesystem::path();
    text += fmt::format("\n[[experiment]]  # {} samples, {:.6g} s to {:.6g} s\nname = {}\n{} = {}\nexclude = {}\n", s.samples(),
                        s.t.front(), s.t.back(), quoted(s.name), study.track ? "track" : "data",
                        quoted(file.lexically_relative(session.study.folder).string()), s.exclude);
    if (s.validation_from < s.t.back())
      text += fmt::format("validation = [{:.10g}, {:.10g}]\n", s.validation_from, std::min(s.validation_to, s.t.back() + 1.0));
  }
}

void add_model(const Prepared& prepared, std::string& text) {
  text += "\n[effects]\n";
  for (const auto& effect : prepared.request.effects) {
    text += fmt::format("{} = {{ kind = {}", effect.name, quoted(effect.kind));
    for (const auto& [role, target] : effect.roles) text += fmt::format(", {} = {}", role, quoted(target));
    text += " }\n";
  }
  text += "\n[parameters]\n";
  for (const auto& p : prepared.model.parameters) {
    if (p.curve >= 0) continue;
    text += fmt::format("{} = {{ free = {}, value = {:.10g}, bounds = [{:.6g}, {:.6g}]", p.name, p.free, p.value, p.lower, p.upper);
    if (p.prior_sigma) text += fmt::format(", sigma = {:.6g}", *p.prior_sigma);
    text += fmt::format(" }}  # {}; {}\n", p.unit, p.doc);
  }
  text += "\n[curves]\n";
  for (const auto& curve : prepared.model.curves) {
    const bool angle = curve.of_unit == "rad";
    text += fmt::format("{} = {{ of = {}, knots = {}, roughness = {} }}  # knots in {}\n", curve.name, quoted(curve.of),
                        numbers_of(curve.spline.breakpoints(), angle ? 1.0 / degree : 1.0),
                        curve.roughness ? fmt::format("{:.6g}", *curve.roughness) : "\"auto\"", angle ? "deg" : curve.of_unit);
  }
}

}  // namespace

void write_resolved(const Session& session, const Prepared& prepared) {
  std::string text;
  add_head(session, text);
  add_experiments(session, prepared, text);
  add_model(prepared, text);
  write_atomically(session.folder.file("resolved.toml"), text);
}

}  // namespace misfit
