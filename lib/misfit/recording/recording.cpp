#include "misfit/recording/recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "misfit/core/column_header.h"
#include "misfit/core/error.h"
#include "misfit/core/shown.h"
#include "misfit/core/text.h"
#include "misfit/core/unique_name.h"
#include "misfit/core/units.h"
#include "misfit/math/statistics.h"
#include "misfit/recording/column_facts.h"
#include "misfit/recording/log_columns.h"
#include "misfit/recording/rates.h"
#include "misfit/recording/recording_time.h"
#include "misfit/recording/time_column.h"

namespace misfit {
namespace {

class ColumnClassifier {
 public:
  ColumnClassifier(RecordingTable recording, const std::vector<std::string>& reserved, const RecordingChoice& choice)
      : table_(std::move(recording.table)), taken_(reserved.begin(), reserved.end()), choice_(choice) {
    taken_.insert("t");
    out_.source = table_.source;
    out_.rows = table_.rows();
    out_.format = recording.format;
    out_.remarks = recording.notes;
    of_log_ = recording.of_log;
  }

  RecordingSurvey run() {
    if (out_.format.empty()) describe_format();
    for (const auto& column : table_.columns) out_.columns.push_back(characterise(column));
    find_time();
    find_segments();
    run_time();
    take_choice();
    find_inputs_and_outputs();
    make_names_usable();
    find_rates();
    name_unknown_units();
    name_doubtful_units();
    fill_parts();
    return std::move(out_);
  }

 private:
  [[noreturn]] void fail(int line, const std::string& message) const { throw InputError({table_.source, line, 0}, message); }
  const std::vector<double>& values(std::size_t column) const { return table_.columns[column].values; }
  std::vector<const ColumnSurvey*> of_use(ColumnUse use) const { return out_.of_use(use); }

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
    s.unit = column.dates ? "s" : header.unit.empty() ? "-" : header.unit;
    if (column.dates)
      out_.remarks.push_back(fmt::format("column '{}' holds dates: read as seconds since {}{}", s.header,
                                         column.from_midnight ? "the midnight before " : "", shown(column.first_date)));
    not_understood_.push_back(shown(header.not_understood, longest_header));
    of_one_letter_.push_back(header.of_one_letter);
    const std::vector<double> known = finite(column.values);
    s.missing = column.values.size() - known.size() - column.text;
    if (column.text > 0) {
      if (known.size() > column.text) {
        fail(column.text_line, fmt::format("column '{}': '{}' is not a number (a missing value is an empty cell or NaN); {} of {} {} text",
                                           s.header, shown(column.first_text, longest_header), counted(column.text, "cell", "cells"),
                                           column.values.size(), column.text == 1 ? "is" : "are"));
      }
      s.use = ColumnUse::text;
      s.why = "text";
      if (!header.unit.empty()) {
        out_.remarks.push_back(
            fmt::format("column '{}' has a unit, and text where numbers are expected ('{}', line {}): it is not in the model", s.header,
                        shown(column.first_text, longest_header), column.text_line));
      }
      return s;
    }
    if (known.empty()) {
      s.use = ColumnUse::constant;
      s.why = "no value at all";
      out_.remarks.push_back(fmt::format("column '{}' has no value at all: what it was to record is not in the model", s.header));
      return s;
    }
    const auto [low, high] = std::minmax_element(known.begin(), known.end());
    s.low = *low;
    s.high = *high;
    s.repeat_share = repeat_share(column.values);
    if (s.low == s.high) {
      s.use = ColumnUse::constant;
      s.why = "never changes: " + format_value(s.low);
    } else {
      s.resolution = resolution_of(known);
      s.is_stepwise = s.repeat_share > stepwise_share && !is_coarsely_digitised(column.values, s.resolution);
    }
    if (s.missing > 0)
      out_.remarks.push_back(
          fmt::format("column '{}': {} of {} values {} missing", s.header, s.missing, column.values.size(), s.missing == 1 ? "is" : "are"));
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

