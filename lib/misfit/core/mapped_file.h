#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace misfit {

/// A file as memory, read by the system when it is looked at: a large one costs no memory. It must not be shortened while it is open.
class MappedFile {
 public:
  /// InputError as read_file() where there is none, or it is no regular file.
  explicit MappedFile(const std::filesystem::path& path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  [[nodiscard]] std::span<const std::byte> bytes() const { return {static_cast<const std::byte*>(start_), size_}; }

 private:
  void* start_ = nullptr;
  std::size_t size_ = 0;
};

/// A whole text: read where it is small or no regular file (so that it may be shortened meanwhile), mapped where it is large.
class FileText {
 public:
  /// Throws as read_file().
  explicit FileText(const std::filesystem::path& path);

  [[nodiscard]] std::string_view text() const;

 private:
  std::optional<MappedFile> mapped_;
  std::string read_;
};

}  // namespace misfit
