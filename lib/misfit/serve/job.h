#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace misfit::serve {

/// How a search goes on: its value by iteration.
struct CostTrace {
  std::string work;  ///< "filter_error"
  std::string what;  ///< of the value: "log-likelihood"
  std::vector<std::pair<int, double>> points;
};

enum class JobState { none, running, done, failed, stopped };

/// One command at work or ended.
struct JobReport {
  int number = 0;       ///< counts from 1; 0: none yet
  std::string command;  ///< as one would type it
  JobState state = JobState::none;
  bool stopping = false;
  int status = 0;  ///< of exit
  double seconds = 0.0;
  std::string work;                ///< what it is at
  std::optional<double> part;      ///< of that work, 0…1
  std::optional<double> left;      ///< seconds at most, where a limit holds
  std::vector<CostTrace> costs;    ///< of the last few searches
  std::vector<std::string> notes;  ///< lines of stderr, the last 200
  std::string output;              ///< of stdout, the last 64 kB
};

/// Runs commands of this program one at a time, each as a process of its own that ends with this object (and, with SIGINT, if this process
/// is killed). Its arguments are given one by one: there is no shell.
class Jobs {
 public:
  /// `ended` hears of each command's end before report() says so; from another thread, with the lock held: it does not ask this object.
  Jobs(std::string program, std::function<void(const JobReport&)> ended);
  ~Jobs();
  Jobs(const Jobs&) = delete;
  Jobs& operator=(const Jobs&) = delete;

  /// false: one is at work. `words`: behind the program's name.
  [[nodiscard]] bool start(std::vector<std::string> words, const std::string& command);
  /// The first time as Ctrl-C, which leaves what was finished; the second time at once.
  void stop();
  [[nodiscard]] JobReport report() const;

 private:
  struct Process;
  void work();
  void run(const std::vector<std::string>& words);
  void read(Process& process);
  void hear(const std::string& line);
  void end(const Process& process);
  void ended_with(int status, JobState state);

  std::string program_;
  std::function<void(const JobReport&)> ended_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::optional<std::vector<std::string>> next_;
  bool ends_ = false;
  int pid_ = 0;
  JobReport report_;
  std::thread thread_;  ///< the last: it uses the others
};

}  // namespace misfit::serve
