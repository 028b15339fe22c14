#include "misfit/data/log/arrays.h"

#include <algorithm>
#include <array>
#include <map>

#include "misfit/core/column_header.h"
#include "misfit/core/shown.h"

namespace misfit {
namespace {

constexpr std::size_t most_columns = 1000;

std::string shape_text(const std::vector<std::size_t>& shape) {
  std::string out;
  for (const std::size_t n : shape) out += (out.empty() ? "" : " x ") + std::to_string(n);
  return out;
}

/// Without sides of length 1.
std::vector<std::size_t> long_sides(const std::vector<std::size_t>& shape) {
  std::vector<std::size_t> out;
  std::copy_if(shape.begin(), shape.end(), std::back_inserter(out), [](std::size_t n) { return n != 1; });
  return out;
}

std::string last_part(const std::string& name) { return name.substr(name.find_last_of("./") + 1); }

/// "a.b.c" → "a.b" → "a" → "".
std::string around(const std::string& group) {
  const auto end = group.find_last_of("./");
  return end == std::string::npos ? "" : group.substr(0, end);
}

}  // namespace

std::optional<std::size_t> count_of(const std::vector<std::size_t>& shape, std::size_t most) {
  std::size_t count = 1;
  for (const std::size_t n : shape) {
    if (n == 0) return 0;
    if (count > most / n) return std::nullopt;
    count *= n;
  }
  return count;
}

void add_array(Log& log, std::vector<ArrayColumn>& columns, const ArrayInfo& array, std::size_t index) {
  const std::vector<std::size_t> sides = long_sides(array.shape);
  const auto add = [&](const std::string& name, std::size_t samples, std::size_t first, std::size_t stride) {
    log.channels.push_back({name, array.group, array.unit, samples, std::nullopt, {}});
    columns.push_back({index, first, stride});
  };
  if (sides.empty() || std::find(sides.begin(), sides.end(), 0U) != sides.end()) return;
  if (sides.size() == 1) return add(array.name, sides[0], 0, 1);
  const bool rows_are_time = sides[0] >= sides[1];
  const std::size_t samples = std::max(sides[0], sides[1]), channels = std::min(sides[0], sides[1]);
  if (sides.size() > 2 || channels > most_columns) {
    log.notes.push_back("'" + shown(array.name) + "' of " + shape_text(array.shape) +
                        " numbers is left out: " + (sides.size() > 2 ? "a matrix has two dimensions" : "more than 1000 channels"));
    return;
  }
  if (!rows_are_time) log.notes.push_back("'" + shown(array.name) + "' of " + shape_text(array.shape) + ": its rows are taken as channels");
  const bool time_is_slow = rows_are_time != array.column_major;
  for (std::size_t j = 0; j < channels; ++j)
    add(array.name + "[" + std::to_string(j) + "]", samples, time_is_slow ? j : j * samples, time_is_slow ? channels : 1);
}

std::vector<double> column_values(const ArrayColumn& column, std::size_t samples, const std::byte* data, std::size_t step,
                                  const NumberType& type) {
  std::vector<double> out;
  out.reserve(samples);
  for (std::size_t i = 0; i < samples; ++i) out.push_back(decode_number(data + (column.first + i * column.stride) * step, type));
  return out;
}

bool is_time_name(const std::string& channel) {
  std::string name = read_header(last_part(channel)).name;
  std::transform(name.begin(), name.end(), name.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  constexpr std::array<std::string_view, 12> words = {"t",    "time", "timestamp", "timestamps", "times", "tout",
                                                      "tvec", "zeit", "temps",     "tijd",       "sec",   "seconds"};
  return std::find(words.begin(), words.end(), name) != words.end();
}

void find_clocks(Log& log) {
  std::map<std::pair<std::string, std::size_t>, std::size_t> times;  // by group and samples, the first of each
  for (std::size_t i = 0; i < log.channels.size(); ++i) {
    LogChannel& c = log.channels[i];
    if (!c.clock && is_time_name(c.name) && times.emplace(std::pair{c.group, c.samples}, i).second) c.clock = i;
  }
  for (LogChannel& c : log.channels) {
    for (std::string group = c.group; !c.clock; group = around(group)) {
      const auto found = times.find({group, c.samples});
      if (found != times.end()) c.clock = found->second;
      if (group.empty()) break;
    }
  }
}

}  // namespace misfit
