#include "misfit/workflow/measure/track_tag.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "misfit/core/error.h"
#include "misfit/core/text.h"
#include "misfit/jobs/interrupt.h"
#include "misfit/math/statistics.h"
#include "misfit/track/search.h"
#include "misfit/video/video.h"
#include "misfit/workflow/measure/moving_object.h"
#include "misfit/workflow/measure/samples.h"
#include "misfit/workflow/measure/shots.h"
#include "misfit/workflow/measure/tags.h"

namespace misfit {
namespace {

/// The tag's way so far.
class TagWay {
 public:
  TagWay(std::filesystem::path path, const VideoStudy& study)
      : path_(std::move(path)), id_(*study.marker.id), cells_(cells_of(study.aruco)), region_(region_of(study)), last_(study.start) {}

  void add_missing() { samples_.push_back({Loss::no_frame, {}, 0.0, 0.0}); }

  const TrackedSample& add(const Frame& frame) {
    Loss why = Loss::not_found;
    const auto tag = tag_in(frame.image);
    if (tag && is_copy(frame, tag->centre)) why = Loss::copy;
    if (tag && why == Loss::not_found) {
      samples_.push_back({Loss::none, tag->centre, tag->sigma, 1.0});
      last_ = tag->centre;
      sides_.push_back(0.25 * (distance(tag->corners[0], tag->corners[1]) + distance(tag->corners[1], tag->corners[2]) +
                               distance(tag->corners[2], tag->corners[3]) + distance(tag->corners[3], tag->corners[0])));
    } else {
      samples_.push_back({why, {}, 0.0, 0.0});
    }
    return samples_.back();
  }

  [[nodiscard]] std::vector<TrackedSample>& samples() { return samples_; }
  [[nodiscard]] const std::set<int>& others() const { return others_; }
  [[nodiscard]] double radius() const { return sides_.empty() ? 0.0 : 0.5 * median(sides_); }

 private:
  std::optional<Tag> tag_in(const Image& image) {
    std::vector<Tag> found;
    for (const Tag& tag : tags_in(image, cells_)) {
      if (tag.id != id_) {
        others_.insert(tag.id);
      } else if (!region_ || contains(*region_, tag.centre)) {
        found.push_back(tag);
      }
    }
    if (found.empty()) return std::nullopt;
    if (found.size() > 1 && !last_) {
      throw RunError(fmt::format(
          "{}: two tags of id {} are in the picture; start = [column, row] or region = [left, top, right, bottom] of [video] chooses one",
          path_.string(), id_));
    }
    if (found.size() == 1) return found.front();
    return *std::min_element(found.begin(), found.end(),
                             [&](const Tag& a, const Tag& b) { return distance(a.centre, *last_) < distance(b.centre, *last_); });
  }

  /// It stands where it was a frame ago, though the three frames before, of even acceleration, say that it moves: the file shows that frame
  /// again.
  [[nodiscard]] bool is_copy(const Frame& frame, const PixelPoint& at) const {
    constexpr double moves = 1.5, stands = 0.1;  // [px] in a frame; of that
    const std::size_t n = samples_.size();
    if (n < 3) return false;
    const TrackedSample &a = samples_[n - 3], &b = samples_[n - 2], &c = samples_[n - 1];
    if (a.loss != Loss::none || b.loss != Loss::none || c.loss != Loss::none) return false;
    const double speed = std::hypot(2.0 * c.at.column - 3.0 * b.at.column + a.at.column, 2.0 * c.at.row - 3.0 * b.at.row + a.at.row);
    return frame.repeated ? speed > 0.3 : speed > moves && distance(c.at, at) < std::min(0.5, stands * speed);
  }

  std::filesystem::path path_;
  int id_, cells_;
  std::optional<Region> region_;
  std::optional<PixelPoint> last_;
  std::vector<TrackedSample> samples_;
  std::vector<double> sides_;
  std::set<int> others_;
};

std::string nothing_found(const std::filesystem::path& path, const VideoStudy& study, const std::set<int>& others, long frames) {
  std::vector<std::string> ids;
  for (int id : others) ids.push_back(std::to_string(id));
  const std::string seen = ids.empty() ? "no tag of that dictionary is" : "tags of it that are seen: " + join_words(ids);
  return fmt::format(
      "{}: the ArUco tag {} of dictionary {} was read in none of {} frames ({}); is [video.aruco] dictionary right (4x4, 5x5, 6x6, 7x7), "
      "has "
      "the tag a white margin, and is each of its cells 2.5 px or more?",
      path.string(), *study.marker.id, study.aruco.dictionary, frames, seen);
}

}  // namespace

VideoTrack track_tag(const std::filesystem::path& path, const VideoStudy& study,
                     const std::function<void(std::size_t, std::size_t)>& progress) {
  Video video(path);
  TagWay way(path, study);
  Shots shots(video.facts().declared);
  std::vector<std::optional<double>> read;
  while (const auto frame = video.next()) {
    stop_if_interrupted();
    for (; std::ssize(read) < frame->number; read.emplace_back()) way.add_missing();
    const TrackedSample& sample = way.add(*frame);
    shots.offer(*frame, {frame->image, 0, 1}, read.size(), sample);
    read.push_back(frame->time);
    if (progress) progress(static_cast<std::size_t>(frame->number), static_cast<std::size_t>(std::max(video.facts().declared, 1L)));
  }
  if (video.facts().decoded < 2) throw RunError(path.string() + ": a track needs at least two frames");
  std::vector<std::string> warnings;
  const std::vector<double> times = sample_times(read, video.facts(), 1, warnings);
  way.samples().resize(times.size());
  VideoTrack out;
  out.track = track_of(way.samples(), video.facts(), times);
  out.facts = facts_of(video.facts(), way.samples());
  if (out.facts.ok == 0) throw RunError(nothing_found(path, study, way.others(), video.facts().decoded));
  out.facts.fields = out.facts.fields_shown = words(FieldOrder::progressive);
  out.facts.fields_evidence = "a tag is read from whole frames";
  out.facts.marker = fmt::format("ArUco tag {} of {}", *study.marker.id, study.aruco.dictionary);
  out.facts.outer = way.radius();
  out.facts.sigma = median(out.track.sigma);
  out.facts.warnings.insert(out.facts.warnings.begin(), warnings.begin(), warnings.end());
  out.shots = shots.finish(way.samples(), times, way.radius());
  return out;
}

}  // namespace misfit
