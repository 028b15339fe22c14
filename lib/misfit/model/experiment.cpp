#include "misfit/model/experiment.h"

#include <algorithm>
#include <cmath>

#include "misfit/core/column_header.h"
#include "misfit/core/error.h"
#include "misfit/core/shown.h"
#include "misfit/core/text.h"
#include "misfit/core/units.h"
#include "misfit/data/held_out_change.h"
#include "misfit/data/log/log.h"
#include "misfit/data/log/time_base.h"
#include "misfit/math/angle.h"
#include "misfit/math/time_steps.h"
#include "misfit/model/recorded_inputs.h"

namespace misfit {
namespace {

/// The input as it was `delay` earlier, at every sample; one that is held is held at its mean over the interval that follows.
std::vector<double> delayed(const std::vector<double>& t, const std::vector<double>& values, double delay, Hold hold) {
  const RecordedInputs recorded{t, {hold}, values};
  std::vector<double> out;
  for (std::size_t i = 0; i < t.size(); ++i) {
    const double end = hold == Hold::zero_order && i + 1 < t.size() ? t[i + 1] : t[i];
    out.push_back(late_input({values.data(), &recorded, t[i], end}, 0, 0.5 * (t[i] + end), delay).value);
  }
  return out;
}

std::vector<double> central_rate(const std::vector<double>& t, const std::vector<double>& y) {
  std::vector<double> rate(y.size(), std::nan(""));
  for (std::size_t i = 1; i + 1 < y.size(); ++i) rate[i] = (y[i + 1] - y[i - 1]) / (t[i + 1] - t[i - 1]);
  return rate;
}

/// Fills missing values linearly (constant at the ends); returns how many, or all if none is known.
std::size_t bridge(const std::vector<double>& t, std::vector<double>& y) {
  std::size_t filled = 0;
  std::size_t known = y.size();
  for (std::size_t i = 0; i < y.size(); ++i) {
    if (!std::isfinite(y[i])) continue;
    for (std::size_t k = known == y.size() ? 0 : known + 1; k < i; ++k, ++filled) {
      y[k] = known == y.size() ? y[i] : y[known] + (y[i] - y[known]) * (t[k] - t[known]) / (t[i] - t[known]);
    }
    known = i;
  }
  if (known == y.size()) return y.size();
  for (std::size_t k = known + 1; k < y.size(); ++k, ++filled) y[k] = y[known];
  return filled;
}

/// The smallest difference above 0 of neighbours: the last digit, where values are rounded coarsely; 0 if nothing changes.
double smallest_step(const std::vector<double>& y) {
  double smallest = 0.0;
  for (std::size_t i = 1; i < y.size(); ++i) {
    const double step = std::abs(y[i] - y[i - 1]);
    if (step > 0.0 && std::isfinite(step) && (smallest == 0.0 || step < smallest)) smallest = step;
  }
  return smallest;
}

/// Sets isolated outliers to missing and returns their number. Outlier: more than 15 robust sigmas from the cubic through two neighbours on
/// either side, and more than five times the largest difference of these neighbours, so that a burst or a jump of the motion itself is not
/// rejected. The sigma is at least that of rounding to the smallest step between neighbours: a flicker of the last digit is not rejected.
std::size_t reject_isolated_outliers(std::vector<double>& y) {
  constexpr double max_sigmas = 15.0, min_times_neighbours = 5.0;
  const auto distance = [&](std::size_t i) { return y[i] - (4.0 * (y[i - 1] + y[i + 1]) - y[i - 2] - y[i + 2]) / 6.0; };
  std::vector<double> distances;
  for (std::size_t i = 2; i + 2 < y.size(); ++i) distances.push_back(distance(i));
  const double limit = max_sigmas * std::max(mad_sigma(distances), smallest_step(y) / std::sqrt(12.0));
  std::vector<std::size_t> outliers;
  for (std::size_t i = 2; i + 2 < y.size(); ++i) {
    const double between = std::max({std::abs(y[i - 2] - y[i - 1]), std::abs(y[i - 1] - y[i + 1]), std::abs(y[i + 1] - y[i + 2])});
    if (std::abs(distance(i)) > std::max(limit, min_times_neighbours * between)) outliers.push_back(i);
  }
  for (std::size_t i : outliers) y[i] = std::nan("");
  return outliers.size();
}

/// The input's name without "_rate"; empty if it is no rate.
std::string level_of(const std::string& input) {
  constexpr std::string_view suffix = "_rate";
  const bool rate = input.size() > suffix.size() && input.ends_with(suffix);
  return rate ? input.substr(0, input.size() - suffix.size()) : "";
}

/// The SI unit of what has a rate in `unit`: "rad/s^2" → "rad/s"; a unit that is none of a rate stays as it is.
std::string level_unit(const std::string& unit) {
  auto symbols = unit_symbols(plain_si(unit));
  for (auto& [symbol, power] : symbols) {
    if (symbol == "s" && power < 0.0) power += 1.0;
  }
  return unit_text(symbols);
}

class Reader {
 public:
  Reader(const Table& table, const Model& model, const ExperimentStudy& study) : table_(table), model_(model), study_(study) {}

