#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "misfit/core/error.h"

namespace misfit {

/// A file cannot be written: the machine's doing (disk full, no permission), not that of data or model.
class WriteError : public RunError {
 public:
  explicit WriteError(const std::string& message) : RunError(message) {}
};

/// Reads a whole file; InputError "FILE: no such file" (with the nearest name in that folder), or why it cannot be read.
[[nodiscard]] std::string read_file(const std::filesystem::path& path);

/// Writes `content` to a temporary name in the same folder, flushes it (checking every write, and fsync) and renames it: a reader sees the
/// old file or the whole new one. WriteError naming file and system message (disk full, no permission); the temporary is removed.
void write_atomically(const std::filesystem::path& path, std::string_view content);

/// Creates `dir` and its parents, and checks that a file can be written there. InputError if not: the message names the folder and why.
void make_writable_folder(const std::filesystem::path& dir);

/// FNV-1a, 64 bit, as 16 hexadecimal digits: to see whether an input changed, not for security.
[[nodiscard]] std::string hash_text(std::string_view content);
[[nodiscard]] std::string hash_file(const std::filesystem::path& path);

}  // namespace misfit
