#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <thread>

#include "tests/benchmark/strangers/bench.h"

namespace strangers {
namespace {

[[noreturn]] void become(const std::vector<std::string>& words, const std::filesystem::path& output, double processor_limit) {
  setpgid(0, 0);
  const auto limit = static_cast<rlim_t>(std::ceil(processor_limit));
  const rlimit both = {limit, limit};
  if (limit > 0) setrlimit(RLIMIT_CPU, &both);
  const int file = open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  dup2(file, 1);
  dup2(file, 2);
  std::vector<char*> arguments;
  for (const auto& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  execv(arguments[0], arguments.data());
  _exit(127);
}

double seconds_of(const timeval& time) { return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec); }

}  // namespace

Ended run(const std::vector<std::string>& words, const std::filesystem::path& output, const Bench& bench) {
  std::filesystem::create_directories(output.parent_path());
  const auto begin = std::chrono::steady_clock::now();
  const auto passed = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(); };
  const pid_t child = fork();
  if (child < 0) return {126, 0.0, 0.0};
  if (child == 0) become(words, output, bench.processor_limit);
  int status = 0;
  rusage used{};
  bool late = false;
  while (wait4(child, &status, WNOHANG, &used) == 0) {
    if (!late && passed() > bench.limit) late = kill(-child, SIGKILL) == 0 || kill(child, SIGKILL) == 0;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  const double processor = seconds_of(used.ru_utime) + seconds_of(used.ru_stime);
  late = late || (bench.processor_limit > 0.0 && WIFSIGNALED(status) && processor > bench.processor_limit - 1.0);
  return {late ? -1 : code, passed(), processor};
}

}  // namespace strangers
