#include "misfit/data/uncertainty.h"

#include <fmt/format.h>

#include <algorithm>

#include "misfit/core/display.h"
#include "misfit/core/units.h"
#include "misfit/data/fit_tables.h"
#include "misfit/data/json_fields.h"

namespace misfit {
namespace {

constexpr const char* how_shares =
    "first-order shares of the variance, Var(E[number | parameter]) / Var(number): least squares of the number on polynomials of the "
    "sampled errors, orthonormal under their distribution (first and second order; B. Sudret, Reliab. Eng. Syst. Saf. 93, 2008; "
    "A. Saltelli et al., Global Sensitivity Analysis, 2008); effect: change per one sigma of the parameter; rest: parameters acting "
    "together";

constexpr const char* trim_name = "trim";
constexpr std::string_view slope_of = "slope of ";

std::string table_of(const std::vector<SpreadCurve>& curves, const CurveFile& file) {
  const SpreadCurve& first = curves[file.curves.front()];
  const std::string unit = display_unit(first.unit);
  std::string text = fmt::format("curve,{}[{}],mean[{}],sigma[{}],low[{}],high[{}],nominal[{}],runs\n", first.of,
                                 display_unit(first.of_unit), unit, unit, unit, unit, unit);
  for (const std::size_t k : file.curves) {
    const SpreadCurve& c = curves[k];
    for (std::size_t i = 0; i < c.x.size(); ++i) {
      const double low = c.mean[i] - 3.0 * c.sigma[i], high = c.mean[i] + 3.0 * c.sigma[i];
      text += fmt::format("{},{},{},{},{},{},{},{:.0f}\n", c.name, display_field(c.x[i], c.of_unit), display_field(c.mean[i], c.unit),
                          display_field(c.sigma[i], c.unit), display_field(low, c.unit), display_field(high, c.unit),
                          display_field(c.nominal[i], c.unit), c.count[i]);
    }
  }
  return text;
}

}  // namespace

template <class Archive>
void fields(Archive& json, MaybeConst<PerturbedParameter> auto& p) {
  json("name", p.name), json("value", p.value), json("sigma", p.sigma), json("unit", p.unit);
  json("distribution", p.distribution), json("group", p.group);
}

/// The slope of a curve of an angle is "1/rad": shown per radian as it is; only whole angles change.
template <class Archive>
void fields(Archive& json, MaybeConst<SpreadNumber> auto& n) {
  const double factor = json.factor("unit", n.unit);
  double rest = n.shares.empty() ? std::numeric_limits<double>::quiet_NaN() : n.rest;
  json("value", Scaled(n.mean, factor)), json("sigma", Scaled(n.sigma, factor));
  json.derived("low", factor * (n.mean - 3.0 * n.sigma));
  json.derived("high", factor * (n.mean + 3.0 * n.sigma));
  json("unit", DisplayUnit(n.unit)), json("runs", n.count);
  json.group("nominal",
             [&](auto& nominal) { nominal("value", Scaled(n.nominal, factor)), nominal("sigma", Sigma(n.nominal_sigma, factor)); });
  const auto share_fields = [factor](auto& object, auto& s) {
    object("share", s.share), object("sigma", s.sigma), object("effect", Scaled(s.effect, factor));
  };
  json("variance_shares", Named(n.shares, &VarianceShare::name, share_fields)), json("rest", rest);
  if constexpr (Archive::reading) n.rest = rest;
}

template <class Archive>
void fields(Archive& json, MaybeConst<SpreadCurve> auto& c) {
  json("name", c.name), json("of", c.of), json("of_unit", c.of_unit), json("unit", c.unit);
  json("informative", c.informative), json("why", c.why), json("x", c.x), json("trimmed", c.trimmed);
  json("nominal", c.nominal), json("mean", c.mean), json("sigma", c.sigma), json("runs", c.count);
}

namespace {

/// Objects of uncertainty.json that repeat part of its `numbers` for other programs.
struct Repeated {
  std::map<std::string, SpreadNumber> slopes;
  Json variance_shares = Json::object();

  explicit Repeated(const Uncertainty& u) {
    for (const SpreadNumber& n : u.numbers) {
      const bool slope = n.name.starts_with(slope_of);
      if (slope) slopes[n.name.substr(slope_of.size())] = n;
      if (slope || n.name == trim_name) variance_shares[n.name] = JsonWriter::json_of(n)["variance_shares"];
    }
  }
};

}  // namespace

/// One object per curve name, the contract's names for the trim and the slopes beside all numbers.
template <class Archive>
void fields(Archive& json, MaybeConst<Uncertainty> auto& u) {
  const Repeated repeated(u);
  const SpreadNumber* trim = u.find(trim_name);
  json("method", u.method), json("runs", u.runs), json("failed", u.failed), json("failures", u.failures);
  json("seed", u.seed);
  json.derived("trim_deg", trim != nullptr && trim->unit == "rad" ? std::optional(*trim) : std::nullopt);
  json.derived("slopes", repeated.slopes);
  json("numbers", Named(u.numbers, &SpreadNumber::name));
  json.derived("variance_shares", repeated.variance_shares);
  json.derived("variance_shares_are", how_shares);
  json("perturbed", u.perturbed), json("notes", u.notes), json("curves", u.curves);
}

const SpreadNumber* Uncertainty::find(const std::string& name) const {
  const auto found = std::find_if(numbers.begin(), numbers.end(), [&](const SpreadNumber& n) { return n.name == name; });
  return found == numbers.end() ? nullptr : &*found;
}

std::vector<std::string> write_uncertainty(const std::filesystem::path& dir, const Uncertainty& uncertainty) {
  std::vector<std::string> names{"uncertainty.json"};
  write_json(dir / names.front(), uncertainty);
  std::vector<CurveEstimate> like;  // the same files as the fit's curves
  for (const auto& c : uncertainty.curves) like.push_back({c.name, c.of, c.of_unit, c.unit, {}, {}, {}, {}, true, "", c.trimmed});
  for (const CurveFile& file : curve_files(like)) {
    names.push_back("uncertainty" + file.name.substr(std::string("curves").size()));
    write_atomically(dir / names.back(), table_of(uncertainty.curves, file));
  }
  return names;
}

Uncertainty read_uncertainty(const std::filesystem::path& dir) { return read_json<Uncertainty>(dir / "uncertainty.json"); }

}  // namespace misfit
