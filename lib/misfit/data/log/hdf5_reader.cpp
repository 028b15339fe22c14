// read_hdf5 of readers.h.

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <map>

#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "misfit/core/module.h"
#include "misfit/core/shown.h"
#include "misfit/data/log/arrays.h"
#include "misfit/data/log/readers.h"

namespace misfit {
namespace {

/// The two ends of a pipe.
class Pipe {
 public:
  Pipe() {
    if (::pipe2(ends_.data(), O_CLOEXEC) != 0) throw MachineError("a pipe cannot be made: " + std::string(std::strerror(errno)));
  }
  ~Pipe() {
    close(0);
    close(1);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  [[nodiscard]] int end(std::size_t i) const { return ends_[i]; }
  void close(std::size_t i) {
    if (ends_[i] >= 0) ::close(std::exchange(ends_[i], -1));
  }

 private:
  std::array<int, 2> ends_{-1, -1};
};

/// misfit_hdf5 at work on a file.
class Helper {
 public:
  Helper(std::string source, const std::vector<std::string>& arguments) : source_(std::move(source)) {
    const std::string program = helper_program("misfit_hdf5", source_ + ": HDF5 files cannot be read").string();
    std::vector<std::string> words{program};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions{};
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_adddup2(&actions, out_.end(1), STDOUT_FILENO);
    ::posix_spawn_file_actions_adddup2(&actions, errors_.end(1), STDERR_FILENO);
    const int failed = ::posix_spawn(&process_, program.c_str(), &actions, nullptr, argv.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    if (failed != 0) throw MachineError(program + " cannot be started: " + std::strerror(failed));
    out_.close(1);
    errors_.close(1);
  }
  ~Helper() {
    out_.close(0);
    errors_.close(0);
    if (process_ > 0) ::waitpid(process_, nullptr, 0);
  }
  Helper(const Helper&) = delete;
  Helper& operator=(const Helper&) = delete;

  /// Up to `size` bytes of what it writes; fewer only at the end.
  std::size_t read(void* to, std::size_t size) { return read_from(out_.end(0), to, size); }

  std::string all() {
    std::string text;
    std::array<char, 65536> buffer{};
    while (const std::size_t n = read(buffer.data(), buffer.size())) text.append(buffer.data(), n);
    return text;
  }

  /// To be called when all is read. InputError where the library refused the file, or ended badly.
  void finish() {
    std::array<char, 2000> buffer{};
    const std::size_t n = read_from(errors_.end(0), buffer.data(), buffer.size());
    int status = 0;
    while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    process_ = 0;
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
    const std::string words(buffer.data(), n);
    if (WIFEXITED(status) && n > 0) throw InputError({source_, 0, 0}, "HDF5: " + shown(words, longest_message));
    const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    throw InputError({source_, 0, 0}, signal == SIGXCPU || signal == SIGKILL
                                          ? "the HDF5 library does not come to an end with it: the file is damaged"
                                          : "the HDF5 library fails on it: the file is damaged, or larger than the memory");
  }

 private:
  static std::size_t read_from(int descriptor, void* to, std::size_t size) {
    std::size_t done = 0;
    while (done < size) {
      const ssize_t n = ::read(descriptor, static_cast<char*>(to) + done, size - done);
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) break;
      done += static_cast<std::size_t>(n);
    }
    return done;
  }

  std::string source_;
  Pipe out_, errors_;
  pid_t process_ = 0;
};

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> out;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t end = std::min(text.find(at, from), text.size());
    out.push_back(text.substr(from, end - from));
    from = end + 1;
  }
  return out;
}

class Hdf5Reader : public LogReader {
 public:
  explicit Hdf5Reader(const std::filesystem::path& path) : path_(std::filesystem::absolute(path).string()) {
    log_.source = path.string();
    log_.format = is_matlab() ? "MAT (MATLAB, version 7.3)" : "HDF5";
    Helper helper(log_.source, {"list", path_});
    const std::vector<std::string> lines = split(helper.all(), '\n');
    helper.finish();
    if (lines.size() < 2 || lines[lines.size() - 2] != "E") throw InputError({log_.source, 0, 0}, "the list of its arrays is cut off");
    for (const std::string& line : lines) take(split(line, '\t'));
    find_clocks(log_);
  }

 protected:
  void read_values(const std::vector<std::size_t>& channels) override {
    std::map<std::size_t, std::vector<std::size_t>> by_array;
    for (const std::size_t c : channels) by_array[columns_[c].array].push_back(c);
    std::vector<std::string> arguments{"read", path_};
    for (const auto& [array, wanted] : by_array) arguments.push_back(std::to_string(array));
    Helper helper(log_.source, arguments);
    for (const auto& [array, wanted] : by_array) {
      if (!read_array(helper, array, wanted)) break;
    }
    helper.finish();
    for (const std::size_t c : channels) {
      if (log_.channels[c].values.empty()) throw InputError({log_.source, 0, 0}, "its numbers are cut off");
    }
  }

 private:
  bool is_matlab() const {
    std::ifstream file(path_, std::ios::binary);
    std::array<char, 10> text{};
    file.read(text.data(), text.size());
    return std::string_view(text.data(), text.size()) == "MATLAB 7.3";
  }

  void take(const std::vector<std::string>& fields) {
    constexpr std::size_t before_shape = 5;
    if (fields[0] == "N" && fields.size() > 1) log_.notes.push_back(shown(fields[1], longest_message));
    if (fields[0] != "A" || fields.size() < before_shape) return;
    ArrayInfo info{fields[1], fields[2], fields[3], {}, fields[4] == "1"};
    for (std::size_t i = before_shape; i < fields.size(); ++i) {
      std::size_t n = 0;
      std::from_chars(fields[i].data(), fields[i].data() + fields[i].size(), n);
      info.shape.push_back(n);
    }
    sizes_.push_back(count_of(info.shape, std::size_t{1} << 60U).value_or(0));
    add_array(log_, columns_, info, sizes_.size() - 1);
  }

  bool read_array(Helper& helper, std::size_t array, const std::vector<std::size_t>& wanted) {
    std::vector<double> all;
    constexpr std::size_t slab = 1 << 20;
    while (all.size() < sizes_[array]) {
      const std::size_t before = all.size(), next = std::min(slab, sizes_[array] - before);
      all.resize(before + next);
      if (helper.read(all.data() + before, next * sizeof(double)) != next * sizeof(double)) return false;
    }
    for (const std::size_t c : wanted) {
      log_.channels[c].values = column_values(columns_[c], log_.channels[c].samples, reinterpret_cast<const std::byte*>(all.data()),
                                              sizeof(double), {NumberKind::real, sizeof(double), std::endian::native == std::endian::big});
    }
    return true;
  }

  std::string path_;
  std::vector<std::size_t> sizes_;  // numbers of each array
  std::vector<ArrayColumn> columns_;
};

}  // namespace

std::unique_ptr<LogReader> read_hdf5(const std::filesystem::path& path) { return std::make_unique<Hdf5Reader>(path); }

}  // namespace misfit
