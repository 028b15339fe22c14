#include "misfit/recording/recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>
#include <utility>

#include "misfit/core/column_header.h"
#include "misfit/core/error.h"
#include "misfit/core/loose_csv.h"
#include "misfit/core/shown.h"
#include "misfit/core/text.h"
#include "misfit/core/unique_name.h"
#include "misfit/core/units.h"
#include "misfit/recording/column_facts.h"
#include "misfit/recording/recording_time.h"

namespace misfit {
namespace {

class ColumnClassifier {
 public:
  ColumnClassifier(const std::filesystem::path& path, const std::vector<std::string>& reserved, ChosenColumns chosen)
      : table_(read_loose_csv(path)), taken_(reserved.begin(), reserved.end()), chosen_(std::move(chosen)) {
    taken_.insert("t");
    out_.source = table_.source;
    out_.rows = table_.rows();
  }

  RecordingSurvey run() {
    describe_format();
    for (const auto& column : table_.columns) out_.columns.push_back(characterise(column));
    find_time();
    run_time();
    find_segments();
    take_chosen();
    find_inputs_and_outputs();
    make_names_usable();
    find_rates();
    name_unknown_units();
    fill_parts();
    return std::move(out_);
  }

 private:
  [[noreturn]] void fail(int line, const std::string& message) const { throw InputError({table_.source, line, 0}, message); }
  const std::vector<double>& values(std::size_t column) const { return table_.columns[column].values; }

  void describe_format() {
    const char* between = table_.delimiter == ','    ? "commas"
                          : table_.delimiter == ';'  ? "semicolons"
                          : table_.delimiter == '\t' ? "tabs"
                                                     : "blanks";
    out_.format = fmt::format("{} between cells, decimal {}", between, table_.decimal_comma ? "commas" : "points");
    if (table_.comments > 0) out_.format += fmt::format(", {} comment line{}", table_.comments, table_.comments == 1 ? "" : "s");
  }

  ColumnSurvey characterise(const LooseColumn& column) {
    ColumnSurvey s;
    const NameAndUnit header = read_header(column.header);
    s.header = shown(column.header, longest_header);
    s.name = header.name;
    s.unit = header.unit.empty() ? "-" : header.unit;
    not_understood_.push_back(shown(header.not_understood, longest_header));
    if (is_called_celsius(header.not_understood)) {
      s.unit = "K";
      not_understood_.back().clear();
      out_.remarks.push_back(fmt::format("column '{}': its numbers are taken as K above 0 degC", s.header));
    }
    const std::vector<double> known = finite(column.values);
    s.missing = column.values.size() - known.size() - column.text;
    if (column.text > 0) {
      if (known.size() > column.text) {
        fail(column.text_line,
             fmt::format("column '{}': '{}' is not a number (a missing value is an empty cell or NaN); {} cell{} of {} are text", s.header,
                         shown(column.first_text, longest_header), column.text, column.text == 1 ? "" : "s", column.values.size()));
      }
      s.use = ColumnUse::text;
      s.why = "text";
      return s;
    }
    if (known.empty()) {
      s.use = ColumnUse::constant;
      s.why = "no value at all";
      return s;
    }
    const auto [low, high] = std::minmax_element(known.begin(), known.end());
    s.low = *low;
    s.high = *high;
    s.held = share_held(column.values);
    if (s.low == s.high) {
      s.use = ColumnUse::constant;
      s.why = "never changes: " + format_value(s.low);
    } else {
      s.resolution = resolution_of(known);
    }
    if (s.missing > 0)
      out_.remarks.push_back(fmt::format("column '{}': {} of {} values are missing", s.header, s.missing, column.values.size()));
    return s;
  }

  void make_names_usable() {
    const std::set<std::string> reserved = taken_;
    for (auto& c : out_.columns) {
      if (c.use == ColumnUse::time) continue;
      const std::string wanted = c.name;
      c.name = unique_name(wanted.substr(0, longest_name), taken_);
      if (reserved.contains(wanted))
        out_.remarks.push_back(
            fmt::format("column '{}' is called {}: the word {} means something else in formulas", c.header, c.name, wanted));
    }
  }

