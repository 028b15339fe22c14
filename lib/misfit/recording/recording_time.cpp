#include "misfit/recording/recording_time.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "misfit/core/error.h"
#include "misfit/core/text.h"
#include "misfit/math/statistics.h"
#include "misfit/math/time_steps.h"

namespace misfit {
namespace {

/// One time that is wrong by itself: time runs forward from the row before it to the row after it, and this one lies outside.
bool is_out_of_order(const std::vector<double>& t, std::size_t i) {
  return i > 0 && i + 1 < t.size() && t[i - 1] < t[i + 1] && (t[i] < t[i - 1] || t[i] > t[i + 1]);
}

/// A time of too few digits, or a column that is none.
void refuse_mostly_repeated(std::size_t rows, std::size_t repeated, const std::string& source) {
  if (2 * repeated > rows) {
    throw InputError({source, 0, 0},
                     fmt::format("{} of {} rows have the time of the row before: is another column the time (--time NAME), or "
                                 "was it written with too few digits?",
                                 repeated, rows));
  }
}

/// Rows in which time runs forward.
void cut(const std::vector<double>& t, const std::vector<double>& segments, const std::string& source, RecordingTime& out) {
  std::size_t without = 0, repeated = 0, backward = 0, wrong = 0;
  std::map<double, std::size_t> piece_of;  // the last of each segment
  for (std::size_t i = 0; i < t.size(); ++i) {
    const double segment = segments.empty() ? 0.0 : segments[i];
    if (!std::isfinite(t[i]) || !std::isfinite(segment)) {
      ++without;
      continue;
    }
    if (segments.empty() && is_out_of_order(t, i)) {
      ++wrong;
      continue;
    }
    const auto [own, is_new] = piece_of.emplace(segment, out.pieces.size());
    if (!is_new && t[i] == t[out.pieces[own->second].back()]) {
      ++repeated;
      continue;
    }
    const bool runs_back = !is_new && t[i] < t[out.pieces[own->second].back()];
    backward += runs_back ? 1U : 0U;
    if (runs_back) own->second = out.pieces.size();
    if (is_new || runs_back) out.pieces.emplace_back();
    out.pieces[own->second].push_back(i);
  }
  refuse_mostly_repeated(t.size(), repeated, source);
  if (without > 0) out.remarks.push_back(counted(without, "row without a time is left out", "rows without a time are left out"));
  if (wrong > 0)
    out.remarks.push_back(counted(wrong, "row whose time is not between those of the rows before and after it is left out",
                                  "rows whose times are not between those of the rows before and after them are left out"));
  if (repeated > 0)
    out.remarks.push_back(counted(repeated, "row repeats the time of the row before and is left out",
                                  "rows repeat the time of the row before and are left out"));
  if (backward > 0) {
    out.remarks.push_back(fmt::format("time runs backward {}: {} recordings in one file, an experiment each",
                                      counted(backward, "time", "times"), out.pieces.size()));
  }
}

void leave_out_short_ones(std::size_t rows, const std::string& source, RecordingTime& out) {
  constexpr std::size_t fewest = 10;
  const std::size_t before = out.pieces.size();
  std::erase_if(out.pieces, [](const auto& piece) { return piece.size() < fewest; });
  if (out.pieces.empty()) throw InputError({source, 0, 0}, fmt::format("{} rows: too few to be a recording, of {} at least", rows, fewest));
  if (out.pieces.size() < before)
    out.remarks.push_back(
        fmt::format("{} with fewer than {} rows: left out", counted(before - out.pieces.size(), "recording", "recordings"), fewest));
}

void find_gaps(const std::vector<double>& t, RecordingTime& out) {
  std::vector<double> steps;
  for (const auto& piece : out.pieces) {
    for (std::size_t k = 1; k < piece.size(); ++k) steps.push_back(t[piece[k]] - t[piece[k - 1]]);
  }
  const LongSteps gaps = long_steps(steps);
  out.step = gaps.usual;
  out.jitter = mad_sigma(steps);
  if (gaps.uneven) {
    out.remarks.push_back(
        fmt::format("uneven steps of time: usually {} s, at most {} s", format_value(gaps.usual), format_value(gaps.longest)));
    return;
  }
  for (const auto& piece : out.pieces) {
    for (std::size_t k = 1; k < piece.size(); ++k) {
      if (t[piece[k]] - t[piece[k - 1]] > kGapInSteps * out.step) out.gaps.push_back({t[piece[k - 1]], t[piece[k]]});
    }
  }
  if (out.gaps.empty()) return;
  const auto longest =
      std::max_element(out.gaps.begin(), out.gaps.end(), [](const Gap& a, const Gap& b) { return a.to - a.from < b.to - b.from; });
  out.remarks.push_back(
      fmt::format("{} {} s, after t = {} s: the model runs across gaps in which no input may have changed; the recording is split at "
                  "others (misfit help data)",
                  out.gaps.size() == 1 ? "1 gap in time, of" : fmt::format("{} gaps in time, the longest", out.gaps.size()),
                  format_value(longest->to - longest->from), format_to_step(longest->from, out.step)));
}

}  // namespace

RecordingTime recording_time(const std::vector<double>& t, const std::vector<double>& segments, const std::string& source) {
  RecordingTime out;
  cut(t, segments, source, out);
  leave_out_short_ones(t.size(), source, out);
  find_gaps(t, out);
  return out;
}

}  // namespace misfit
