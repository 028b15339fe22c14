#include "misfit/jobs/work_queue.h"

#include <algorithm>
#include <exception>
#include <limits>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include "misfit/core/watch.h"

namespace misfit {
namespace {

/// Jobs are handed out in the order of k. If a job ran, every job before it has been started too and will finish, so the exception of the
/// lowest k is the same one whatever the number of threads.
class Queue {
 public:
  Queue(std::size_t jobs, const std::function<void(std::size_t)>& job, const ProgressFn& progress, const std::atomic<bool>* stop)
      : jobs_(jobs), job_(job), progress_(progress), stop_(stop) {}

  void work() {
    while (!failed_ && !(stop_ && stop_->load())) {
      const std::size_t k = next_++;
      if (k >= jobs_) return;
      try {
        job_(k);
        finished();
      } catch (const Interrupted&) {
        if (stop_ != nullptr) return;  // as if it had not been begun
        fail(k);
      } catch (...) {
        fail(k);
      }
    }
  }

  /// To be called when all threads have ended.
  [[nodiscard]] bool result() const {
    if (exception_) std::rethrow_exception(exception_);
    return done_ == jobs_;
  }

 private:
  void fail(std::size_t k) {
    const std::lock_guard lock(mutex_);
    failed_ = true;
    if (k >= failed_job_) return;
    failed_job_ = k;
    exception_ = std::current_exception();
  }

  void finished() {
    const std::lock_guard lock(mutex_);
    ++done_;
    if (progress_) progress_(done_, jobs_);
  }

  const std::size_t jobs_;
  const std::function<void(std::size_t)>& job_;
  const ProgressFn& progress_;
  const std::atomic<bool>* stop_;
  std::atomic<std::size_t> next_{0};
  std::atomic<bool> failed_{false};
  std::mutex mutex_;
  std::size_t done_ = 0;
  std::size_t failed_job_ = std::numeric_limits<std::size_t>::max();
  std::exception_ptr exception_;
};

}  // namespace

bool run_jobs(std::size_t jobs, int threads, const std::function<void(std::size_t)>& job, const ProgressFn& progress,
              const std::atomic<bool>* stop) {
  const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  const std::size_t workers = std::min(jobs, threads > 0 ? static_cast<std::size_t>(threads) : cores);
  Queue queue(jobs, job, progress, stop);
  std::vector<std::thread> others;
  for (std::size_t i = 1; i < workers; ++i) {
    try {
      others.emplace_back([&queue, watch = Watch::current()] {
        const SameWatch same(watch);
        queue.work();
      });
    } catch (const std::system_error&) {
      break;  // the machine grants no more threads: those that run do all the jobs
    }
  }
  queue.work();
  for (std::thread& thread : others) thread.join();
  return queue.result();
}

}  // namespace misfit