  /// The column of that header or name.
  std::size_t column_named(const std::string& name, const std::string& option) const {
    std::vector<std::string> names;
    const std::string last = name.substr(name.find_last_of("./") + 1);
    const auto without_unit = [](const std::string& header) {
      const std::string bare = header.substr(0, header.find_last_of("[("));
      return bare.substr(0, bare.find_last_not_of(' ') + 1);
    };
    for (const std::string& wanted : {name, last}) {
      for (std::size_t i = 0; i < out_.columns.size(); ++i) {
        const std::string& header = table_.columns[i].header;
        if (header == wanted || out_.columns[i].name == wanted || without_unit(header) == wanted) return i;
      }
    }
    for (const auto& column : out_.columns) names.push_back(column.name);
    fail(0, option + ": no column '" + shown(name) + "'" + suggest(name, names));
  }

  /// The first of the surest; of a log the one that its rows are of.
  void find_time() {
    if (of_log_) time_ = 0;
    const bool given = !of_log_ && !choice_.time.empty();
    if (given) time_ = column_named(choice_.time, "--time");
    if (given && (out_.columns[time_].use != ColumnUse::unused || !(increasing_share(values(time_)) > least_increasing_share)))
      fail(0, fmt::format("column '{}' is no time: it does not run forward", out_.columns[time_].header));
    if (!given && !of_log_) time_ = surest_time(out_.columns, table_).value_or(none);
    if (time_ == none) {
      fail(0, std::string("no column of time: none is called t or time, or is in s, ms, min or h, or holds dates, and increases") +
                  counting_column(out_.columns, table_) + "; write one as t[s], or dates as 2024-03-01 00:10:00 or 01.03.2024 00:10");
    }
    ColumnSurvey& c = out_.columns[time_];
    c.use = ColumnUse::time;
    c.resolution = 0.0;
    refuse_unit_of_time(c);
    if (c.unit == "-") {
      c.unit = std::string("s");
      out_.remarks.push_back(unit_found(time_, "taken as seconds"));
    }
    c.why = "increases steadily" + (c.unit == "s" ? std::string() : ", in " + c.unit);
    const double factor = convert(1.0, c.unit, "s");
    for (const double v : values(time_)) t_.push_back(factor * v);
  }

  void refuse_unit_of_time(const ColumnSurvey& c) const {
    const std::string& unknown = not_understood_[time_];
    if (!unknown.empty())
      fail(0,
           fmt::format("column '{}': '{}' is no known unit of time; known are s, ms, us, ns, min, h and d, and dates", c.header, unknown));
    if (c.unit != "-" && !parse_unit(c.unit).same_dimension(parse_unit("s")))
      fail(0, fmt::format("column '{}' is in {}, which is no unit of time", c.header, c.unit));
  }

  void run_time() {
    RecordingTime time = recording_time(t_, segments_, table_.source);
    pieces_ = std::move(time.pieces);
    out_.step = time.step;
    out_.jitter = time.jitter;
    out_.gaps = std::move(time.gaps);
    out_.remarks.insert(out_.remarks.end(), time.remarks.begin(), time.remarks.end());
  }

  /// Of the first column called segment, id, run or the like; one that only counts rows is passed over, and an on/off signal, whose numbers
  /// come again while time runs on, is none.
  void find_segments() {
    const bool time_runs_on = increasing_share(values(time_)) == 1.0;
    for (std::size_t i = 0; i < out_.columns.size(); ++i) {
      ColumnSurvey& c = out_.columns[i];
      if (c.use != ColumnUse::unused || !is_called_segment(c.name) || !is_integer(finite(values(i)))) continue;
      if (time_runs_on && comes_back(values(i))) continue;
      const std::vector<double> known = finite(values(i));
      const std::set<double> numbers(known.begin(), known.end());
      constexpr std::size_t fewest_rows = 10;  // of a recording
      if (numbers.size() * fewest_rows > known.size() || !segments_.empty()) {
        leave_out(i, "numbers rows, or a second number of recordings: left out");
        continue;
      }
      c.use = ColumnUse::segment;
      c.why = "whole numbers: the number of a recording";
      segments_ = values(i);
      out_.remarks.push_back(fmt::format("column '{}' numbers {} recordings, {} to {}: an experiment each", c.header, numbers.size(),
                                         format_value(c.low), format_value(c.high)));
    }
  }

  void leave_out(std::size_t i, const std::string& why) {
    out_.columns[i].why = why;
    left_out_.insert(i);
  }