  Signals run() {
    read_time();
    const SystemSpec& spec = model_.system->spec();
    for (const auto& output : spec.outputs)
      out_.measured.push_back({output.name, output.unit, kept(values_of(output.name, output.unit)), 0.0});
    for (auto& channel : out_.measured) {
      const std::size_t outliers = reject_isolated_outliers(channel.values);
      if (outliers > 0) out_.notes.push_back("channel " + channel.name + ": " + std::to_string(outliers) + " isolated outliers rejected");
    }
    const std::vector<std::string> needed = model_.needed_inputs();
    for (const auto& input : spec.inputs) {
      const bool wanted = std::find(needed.begin(), needed.end(), input.name) != needed.end() || is_recorded_whole(input);
      out_.inputs.push_back({input.name, input.unit, wanted ? read_input(input) : std::vector<double>{}, 0.0});
    }
    split();
    note_still_inputs();
    count_missing();
    out_.name = study_.name;
    return std::move(out_);
  }

 private:
  std::string header(const std::string& name) const { return study_.columns.header(name); }
  std::vector<double> values_of(const std::string& name, const std::string& unit) {
    return study_.columns.values(table_, name, unit, out_.notes);
  }
  std::vector<double> kept(const std::vector<double>& column) const {
    std::vector<double> values;
    for (std::size_t row : rows_) values.push_back(column[row]);
    return values;
  }
  /// `role` is what the column is to the model. A table that was computed has no lines: what gave no value is no mistake of its reader.
  [[noreturn]] void refuse_empty(const std::string& role, const std::string& name) const {
    if (table_.line.empty()) throw RunError("experiment '" + shown(study_.name) + "': " + role + " " + name + " has no value at all");
    const Column* column = table_.find(header(name));
    const std::string what = role + " '" + shown(name) + "' of experiment '" + shown(study_.name) + "'";
    throw InputError(line(rows_.front()), (column == nullptr ? what : "column '" + shown(column->name) + "', " + what + ",") +
                                              " has no value at all from here to the end: it needs at least one number");
  }
  Source line(std::size_t row) const { return {table_.source, row < table_.line.size() ? table_.line[row] : 0, 0}; }

  /// Where the study maps no column to it and none is called t: one that is called time, as misfit init would take it.
  [[nodiscard]] ColumnMap map_of_time() const {
    if (header("t") != "t" || table_.find("t") != nullptr) return study_.columns;
    const auto time = std::find_if(table_.columns.begin(), table_.columns.end(), [](const Column& column) {
      const std::string name = read_header(column.name).name;
      return is_called_time(name) && !may_be_temperature(name);
    });
    return time == table_.columns.end() ? study_.columns : ColumnMap{{{"t", time->name}}};
  }

