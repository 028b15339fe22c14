#include "misfit/data/batch.h"

#include <fmt/format.h>

#include "misfit/core/units.h"
#include "misfit/data/json_number.h"

namespace misfit {
namespace {

double shown(double value, const std::string& unit) { return convert(value, unit, display_unit(unit)); }

Json to_json(const BatchRow& row) {
  return {{"study", row.study},
          {"path", row.path},
          {"folder", row.folder},
          {"method", row.method},
          {"status", row.status},
          {"message", row.message},
          {"values", estimates_to_json(row.values)},
          {"rms", estimates_to_json(row.rms)}};
}

BatchRow row_from(const Json& object) {
  BatchRow row;
  object.at("study").get_to(row.study);
  object.at("path").get_to(row.path);
  object.at("folder").get_to(row.folder);
  object.at("method").get_to(row.method);
  object.at("status").get_to(row.status);
  object.at("message").get_to(row.message);
  row.values = estimates_from_json(object.at("values"));
  row.rms = estimates_from_json(object.at("rms"));
  return row;
}

Json to_json(const BatchSummary& s) {
  const auto in = [&](double value) { return number_or_null(shown(value, s.unit)); };
  return {{"method", s.method},
          {"name", s.name},
          {"unit", display_unit(s.unit)},
          {"studies", s.count},
          {"mean", in(s.mean)},
          {"mean_sigma", sigma_or_null(shown(s.mean_sigma, s.unit))},
          {"scatter", in(s.scatter)},
          {"own_sigma", sigma_or_null(shown(s.own_sigma, s.unit))},
          {"p_value", number_or_null(s.p_value)}};
}

/// Every number that some row has, with its unit, in the order of appearance.
std::vector<std::pair<std::string, std::string>> columns_of(const std::vector<BatchRow>& rows) {
  std::vector<std::pair<std::string, std::string>> columns;
  const auto add = [&](const std::string& name, const std::string& unit) {
    const std::pair<std::string, std::string> column{name, unit};
    if (std::find(columns.begin(), columns.end(), column) == columns.end()) columns.push_back(column);
  };
  for (const BatchRow& row : rows) {
    for (const auto& [name, e] : row.values) add(name, e.unit);
    for (const auto& [name, e] : row.rms) add("rms of " + name, e.unit);
  }
  return columns;
}

std::string field(double value, const std::string& unit) {
  return std::isfinite(value) ? fmt::format("{}", shown(value, unit)) : std::string();
}

/// A text as one field of a CSV.
std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c == '\n' || c == '\r' ? ' ' : c;
  }
  return out + "\"";
}

const Estimate* value_in(const BatchRow& row, const std::pair<std::string, std::string>& column) {
  constexpr std::string_view rms_of = "rms of ";
  const bool rms = column.first.starts_with(rms_of);
  const auto& from = rms ? row.rms : row.values;
  const auto found = from.find(rms ? column.first.substr(rms_of.size()) : column.first);
  return found == from.end() || found->second.unit != column.second ? nullptr : &found->second;
}

std::string table_of(const std::vector<BatchRow>& rows) {
  const auto columns = columns_of(rows);
  std::string text = "study,method,status";
  for (const auto& [name, unit] : columns) {
    const std::string u = display_unit(unit);
    text += fmt::format(",{}", quoted(fmt::format("{}[{}]", name, u)));
    if (!name.starts_with("rms of ")) text += fmt::format(",{}", quoted(fmt::format("{}_sigma[{}]", name, u)));
  }
  text += ",message\n";
  for (const BatchRow& row : rows) {
    text += fmt::format("{},{},{}", quoted(row.study), row.method, row.status);
    for (const auto& column : columns) {
      const Estimate* e = value_in(row, column);
      text += "," + (e == nullptr ? "" : field(e->value, e->unit));
      if (!column.first.starts_with("rms of ")) text += "," + (e == nullptr || !(e->sigma > 0.0) ? "" : field(e->sigma, e->unit));
    }
    text += fmt::format(",{}\n", quoted(row.message));
  }
  return text;
}

}  // namespace

std::string batch_rows_text(const std::vector<BatchRow>& rows) {
  Json array = Json::array();
  for (const BatchRow& row : rows) array.push_back(to_json(row));
  return array.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::vector<BatchRow> batch_rows_from(const std::string& text) {
  std::vector<BatchRow> rows;
  try {
    for (const Json& object : Json::parse(text)) rows.push_back(row_from(object));
  } catch (const Json::exception& error) {
    throw RunError(std::string("a stored result of the batch cannot be read: ") + error.what());
  }
  return rows;
}

void write_batch(const std::filesystem::path& dir, const Batch& batch) {
  Json out{{"studies", Json::array()}, {"summary", Json::array()}};
  for (const BatchRow& row : batch.rows) out["studies"].push_back(to_json(row));
  for (const BatchSummary& s : batch.summary) out["summary"].push_back(to_json(s));
  write_atomically(dir / "batch.json", out.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
  write_atomically(dir / "batch.csv", table_of(batch.rows));
}

}  // namespace misfit
