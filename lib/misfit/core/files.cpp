#include "misfit/core/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <functional>
#include <system_error>
#include <utility>
#include <vector>

#include "misfit/core/new_file.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

std::string system_message(int code) { return std::generic_category().message(code); }

/// Is this errno caused by the machine's state (disk, memory, limits) and not by what was asked for?
bool of_machine(int code) {
  constexpr std::array codes{EIO, ENOSPC, EDQUOT, EMFILE, ENFILE, ENOMEM, ENOBUFS, ESTALE, ETIMEDOUT};
  return std::find(codes.begin(), codes.end(), code) != codes.end();
}

[[noreturn]] void refuse_reading(const fs::path& path, int code) {
  const std::string message = path.string() + ": cannot be read: " + system_message(code);
  if (of_machine(code)) throw MachineError(message);
  throw InputError(message);
}

[[noreturn]] void refuse_folder(const fs::path& dir, const std::string& what, int code) {
  const std::string message = dir.string() + ": the folder cannot be " + what + ": " + system_message(code);
  if (of_machine(code)) throw WriteError(message);
  throw InputError(message);
}

std::string no_such_file(const fs::path& path) {
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  std::error_code error;
  if (!fs::is_directory(folder, error)) return path.string() + ": no such file: the folder " + folder.string() + " does not exist";
  std::vector<std::string> names;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    names.push_back(it->path().filename().string());
  const std::string nearest = nearest_name(path.filename().string(), names);
  return path.string() + ": no such file" + (nearest.empty() ? "" : " — did you mean '" + nearest + "'?");
}

/// A file descriptor that is closed at the end of its scope. `close()` reports errors (a full disk may show only there).
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int number() const { return number_; }
  int release() { return std::exchange(number_, -1); }
  int close() {
    const int result = ::close(number_);
    number_ = -1;
    return result == 0 ? 0 : errno;
  }

 private:
  int number_;
};

/// 0, or the errno of the first write that failed.
int write_all(int descriptor, std::string_view content) {
  while (!content.empty()) {
    const ssize_t n = ::write(descriptor, content.data(), content.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return errno;
    if (n == 0) return ENOSPC;
    content.remove_prefix(n);
  }
  return 0;
}

/// A new file, to be written; its number, or below 0 with errno.
int open_new_file(const fs::path& path) { return ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666); }

/// To the device; 0 or errno. Pipes and some network folders cannot flush (EINVAL): that is no loss of data.
int flush(int descriptor) { return ::fsync(descriptor) != 0 && errno != EINVAL ? errno : 0; }

/// Unique among threads and processes of this machine, hidden, in the same folder (so that rename cannot cross devices).
fs::path temporary_name(const fs::path& path) {
  static std::atomic<unsigned> counter{0};
  const unsigned number = counter++;
  return path.parent_path() / fmt::format(".{}.{}.{}.tmp", path.filename().string(), ::getpid(), number);
}

/// 0, or why no file can be made in `dir`. The file has no name, so a sudden end leaves nothing, but where the file system has no such
/// files.
int try_writing(const fs::path& dir) {
  const Descriptor nameless(::open(dir.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666));
  if (nameless.number() >= 0) return 0;
  if (errno != EOPNOTSUPP && errno != EISDIR && errno != ENOENT) return errno;
  const fs::path probe = temporary_name(dir / "probe");
  Descriptor file(open_new_file(probe));
  const int failure = file.number() < 0 ? errno : file.close();
  std::error_code ignored;
  fs::remove(probe, ignored);
  return failure;
}

}  // namespace

int open_for_reading(const fs::path& path) {
  Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.number() < 0 && (errno == ENOENT || errno == ENOTDIR)) throw InputError(no_such_file(path));
  if (file.number() < 0) refuse_reading(path, errno);
  struct stat status {};
  if (::fstat(file.number(), &status) == 0 && S_ISDIR(status.st_mode)) throw InputError(path.string() + ": is a folder, a file is needed");
  return file.release();
}

void read_pieces(const fs::path& path, const std::function<void(std::string_view)>& take) {
  const Descriptor file(open_for_reading(path));
  std::vector<char> buffer(1 << 16);
  for (;;) {
    const ssize_t n = ::read(file.number(), buffer.data(), buffer.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) refuse_reading(path, errno);
    if (n == 0) return;
    take({buffer.data(), static_cast<std::size_t>(n)});
  }
}

std::string read_file(const fs::path& path) {
  std::string content;
  std::error_code error;
  const auto size = fs::file_size(path, error);
  if (!error) content.reserve(size);
  read_pieces(path, [&](std::string_view piece) { content.append(piece); });
  return content;
}

NewFile::NewFile(const fs::path& path) : path_(path), temporary_(temporary_name(path)) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) throw WriteError(path.string() + ": cannot be written: it is a folder");
  descriptor_ = open_new_file(temporary_);
  if (descriptor_ < 0) fail(errno);
}

NewFile::~NewFile() {
  if (descriptor_ < 0) return;
  ::close(descriptor_);
  std::error_code ignored;
  fs::remove(temporary_, ignored);
}

void NewFile::add(std::string_view piece) {
  if (const int error = write_all(descriptor_, piece)) fail(error);
}

void NewFile::publish() {
  int error = flush(descriptor_);
  if (::close(std::exchange(descriptor_, -1)) != 0 && error == 0) error = errno;
  if (error == 0 && ::rename(temporary_.c_str(), path_.c_str()) != 0) error = errno;
  if (error == 0) return;
  std::error_code ignored;
  fs::remove(temporary_, ignored);
  fail(error);
}

void NewFile::fail(int code) const { throw WriteError(path_.string() + ": cannot be written: " + system_message(code)); }

void write_atomically(const fs::path& path, std::string_view content) {
  NewFile file(path);
  file.add(content);
  file.publish();
}

void make_writable_folder(const fs::path& dir) {
  std::error_code error;
  fs::create_directories(dir, error);
  if (error) refuse_folder(dir, "made", error.value());
  if (!fs::is_directory(dir, error)) throw InputError(dir.string() + ": is a file, a folder is needed");
  if (const int failure = try_writing(dir)) refuse_folder(dir, "written to", failure);
}

namespace {

/// FNV-1a, piece by piece.
class Hash {
 public:
  void add(std::string_view content) {
    for (const char c : content) {
      hash_ ^= static_cast<unsigned char>(c);
      hash_ *= 1099511628211ULL;
    }
  }
  [[nodiscard]] std::string text() const {
    std::uint64_t rest = hash_;
    std::string out(16, '0');
    for (std::size_t i = 16; i-- > 0; rest >>= 4) out[i] = "0123456789abcdef"[rest & 15U];
    return out;
  }

 private:
  std::uint64_t hash_ = 14695981039346656037ULL;
};

}  // namespace

std::string hash_text(std::string_view content) {
  Hash hash;
  hash.add(content);
  return hash.text();
}

std::string hash_file(const fs::path& path) {
  Hash hash;
  read_pieces(path, [&](std::string_view piece) { hash.add(piece); });
  return hash.text();
}

}  // namespace misfit
