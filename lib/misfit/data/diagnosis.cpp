#include "misfit/data/diagnosis.h"

#include "misfit/core/display.h"
#include "misfit/core/file_name.h"
#include "misfit/core/table.h"
#include "misfit/core/units.h"
#include "misfit/data/json_fields.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

/// A column of missing_force.csv.
struct NamedColumn {
  std::string name, unit;  ///< SI
};

/// What diagnosis.json says of a MissingForce, whose numbers are in a table.
struct MissingForceTable {
  std::string experiment, file;
  std::vector<NamedColumn> ports, quantities;
};

}  // namespace

template <class Archive>
void fields(Archive& json, MaybeConst<WhitenessReport> auto& w) {
  json("experiment", w.experiment), json("channel", w.channel), json("lags", w.lags), json("ljung_box", w.ljung_box);
  json("ljung_box_p", w.ljung_box_p), json("periodogram_p", w.periodogram_p);
  json("peak_frequency", w.peak_frequency), json("peak_power", w.peak_power), json("peak_p", w.peak_p);
  json("band", w.band), json("autocorrelation", w.autocorrelation), json("frequency", w.frequency);
  json("power", w.power);
}

template <class Archive>
void fields(Archive& json, MaybeConst<ForceMap> auto& m) {
  json("port", m.port), json("port_unit", m.port_unit), json("quantity", m.quantity);
  json("quantity_unit", m.quantity_unit), json("chi2", m.chi2), json("dof", m.dof), json("p_value", m.p_value);
  json("p_corrected", m.p_corrected), json("sentence", m.sentence), json("x", m.x), json("amplitude", m.amplitude);
  json("sigma", m.sigma), json("count", m.count);
}

template <class Archive>
void fields(Archive& json, MaybeConst<PairMap> auto& m) {
  json("port", m.port), json("port_unit", m.port_unit), json("quantity_x", m.quantity_x), json("unit_x", m.unit_x);
  json("quantity_y", m.quantity_y), json("unit_y", m.unit_y), json("chi2", m.chi2), json("dof", m.dof);
  json("p_value", m.p_value), json("p_corrected", m.p_corrected), json("x", m.x), json("y", m.y);
  json("amplitude", m.amplitude), json("sigma", m.sigma);
}

template <class Archive>
void fields(Archive& json, MaybeConst<NisSeries> auto& n) {
  json("experiment", n.experiment), json("lower", n.lower), json("upper", n.upper), json("outside", n.outside);
  json("t", n.t), json("nis", n.nis);
}

template <class Archive>
void fields(Archive& json, MaybeConst<ForcePulses> auto& p) {
  json("experiment", p.experiment), json("port", p.port), json("port_unit", p.port_unit), json("begin", p.begin);
  json("end", p.end), json("peak", p.peak), json("sentence", p.sentence);
}

template <class Archive>
void fields(Archive& json, MaybeConst<NamedColumn> auto& column) {
  json("name", column.name), json("unit", column.unit);
}

template <class Archive>
void fields(Archive& json, MaybeConst<MissingForceTable> auto& table) {
  json("experiment", table.experiment), json("file", table.file), json("ports", table.ports);
  json("quantities", table.quantities);
}

namespace {

/// diagnosis.json.
struct StoredDiagnosis {
  Diagnosis diagnosis;
  std::vector<MissingForceTable> missing;
};

std::string file_of_missing(const Diagnosis& diagnosis, std::size_t k) {
  return "missing_force" + file_suffix(k, diagnosis.missing[k].experiment) + ".csv";
}

std::vector<NamedColumn> columns(const std::vector<std::string>& names, const std::vector<std::string>& units) {
  std::vector<NamedColumn> out;
  for (std::size_t k = 0; k < names.size(); ++k) out.push_back({names[k], units[k]});
  return out;
}

void write_missing(const fs::path& path, const MissingForce& m) {
  Table table;
  table.add("t", "s", m.t);
  const auto add = [&](const std::string& name, const std::string& unit, const std::vector<double>& values) {
    table.add(name, display_unit(unit), display_values(values, unit));
  };
  for (std::size_t p = 0; p < m.ports.size(); ++p) {
    add(m.ports[p], m.port_units[p], m.force[p]);
    add(m.ports[p] + "_sigma", m.port_units[p], m.sigma[p]);
  }
  for (std::size_t q = 0; q < m.quantities.size(); ++q)
    table.add(m.quantities[q], display_level_unit(m.quantity_units[q]), display_levels(m.values[q], m.quantity_units[q]));
  write_csv(path, table);
}

MissingForce read_missing(const fs::path& dir, const MissingForceTable& stored) {
  MissingForce m;
  m.experiment = stored.experiment;
  const Table table = read_csv(dir / stored.file);
  m.t = table.values("t", "s");
  for (const auto& [name, unit] : stored.ports) {
    m.ports.push_back(name);
    m.port_units.push_back(unit);
    m.force.push_back(table.values(name, unit));
    m.sigma.push_back(table.values(name + "_sigma", unit));
  }
  for (const auto& [name, unit] : stored.quantities) {
    m.quantities.push_back(name);
    m.quantity_units.push_back(unit);
    m.values.push_back(table.values(name, unit));
  }
  return m;
}

}  // namespace

template <class Archive>
void fields(Archive& json, MaybeConst<StoredDiagnosis> auto& stored) {
  auto& d = stored.diagnosis;
  json("method", d.method), json("sentences", d.sentences), json("maps", d.maps), json("pairs", d.pairs);
  json("whiteness", d.whiteness), json("nis", d.nis), json("missing", stored.missing), json.if_there("pulses", d.pulses),
      json("seconds", d.seconds);
}

const ForceMap* find_map(const Diagnosis& diagnosis, const std::string& port, const std::string& quantity) {
  for (const ForceMap& map : diagnosis.maps) {
    if (map.port == port && map.quantity == quantity) return &map;
  }
  return nullptr;
}

void write_diagnosis(const fs::path& dir, const Diagnosis& diagnosis) {
  make_writable_folder(dir);
  StoredDiagnosis stored{diagnosis, {}};
  for (std::size_t k = 0; k < diagnosis.missing.size(); ++k) {
    const MissingForce& m = diagnosis.missing[k];
    const std::string file = file_of_missing(diagnosis, k);
    write_missing(dir / file, m);
    stored.missing.push_back({m.experiment, file, columns(m.ports, m.port_units), columns(m.quantities, m.quantity_units)});
  }
  write_json(dir / "diagnosis.json", stored);
}

Diagnosis read_diagnosis(const fs::path& dir) {
  auto stored = read_json<StoredDiagnosis>(dir / "diagnosis.json");
  for (const MissingForceTable& table : stored.missing) stored.diagnosis.missing.push_back(read_missing(dir, table));
  return std::move(stored.diagnosis);
}

}  // namespace misfit
