#include "misfit/video/video.h"

#include <fmt/format.h>

#include <cmath>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <new>
#include <system_error>
#include <thread>

#include "misfit/core/error.h"
#include "misfit/core/text.h"
#include "misfit/video/clock.h"
#include "misfit/video/module.h"
#include "misfit/video/stream.h"

namespace misfit {
namespace {

constexpr std::size_t queue_length = 16;  // frames decoded ahead

}  // namespace

struct Video::State {
  std::unique_ptr<video_module::VideoStream> stream;
  VideoFacts facts;
  std::deque<Frame> queue;
  std::mutex mutex;
  std::condition_variable changed;
  bool ended = false, stop = false;
  std::exception_ptr failure;  ///< of the decoding thread, for the one that asks for frames
  std::thread thread;
  // of the decoding thread alone
  Image before = {};
  FrameNumbers numbers;
  long number = -1;
  std::vector<double> times;  ///< of the frames that have one [s]
  long missing = 0, repeated = 0;
  bool coloured = false;

  State() = default;
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() {
    {
      const std::lock_guard lock(mutex);
      stop = true;
    }
    changed.notify_all();
    if (thread.joinable()) thread.join();
  }

  /// Of the frame just read, if it is later than those before.
  std::optional<double> time() {
    const double timestamp = stream->timestamp;
    if (!std::isfinite(timestamp) || (!times.empty() && timestamp <= times.back())) return std::nullopt;
    times.push_back(timestamp);
    return timestamp - times.front();
  }

  /// What all timestamps say at the end.
  void set_clock() {
    const FrameClock clock = clock_of(times, facts.rate);
    facts.variable = facts.variable || !clock.constant;
    facts.rate = clock.rate;
    if (facts.variable && times.size() > 1) facts.rate = static_cast<double>(times.size() - 1) / (times.back() - times.front());
  }

  std::optional<Frame> decode() {
    Frame frame;
    frame.image = Image(facts.width, facts.height);
    if (coloured) frame.colour = ColourImage(facts.width, facts.height);
    if (!stream->next(frame.image.pixels.data(), coloured ? frame.colour.bgr.data() : nullptr)) return std::nullopt;
    frame.time = time();
    frame.number = numbers.next(facts.variable ? std::nullopt : frame.time, facts.rate);
    missing += frame.number - number - 1;
    number = frame.number;
    frame.repeated = frame.image == before;
    repeated += frame.repeated ? 1 : 0;
    before = frame.image;
    return frame;
  }

  void start(const std::filesystem::path& path) {
    try {
      thread = std::thread([this] { run(); });
    } catch (const std::system_error& error) {
      throw RunError(path.string() + ": no thread can be started to decode the video: " + error.what());
    }
  }

  void run() {
    try {
      while (pass_on(decode())) {
      }
    } catch (const std::bad_alloc&) {
      fail(std::current_exception());
    } catch (const std::exception& error) {
      fail(std::make_exception_ptr(RunError(facts.file + ": the video cannot be decoded: " + error.what())));
    }
  }

  void fail(std::exception_ptr why) {
    const std::lock_guard lock(mutex);
    failure = std::move(why);
    ended = true;
    changed.notify_all();
  }

  /// False if there is no more to do.
  bool pass_on(std::optional<Frame> frame) {
    std::unique_lock lock(mutex);
    changed.wait(lock, [&] { return !frame || queue.size() < queue_length || stop; });
    if (frame && !stop) queue.push_back(std::move(*frame));
    ended = !frame;
    changed.notify_all();
    return frame && !stop;
  }
};

namespace {

std::vector<double> increasing(const std::vector<double>& timestamps) {
  std::vector<double> out;
  for (const double t : timestamps) {
    if (std::isfinite(t) && (out.empty() || t > out.back())) out.push_back(t);
  }
  return out;
}

}  // namespace

Video::Video(const std::filesystem::path& path, Colours colours) : state_(std::make_unique<State>()) {
  state_->stream = opened_stream(path);
  const video_module::VideoStream& stream = *state_->stream;
  VideoFacts& facts = state_->facts;
  facts.file = path.filename().string();
  facts.width = stream.width;
  facts.height = stream.height;
  facts.rate = stream.rate;
  facts.declared = stream.declared;
  const FrameClock clock = clock_of(increasing(stream.first_timestamps), stream.rate);
  facts.variable = !clock.constant;
  facts.rate = clock.rate;
  state_->coloured = colours == Colours::bgr;
  state_->start(path);
}

Video::Video(Video&&) noexcept = default;
Video& Video::operator=(Video&&) noexcept = default;
Video::~Video() = default;

std::optional<Frame> Video::next() {
  State& s = *state_;
  std::unique_lock lock(s.mutex);
  s.changed.wait(lock, [&s] { return !s.queue.empty() || s.ended; });
  if (s.queue.empty()) {
    if (s.failure) std::rethrow_exception(s.failure);
    if (!s.facts.finished) s.set_clock();
    s.facts.finished = true;
    s.facts.missing = s.missing;
    s.facts.repeated = s.repeated;
    return std::nullopt;
  }
  Frame frame = std::move(s.queue.front());
  s.queue.pop_front();
  ++s.facts.decoded;
  s.changed.notify_all();
  return frame;
}

const VideoFacts& Video::facts() const { return state_->facts; }

std::vector<std::string> notes_of(const VideoFacts& facts) {
  std::vector<std::string> notes;
  const long reached = facts.decoded + facts.missing;
  const long tolerance = 1;  // a container that declares a duration rounds it
  if (facts.finished && facts.declared > 0 && reached < facts.declared - tolerance) {
    notes.push_back(
        fmt::format("{}: the file is truncated or damaged, or an editor hid a part of it: it declares {} frames ({:.1f} s) and only {} "
                    "could be decoded, so the video ends after {:.1f} s",
                    facts.file, facts.declared, static_cast<double>(facts.declared) / facts.rate, facts.decoded,
                    static_cast<double>(reached) / facts.rate));
  }
  if (facts.missing > 0) {
    notes.push_back(fmt::format("{}: {} missing between others, as its timestamps show: {} lost", facts.file,
                                counted(facts.missing, "frame is", "frames are"),
                                facts.missing == 1 ? "its sample is" : "their samples are"));
  }
  if (facts.variable) {
    notes.push_back(
        fmt::format("{}: its frames do not follow each other at a constant rate: every sample has the time that the file gives "
                    "its frame (in the mean {:.4g} frames/s)",
                    facts.file, facts.rate));
  }
  if (facts.repeated > 0)
    notes.push_back(fmt::format("{}: {} of the frame before", facts.file,
                                counted(facts.repeated, "frame is an exact copy", "frames are exact copies")));
  return notes;
}

Image read_image(const std::filesystem::path& path) {
  check_media_file(path);
  Image image;
  std::string why;
  image.pixels = video_backend().read_image(path.string(), image.width, image.height, why);
  if (image.empty()) throw RunError(path.string() + ": " + why);
  return image;
}

}  // namespace misfit
