#pragma once

// Recordings as other programs keep them: named channels, each with its own clock and unit, whatever the format of the file.

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace misfit {

/// One series of numbers of a recording.
struct LogChannel {
  std::string name;   ///< unique in its log: "vehicle_attitude.q[0]", "IMU[1].GyrX", "run1/w"
  std::string group;  ///< topic, struct or folder it stands in: "vehicle_attitude"; empty: none
  std::string unit;   ///< as the file says: "us", "rad/s"; empty: it says none
  std::size_t samples = 0;
  std::optional<std::size_t> clock;  ///< index of the channel that is its time, of as many samples; itself for a time
  std::vector<double> values;        ///< NaN = missing; empty until read
};

/// What a file holds.
struct Log {
  std::string source;  ///< the file, for messages
  std::string format;  ///< "ULog (PX4)"
  std::vector<LogChannel> channels;
  std::vector<std::string> notes;  ///< what was left out or is odd: one sentence each

  /// The channel of that name, or the only one whose name ends with it behind a '.' or '/': "w" for "motor.w".
  /// InputError naming the file and the nearest names, or those that it could be.
  [[nodiscard]] std::size_t index_of(const std::string& name) const;
  /// The same; nullopt where it is none, or could be several.
  [[nodiscard]] std::optional<std::size_t> find(const std::string& name) const;
};

/// An open file: what is in it is known at once, values are read when they are asked for, so that a file may be larger than the memory.
class LogReader {
 public:
  virtual ~LogReader() = default;
  LogReader() = default;
  LogReader(const LogReader&) = delete;
  LogReader& operator=(const LogReader&) = delete;

  [[nodiscard]] const Log& log() const { return log_; }
  /// Fills `values` of these channels of log(). InputError where the file is damaged.
  void read(const std::vector<std::size_t>& channels);
  /// Takes the values of a channel out of log(), which may be large.
  [[nodiscard]] std::vector<double> release(std::size_t channel) { return std::exchange(log_.channels.at(channel).values, {}); }

 protected:
  /// `channels`: sorted, each once, none read yet.
  virtual void read_values(const std::vector<std::size_t>& channels) = 0;
  Log log_;
};

/// Opens MAT (v5, v7.3), HDF5, NPY, NPZ, ULog and DataFlash files, recognised by their first bytes; anything else is read as CSV.
/// InputError: no such file; a format that is known and not read, with what to do; damage, with its byte and what was expected there.
[[nodiscard]] std::unique_ptr<LogReader> open_log(const std::filesystem::path& path);

/// Is the file one that open_log() reads by other means than as CSV? False for a file that is not there or cannot be read.
[[nodiscard]] bool is_binary_log(const std::filesystem::path& path);

/// Does the name end as that of a recording: ".csv", ".mat", ".ulg", …?
[[nodiscard]] bool is_recording_name(std::string_view name);

/// "MAT, HDF5, NPY, NPZ, ULog, DataFlash .bin or CSV"
[[nodiscard]] std::string formats_of_logs();

}  // namespace misfit
