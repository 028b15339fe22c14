#include "misfit/serve/job.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "misfit/core/error.h"

namespace misfit::serve {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::size_t most_notes = 200, most_output = 1 << 16, most_points = 2000, most_traces = 4, longest_line = 4096;
constexpr std::chrono::seconds patience{10};
constexpr int not_started = 127;  // status of a program that cannot be run, as a shell has it

struct Pipe {
  int from = -1, to = -1;
  Pipe() {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw RunError("no process can be started: too many open files");
    from = ends[0];
    to = ends[1];
  }
  ~Pipe() {
    close_end(from);
    close_end(to);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  static void close_end(int& end) {
    if (end >= 0) ::close(end);
    end = -1;
  }
};

/// The environment, with progress as lines instead of one for a terminal.
std::vector<std::string> environment() {
  std::vector<std::string> out;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    if (!std::string_view(*entry).starts_with("MISFIT_PROGRESS=")) out.emplace_back(*entry);
  }
  out.emplace_back("MISFIT_PROGRESS=lines");
  return out;
}

std::vector<char*> pointers(std::vector<std::string>& words) {
  std::vector<char*> out;
  for (std::string& word : words) out.push_back(word.data());
  out.push_back(nullptr);
  return out;
}

/// What a child is to become.
struct Start {
  const char* program;
  char* const* words;
  char* const* variables;
  int out, err;  ///< descriptors
  pid_t parent;
};

/// In the child, between fork and exec: nothing here takes memory or a lock.
[[noreturn]] void become(const Start& start) {
  ::prctl(PR_SET_PDEATHSIG, SIGINT);
  if (::getppid() != start.parent) ::_exit(1);
  ::setpgid(0, 0);  // Ctrl-C is for the server, which tells its job
  ::dup2(::open("/dev/null", O_RDONLY), STDIN_FILENO);
  ::dup2(start.out, STDOUT_FILENO);
  ::dup2(start.err, STDERR_FILENO);
  ::signal(SIGINT, SIG_DFL);
  ::signal(SIGTERM, SIG_DFL);
  ::signal(SIGPIPE, SIG_IGN);
  ::execve(start.program, start.words, start.variables);
  ::_exit(not_started);
}

void keep_last(std::string& text, std::size_t most) {
  if (text.size() > most) text.erase(0, text.size() - most);
}

}  // namespace

struct Jobs::Process {
  Pipe out, err;
  pid_t pid = 0;
  Clock::time_point begin = Clock::now();
  std::string line;  ///< of stderr, not yet whole
  int status = 0;
};

Jobs::Jobs(std::string program, std::function<void(const JobReport&)> ended)
    : program_(std::move(program)), ended_(std::move(ended)), thread_([this] { work(); }) {}

Jobs::~Jobs() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
    if (pid_ > 0) ::kill(pid_, SIGINT);
  }
  wake_.notify_all();
  thread_.join();
}

bool Jobs::start(std::vector<std::string> words, const std::string& command) {
  {
    const std::lock_guard lock(mutex_);
    if (report_.state == JobState::running || ends_) return false;
    const int number = report_.number + 1;
    report_ = {};
    report_.number = number;
    report_.command = command;
    report_.state = JobState::running;
    next_ = std::move(words);
  }
  wake_.notify_all();
  return true;
}

void Jobs::stop() {
  const std::lock_guard lock(mutex_);
  if (pid_ > 0) ::kill(pid_, report_.stopping ? SIGKILL : SIGINT);
  if (report_.state == JobState::running) report_.stopping = true;
}

JobReport Jobs::report() const {
  const std::lock_guard lock(mutex_);
  return report_;
}

void Jobs::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    wake_.wait(lock, [this] { return ends_ || next_; });
    if (ends_) return;
    const std::vector<std::string> words = std::move(*next_);
    next_.reset();
    lock.unlock();
    try {
      run(words);
    } catch (const std::exception& error) {
      const std::lock_guard again(mutex_);
      report_.notes.emplace_back(error.what());
      ended_with(not_started, JobState::failed);
    }
    lock.lock();
  }
}

void Jobs::run(const std::vector<std::string>& words) {
  Process process;
  std::vector<std::string> arguments{"misfit"}, variables = environment();
  arguments.insert(arguments.end(), words.begin(), words.end());
  const std::vector<char*> argv = pointers(arguments), envp = pointers(variables);
  const Start start{program_.c_str(), argv.data(), envp.data(), process.out.to, process.err.to, ::getpid()};
  process.pid = ::fork();
  if (process.pid < 0) throw RunError("no process can be started");
  if (process.pid == 0) become(start);
  Pipe::close_end(process.out.to);
  Pipe::close_end(process.err.to);
  {
    const std::lock_guard lock(mutex_);
    pid_ = process.pid;
    if (report_.stopping || ends_) ::kill(pid_, SIGINT);  // asked for before there was one
  }
  read(process);
  end(process);
}