  /// What --input and --output name; with both, nothing else is taken.
  void take_choice() {
    for (const auto& [names, use, option] :
         {std::tuple{&choice_.inputs, ColumnUse::input, "--input"}, {&choice_.outputs, ColumnUse::output, "--output"}}) {
      for (const std::string& name : *names) {
        ColumnSurvey& c = out_.columns[column_named(name, option)];
        if (c.use == ColumnUse::constant || c.use == ColumnUse::text || c.use == ColumnUse::time)
          fail(0, fmt::format("column '{}', named by {}, is no signal: {}", c.header, option, c.why));
        if (c.chosen_by_user && c.use != use)
          fail(0, fmt::format("column '{}' is named by --input and by --output: it can be one of them", c.header));
        c.use = use;
        c.chosen_by_user = true;
        c.why = fmt::format("named by {}", option);
      }
    }
    if (choice_.outputs.empty()) return;
    for (std::size_t i = 0; i < out_.columns.size(); ++i) {
      ColumnSurvey& c = out_.columns[i];
      if (c.use != ColumnUse::unused || left_out_.contains(i) || (choice_.inputs.empty() && looks_like_input(c))) continue;
      leave_out(i, choice_.inputs.empty() ? "not named by --output, and no input by its looks: left out"
                                          : "named by neither --input nor --output: left out");
    }
  }

  /// "t_out" beside "t_in" may be outdoors, or where water comes out: the name does not say which of the two drives the other.
  [[nodiscard]] bool is_named_input(const ColumnSurvey& c) const {
    return is_called_input(c.name) && std::none_of(out_.columns.begin(), out_.columns.end(),
                                                   [&](const ColumnSurvey& other) { return are_called_in_and_out(other.name, c.name); });
  }
  [[nodiscard]] bool looks_like_input(const ColumnSurvey& c) const { return is_named_input(c) || c.is_stepwise; }

  void find_inputs_and_outputs() {
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < out_.columns.size(); ++i) {
      if (out_.columns[i].use == ColumnUse::unused && !left_out_.contains(i)) open.push_back(i);
    }
    const bool measured = !of_use(ColumnUse::output).empty();
    if (open.empty() && measured) return;
    if (open.empty()) fail(0, "no column but time changes: nothing was measured");
    const bool may_be_input = choice_.inputs.empty() && (measured || open.size() > 1);
    for (const std::size_t i : open) {
      ColumnSurvey& c = out_.columns[i];
      if (may_be_input && is_named_input(c)) {
        c.use = ColumnUse::input;
        c.why = "named like an input";
      } else if (may_be_input && c.is_stepwise) {
        c.use = ColumnUse::input;
        c.why = fmt::format("constant between jumps ({:.0f} % of its samples equal the one before)", 100.0 * c.repeat_share);
      } else {
        c.use = ColumnUse::output;
        c.why = open.size() == 1 ? "the only column that was measured" : "not named like an input, and it varies";
        for (auto& remark : limit_remarks(c.header, values(i))) out_.remarks.push_back(std::move(remark));
      }
    }
    for (std::size_t i = 0; i < out_.columns.size(); ++i) {
      ColumnSurvey& c = out_.columns[i];
      c.is_measured_input = c.use == ColumnUse::input && is_smooth(values(i));
    }
    if (of_use(ColumnUse::output).empty()) take_an_input_as_output(open);
    if (of_use(ColumnUse::input).empty())
      out_.remarks.emplace_back(
          "no column is an input: what drives the motion, if anything does, is not in this recording (or named by --input)");
  }

  /// It stays where it is for many samples: somebody sets it.
  [[nodiscard]] static bool is_set(const ColumnSurvey& c) {
    constexpr double mostly = 0.9;
    return c.is_stepwise && c.repeat_share > mostly;
  }

  /// Where every column looks like an input: a name ("force") says less than a column that somebody sets beside one that varies.
  void take_an_input_as_output(const std::vector<std::size_t>& open) {
    const auto unlike = std::find_if(open.rbegin(), open.rend(), [this](std::size_t i) { return !is_named_input(out_.columns[i]); });
    const auto varies = std::find_if(open.rbegin(), open.rend(), [this](std::size_t i) { return !out_.columns[i].is_stepwise; });
    const bool all_others_set = varies != open.rend() && std::all_of(open.begin(), open.end(), [&](std::size_t i) {
                                  return i == *varies || is_set(out_.columns[i]);
                                });
    ColumnSurvey& last = out_.columns[all_others_set ? *varies : unlike == open.rend() ? open.back() : *unlike];
    last.use = ColumnUse::output;
    last.is_measured_input = false;
    last.why = all_others_set
                   ? std::string("called like an input, but it varies, and what else there is stays where it is for many samples")
                   : fmt::format("every column looks like an input; the last{} is taken as the output",
                                 unlike == open.rend() ? "" : " that is not called like one");
  }

