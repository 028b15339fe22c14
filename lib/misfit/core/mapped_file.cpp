#include "misfit/core/mapped_file.h"

#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <string>
#include <system_error>

#include "misfit/core/error.h"
#include "misfit/core/files.h"

namespace misfit {

MappedFile::MappedFile(const std::filesystem::path& path) {
  const int file = open_for_reading(path);
  struct stat status {};
  const bool regular = ::fstat(file, &status) == 0 && S_ISREG(status.st_mode);
  size_ = regular ? static_cast<std::size_t>(status.st_size) : 0;
  if (size_ > 0) start_ = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, file, 0);
  ::close(file);
  if (!regular) throw InputError(path.string() + ": is a pipe or a device, a file is needed");
  if (start_ == MAP_FAILED) throw MachineError(path.string() + ": cannot be mapped into memory");
}

MappedFile::~MappedFile() {
  if (size_ > 0) ::munmap(start_, size_);
}

FileText::FileText(const std::filesystem::path& path) {
  constexpr std::uintmax_t large = 64U << 20U;
  std::error_code none;
  if (std::filesystem::is_regular_file(path, none) && std::filesystem::file_size(path, none) > large && !none) {
    mapped_.emplace(path);
  } else {
    read_ = read_file(path);
  }
}

std::string_view FileText::text() const {
  if (!mapped_) return read_;
  return {reinterpret_cast<const char*>(mapped_->bytes().data()), mapped_->bytes().size()};
}

}  // namespace misfit