void Jobs::read(Process& process) {
  std::array<char, 8192> buffer{};
  std::optional<Clock::time_point> last;
  while (process.out.from >= 0 || process.err.from >= 0) {
    std::array<pollfd, 2> both{pollfd{process.out.from, POLLIN, 0}, pollfd{process.err.from, POLLIN, 0}};
    const int ready = ::poll(both.data(), both.size(), 200);
    const std::lock_guard lock(mutex_);
    report_.seconds = std::chrono::duration<double>(Clock::now() - process.begin).count();
    if (ends_ && !last) last = Clock::now() + patience;
    if (last && Clock::now() > *last) ::kill(process.pid, SIGKILL);
    if (ready <= 0) continue;
    for (int* from : {&process.out.from, &process.err.from}) {
      const pollfd& one = both[from == &process.out.from ? 0 : 1];
      if (*from < 0 || one.revents == 0) continue;
      const ssize_t n = ::read(*from, buffer.data(), buffer.size());
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) {
        Pipe::close_end(*from);
        continue;
      }
      std::string& text = from == &process.out.from ? report_.output : process.line;
      text.append(buffer.data(), static_cast<std::size_t>(n));
    }
    keep_last(report_.output, most_output);
    for (std::size_t end = process.line.find('\n'); end != std::string::npos; end = process.line.find('\n')) {
      hear(process.line.substr(0, end));
      process.line.erase(0, end + 1);
    }
    if (process.line.size() > longest_line) process.line.clear();
  }
}

namespace {

/// Of one search; several are at work at once.
CostTrace& trace_of(std::vector<CostTrace>& all, const std::string& work, const std::string& what) {
  auto found = std::find_if(all.begin(), all.end(), [&](const CostTrace& one) { return one.work == work && one.what == what; });
  if (found == all.end()) found = all.insert(all.end(), {work, what, {}});
  return *found;
}

/// A full list goes on with every second of its points.
void add_point(std::vector<std::pair<int, double>>& points, int iteration, double value) {
  if (points.size() >= most_points) {
    for (std::size_t k = 1; 2 * k < points.size(); ++k) points[k] = points[2 * k];
    points.resize((points.size() + 1) / 2);
  }
  points.emplace_back(iteration, value);
}

}  // namespace

/// A line of stderr: progress (apps/progress.cpp), or a note. With the lock held.
void Jobs::hear(const std::string& line) {
  if (line.empty()) return;
  const nlohmann::json progress = line.starts_with(R"({"progress":)") ? nlohmann::json::parse(line, nullptr, false) : nlohmann::json();
  if (!progress.is_object()) {
    report_.notes.push_back(line.substr(0, longest_line));
    if (report_.notes.size() > most_notes) report_.notes.erase(report_.notes.begin());
    return;
  }
  const auto number = [&](const char* name) -> std::optional<double> {
    const auto found = progress.find(name);
    if (found == progress.end() || !found->is_number()) return std::nullopt;
    return found->get<double>();
  };
  report_.work = progress["progress"].is_string() ? progress["progress"].get<std::string>() : "";
  report_.part = number("part");
  report_.left = number("left");
  const auto value = number("value"), iteration = number("iteration");
  if (!value || !iteration) return;
  const std::string what = progress.contains("what") && progress["what"].is_string() ? progress["what"].get<std::string>() : "";
  add_point(trace_of(report_.costs, report_.work, what).points, static_cast<int>(*iteration), *value);
  if (report_.costs.size() > most_traces) report_.costs.erase(report_.costs.begin());
}

void Jobs::end(const Process& process) {
  int status = 0;
  while (::waitpid(process.pid, &status, 0) < 0 && errno == EINTR) {
  }
  const std::lock_guard lock(mutex_);
  pid_ = 0;
  if (!process.line.empty()) hear(process.line);
  report_.seconds = std::chrono::duration<double>(Clock::now() - process.begin).count();
  const int own = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  const bool stopped = report_.stopping || ends_;
  ended_with(own, own == 0 ? JobState::done : stopped ? JobState::stopped : JobState::failed);
}

/// With the lock held.
void Jobs::ended_with(int status, JobState state) {
  report_.status = status;
  report_.state = state;
  try {
    ended_(report_);
  } catch (const std::exception& error) {  // the disk is full
    report_.notes.emplace_back(error.what());
  }
}

}  // namespace misfit::serve
