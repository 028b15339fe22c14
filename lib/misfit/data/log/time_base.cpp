#include "misfit/data/log/time_base.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <set>

#include "misfit/core/column_header.h"
#include "misfit/core/error.h"
#include "misfit/core/shown.h"
#include "misfit/core/text.h"
#include "misfit/core/units.h"

namespace misfit {
namespace {

/// Times that increase, and the samples that have them.
struct Clock {
  std::vector<double> t;  ///< [s]
  std::vector<std::size_t> rows;
};

class TimeBase {
 public:
  TimeBase(LogReader& reader, const std::vector<WantedChannel>& wanted, std::vector<std::string>& notes, Rows rows)
      : reader_(reader), log_(reader.log()), wanted_(wanted), notes_(notes), rows_(rows) {}

  Table run(const std::optional<std::string>& time) {
    for (const WantedChannel& w : wanted_) channels_.push_back(log_.index_of(w.name));
    base_ = time ? log_.index_of(*time) : clock_of_most();
    read_channels();
    const bool one_clock = std::all_of(channels_.begin(), channels_.end(), [this](std::size_t c) { return clock_of(c) == base_; });
    const Clock base = one_clock && rows_ == Rows::as_recorded ? all_rows() : time ? clock(base_) : clock_of_all();
    if (base.t.empty()) fail("'" + name(base_) + "' has no value: no time is known");
    table_.source = log_.source;
    table_.add(time.value_or("t"), "s", base.t);
    for (std::size_t i = 0; i < wanted_.size(); ++i) add(base, i);
    note_brought();
    leave_out_rows_without_inputs();
    return std::move(table_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { throw InputError({log_.source, 0, 0}, message); }
  [[nodiscard]] std::string name(std::size_t channel) const { return shown(log_.channels[channel].name, longest_name); }

  /// Of the measured channels; of all, if none is.
  [[nodiscard]] std::size_t clock_of_most() const {
    std::optional<std::size_t> out;
    for (const bool any : {false, true}) {
      for (std::size_t i = 0; i < wanted_.size(); ++i) {
        if (!any && wanted_[i].between != Between::nearest) continue;
        const LogChannel& c = log_.channels[channels_[i]];
        if (!c.clock) fail_without_time(c);
        if (!out || c.samples > log_.channels[*out].samples) out = c.clock;
      }
      if (out) return *out;
    }
    fail("no channel is wanted");
  }

  [[noreturn]] void fail_without_time(const LogChannel& channel) const {
    std::vector<std::string> alike;
    for (const LogChannel& c : log_.channels) {
      if (c.samples == channel.samples && c.name != channel.name) alike.push_back(c.name);
    }
    fail("channel '" + shown(channel.name) +
         "' has no time of its own: say which one is it, as columns = { t = \"…\" } or --time; of as many " +
         "samples are: " + (alike.empty() ? "none" : some_names("time", alike)));
  }

  /// That of the measured channels. Where they have several, the times of all, so that every sample stands at its own; those of held inputs
  /// as well, whose changes act when they come, unless they are more than all measurements.
  [[nodiscard]] Clock clock_of_all() {
    std::map<std::size_t, std::size_t> measured, held;  // samples by clock
    for (std::size_t i = 0; i < wanted_.size(); ++i) {
      const std::size_t own = clock_of(channels_[i]);
      if (wanted_[i].between == Between::nearest) measured[own] = log_.channels[own].samples;
      if (wanted_[i].between == Between::held) held[own] = log_.channels[own].samples;
    }
    if (measured.size() < 2) return clock(base_);
    joined_ = true;
    std::size_t samples = 0;
    for (const auto& [own, size] : measured) samples += size;
    for (const auto& [own, size] : held) {
      if (size <= samples) measured[own] = size;
    }
    Clock out;
    for (const auto& [own, size] : measured) {
      const Clock here = clock(own);
      out.t.insert(out.t.end(), here.t.begin(), here.t.end());
    }
    join(out.t);
    notes_.push_back(fmt::format("{} clocks: every measurement stands at its own time, in {} rows", measured.size(), out.t.size()));
    return out;
  }

  /// In order; times that are the same but for rounding once.
  static void join(std::vector<double>& t) {
    constexpr double rounding = 1e-6;  // of the usual step
    std::sort(t.begin(), t.end());
    const double same = t.size() > 1 ? rounding * (t.back() - t.front()) / static_cast<double>(t.size() - 1) : 0.0;
    t.erase(std::unique(t.begin(), t.end(), [&](double a, double b) { return b - a <= same; }), t.end());
  }

  /// That of the base, which may be the second time of a group, for a channel of the same rows; and, if it has as many samples, for one
  /// without a clock.
  [[nodiscard]] std::size_t clock_of(std::size_t channel) const {
    const LogChannel &c = log_.channels[channel], &base = log_.channels[base_];
    if (c.samples == base.samples && (!c.clock || channel == base_ || c.clock == base.clock)) return base_;
    if (!c.clock) fail_without_time(c);
    return *c.clock;
  }

  void read_channels() {
    std::set<std::size_t> all(channels_.begin(), channels_.end());
    all.insert(base_);
    for (const std::size_t c : channels_) all.insert(clock_of(c));
    reader_.read({all.begin(), all.end()});
  }

  [[nodiscard]] std::string unit_of_time(std::size_t channel) const {
    const LogChannel& c = log_.channels[channel];
    const std::string unit = known_unit(c);
    if (unit.empty() && !c.unit.empty())
      fail("time '" + name(channel) + "': the unit '" + shown(c.unit) + "' is not known: s, ms, us, ns, min, h, d are");
    if (!unit.empty() && !parse_unit(unit).same_dimension(parse_unit("s")))
      fail("time '" + name(channel) + "' is in " + unit + ", which is no unit of time");
    if (unit.empty()) note_once("time '" + name(channel) + "' names no unit: taken as seconds");
    return unit.empty() ? "s" : unit;
  }

  void note_once(const std::string& text) const {
    if (std::find(notes_.begin(), notes_.end(), text) == notes_.end()) notes_.push_back(text);
  }

  [[nodiscard]] std::vector<double> seconds_of(std::size_t channel) const {
    std::vector<double> seconds = log_.channels[channel].values;
    convert(seconds, unit_of_time(channel), "s");
    return seconds;
  }

  /// Of the base, as they stand in the log.
  [[nodiscard]] Clock all_rows() const {
    Clock out{seconds_of(base_), {}};
    out.rows.resize(out.t.size());
    std::iota(out.rows.begin(), out.rows.end(), 0U);
    return out;
  }

  [[nodiscard]] Clock clock(std::size_t channel) const {
    const std::vector<double> seconds = seconds_of(channel);
    Clock out;
    for (std::size_t i = 0; i < seconds.size(); ++i) {
      if (!std::isfinite(seconds[i]) || (!out.t.empty() && !(seconds[i] > out.t.back()))) continue;
      out.t.push_back(seconds[i]);
      out.rows.push_back(i);
    }
    if (out.t.size() == seconds.size()) return out;
    const auto back = std::adjacent_find(seconds.begin(), seconds.end(), std::greater<>());
    const std::string anew = back == seconds.end() ? "" : fmt::format("; it runs back at sample {}", back - seconds.begin() + 2);
    note_once(fmt::format("time '{}': {} of {} samples are left out, whose time is missing or not after the one before{}", name(channel),
                          seconds.size() - out.t.size(), seconds.size(), anew));
    return out;
  }

  void add(const Clock& base, std::size_t i) {
    const LogChannel& c = log_.channels[channels_[i]];
    const std::size_t own = clock_of(channels_[i]);
    std::vector<double> values;
    if (own == base_ && !joined_) {
      for (const std::size_t row : base.rows) values.push_back(c.values[row]);
    } else {
      const Clock clock_here = clock(own);
      if (clock_here.t.empty()) fail("'" + name(own) + "' has no value: no time of '" + name(channels_[i]) + "' is known");
      values = wanted_[i].between == Between::nearest ? at_nearest(base, clock_here, c) : between(base, clock_here, c, wanted_[i].between);
    }
    table_.add(wanted_[i].name, known_unit(c), std::move(values));
  }

  /// Each sample once, where it is nearest and no nearer one stands, if it is not farther than half a step from it.
  std::vector<double> at_nearest(const Clock& base, const Clock& own, const LogChannel& channel) {
    std::vector<double> out(base.t.size(), std::nan("")), distance(base.t.size(), INFINITY);
    double farthest = 0.0;
    std::size_t placed = 0;
    for (std::size_t k = 0, j = 0; k < own.t.size(); ++k) {
      while (j + 1 < base.t.size() && std::abs(base.t[j + 1] - own.t[k]) <= std::abs(base.t[j] - own.t[k])) ++j;
      const double d = std::abs(base.t[j] - own.t[k]), step = j > 0               ? base.t[j] - base.t[j - 1]
                                                              : base.t.size() > 1 ? base.t[1] - base.t[0]
                                                                                  : 0.0;
      if (d > step / 2.0 * (1.0 + 1e-9) || d >= distance[j]) continue;
      if (std::isinf(distance[j])) ++placed;
      distance[j] = d;
      out[j] = channel.values[own.rows[k]];
    }
    if (joined_) return out;
    for (const double d : distance) farthest = std::isinf(d) ? farthest : std::max(farthest, d);
    notes_.push_back(fmt::format(
        "'{}' has a clock of its own: {} of its {} samples stand at the nearest time of '{}', moved by at most {} s; the others "
        "are left out, for another stands there or no time is near",
        shown(channel.name, longest_name), placed, own.t.size(), name(base_), format_value(farthest)));
    return out;
  }

  std::vector<double> between(const Clock& base, const Clock& own, const LogChannel& channel, Between how) {
    std::vector<double> out;
    const bool linear = how == Between::linear;
    std::size_t k = 0;
    for (const double t : base.t) {
      while (k + 1 < own.t.size() && own.t[k + 1] <= t) ++k;
      const double value = channel.values[own.rows[k]];
      const bool known = own.t[k] <= t && (!linear || k + 1 < own.t.size() || own.t[k] == t);
      const double share = known && linear && k + 1 < own.t.size() ? (t - own.t[k]) / (own.t[k + 1] - own.t[k]) : 0.0;
      out.push_back(!known ? std::nan("") : share > 0.0 ? value + share * (channel.values[own.rows[k + 1]] - value) : value);
    }
    brought_[{own.t.size(), linear}].push_back("'" + shown(channel.name, longest_name) + "'");
    inputs_.push_back(table_.columns.size());
    return out;
  }

  /// A sentence for all channels of one clock.
  void note_brought() {
    constexpr std::size_t most = 3;
    for (auto& [how, names] : brought_) {
      const bool one = names.size() == 1;
      if (names.size() > most + 1) {
        names[most] = fmt::format("{} more", names.size() - most);
        names.resize(most + 1);
      }
      notes_.push_back(fmt::format("{} ({} samples) {} of {} own: {} at the times of {}", join_words(names), how.first,
                                   one ? "has a clock" : "have a clock", one ? "its" : "their",
                                   how.second ? "interpolated linearly" : "the last value is held",
                                   joined_ ? std::string("the measurements") : "'" + name(base_) + "'"));
    }
  }

  /// Rows before the first and behind the last known value of an input of another clock.
  void leave_out_rows_without_inputs() {
    const std::size_t rows = table_.rows();
    std::size_t from = 0, to = rows;
    for (const std::size_t j : inputs_) {
      const std::vector<double>& v = table_.columns[j].values;
      while (from < to && !std::isfinite(v[from])) ++from;
      while (to > from && !std::isfinite(v[to - 1])) --to;
    }
    if (from == to) fail("the recordings of inputs and outputs have no time in common");
    if (to - from == rows) return;
    notes_.push_back(fmt::format("{} of {} samples are left out at the ends, where an input is not known", rows - (to - from), rows));
    for (Column& column : table_.columns) column.values = {column.values.begin() + from, column.values.begin() + to};
  }

  static constexpr std::size_t longest_name = 80;
  LogReader& reader_;
  const Log& log_;
  const std::vector<WantedChannel>& wanted_;
  std::vector<std::string>& notes_;
  Rows rows_;
  std::vector<std::size_t> channels_;                                         // of each wanted one
  std::vector<std::size_t> inputs_;                                           // columns of inputs that were brought from another clock
  std::map<std::pair<std::size_t, bool>, std::vector<std::string>> brought_;  // held or linear channels, by samples
  std::size_t base_ = 0;
  bool joined_ = false;  // the rows are of several clocks
  Table table_;
};

}  // namespace

Table on_one_time_base(LogReader& reader, const std::vector<WantedChannel>& wanted, const std::optional<std::string>& time,
                       std::vector<std::string>& notes, Rows rows) {
  return TimeBase(reader, wanted, notes, rows).run(time);
}

std::string known_unit(const LogChannel& channel) {
  if (!channel.unit.empty()) return read_header("x[" + channel.unit + "]").unit;
  std::string last = channel.name.substr(channel.name.find_last_of("./") + 1);
  if (last.ends_with(']') && last.find_first_not_of("0123456789", last.rfind('[') + 1) == last.size() - 1)
    last.resize(last.rfind('['));  // q[0]
  return read_header(last).unit;
}

}  // namespace misfit
