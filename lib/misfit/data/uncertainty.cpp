#include "misfit/data/uncertainty.h"

#include <fmt/format.h>

#include <algorithm>

#include "misfit/core/units.h"
#include "misfit/data/fit_tables.h"
#include "misfit/data/json_number.h"

namespace misfit {
namespace {

constexpr const char* how_shares =
    "first-order shares of the variance, Var(E[number | parameter]) / Var(number): least squares of the number on polynomials of the "
    "sampled errors, orthonormal under their distribution (first and second order; B. Sudret, Reliab. Eng. Syst. Saf. 93, 2008; A. "
    "Saltelli "
    "et al., Global Sensitivity Analysis, 2008); effect: change per one sigma of the parameter; rest: parameters acting together";

std::string shown_unit(const std::string& unit) { return display_unit(unit); }
double shown(double value, const std::string& unit) { return convert(value, unit, display_unit(unit)); }

/// The slope of a curve of an angle is "1/rad": shown per radian as it is; only whole angles change.
Json number_to_json(const SpreadNumber& n) {
  const auto in = [&](double v) { return number_or_null(shown(v, n.unit)); };
  Json shares = Json::object();
  for (const VarianceShare& s : n.shares)
    shares[s.name] = {{"share", number_or_null(s.share)}, {"sigma", number_or_null(s.sigma)}, {"effect", in(s.effect)}};
  return {{"value", in(n.mean)},
          {"sigma", in(n.sigma)},
          {"low", in(n.mean - 3.0 * n.sigma)},
          {"high", in(n.mean + 3.0 * n.sigma)},
          {"unit", shown_unit(n.unit)},
          {"runs", n.count},
          {"nominal", {{"value", in(n.nominal)}, {"sigma", sigma_or_null(shown(n.nominal_sigma, n.unit))}}},
          {"variance_shares", shares},
          {"rest", n.shares.empty() ? Json(nullptr) : number_or_null(n.rest)}};
}

std::string si_of(const std::string& unit) {
  if (unit == "deg") return "rad";
  if (unit == "deg/s") return "rad/s";
  return unit == "deg/s^2" ? "rad/s^2" : unit;
}

SpreadNumber number_from_json(const std::string& name, const Json& object) {
  SpreadNumber n;
  n.name = name;
  const std::string unit = object.at("unit");
  n.unit = si_of(unit);
  const auto in = [&](const Json& from, const char* key) { return convert(number_or_nan(from, key), unit, n.unit); };
  n.mean = in(object, "value");
  n.sigma = in(object, "sigma");
  n.count = object.at("runs");
  n.nominal = in(object.at("nominal"), "value");
  const double sigma = in(object.at("nominal"), "sigma");
  n.nominal_sigma = std::isfinite(sigma) ? sigma : 0.0;
  n.rest = number_or_nan(object, "rest");
  for (const auto& [share, entry] : object.at("variance_shares").items())
    n.shares.push_back({share, number_or_nan(entry, "share"), number_or_nan(entry, "sigma"), in(entry, "effect")});
  return n;
}

Json curve_to_json(const SpreadCurve& c) {
  Json out{{"name", c.name}, {"of", c.of},        {"of_unit", c.of_unit}, {"unit", c.unit}, {"informative", c.informative},
           {"why", c.why},   {"x", Json::array()}};
  out["trimmed"] = c.trimmed;
  out["x"] = numbers_to_json(c.x);
  out["nominal"] = numbers_to_json(c.nominal);
  out["mean"] = numbers_to_json(c.mean);
  out["sigma"] = numbers_to_json(c.sigma);
  out["runs"] = numbers_to_json(c.count);
  return out;
}

SpreadCurve curve_from_json(const Json& object) {
  const auto numbers = [&](const char* key) { return numbers_from_json(object.at(key)); };
  return {object.at("name"), object.at("of"),          object.at("of_unit"), object.at("unit"),
          numbers("x"),      numbers("nominal"),       numbers("mean"),      numbers("sigma"),
          numbers("runs"),   object.at("informative"), object.at("why"),     object.value("trimmed", false)};
}

Json perturbed_to_json(const PerturbedParameter& p) {
  return {
      {"name", p.name},  {"value", number_or_null(p.value)}, {"sigma", number_or_null(p.sigma)}, {"unit", p.unit}, {"reading", p.reading},
      {"group", p.group}};
}

/// One object per curve name, the contract's names for the trim and the slopes beside all numbers.
Json to_json(const Uncertainty& u) {
  Json out{{"method", u.method}, {"runs", u.runs}, {"failed", u.failed}, {"failures", Json(u.failures)}, {"seed", u.seed}};
  const SpreadNumber* trim = u.find("trim");
  out["trim_deg"] = trim != nullptr && trim->unit == "rad" ? number_to_json(*trim) : Json(nullptr);
  out["slopes"] = Json::object();
  out["numbers"] = Json::object();
  constexpr std::string_view slope_of = "slope of ";
  for (const SpreadNumber& n : u.numbers) {
    out["numbers"][n.name] = number_to_json(n);
    if (n.name.starts_with(slope_of)) out["slopes"][n.name.substr(slope_of.size())] = number_to_json(n);
  }
  out["variance_shares"] = Json::object();
  for (const SpreadNumber& n : u.numbers) {
    if (n.name == "trim" || n.name.starts_with(slope_of)) out["variance_shares"][n.name] = out["numbers"][n.name]["variance_shares"];
  }
  out["variance_shares_are"] = how_shares;
  out["perturbed"] = Json::array();
  for (const auto& p : u.perturbed) out["perturbed"].push_back(perturbed_to_json(p));
  out["notes"] = u.notes;
  out["curves"] = Json::array();
  for (const auto& c : u.curves) out["curves"].push_back(curve_to_json(c));
  return out;
}

std::string field(double value, const std::string& unit) {
  return std::isfinite(value) ? fmt::format("{}", shown(value, unit)) : std::string();
}

std::string table_of(const std::vector<SpreadCurve>& curves, const CurveFile& file) {
  const SpreadCurve& first = curves[file.curves.front()];
  const std::string unit = shown_unit(first.unit);
  std::string text = fmt::format("curve,{}[{}],mean[{}],sigma[{}],low[{}],high[{}],nominal[{}],runs\n", first.of, shown_unit(first.of_unit),
                                 unit, unit, unit, unit, unit);
  for (const std::size_t k : file.curves) {
    const SpreadCurve& c = curves[k];
    for (std::size_t i = 0; i < c.x.size(); ++i) {
      const double low = c.mean[i] - 3.0 * c.sigma[i], high = c.mean[i] + 3.0 * c.sigma[i];
      text += fmt::format("{},{},{},{},{},{},{},{:.0f}\n", c.name, field(c.x[i], c.of_unit), field(c.mean[i], c.unit),
                          field(c.sigma[i], c.unit), field(low, c.unit), field(high, c.unit), field(c.nominal[i], c.unit), c.count[i]);
    }
  }
  return text;
}

}  // namespace

const SpreadNumber* Uncertainty::find(const std::string& name) const {
  const auto found = std::find_if(numbers.begin(), numbers.end(), [&](const SpreadNumber& n) { return n.name == name; });
  return found == numbers.end() ? nullptr : &*found;
}

std::vector<std::string> write_uncertainty(const std::filesystem::path& dir, const Uncertainty& uncertainty) {
  std::vector<std::string> names{"uncertainty.json"};
  write_atomically(dir / names.front(), to_json(uncertainty).dump(1) + "\n");
  std::vector<CurveEstimate> like;  // the same files as the fit's curves
  for (const auto& c : uncertainty.curves) like.push_back({c.name, c.of, c.of_unit, c.unit, {}, {}, {}, {}, true, ""});
  for (const CurveFile& file : curve_files(like)) {
    names.push_back("uncertainty" + file.name.substr(std::string("curves").size()));
    write_atomically(dir / names.back(), table_of(uncertainty.curves, file));
  }
  return names;
}

Uncertainty read_uncertainty(const std::filesystem::path& dir) {
  return parsed_file(dir / "uncertainty.json", [](const Json& object) {
    Uncertainty u;
    u.method = object.at("method");
    u.runs = object.at("runs");
    u.failed = object.at("failed");
    u.seed = object.at("seed");
    u.failures = object.at("failures").get<std::map<std::string, std::size_t>>();
    for (const auto& [name, entry] : object.at("numbers").items()) u.numbers.push_back(number_from_json(name, entry));
    for (const auto& p : object.at("perturbed"))
      u.perturbed.push_back(
          {p.at("name"), p.at("unit"), number_or_nan(p, "value"), number_or_nan(p, "sigma"), p.at("reading"), p.at("group")});
    for (const auto& c : object.at("curves")) u.curves.push_back(curve_from_json(c));
    u.notes = object.at("notes").get<std::vector<std::string>>();
    return u;
  });
}

}  // namespace misfit
