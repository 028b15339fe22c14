#include "misfit/page/json_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>

#include "misfit/core/enum_name.h"
#include "misfit/report/extent.h"
#include "misfit/report/symbols.h"

namespace misfit::page {
namespace {

using report::Figure;
using report::Panel;
using report::Series;
using report::Style;

constexpr std::array<const char*, 13> style_names = {"line", "dashed",    "dotted", "points", "markers", "error_bars", "x_bars",
                                                     "band", "pale_band", "steps",  "boxes",  "bars",    "cells"};

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](double p, double q) { return std::bit_cast<std::uint64_t>(p) == std::bit_cast<std::uint64_t>(q); });
}

/// The values of x of a figure's series, each once.
class SharedX {
 public:
  std::size_t place(const std::vector<double>& x) {
    for (std::size_t k = 0; k < all_.size(); ++k) {
      if (same_bits(*all_[k], x)) return k;
    }
    all_.push_back(&x);
    return all_.size() - 1;
  }
  [[nodiscard]] std::string text() const {
    std::vector<std::string> out;
    for (const std::vector<double>* x : all_) out.push_back(json_places(*x));
    return json_list(out);
  }

 private:
  std::vector<const std::vector<double>*> all_;
};

std::string range(const std::optional<std::array<double, 2>>& range) {
  return range ? fmt::format("[{},{}]", json_number(range->front()), json_number(range->back())) : "null";
}

std::string marks(const std::vector<report::Mark>& marks) {
  std::vector<std::string> out;
  for (const report::Mark& mark : marks) out.push_back(fmt::format(R"([{},{}])", json_number(mark.at), json_words(mark.text)));
  return json_list(out);
}

std::string json_of(const Series& s, SharedX& shared) {
  std::string out =
      fmt::format(R"({{"key":{},"legend":{},"style":"{}","colour":{},"width":{},"x":{})", json_string(s.key), json_words(s.legend),
                  enum_name(style_names, s.style), json_string(s.colour), json_number(s.width), shared.place(s.x));
  for (const auto& [name, values] : {std::pair{"y", &s.y}, {"lo", &s.lo}, {"hi", &s.hi}, {"z", &s.z}}) {
    if (!values->empty()) out += fmt::format(R"(,"{}":{})", name, json_numbers(*values));
  }
  return out + "}";
}

std::string json_of(const Panel& p, SharedX& shared) {
  std::vector<std::string> series;
  for (const Series& s : p.series) series.push_back(json_of(s, shared));
  const std::string beside =
      p.beside ? fmt::format(R"({{"label":{},"range":{}}})", json_words(p.beside->label), range(p.beside->range)) : "null";
  return fmt::format(
      R"({{"label":{},"name":{},"unit":{},"series":{},"range":{},"height":{},"zero":{},"marks":{},"ground":{},"beside":{}}})",
      json_words(p.y_label), json_string(p.y_label), json_words(p.y_unit), json_list(series), range(p.y_range), json_number(p.height),
      p.zero_line, marks(p.y_marks), json_string(p.ground), beside);
}

struct BlockWriter {
  std::string operator()(const Heading& b) const {
    return fmt::format(R"({{"kind":"heading","text":{},"level":{}}})", json_words(b.text), b.level);
  }
  std::string operator()(const Paragraph& b) const {
    const std::string text = b.tone == Tone::command ? json_string(b.text) : json_words(b.text);
    return fmt::format(R"({{"kind":"paragraph","text":{},"tone":{}}})", text, tone(b.tone));
  }
  std::string operator()(const List& b) const {
    const std::string folded = b.folded.empty() ? "" : R"(,"folded":)" + json_words(b.folded);
    return fmt::format(R"({{"kind":"list","items":{},"tone":{}{}}})", words(b.items), tone(b.tone), folded);
  }
  std::string operator()(const TableBlock& b) const {
    std::vector<std::string> columns, rows;
    for (const TableColumn& c : b.columns)
      columns.push_back(fmt::format(R"({{"heading":{},"right":{}}})", json_words(c.heading), c.align == Align::right));
    for (const auto& row : b.rows) rows.push_back(words(row));
    return fmt::format(R"({{"kind":"table","columns":{},"rows":{}}})", json_list(columns), json_list(rows));
  }
  std::string operator()(const FigurePlace& b) const { return fmt::format(R"({{"kind":"figures","name":{}}})", json_string(b.name)); }

