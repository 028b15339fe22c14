#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

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

}  // namespace misfit
