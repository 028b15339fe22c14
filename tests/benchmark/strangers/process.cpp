#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "tests/benchmark/strangers/bench.h"

namespace strangers {
namespace {

[[noreturn]] void become(const std::vector<std::string>& words, const std::filesystem::path& output) {
  setpgid(0, 0);
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

Ended run(const std::vector<std::string>& words, const std::filesystem::path& output, double limit) {
  std::filesystem::create_directories(output.parent_path());
  const auto begin = std::chrono::steady_clock::now();
  const auto passed = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(); };
  const pid_t child = fork();
  if (child < 0) return {126, 0.0, 0.0};
  if (child == 0) become(words, output);
  int status = 0;
  rusage used{};
  bool late = false;
  while (wait4(child, &status, WNOHANG, &used) == 0) {
    if (!late && passed() > limit) late = kill(-child, SIGKILL) == 0 || kill(child, SIGKILL) == 0;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return {late ? -1 : code, passed(), seconds_of(used.ru_utime) + seconds_of(used.ru_stime)};
}

}  // namespace strangers
