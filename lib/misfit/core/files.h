#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "misfit/core/error.h"

namespace misfit {

/// The machine cannot do it now (disk full, a read that fails, too many open files), whatever the request: the same command may succeed
/// later, so it is never kept as a result.
class MachineError : public RunError {
 public:
  explicit MachineError(const std::string& message) : RunError(message) {}
};

/// A file cannot be written: the machine's doing (disk full, no permission), not that of data or model.
class WriteError : public MachineError {
 public:
  explicit WriteError(const std::string& message) : MachineError(message) {}
};

/// A descriptor of the file, to be closed by the caller; InputError and MachineError as read_file().
[[nodiscard]] int open_for_reading(const std::filesystem::path& path);

/// Reads a whole file; InputError "FILE: no such file" (with the nearest name in that folder), or why it may not be read; MachineError
/// where the machine fails in it.
[[nodiscard]] std::string read_file(const std::filesystem::path& path);

/// Writes `content` to a temporary name in the same folder, flushes it (checking every write, and fsync) and renames it: a reader sees the
/// old file or the whole new one. WriteError naming file and system message (disk full, no permission); the temporary is removed.
void write_atomically(const std::filesystem::path& path, std::string_view content);

/// Creates `dir` and its parents, and checks that a file can be written there. InputError if not: the message names the folder and why;
/// WriteError where the machine fails in it (disk full).
void make_writable_folder(const std::filesystem::path& dir);

/// FNV-1a, 64 bit, as 16 hexadecimal digits: to see whether an input changed, not for security.
[[nodiscard]] std::string hash_text(std::string_view content);
[[nodiscard]] std::string hash_file(const std::filesystem::path& path);

}  // namespace misfit
