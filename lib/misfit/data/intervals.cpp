#include "misfit/data/intervals.h"

#include <fmt/format.h>

#include "misfit/core/units.h"
#include "misfit/data/json_number.h"

namespace misfit {
namespace {

Json to_json(const BootstrapNumber& n) {
  return {{"name", n.name},
          {"unit", n.unit},
          {"value", number_or_null(n.value)},
          {"fit_sigma", sigma_or_null(n.fit_sigma)},
          {"mean", number_or_null(n.mean)},
          {"sigma", number_or_null(n.sigma)},
          {"interval_95", {number_or_null(n.lower), number_or_null(n.upper)}},
          {"runs", n.runs}};
}

BootstrapNumber number_from(const Json& object) {
  BootstrapNumber n;
  n.name = object.at("name");
  n.unit = object.at("unit");
  n.value = number_or_nan(object, "value");
  n.fit_sigma = optional_from_json(object, "fit_sigma").value_or(0.0);
  n.mean = number_or_nan(object, "mean");
  n.sigma = number_or_nan(object, "sigma");
  const std::vector<double> interval = numbers_from_json(object.at("interval_95"));
  n.lower = interval.at(0);
  n.upper = interval.at(1);
  n.runs = object.at("runs");
  return n;
}

Json to_json(const BootstrapCurve& c) {
  return {{"name", c.name},
          {"of", c.of},
          {"of_unit", c.of_unit},
          {"unit", c.unit},
          {"x", numbers_to_json(c.x)},
          {"value", numbers_to_json(c.value)},
          {"fit_sigma", numbers_to_json(c.fit_sigma)},
          {"mean", numbers_to_json(c.mean)},
          {"sigma", numbers_to_json(c.sigma)},
          {"lower_95", numbers_to_json(c.lower)},
          {"upper_95", numbers_to_json(c.upper)},
          {"count", numbers_to_json(c.count)}};
}

BootstrapCurve curve_from(const Json& object) {
  BootstrapCurve c;
  c.name = object.at("name");
  c.of = object.at("of");
  c.of_unit = object.at("of_unit");
  c.unit = object.at("unit");
  c.x = numbers_from_json(object.at("x"));
  c.value = numbers_from_json(object.at("value"));
  c.fit_sigma = numbers_from_json(object.at("fit_sigma"));
  c.mean = numbers_from_json(object.at("mean"));
  c.sigma = numbers_from_json(object.at("sigma"));
  c.lower = numbers_from_json(object.at("lower_95"));
  c.upper = numbers_from_json(object.at("upper_95"));
  c.count = numbers_from_json(object.at("count"));
  return c;
}

/// Method and curve as text, angles in degrees.
std::string curves_as_csv(const std::vector<Bootstrap>& bootstraps) {
  std::string text = "method,curve,of,x,x_unit,value,fit_sigma,mean,sigma,lower_95,upper_95,unit\n";
  for (const Bootstrap& b : bootstraps) {
    for (const BootstrapCurve& c : b.curves) {
      const std::string x_unit = display_unit(c.of_unit), unit = display_unit(c.unit);
      const auto shown = [&](double v) { return std::isfinite(v) ? fmt::format("{}", convert(v, c.unit, unit)) : std::string(); };
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

void write_bootstrap(const std::filesystem::path& dir, const std::vector<Bootstrap>& bootstraps) {
  Json array = Json::array();
  for (const Bootstrap& b : bootstraps) {
    Json numbers = Json::array(), curves = Json::array();
    for (const auto& n : b.numbers) numbers.push_back(to_json(n));
    for (const auto& c : b.curves) curves.push_back(to_json(c));
    array.push_back({{"method", b.method},
                     {"how", b.how},
                     {"block_samples", b.block},
                     {"runs", b.runs},
                     {"failed", b.failed},
                     {"seed", b.seed},
                     {"failures", b.failures},
                     {"notes", b.notes},
                     {"numbers", numbers},
                     {"curves", curves}});
  }
  make_writable_folder(dir);
  write_atomically(dir / "bootstrap.csv", curves_as_csv(bootstraps));
  write_atomically(dir / "bootstrap.json", array.dump(1) + "\n");
}

std::vector<Bootstrap> read_bootstrap(const std::filesystem::path& dir) {
  return parsed_file(dir / "bootstrap.json", [](const Json& array) {
    std::vector<Bootstrap> out;
    for (const Json& object : array) {
      Bootstrap b;
      b.method = object.at("method");
      b.how = object.at("how");
      b.block = object.at("block_samples");
      b.runs = object.at("runs");
      b.failed = object.at("failed");
      b.seed = object.at("seed");
      b.failures = object.at("failures").get<std::map<std::string, std::size_t>>();
      b.notes = object.at("notes").get<std::vector<std::string>>();
      for (const Json& n : object.at("numbers")) b.numbers.push_back(number_from(n));
      for (const Json& c : object.at("curves")) b.curves.push_back(curve_from(c));
      out.push_back(std::move(b));
    }
    return out;
  });
}

void write_profiles(const std::filesystem::path& dir, const std::vector<LikelihoodProfile>& profiles) {
  Json array = Json::array();
  for (const LikelihoodProfile& p : profiles) {
    array.push_back({{"method", p.method},
                     {"parameter", p.parameter},
                     {"unit", p.unit},
                     {"best", number_or_null(p.best)},
                     {"sigma", sigma_or_null(p.sigma)},
                     {"plain_sigma", sigma_or_null(p.plain_sigma)},
                     {"scale", number_or_null(p.scale)},
                     {"interval_95", {number_or_null(p.lower), number_or_null(p.upper)}},
                     {"interval_found", {p.lower_found, p.upper_found}},
                     {"value", numbers_to_json(p.value)},
                     {"drop", numbers_to_json(p.drop)},
                     {"words", p.words}});
  }
  make_writable_folder(dir);
  write_atomically(dir / "profile.json", array.dump(1) + "\n");
}

std::vector<LikelihoodProfile> read_profiles(const std::filesystem::path& dir) {
  return parsed_file(dir / "profile.json", [](const Json& array) {
    std::vector<LikelihoodProfile> out;
    for (const Json& object : array) {
      LikelihoodProfile p;
      p.method = object.at("method");
      p.parameter = object.at("parameter");
      p.unit = object.at("unit");
      p.best = number_or_nan(object, "best");
      p.sigma = optional_from_json(object, "sigma").value_or(0.0);
      p.plain_sigma = optional_from_json(object, "plain_sigma").value_or(0.0);
      p.scale = number_or_nan(object, "scale");
      const std::vector<double> interval = numbers_from_json(object.at("interval_95"));
      p.lower = interval.at(0);
      p.upper = interval.at(1);
      p.lower_found = object.at("interval_found").at(0);
      p.upper_found = object.at("interval_found").at(1);
      p.value = numbers_from_json(object.at("value"));
      p.drop = numbers_from_json(object.at("drop"));
      p.words = object.at("words").get<std::vector<std::string>>();
      out.push_back(std::move(p));
    }
    return out;
  });
}

void write_resampling_notes(const std::filesystem::path& dir, const std::vector<std::string>& notes) {
  make_writable_folder(dir);
  write_atomically(dir / "resampling.json", Json{{"notes", notes}}.dump(1) + "\n");
}

std::vector<std::string> read_resampling_notes(const std::filesystem::path& dir) {
  return parsed_file(dir / "resampling.json", [](const Json& object) { return object.at("notes").get<std::vector<std::string>>(); });
}

}  // namespace misfit