  void read_time() {
    const std::vector<double> t = map_of_time().values(table_, "t", "s", out_.notes);
    for (std::size_t i = 0; i < t.size(); ++i) {
      if (!std::isfinite(t[i])) continue;
      if (!rows_.empty() && !(t[i] > t[rows_.back()])) {
        throw InputError(line(i), "time does not increase: " + format_value(t[i]) + " s after " + format_value(t[rows_.back()]) + " s");
      }
      rows_.push_back(i);
    }
    if (rows_.size() < t.size())
      out_.notes.push_back(counted(t.size() - rows_.size(), "row without time dropped", "rows without time dropped"));
    if (rows_.size() < 2)
      throw RunError("experiment '" + shown(study_.name) + "': " + std::to_string(rows_.size()) +
                     " samples with a time are not a recording");
    for (std::size_t row : rows_) out_.t.push_back(t[row]);
  }

  /// Then it is read even where the model does not need it: discovery asks whether it acts.
  bool is_recorded_whole(const InputSpec& input) const {
    const Column* column = table_.find(header(input.name));
    return column != nullptr &&
           std::all_of(rows_.begin(), rows_.end(), [&](std::size_t row) { return std::isfinite(column->values[row]); });
  }

  std::vector<double> read_input(const InputSpec& input) {
    std::vector<double> values = read_as_recorded(input);
    if (input.delay == 0.0) return values;
    out_.notes.push_back("input " + input.name + " acts " + format_value(input.delay) +
                         " s after it is recorded; before that its first value is taken");
    return delayed(out_.t, values, input.delay, input.hold);
  }

  /// Angles unwrapped, and said where that changes something; all else as it is: a rate may jump by more than half a turn per second.
  std::vector<double> without_turns(std::vector<double> values, const std::string& unit, const std::string& input) {
    if (plain_si(unit) != "rad") return values;
    std::vector<double> angles = unwrapped(values);
    for (std::size_t i = 0; i < angles.size(); ++i) {
      if (!std::isfinite(angles[i]) || angles[i] == values[i]) continue;
      out_.notes.push_back("input " + input + ": the angle is unwrapped, full turns are added from " + format_value(out_.t[i]) + " s on");
      break;
    }
    return angles;
  }

  std::vector<double> read_as_recorded(const InputSpec& input) {
    std::vector<double> values;
    const std::string base = level_of(input.name);
    if (!base.empty() && table_.find(header(input.name)) == nullptr) {
      if (table_.find(header(base)) == nullptr) static_cast<void>(table_.at(header(input.name)));  // throws, naming the nearest
      const std::string unit = level_unit(input.unit);
      values = central_rate(out_.t, without_turns(kept(values_of(base, unit)), unit, input.name));
      out_.notes.push_back("input " + input.name + " differentiated from " + base);
    } else {
      values = without_turns(kept(values_of(input.name, input.unit)), input.unit, input.name);
    }
    std::vector<bool> missing;
    for (double v : values) missing.push_back(!std::isfinite(v));
    const std::size_t filled = bridge(out_.t, values);
    if (filled == values.size()) refuse_empty("input", input.name);
    if (filled == 0) return values;
    out_.notes.push_back("input " + input.name + ": " + std::to_string(filled) + " missing values bridged; the samples there are not used");
    for (auto& channel : out_.measured) {
      for (std::size_t i = 0; i < missing.size(); ++i) {
        if (missing[i]) channel.values[i] = std::nan("");
      }
    }
    return values;
  }

