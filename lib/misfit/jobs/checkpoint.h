#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace misfit {

/// Where the result of a job stands in a checkpoint.
struct CheckpointEntry {
  std::uint64_t job = 0;
  std::uint64_t offset = 0;  ///< of its bytes in the file
  std::uint64_t size = 0;
};

/// What a checkpoint holds up to the first record that is torn (its checksum does not hold, or the file ends in it).
struct CheckpointContent {
  std::vector<CheckpointEntry> entries;  ///< in the order of the file
  std::uint64_t valid = 0;               ///< length of the part that holds; what stands behind is to be dropped
  bool ours = false;                     ///< false: no file, or of another digest: then nothing is in it
};

/// A checkpoint is a line "misfit checkpoint 1 DIGEST" and records appended as jobs end: job, size (8 bytes each, of this machine's order),
/// the bytes, FNV-1a of all that. Reads record by record: memory is one record and the entries.
[[nodiscard]] CheckpointContent read_checkpoint(const std::filesystem::path& path, const std::string& digest);

/// Appends to a checkpoint from any thread. One writer per file: the file is locked as long as it lives.
class CheckpointWriter {
 public:
  /// Opens PATH, dropping what is torn or of another digest. WriteError: it cannot be written, is a link, or is a file that is no
  /// checkpoint. RunError: another process is writing it.
  CheckpointWriter(std::filesystem::path path, const std::string& digest);
  ~CheckpointWriter();
  CheckpointWriter(const CheckpointWriter&) = delete;
  CheckpointWriter& operator=(const CheckpointWriter&) = delete;

  /// WriteError naming file and system message (disk full); what was written of the record is taken back.
  void append(std::uint64_t job, std::string_view bytes);
  /// Onto the disk itself; append() does it every few seconds as well. WriteError.
  void sync();

 private:
  void write_whole(std::string_view bytes);
  void flush();

  std::filesystem::path path_;
  int file_ = -1;
  std::uint64_t length_ = 0;
  std::int64_t synced_ = 0;  ///< [s] of the steady clock
  std::mutex mutex_;
};

/// The bytes of one entry. RunError if the file has changed since.
[[nodiscard]] std::string read_checkpoint_entry(const std::filesystem::path& path, const CheckpointEntry& entry);

/// Is it a file (no link) that begins as a checkpoint does?
[[nodiscard]] bool is_checkpoint_of_ours(const std::filesystem::path& path);

/// Numbers as bytes, to the last bit.
[[nodiscard]] std::string pack_numbers(const std::vector<double>& numbers);
/// RunError if the size is not a multiple of 8.
[[nodiscard]] std::vector<double> unpack_numbers(std::string_view bytes);

}  // namespace misfit