  /// Share of the steps that run forward.
  double forward(std::size_t column) const {
    const std::vector<double> t = finite(values(column));
    std::size_t count = 0;
    for (std::size_t i = 1; i < t.size(); ++i) count += t[i] > t[i - 1] ? 1U : 0U;
    return t.size() < 2 ? 0.0 : static_cast<double>(count) / static_cast<double>(t.size() - 1);
  }

  void find_time() {
    constexpr double min_forward_share = 0.5;
    std::string counter;
    for (const bool by_name : {true, false}) {
      for (std::size_t i = 0; i < out_.columns.size() && time_ == none; ++i) {
        ColumnSurvey& c = out_.columns[i];
        if (c.use != ColumnUse::unused || !(forward(i) > min_forward_share)) continue;
        const Unit unit = parse_unit(c.unit);
        const bool of_time = unit.same_dimension(parse_unit("s"));
        if (by_name ? is_called_time(c.name) && (of_time || c.unit == "-") : of_time) time_ = i;
        if (time_ == none && counter.empty() && forward(i) == 1.0 && is_integer(finite(values(i)))) counter = c.header;
      }
    }
    if (time_ == none)
      fail(0, std::string("no column of time: none is called t or time, or is in s, ms, min or h, and increases") +
                  (counter.empty() ? "" : " ('" + counter + "' counts rows, but over which interval?)") + "; write one as t[s]");
    ColumnSurvey& c = out_.columns[time_];
    c.use = ColumnUse::time;
    c.resolution = 0.0;
    if (c.unit == "-") {
      c.unit = std::string("s");
      out_.remarks.push_back(unit_found(time_, "taken as seconds"));
    }
    c.why = "increases steadily" + (c.unit == "s" ? std::string() : ", in " + c.unit);
    const double factor = convert(1.0, c.unit, "s");
    for (const double v : values(time_)) t_.push_back(factor * v);
  }

  void run_time() {
    RecordingTime time = recording_time(t_, table_.source);
    pieces_ = std::move(time.pieces);
    out_.step = time.step;
    out_.jitter = time.jitter;
    out_.gaps = std::move(time.gaps);
    out_.remarks.insert(out_.remarks.end(), time.remarks.begin(), time.remarks.end());
  }

  void find_segments() {
    for (std::size_t i = 0; i < out_.columns.size(); ++i) {
      ColumnSurvey& c = out_.columns[i];
      constexpr double min_held_share = 0.95;
      if (c.use != ColumnUse::unused || !is_called_segment(c.name) || !is_integer(finite(values(i))) || c.held < min_held_share) continue;
      c.use = ColumnUse::segment;
      c.why = "constant whole numbers: a number of the recording";
      out_.remarks.push_back(
          fmt::format("column '{}' numbers recordings {} to {}, time continues across them: kept together as one recording", c.header,
                      format_value(c.low), format_value(c.high)));
    }
  }

  /// What the user chose; with chosen inputs no other column is one, with chosen outputs neither.
  void take_chosen() {
    for (const auto& [names, use, word] :
         {std::tuple{&chosen_.inputs, ColumnUse::input, "--input"}, std::tuple{&chosen_.outputs, ColumnUse::output, "--output"}}) {
      for (const std::string& name : *names) {
        ColumnSurvey& c = chosen_column(name, word);
        c.use = use;
        c.chosen = true;
        c.why = std::string("chosen by ") + word;
      }
    }
    if (chosen_.outputs.empty()) return;
    for (auto& c : out_.columns) {
      if (c.use != ColumnUse::unused || (chosen_.inputs.empty() && looks_like_input(c))) continue;
      c.use = ColumnUse::constant;
      c.why = "not among the columns chosen";
    }
  }