  /// An output that is another's derivative.
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
      out_.remarks.push_back(
          fmt::format("column '{}': {}its numbers are taken as they are", out_.columns[i].header, not_known(not_understood_[i])));
    }
  }

  /// Units that may be something else: a subscript (V is none), the acceleration of gravity, an inlet.
  void name_doubtful_units() {
    std::vector<std::string> of_one_letter;
    for (std::size_t i = 0; i < out_.columns.size(); ++i) {
      const ColumnSurvey& c = out_.columns[i];
      const bool signal = c.use == ColumnUse::input || c.use == ColumnUse::output || c.use == ColumnUse::rate;
      if (!signal) continue;
      if (of_one_letter_[i] && c.unit != "V") of_one_letter.push_back(fmt::format("'{}' in {}", c.header, c.unit));
      const bool acceleration = c.unit == "g" && (c.name.starts_with('a') || c.name.starts_with('A'));
      if (acceleration) out_.remarks.push_back(fmt::format("column '{}': g is read as gram, not as 9.81 m/s^2", c.header));
      if (c.unit == "in" && c.header.ends_with(')')) out_.remarks.push_back(fmt::format("column '{}': (in) is read as inch", c.header));
    }
    constexpr std::size_t most = 3;
    if (of_one_letter.size() > most + 1) {
      of_one_letter[most] = fmt::format("{} more", of_one_letter.size() - most);
      of_one_letter.resize(most + 1);
    }
    if (!of_one_letter.empty())
      out_.remarks.push_back("units read from the last letter of names: " + join_words(of_one_letter) +
                             "; write one in brackets, as p_s[Pa], where it is a subscript");
  }

  /// With the unit that may be meant.
  static std::string not_known(const std::string& unit) {
    try {
      static_cast<void>(parse_unit(unit));
    } catch (const InputError& error) {
      const std::string words = error.what();
      if (const std::size_t end = words.find("? Valid:"); end != std::string::npos) return words.substr(0, end) + "? Now ";
    }
    return "the unit '" + unit + "' is not known, ";
  }

  bool is_rate(std::size_t rate, std::size_t level) const {
    const Unit own = parse_unit(out_.columns[rate].unit), derived = parse_unit(rate_unit(out_.columns[level].unit));
    const bool no_unit = out_.columns[rate].unit == "-";
    if (!no_unit && !own.same_dimension(derived)) return false;
    return is_rate_of(values(rate), values(level), no_unit ? 1.0 : derived.to_si / own.to_si, {t_, pieces_});
  }

  /// Columns that nobody uses are given back first: of a long recording only those that are used are held twice.
  void fill_parts() {
    for (std::size_t i = 0; i < out_.columns.size(); ++i) {
      const ColumnUse use = out_.columns[i].use;
      if (use != ColumnUse::input && use != ColumnUse::output && use != ColumnUse::rate) table_.columns[i].values = {};
    }
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
          kept.reserve(piece.size());
          for (const std::size_t row : piece) kept.push_back(values(i)[row]);
          part.add(out_.columns[i].name, out_.columns[i].unit, std::move(kept));
        }
      }
      out_.parts.push_back(std::move(part));
    }
  }

  std::vector<std::string> not_understood_;  ///< unit in the header, per column; empty: known, or none, or found out
  std::vector<bool> of_one_letter_;          ///< per column: its unit is the last letter of its name
  static constexpr std::size_t longest_name = 64, longest_header = 80;  // bytes
  static constexpr double stepwise_share = 0.5;                         // of the samples of what jumps
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  LooseTable table_;
  std::set<std::string> taken_;  // names that are reserved or given
  RecordingSurvey out_;
  const RecordingChoice& choice_;
  bool of_log_ = false;  // the first column is its time
  std::set<std::size_t> left_out_;
  std::size_t time_ = none;
  std::vector<double> segments_;                  // the number of its recording, a value per row; empty: none
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

RecordingSurvey survey_recording(const std::filesystem::path& path, const std::vector<std::string>& reserved,
                                 const RecordingChoice& choice) {
  return ColumnClassifier(recording_table(path, choice), reserved, choice).run();
}

}  // namespace misfit