 private:
  static std::string words(const std::vector<std::string>& texts) {
    std::vector<std::string> out;
    for (const std::string& text : texts) out.push_back(json_words(text));
    return json_list(out);
  }
  static std::string tone(Tone tone) {
    constexpr std::array names = {"plain", "lead", "warning", "command"};
    return json_string(enum_name(names, tone));
  }
};

}  // namespace

std::string json_string(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string json_words(const std::string& text) {
  const std::vector<report::Run> runs = report::typeset(text);
  if (runs.size() == 1 && runs.front().place == report::Run::Place::line) return json_string(runs.front().text);
  std::vector<std::string> out;
  for (const report::Run& run : runs) {
    const int place = run.place == report::Run::Place::line ? 0 : run.place == report::Run::Place::below ? -1 : 1;
    out.push_back(fmt::format("[{},{}]", json_string(run.text), place));
  }
  return json_list(out);
}

std::string json_number(double value) { return std::isfinite(value) ? fmt::format("{}", value) : "null"; }

std::string json_numbers(const std::vector<double>& values, int digits) {
  constexpr int all = 17;
  digits = std::min(digits + report::digits_before_span(report::extent_of(values)), all);
  fmt::memory_buffer out;
  out.push_back('[');
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) out.push_back(',');
    if (std::isfinite(values[i])) {
      fmt::format_to(std::back_inserter(out), "{:.{}g}", values[i], digits);
    } else {
      out.append(std::string_view("null"));
    }
  }
  out.push_back(']');
  return fmt::to_string(out);
}

std::string json_places(const std::vector<double>& x) {
  constexpr int of_span = 9, most = 17;  // significant digits; 17 give a number as it is
  double least = std::numeric_limits<double>::infinity(), largest = -least;
  for (const double value : x) {
    if (std::isfinite(value)) least = std::min(least, value), largest = std::max(largest, value);
  }
  const double span = largest - least, size = std::max(std::abs(least), std::abs(largest));
  const int more = span > 0.0 && size > span ? static_cast<int>(std::ceil(std::log10(size / span))) : 0;
  return json_numbers(x, std::min(of_span + more, most));
}

std::string json_list(const std::vector<std::string>& items) { return fmt::format("[{}]", fmt::join(items, ",")); }

std::string json_of(const Figure& f) {
  SharedX shared;
  std::vector<std::string> panels, notes;
  for (const Panel& panel : f.panels) panels.push_back(json_of(panel, shared));
  for (const std::string& note : f.notes) notes.push_back(json_words(note));
  return fmt::format(R"({{"name":{},"title":{},"caption":{},"xLabel":{},"xName":{},"xUnit":{},"xRange":{},"panels":{},"xs":{},"notes":{},)"
                     R"("equal":{},"xMarks":{},"zLabel":{},"zMost":{}}})",
                     json_string(f.name), json_words(f.title), json_words(f.caption), json_words(f.x_label), json_string(f.x_label),
                     json_words(f.x_unit), range(f.x_range), json_list(panels), shared.text(), json_list(notes), f.equal_axes,
                     marks(f.x_marks), json_words(f.z_label), json_number(report::colour_limit(f)));
}

std::string json_of(const Blocks& blocks) {
  std::vector<std::string> out;
  for (const Block& block : blocks.all()) out.push_back(std::visit(BlockWriter{}, block));
  return json_list(out);
}

}  // namespace misfit::page
