#include "misfit/data/intervals.h"

#include <fmt/format.h>

#include "misfit/core/display.h"
#include "misfit/core/units.h"
#include "misfit/data/json_fields.h"

namespace misfit {

template <class Archive>
void fields(Archive& json, MaybeConst<BootstrapNumber> auto& n) {
  json("name", n.name), json("unit", n.unit), json("value", n.value), json("fit_sigma", Sigma(n.fit_sigma));
  json("mean", n.mean), json("sigma", n.sigma), json("interval_95", std::tie(n.lower, n.upper)), json("runs", n.runs);
}

template <class Archive>
void fields(Archive& json, MaybeConst<BootstrapCurve> auto& c) {
  json("name", c.name), json("of", c.of), json("of_unit", c.of_unit), json("unit", c.unit), json("x", c.x);
  json("value", c.value), json("fit_sigma", c.fit_sigma), json("mean", c.mean), json("sigma", c.sigma);
  json("lower_95", c.lower), json("upper_95", c.upper), json("count", c.count);
}

template <class Archive>
void fields(Archive& json, MaybeConst<Bootstrap> auto& b) {
  json("method", b.method), json("how", b.how), json("block_samples", b.block), json("runs", b.runs);
  json("failed", b.failed), json("seed", b.seed), json("failures", b.failures), json("notes", b.notes);
  json("numbers", b.numbers), json("curves", b.curves);
}

template <class Archive>
void fields(Archive& json, MaybeConst<LikelihoodProfile> auto& p) {
  json("method", p.method), json("parameter", p.parameter), json("unit", p.unit), json("best", p.best);
  json("sigma", Sigma(p.sigma)), json("plain_sigma", Sigma(p.plain_sigma)), json("scale", p.scale);
  json("interval_95", std::tie(p.lower, p.upper)), json("interval_found", std::tie(p.lower_found, p.upper_found));
  json("value", p.value), json("drop", p.drop), json("words", p.words);
}

namespace {

/// The notes of a Resampling, which is stored in several files.
struct ResamplingNotes {
  std::vector<std::string> notes;
};

/// Method and curve as text, angles in degrees.
std::string curves_as_csv(const std::vector<Bootstrap>& bootstraps) {
  std::string text = "method,curve,of,x,x_unit,value,fit_sigma,mean,sigma,lower_95,upper_95,unit\n";
  for (const Bootstrap& b : bootstraps) {
    for (const BootstrapCurve& c : b.curves) {
      const std::string x_unit = display_unit(c.of_unit), unit = display_unit(c.unit);
      const auto shown = [&](double v) { return display_field(v, c.unit); };
      for (std::size_t i = 0; i < c.x.size(); ++i) {
        text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{}\n", b.method, c.name, c.of, convert(c.x[i], c.of_unit, x_unit), x_unit,
                            shown(c.value[i]), shown(c.fit_sigma[i]), shown(c.mean[i]), shown(c.sigma[i]), shown(c.lower[i]),
                            shown(c.upper[i]), unit);
      }
    }
  }
  return text;
}

}  // namespace

template <class Archive>
void fields(Archive& json, MaybeConst<ResamplingNotes> auto& r) {
  json("notes", r.notes);
}

void write_bootstrap(const std::filesystem::path& dir, const std::vector<Bootstrap>& bootstraps) {
  make_writable_folder(dir);
  write_atomically(dir / "bootstrap.csv", curves_as_csv(bootstraps));
  write_json(dir / "bootstrap.json", bootstraps);
}

std::vector<Bootstrap> read_bootstrap(const std::filesystem::path& dir) {
  return read_json<std::vector<Bootstrap>>(dir / "bootstrap.json");
}

void write_profiles(const std::filesystem::path& dir, const std::vector<LikelihoodProfile>& profiles) {
  make_writable_folder(dir);
  write_json(dir / "profile.json", profiles);
}

std::vector<LikelihoodProfile> read_profiles(const std::filesystem::path& dir) {
  return read_json<std::vector<LikelihoodProfile>>(dir / "profile.json");
}

void write_resampling_notes(const std::filesystem::path& dir, const std::vector<std::string>& notes) {
  make_writable_folder(dir);
  write_json(dir / "resampling.json", ResamplingNotes{notes});
}

std::vector<std::string> read_resampling_notes(const std::filesystem::path& dir) {
  return read_json<ResamplingNotes>(dir / "resampling.json").notes;
}

}  // namespace misfit