  ColumnSurvey& chosen_column(const std::string& name, const std::string& option) {
    std::vector<std::string> names;
    for (auto& c : out_.columns) {
      if ((c.name == name || c.header == name) && (c.use == ColumnUse::unused || c.use == ColumnUse::segment)) return c;
      if (c.use == ColumnUse::unused) names.push_back(c.name);
      if ((c.name == name || c.header == name)) fail(0, fmt::format("{}: column '{}' cannot be one: {}", option, c.header, c.why));
    }
    fail(0, fmt::format("{}: there is no column '{}'{}", option, shown(name, longest_header), suggest(name, names)));
  }

  static constexpr double held_share_ = 0.5;
  static bool looks_like_input(const ColumnSurvey& c) { return is_called_input(c.name) || c.held > held_share_; }

  void find_inputs_and_outputs() {
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < out_.columns.size(); ++i) {
      if (out_.columns[i].use == ColumnUse::unused) open.push_back(i);
    }
    const bool measured = !chosen_.outputs.empty();
    if (open.empty() && !measured) fail(0, "no column but time changes: nothing was measured");
    const bool may_be_input = chosen_.inputs.empty() && (measured || open.size() > 1);
    for (const std::size_t i : open) {
      ColumnSurvey& c = out_.columns[i];
      if (may_be_input && is_called_input(c.name)) {
        c.use = ColumnUse::input;
        c.why = "named like an input";
      } else if (may_be_input && c.held > held_share_) {
        c.use = ColumnUse::input;
        c.why = fmt::format("constant between jumps ({:.0f} % of its samples equal the one before)", 100.0 * c.held);
      } else {
        c.use = ColumnUse::output;
        c.why = open.size() == 1 ? "the only column that was measured" : "not named like an input, and it varies";
        for (auto& remark : limit_remarks(c.header, values(i))) out_.remarks.push_back(std::move(remark));
      }
    }
    for (std::size_t i = 0; i < out_.columns.size(); ++i) {
      ColumnSurvey& c = out_.columns[i];
      c.measured = c.use == ColumnUse::input && is_smooth(values(i));
    }
    const bool any = std::any_of(open.begin(), open.end(), [&](std::size_t i) { return out_.columns[i].use == ColumnUse::output; });
    if (any || measured) return;
    ColumnSurvey& last = out_.columns[open.back()];
    last.use = ColumnUse::output;
    last.why = "every column looks like an input; the last is taken as the output";
  }

  /// An output that is another's derivative: correlated to better than 0.99 with its central difference, with a slope within 10 % of 1.
  void find_rates() {
    for (std::size_t i = 0; i < out_.columns.size(); ++i) {
      for (std::size_t j = 0; j < out_.columns.size() && out_.columns[i].use == ColumnUse::output; ++j) {
        if (i == j || out_.columns[j].use != ColumnUse::output || !is_rate(i, j)) continue;
        out_.columns[i].use = ColumnUse::rate;
        out_.columns[i].rate_of = out_.columns[j].name;
        out_.columns[i].why = "the rate of change of " + out_.columns[j].name;
        if (out_.columns[i].unit != "-") continue;
        out_.columns[i].unit = rate_unit(out_.columns[j].unit);
        out_.remarks.push_back(unit_found(i, "taken as " + out_.columns[i].unit));
      }
    }
  }

  /// The remark on a column whose header gives no unit, or none that is known, where the numbers show it.
  std::string unit_found(std::size_t i, const std::string& found) {
    const std::string unknown = std::exchange(not_understood_[i], "");
    const std::string column = "column '" + out_.columns[i].header + "'";
    return unknown.empty() ? column + " names no unit: " + found : column + ": the unit '" + unknown + "' is not known: " + found;
  }

  void name_unknown_units() {
    for (std::size_t i = 0; i < not_understood_.size(); ++i) {
      if (not_understood_[i].empty()) continue;
      out_.remarks.push_back(fmt::format("column '{}': the unit '{}' is not known, its numbers are taken as they are",
                                         out_.columns[i].header, not_understood_[i]));
    }
  }

