#include "misfit/recording/log_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "misfit/core/shown.h"
#include "misfit/core/text.h"
#include "misfit/data/log/arrays.h"
#include "misfit/data/log/log.h"
#include "misfit/data/log/time_base.h"

namespace misfit {
namespace {

std::vector<std::string> groups_of(const Log& log) {
  std::vector<std::string> out;
  for (const LogChannel& c : log.channels) {
    if (std::find(out.begin(), out.end(), c.group) == out.end()) out.push_back(c.group);
  }
  return out;
}

/// Times of other clocks stand in topics too: "timestamp_sample".
bool is_a_time(const LogChannel& channel) {
  const std::string last = channel.name.substr(channel.name.find_last_of("./") + 1);
  return is_time_name(channel.name) || last.starts_with("timestamp");
}

/// A line per group: its samples and channels.
std::string list_of(const Log& log) {
  constexpr std::size_t most_names = 12;
  std::string out;
  for (const std::string& group : groups_of(log)) {
    std::vector<std::string> names;
    std::size_t samples = 0;
    for (const LogChannel& c : log.channels) {
      if (c.group != group) continue;
      samples = std::max(samples, c.samples);
      const std::string own = group.empty() || c.name.size() <= group.size() ? c.name : c.name.substr(group.size() + 1);
      names.push_back(shown(own) + (c.unit.empty() ? "" : " [" + shown(c.unit) + "]"));
    }
    const std::size_t more = names.size() > most_names ? names.size() - most_names : 0;
    names.resize(names.size() - more);
    out += fmt::format("{} ({} samples):\n", group.empty() ? "(no group)" : shown(group), samples);
    out += wrap_text(fmt::format("{}{}", fmt::join(names, ", "), more > 0 ? fmt::format(", and {} more", more) : ""), 110, "    ") + "\n";
  }
  return out;
}

/// All channels of a group, but for times.
std::vector<std::size_t> channels_in(const Log& log, const std::string& group) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < log.channels.size(); ++i) {
    if (log.channels[i].group == group && log.channels[i].clock != i && !is_a_time(log.channels[i])) out.push_back(i);
  }
  if (!out.empty()) return out;
  throw InputError({log.source, 0, 0}, "no topic '" + shown(group) + "'" + suggest(group, groups_of(log)));
}

/// Channels that are no times, if all have one clock.
std::vector<std::size_t> of_one_clock(const Log& log) {
  std::vector<std::size_t> out;
  std::set<std::optional<std::size_t>> clocks;
  for (std::size_t i = 0; i < log.channels.size(); ++i) {
    if (log.channels[i].clock == i) continue;
    out.push_back(i);
    clocks.insert(log.channels[i].clock);
  }
  constexpr std::size_t most = 200;
  if (clocks.size() != 1 || out.size() > most) return {};
  return out;
}

std::vector<WantedChannel> wanted_of(const Log& log, const RecordingChoice& choice) {
  std::vector<WantedChannel> out;
  std::set<std::size_t> known;
  const auto add = [&](std::size_t channel, Between between) {
    if (known.insert(channel).second) out.push_back({log.channels[channel].name, between});
  };
  for (const std::string& name : choice.outputs) add(log.index_of(name), Between::nearest);
  for (const std::string& name : choice.inputs) add(log.index_of(name), Between::held);
  for (std::size_t i = 0; i < choice.topics.size(); ++i) {
    for (const std::size_t c : channels_in(log, choice.topics[i]))
      add(c, i == 0 && choice.outputs.empty() ? Between::nearest : Between::held);
  }
  if (!choice.topics.empty() || !choice.outputs.empty()) return out;
  std::vector<std::size_t> all = of_one_clock(log);
  if (all.empty()) throw ChannelsUndecided(log.source, list_of(log));
  const std::size_t time = choice.time.empty() ? log.channels.size() : log.index_of(choice.time);
  for (const std::size_t c : all) {
    if (c != time) add(c, Between::nearest);
  }
  return out;
}

/// "topic.q[0]" → "q[0]", if no other wanted channel is called so.
std::string short_name(const std::string& name, const std::vector<WantedChannel>& wanted) {
  const auto last = [](const std::string& n) { return n.substr(n.find_last_of("./") + 1); };
  const auto same = std::count_if(wanted.begin(), wanted.end(), [&](const WantedChannel& w) { return last(w.name) == last(name); });
  return same == 1 ? last(name) : name;
}

}  // namespace

ChannelsUndecided::ChannelsUndecided(const std::string& source, std::string channels)
    : InputError({source, 0, 0}, "channels of several clocks: say which are meant, --topic TOPIC, or --output CHANNEL and --input CHANNEL"),
      channels_(std::move(channels)) {}

RecordingTable recording_table(const std::filesystem::path& path, const RecordingChoice& choice) {
  if (!is_binary_log(path)) return {read_loose_csv(path, choice.names), "", {}, false};
  const std::unique_ptr<LogReader> reader = open_log(path);
  const Log& log = reader->log();
  if (!choice.names.empty()) throw InputError({log.source, 0, 0}, "--names are for CSV files: the channels of a log have names");
  RecordingTable out{{}, log.format, log.notes, true};
  if (log.channels.empty()) throw InputError({log.source, 0, 0}, "no series of numbers is in it");
  const std::vector<WantedChannel> wanted = wanted_of(log, choice);
  const std::optional<std::string> time = choice.time.empty() ? std::nullopt : std::optional(choice.time);
  const Table table = on_one_time_base(*reader, wanted, time, out.notes, Rows::as_recorded);
  out.table.source = table.source;
  for (const Column& c : table.columns) {
    const std::string header =
        out.table.columns.empty() ? "t[s]" : short_name(c.name, wanted) + "[" + (c.unit.empty() ? "-" : c.unit) + "]";
    LooseColumn& column = out.table.columns.emplace_back();
    column.header = header;
    column.values = c.values;
  }
  out.table.line.resize(table.rows());
  std::iota(out.table.line.begin(), out.table.line.end(), 1);
  return out;
}

}  // namespace misfit
