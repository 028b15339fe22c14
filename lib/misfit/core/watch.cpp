#include "misfit/core/watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace misfit {
namespace {

std::atomic<bool> flag{false};  // not in a function: a signal handler must not run an initialisation

constinit thread_local const Watch* watching = nullptr;
constinit thread_local unsigned looks = 0;

}  // namespace

std::atomic<bool>& interrupted() { return flag; }

Interrupted::Interrupted() : Stopped("interrupted; finished work is kept in the run folder, and the same command continues from there") {}

namespace {

constexpr const char* more_time = "more time: --time-limit SECONDS, or time_limit of [fit]";

}  // namespace

std::string in_words(const TimeLimitReached& spent, const std::string& what, double value) {
  return fmt::format("{} at a {} of {:.6g}: the values are the best found until then and not where the search would have ended ({})",
                     spent.what(), what, value, more_time);
}

std::string in_words(const TimeLimitReached& spent) { return fmt::format("{}, before there was any result ({})", spent.what(), more_time); }

Watch::Watch(std::string work, double limit, ProgressCallback on_progress)
    : work_(std::move(work)), limit_(limit), on_progress_(std::move(on_progress)), outer_(watching) {
  if (outer_ != nullptr) first_ = outer_->first_;
  if (limit_ > 0.0) {
    constexpr double longest = 1e9;  // beyond it a clock's nanoseconds overflow
    end_ = begin_ + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(std::min(limit_, longest)));
    if (first_ == nullptr || *end_ < *first_->end_) first_ = this;
  }
  if (!on_progress_ && outer_ != nullptr) on_progress_ = outer_->on_progress_;
  watching = this;
}

Watch::~Watch() { watching = outer_; }

bool Watch::spent() const { return first_ != nullptr && Clock::now() >= *first_->end_; }

std::string Watch::words() const {
  return first_ == nullptr ? "" : fmt::format("the time limit of {:g} s for {} was spent", first_->limit_, first_->work_);
}

const Watch* Watch::current() { return watching; }

SameWatch::SameWatch(const Watch* watch) : before_(std::exchange(watching, watch)) {}

SameWatch::~SameWatch() { watching = before_; }

SuspendedTimeLimit::SuspendedTimeLimit() {
  if (watching == nullptr) return;
  watch_.emplace(watching->work_);
  watch_->first_ = nullptr;
}

SuspendedTimeLimit::~SuspendedTimeLimit() = default;

void look_at_watch() {
  constexpr unsigned between_clocks = 32;
  if (flag.load(std::memory_order_relaxed)) throw Interrupted();
  if (watching == nullptr || ++looks % between_clocks != 0) return;
  if (watching->spent()) throw TimeLimitReached(watching->words());
}

void report_iteration(int iteration, const char* what, double value) {
  if (flag.load(std::memory_order_relaxed)) throw Interrupted();
  if (watching == nullptr) return;
  if (watching->spent()) throw TimeLimitReached(watching->words());
  if (!watching->on_progress_) return;
  const auto seconds = [](auto from, auto to) { return std::chrono::duration<double>(to - from).count(); };
  const auto now = Watch::Clock::now();
  SearchState state{iteration, what, value, watching->work_, seconds(watching->begin_, now)};
  if (watching->first_ != nullptr) state.left = std::max(seconds(now, *watching->first_->end_), 0.0);
  watching->on_progress_(state);
}

}  // namespace misfit