  /// With differences over 1, 2, 4 … samples: noise hides the derivative of what is sampled quickly.
  bool is_rate(std::size_t rate, std::size_t of) const {
    constexpr std::size_t longest = 64;
    for (std::size_t span = 1; span <= longest && 40 * span < table_.rows(); span *= 2) {
      if (is_rate_over(span, rate, of)) return true;
    }
    return false;
  }

  bool is_rate_over(std::size_t span, std::size_t rate, std::size_t of) const {
    const Unit a = parse_unit(out_.columns[rate].unit), b = parse_unit(rate_unit(out_.columns[of].unit));
    if (out_.columns[rate].unit != "-" && !a.same_dimension(b)) return false;
    const double factor = out_.columns[rate].unit == "-" ? 1.0 : b.to_si / a.to_si;
    double xx = 0.0, xy = 0.0, yy = 0.0;
    for (const auto& piece : pieces_) {
      for (std::size_t k = span; k + span < piece.size(); ++k) {
        const double x = factor * (values(of)[piece[k + span]] - values(of)[piece[k - span]]) / (t_[piece[k + span]] - t_[piece[k - span]]);
        const double y = mean_between(rate, piece[k - span], piece[k + span]);
        if (!std::isfinite(x) || !std::isfinite(y)) continue;
        xx += x * x;
        xy += x * y;
        yy += y * y;
      }
    }
    constexpr double alike = 0.98, near_one = 0.1;
    return xx > 0.0 && yy > 0.0 && xy * xy > alike * xx * yy && std::abs(xy / xx - 1.0) < near_one;
  }

  /// Trapezium rule over the rows from … to, as of equal intervals.
  double mean_between(std::size_t column, std::size_t from, std::size_t to) const {
    if (to - from == 2) return values(column)[from + 1];
    double sum = 0.5 * (values(column)[from] + values(column)[to]);
    for (std::size_t i = from + 1; i < to; ++i) sum += values(column)[i];
    return sum / static_cast<double>(to - from);
  }

  void fill_parts() {
    for (const auto& piece : pieces_) {
      Table part;
      part.source = table_.source;
      std::vector<double> t;
      for (const std::size_t row : piece) t.push_back(t_[row]);
      part.add("t", "s", std::move(t));
      for (const ColumnUse use : {ColumnUse::input, ColumnUse::output, ColumnUse::rate}) {
        for (std::size_t i = 0; i < out_.columns.size(); ++i) {
          if (out_.columns[i].use != use) continue;
          std::vector<double> kept;
          for (const std::size_t row : piece) kept.push_back(values(i)[row]);
          part.add(out_.columns[i].name, out_.columns[i].unit, std::move(kept));
        }
      }
      out_.parts.push_back(std::move(part));
    }
  }

  std::vector<std::string> not_understood_;  ///< unit in the header, per column; empty: known, or none, or found out
  static constexpr std::size_t longest_name = 64, longest_header = 80;  // bytes
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  LooseTable table_;
  std::set<std::string> taken_;  // names that are reserved or given
  ChosenColumns chosen_;
  RecordingSurvey out_;
  std::size_t time_ = none;
  std::vector<double> t_;                         // [s], a value per row
  std::vector<std::vector<std::size_t>> pieces_;  // rows in which time runs forward
};

}  // namespace

std::vector<const ColumnSurvey*> RecordingSurvey::of_use(ColumnUse use) const {
  std::vector<const ColumnSurvey*> out;
  for (const auto& c : columns) {
    if (c.use == use) out.push_back(&c);
  }
  return out;
}

RecordingSurvey survey_recording(const std::filesystem::path& path, const std::vector<std::string>& reserved, const ChosenColumns& chosen) {
  return ColumnClassifier(path, reserved, chosen).run();
}

}  // namespace misfit