  void split() {
    using Validation = ExperimentStudy::Validation;
    const double first = out_.t.front(), last = out_.t.back();
    if (study_.validation == Validation::last_fraction) {
      out_.validation_from = first + (1.0 - study_.fraction) * (last - first);
    } else if (study_.validation == Validation::interval) {
      out_.validation_from = study_.from;
      out_.validation_to = study_.to;
      if (study_.from > last || study_.to < first) {
        throw InputError(study_.where, "validation interval " + format_value(study_.from) + " to " + format_value(study_.to) +
                                           " s lies outside the recording, " + format_value(first) + " to " + format_value(last) + " s");
      }
    }
    out_.exclude = std::max(study_.exclude, 0L);
    if (out_.exclude >= out_.samples())
      throw InputError(study_.where,
                       "exclude = " + std::to_string(study_.exclude) + " leaves no sample of " + std::to_string(out_.samples()));
  }

  /// Such an input is a constant to the estimation.
  void note_still_inputs() {
    for (const Signal& input : out_.inputs) {
      if (changes_held_out_alone(input.values, out_.exclude, [this](std::size_t i) { return out_.held_out(i); }))
        out_.notes.push_back("input " + input.name +
                             " changes in the part that is held out alone: what it does cannot be estimated, hold " + "out another part");
    }
  }

  void count_missing() {
    for (const auto& channel : out_.measured) {
      const auto missing = std::count_if(channel.values.begin(), channel.values.end(), [](double v) { return !std::isfinite(v); });
      if (missing == std::ssize(channel.values)) refuse_empty("output", channel.name);
      if (missing > 0)
        out_.notes.push_back("channel " + channel.name + ": " + std::to_string(missing) + " of " + std::to_string(channel.values.size()) +
                             " samples missing, carried as gaps");
    }
    std::vector<double> steps;
    for (std::size_t i = 1; i < out_.t.size(); ++i) steps.push_back(out_.t[i] - out_.t[i - 1]);
    const LongSteps gaps = long_steps(steps);
    const std::string longest = format_value(gaps.longest) + " s";
    if (gaps.uneven) {
      out_.notes.push_back("uneven steps of time: usually " + format_value(gaps.usual) + " s, at most " + longest);
    } else if (gaps.count > 0) {
      out_.notes.push_back((gaps.count == 1 ? "1 gap in time, of " : std::to_string(gaps.count) + " gaps in time, the longest ") + longest);
    }
  }

  const Table& table_;
  const Model& model_;
  const ExperimentStudy& study_;
  std::vector<std::size_t> rows_;
  Signals out_;
};

}  // namespace

Table read_recording(const ExperimentStudy& study, const Model& model, std::vector<std::string>& notes) {
  if (!is_binary_log(*study.data)) return read_csv(*study.data);
  const std::unique_ptr<LogReader> reader = open_log(*study.data);
  notes.insert(notes.end(), reader->log().notes.begin(), reader->log().notes.end());
  std::vector<WantedChannel> wanted;
  for (const auto& output : model.system->spec().outputs) wanted.push_back({study.columns.header(output.name), Between::nearest});
  const std::vector<std::string> needed = model.needed_inputs();
  for (const auto& input : model.system->spec().inputs) {
    if (std::find(needed.begin(), needed.end(), input.name) == needed.end()) continue;
    const std::string level = level_of(input.name), own = study.columns.header(input.name);
    const bool differentiated = !level.empty() && !reader->log().find(own) && reader->log().find(study.columns.header(level));
    wanted.push_back(
        {differentiated ? study.columns.header(level) : own, input.hold == Hold::zero_order ? Between::held : Between::linear});
  }
  const std::string time = study.columns.header("t");
  return on_one_time_base(*reader, wanted, time == "t" ? std::nullopt : std::optional(time), notes);
}

Signals signals_from(const Table& table, const Model& model, const ExperimentStudy& study) { return Reader(table, model, study).run(); }

std::vector<std::string> signal_names(const SystemSpec& spec) {
  std::vector<std::string> names{"t"};
  const auto add = [&](const std::string& name) {
    if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (const auto& output : spec.outputs) add(output.name);
  for (const auto& input : spec.inputs) add(input.name);
  for (const auto& input : spec.inputs) add(level_of(input.name));
  return names;
}

}  // namespace misfit
