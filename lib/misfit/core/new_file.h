#pragma once

#include <filesystem>
#include <string_view>

namespace misfit {

/// write_atomically() piece by piece, for files that are too large to be held as one text. Under a temporary name in the same folder until
/// publish(), which flushes and renames it; removed if that is not reached. WriteError as there.
class NewFile {
 public:
  explicit NewFile(const std::filesystem::path& path);
  ~NewFile();
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  void add(std::string_view piece);
  void publish();

 private:
  [[noreturn]] void fail(int code) const;

  std::filesystem::path path_, temporary_;
  int descriptor_ = -1;
};

}  // namespace misfit
