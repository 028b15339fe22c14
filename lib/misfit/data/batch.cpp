#include "misfit/data/batch.h"

#include <fmt/format.h>

#include "misfit/core/display.h"
#include "misfit/core/units.h"
#include "misfit/data/json_fields.h"

namespace misfit {

template <class Archive>
void fields(Archive& json, MaybeConst<BatchRow> auto& row) {
  json("study", row.study), json("path", row.path), json("folder", row.folder), json("method", row.method);
  json("status", row.status), json("message", row.message), json("values", row.values), json("rms", row.rms);
}

template <class Archive>
void fields(Archive& json, MaybeConst<BatchSummary> auto& s) {
  const double factor = json.factor("unit", s.unit);
  json("method", s.method), json("name", s.name), json("unit", DisplayUnit(s.unit)), json("studies", s.count);
  json("mean", Scaled(s.mean, factor)), json("mean_sigma", Sigma(s.mean_sigma, factor));
  json("scatter", Scaled(s.scatter, factor)), json("own_sigma", Sigma(s.own_sigma, factor));
  json("p_value", s.p_value);
}

template <class Archive>
void fields(Archive& json, MaybeConst<Batch> auto& batch) {
  json("studies", batch.rows), json("summary", batch.summary);
}

namespace {

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
      text += "," + (e == nullptr ? "" : display_field(e->value, e->unit));
      if (!column.first.starts_with("rms of ")) text += "," + (e == nullptr || !(e->sigma > 0.0) ? "" : display_field(e->sigma, e->unit));
    }
    text += fmt::format(",{}\n", quoted(row.message));
  }
  return text;
}

}  // namespace

std::string batch_rows_text(const std::vector<BatchRow>& rows) {
  return JsonWriter::json_of(rows).dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::vector<BatchRow> batch_rows_from(const std::string& text) {
  std::vector<BatchRow> rows;
  try {
    JsonReader::read(Json::parse(text), rows);
  } catch (const Json::exception& error) {
    throw RunError(std::string("a stored result of the batch cannot be read: ") + error.what());
  }
  return rows;
}

void write_batch(const std::filesystem::path& dir, const Batch& batch) {
  write_json(dir / "batch.json", batch);
  write_atomically(dir / "batch.csv", table_of(batch.rows));
}

}  // namespace misfit
