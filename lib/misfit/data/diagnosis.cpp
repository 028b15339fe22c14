#include "misfit/data/diagnosis.h"

#include "misfit/core/file_name.h"
#include "misfit/core/table.h"
#include "misfit/core/units.h"
#include "misfit/data/json_number.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

Json to_json(const WhitenessReport& w) {
  return {{"experiment", w.experiment},
          {"channel", w.channel},
          {"lags", w.lags},
          {"ljung_box", number_or_null(w.ljung_box)},
          {"ljung_box_p", number_or_null(w.ljung_box_p)},
          {"periodogram_p", number_or_null(w.periodogram_p)},
          {"peak_frequency", number_or_null(w.peak_frequency)},
          {"peak_power", number_or_null(w.peak_power)},
          {"peak_p", number_or_null(w.peak_p)},
          {"band", number_or_null(w.band)},
          {"autocorrelation", numbers_to_json(w.autocorrelation)},
          {"frequency", numbers_to_json(w.frequency)},
          {"power", numbers_to_json(w.power)}};
}

WhitenessReport whiteness_from(const Json& object) {
  WhitenessReport w;
  w.experiment = object.at("experiment");
  w.channel = object.at("channel");
  w.lags = object.at("lags");
  w.ljung_box = number_or_nan(object, "ljung_box");
  w.ljung_box_p = number_or_nan(object, "ljung_box_p");
  w.periodogram_p = number_or_nan(object, "periodogram_p");
  w.peak_frequency = number_or_nan(object, "peak_frequency");
  w.peak_power = number_or_nan(object, "peak_power");
  w.peak_p = number_or_nan(object, "peak_p");
  w.band = number_or_nan(object, "band");
  w.autocorrelation = numbers_from_json(object.at("autocorrelation"));
  w.frequency = numbers_from_json(object.at("frequency"));
  w.power = numbers_from_json(object.at("power"));
  return w;
}

Json to_json(const ForceMap& m) {
  return {{"port", m.port},
          {"port_unit", m.port_unit},
          {"quantity", m.quantity},
          {"quantity_unit", m.quantity_unit},
          {"chi2", number_or_null(m.chi2)},
          {"dof", m.dof},
          {"p_value", number_or_null(m.p_value)},
          {"p_corrected", number_or_null(m.p_corrected)},
          {"sentence", m.sentence},
          {"x", numbers_to_json(m.x)},
          {"amplitude", numbers_to_json(m.amplitude)},
          {"sigma", numbers_to_json(m.sigma)},
          {"count", numbers_to_json(m.count)}};
}

ForceMap map_from(const Json& object) {
  ForceMap m;
  m.port = object.at("port");
  m.port_unit = object.at("port_unit");
  m.quantity = object.at("quantity");
  m.quantity_unit = object.at("quantity_unit");
  m.chi2 = number_or_nan(object, "chi2");
  m.dof = object.at("dof");
  m.p_value = number_or_nan(object, "p_value");
  m.p_corrected = number_or_nan(object, "p_corrected");
  m.sentence = object.at("sentence");
  m.x = numbers_from_json(object.at("x"));
  m.amplitude = numbers_from_json(object.at("amplitude"));
  m.sigma = numbers_from_json(object.at("sigma"));
  m.count = numbers_from_json(object.at("count"));
  return m;
}

Json to_json(const PairMap& m) {
  return {{"port", m.port},
          {"port_unit", m.port_unit},
          {"quantity_x", m.quantity_x},
          {"unit_x", m.unit_x},
          {"quantity_y", m.quantity_y},
          {"unit_y", m.unit_y},
          {"chi2", number_or_null(m.chi2)},
          {"dof", m.dof},
          {"p_value", number_or_null(m.p_value)},
          {"p_corrected", number_or_null(m.p_corrected)},
          {"x", numbers_to_json(m.x)},
          {"y", numbers_to_json(m.y)},
          {"amplitude", numbers_to_json(m.amplitude)},
          {"sigma", numbers_to_json(m.sigma)}};
}

PairMap pair_from(const Json& object) {
  PairMap m;
  m.port = object.at("port");
  m.port_unit = object.at("port_unit");
  m.quantity_x = object.at("quantity_x");
  m.unit_x = object.at("unit_x");
  m.quantity_y = object.at("quantity_y");
  m.unit_y = object.at("unit_y");
  m.chi2 = number_or_nan(object, "chi2");
  m.dof = object.at("dof");
  m.p_value = number_or_nan(object, "p_value");
  m.p_corrected = number_or_nan(object, "p_corrected");
  m.x = numbers_from_json(object.at("x"));
  m.y = numbers_from_json(object.at("y"));
  m.amplitude = numbers_from_json(object.at("amplitude"));
  m.sigma = numbers_from_json(object.at("sigma"));
  return m;
}

Json to_json(const NisSeries& n) {
  return {{"experiment", n.experiment},           {"lower", number_or_null(n.lower)}, {"upper", number_or_null(n.upper)},
          {"outside", number_or_null(n.outside)}, {"t", numbers_to_json(n.t)},        {"nis", numbers_to_json(n.nis)}};
}

NisSeries nis_from(const Json& object) {
  return {object.at("experiment"),        numbers_from_json(object.at("t")), numbers_from_json(object.at("nis")),
          number_or_nan(object, "lower"), number_or_nan(object, "upper"),    number_or_nan(object, "outside")};
}

std::string file_of_missing(const Diagnosis& diagnosis, std::size_t k) {
  return "missing_force" + file_suffix(k, diagnosis.missing[k].experiment) + ".csv";
}

Json to_json(const MissingForce& m, const std::string& file) {
  Json ports = Json::array(), quantities = Json::array();
  for (std::size_t p = 0; p < m.ports.size(); ++p) ports.push_back({{"name", m.ports[p]}, {"unit", m.port_units[p]}});
  for (std::size_t q = 0; q < m.quantities.size(); ++q) quantities.push_back({{"name", m.quantities[q]}, {"unit", m.quantity_units[q]}});
  return {{"experiment", m.experiment}, {"file", file}, {"ports", ports}, {"quantities", quantities}};
}

std::vector<double> shown(std::vector<double> values, const std::string& unit) {
  const double factor = convert(1.0, unit, display_unit(unit));
  for (double& value : values) value *= factor;
  return values;
}

void write_missing(const fs::path& path, const MissingForce& m) {
  Table table;
  table.add("t", "s", m.t);
  const auto add = [&](const std::string& name, const std::string& unit, const std::vector<double>& values) {
    table.add(name, display_unit(unit), shown(values, unit));
  };
  for (std::size_t p = 0; p < m.ports.size(); ++p) {
    add(m.ports[p], m.port_units[p], m.force[p]);
    add(m.ports[p] + "_sigma", m.port_units[p], m.sigma[p]);
  }
  for (std::size_t q = 0; q < m.quantities.size(); ++q) add(m.quantities[q], m.quantity_units[q], m.values[q]);
  write_csv(path, table);
}

MissingForce missing_from(const Json& object, const fs::path& dir) {
  MissingForce m;
  m.experiment = object.at("experiment");
  const Table table = read_csv(dir / object.at("file").get<std::string>());
  m.t = table.values("t", "s");
  for (const Json& port : object.at("ports")) {
    m.ports.push_back(port.at("name"));
    m.port_units.push_back(port.at("unit"));
    m.force.push_back(table.values(m.ports.back(), m.port_units.back()));
    m.sigma.push_back(table.values(m.ports.back() + "_sigma", m.port_units.back()));
  }
  for (const Json& quantity : object.at("quantities")) {
    m.quantities.push_back(quantity.at("name"));
    m.quantity_units.push_back(quantity.at("unit"));
    m.values.push_back(table.values(m.quantities.back(), m.quantity_units.back()));
  }
  return m;
}

}  // namespace

void write_diagnosis(const fs::path& dir, const Diagnosis& diagnosis) {
  make_writable_folder(dir);
  Json root = {{"method", diagnosis.method}, {"sentences", diagnosis.sentences}, {"maps", Json::array()},
               {"pairs", Json::array()},     {"whiteness", Json::array()},       {"nis", Json::array()},
               {"missing", Json::array()},   {"seconds", diagnosis.seconds}};
  for (const auto& map : diagnosis.maps) root["maps"].push_back(to_json(map));
  for (const auto& pair : diagnosis.pairs) root["pairs"].push_back(to_json(pair));
  for (const auto& report : diagnosis.whiteness) root["whiteness"].push_back(to_json(report));
  for (const auto& series : diagnosis.nis) root["nis"].push_back(to_json(series));
  for (std::size_t k = 0; k < diagnosis.missing.size(); ++k) {
    const std::string file = file_of_missing(diagnosis, k);
    write_missing(dir / file, diagnosis.missing[k]);
    root["missing"].push_back(to_json(diagnosis.missing[k], file));
  }
  write_atomically(dir / "diagnosis.json", root.dump(1) + "\n");
}

Diagnosis read_diagnosis(const fs::path& dir) {
  return parsed_file(dir / "diagnosis.json", [&](const Json& root) {
    Diagnosis d;
    d.method = root.at("method");
    d.sentences = root.at("sentences").get<std::vector<std::string>>();
    for (const Json& object : root.at("maps")) d.maps.push_back(map_from(object));
    for (const Json& object : root.at("pairs")) d.pairs.push_back(pair_from(object));
    for (const Json& object : root.at("whiteness")) d.whiteness.push_back(whiteness_from(object));
    for (const Json& object : root.at("nis")) d.nis.push_back(nis_from(object));
    for (const Json& object : root.at("missing")) d.missing.push_back(missing_from(object, dir));
    d.seconds = number_or_nan(root, "seconds");
    return d;
  });
}

}  // namespace misfit
