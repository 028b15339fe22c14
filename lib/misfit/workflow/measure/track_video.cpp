#include "misfit/workflow/measure/track_video.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "misfit/core/error.h"
#include "misfit/jobs/interrupt.h"
#include "misfit/math/statistics.h"
#include "misfit/track/survey.h"
#include "misfit/track/tracker.h"
#include "misfit/video/video.h"
#include "misfit/workflow/measure/moving_object.h"
#include "misfit/workflow/measure/samples.h"
#include "misfit/workflow/measure/shots.h"
#include "misfit/workflow/measure/track_tag.h"

namespace misfit {
namespace {

constexpr double max_doubled_share = 0.15;
constexpr double outline_error = 0.15;     // [px] an assumption: as large as found in rendered films, where the ground has a texture
constexpr long frames_for_a_ring = 12;     // searched before it is said that there is none
constexpr double least_ring_share = 0.75;  // of them, in which a ring must be found

/// What is followed, and how it was found.
struct MarkerSurvey {
  Appearance look;
  FieldEvidence evidence;
  std::vector<PixelPoint> still;
  std::optional<MovingObject> moving = {};
  std::string chosen = {};  ///< why, where the study leaves the choice

  [[nodiscard]] Colours colours() const { return moving ? Colours::bgr : Colours::grey; }
  [[nodiscard]] double radius() const {
    if (moving) return 0.5 * std::max(moving->silhouette.width, moving->silhouette.height);
    return std::max(look.marker.reach_x(), look.marker.reach_y());
  }
};

void check_frames(const std::filesystem::path& path, const VideoFacts& facts) {
  if (!facts.finished || facts.decoded > 1) return;
  if (facts.decoded == 0)
    throw RunError(fmt::format("{}: not a single frame can be decoded (the file declares {})", path.string(), facts.declared));
  throw RunError(path.string() + ": the video has one frame only: a track needs at least two");
}

MarkerSurvey learn_marker(const std::filesystem::path& path, const VideoStudy& study) {
  Video video(path);
  Survey survey({marker_of(study.marker), study.start, region_of(study)});
  while (const auto frame = video.next()) {
    stop_if_interrupted();
    survey.add(frame->image, frame->number);
    if (survey.enough()) break;
  }
  check_frames(path, video.facts());
  const auto look = survey.appearance();
  if (!look) {
    const std::string what = study.marker.picture ? "the marker of " + study.marker.picture->filename().string()
                                                  : "a " + study.marker.kind + " marker of 8 to 30 px";
    throw RunError(
        fmt::format("{}: {} was found in none of the {} frames searched; is [video] marker right (moving, ring, bright, dark, or a PNG cut "
                    "from a frame)? start = [column, row] or region = [left, top, right, bottom] gives its place",
                    path.string(), what, survey.frames()));
  }
  if (!study.start && !study.region && survey.doubled() > max_doubled_share) {
    throw RunError(fmt::format(
        "{}: in {:.0f} % of the fields searched two moving objects resemble the marker. If there are two, choose one: "
        "[video] "
        "start = [column, row]. If there is one, the frames are blends of two fields (an interlaced video that was blurred or scaled "
        "as a whole), and the original video is needed: the order of the two fields cannot be determined any more",
        path.string(), 100.0 * survey.doubled()));
  }
  return {*look, survey.evidence(), survey.still()};
}

bool begins_with_a_ring(const std::filesystem::path& path, const VideoStudy& study) {
  Video video(path);
  Survey survey({marker_of({"ring", std::nullopt}), study.start, region_of(study)});
  for (long k = 0; k < frames_for_a_ring; ++k) {
    const auto frame = video.next();
    if (!frame) break;
    survey.add(frame->image, frame->number);
  }
  return survey.share() >= least_ring_share;
}

MarkerSurvey survey_of(MovingObject&& object) {
  MarkerSurvey out{object.look, object.evidence, object.still, std::nullopt, {}};
  out.moving = std::move(object);
  return out;
}

MarkerSurvey learn_moving(const std::filesystem::path& path, const VideoStudy& study) {
  std::string why;
  if (auto object = find_moving_object(path, study, why)) return survey_of(std::move(*object));
  throw RunError(path.string() + ": no moving object can be followed: " + why +
                 "; [video] marker names what to look for instead (ring, bright, dark, or a PNG cut from a frame)");
}

/// The study's choice, or ours: a ring where the first frames show one, else what moves before a ground that stands still, else a ring
/// again.
MarkerSurvey learn(const std::filesystem::path& path, const VideoStudy& study) {
  const std::string& kind = study.marker.kind;
  if (kind == "moving") return learn_moving(path, study);
  if (kind != "auto") return learn_marker(path, study);
  std::string why;
  const bool ring = begins_with_a_ring(path, study);
  std::optional<MovingObject> object;
  if (!ring) object = find_moving_object(path, study, why);
  MarkerSurvey out = object ? survey_of(std::move(*object)) : learn_marker(path, study);
  out.chosen = ring         ? "a ring is in the first frames"
               : out.moving ? "no ring is in the first frames, and one object moves before a ground that stands still"
                            : "found later in the video; nothing else can be followed: " + why;
  return out;
}

/// Feeds the fields of all frames, in the order of time.
class Run {
 public:
  Run(const MarkerSurvey& survey, const VideoStudy& study, FieldOrder order, const VideoFacts& facts)
      : survey_(survey),
        tracker_(options(survey, study)),
        order_(order),
        shots_(facts.declared),
        rate_(facts.rate),
        variable_(facts.variable) {}

  void add(Frame frame) {
    const std::size_t first = frame.number * fields();
    while (times_.size() < first) {
      tracker_.add_missing();
      times_.emplace_back();
    }
    const Image followed = survey_.moving ? survey_.moving->picture_of(frame.colour) : Image();
    const Image& picture = survey_.moving ? followed : frame.image;
    if (fields() == 1) {
      add(frame, {{picture, 0, 1}, {frame.image, 0, 1}, frame.time});
      return;
    }
    const int row = order_ == FieldOrder::top_first ? 0 : 1;
    auto later = frame.time;
    if (later) *later += 0.5 / rate_;
    add(frame, {field_of(picture, row), field_of(frame.image, row), frame.time});
    add(frame, {field_of(picture, 1 - row), field_of(frame.image, 1 - row), later});
  }

  [[nodiscard]] std::size_t fields() const { return order_ == FieldOrder::progressive ? 1 : 2; }
  /// All samples, in pixels of the frame.
  std::vector<TrackedSample> finish() {
    std::vector<TrackedSample> samples = tracker_.finish();
    if (!survey_.moving) return samples;
    // An outline before a textured ground is less sure than its fit says; uneven times would look like an error.
    const double white = variable_ ? 0.0 : white_error(samples);
    for (TrackedSample& s : samples) {
      if (s.loss != Loss::none) continue;
      s.at = survey_.moving->in_frame(s.at);
      s.sigma = std::hypot(std::max(s.sigma, white) * survey_.moving->silhouette.shrink, outline_error);
    }
    return samples;
  }
  [[nodiscard]] const std::vector<std::optional<double>>& times() const { return times_; }
  Shots& shots() { return shots_; }

 private:
  struct Lines {
    Field followed, shown;
    std::optional<double> time;  ///< of the file [s]
  };

  static TrackerOptions options(const MarkerSurvey& survey, const VideoStudy& study) {
    TrackerOptions out{survey.look, study.start, region_of(study), survey.still};
    if (!survey.moving) return out;
    if (out.start) out.start = survey.moving->in_picture(*out.start);
    if (!out.region) return out;
    const PixelPoint from = survey.moving->in_picture({out.region->left, out.region->top});
    const PixelPoint to = survey.moving->in_picture({out.region->right, out.region->bottom});
    out.region = Region{from.column, from.row, to.column, to.row};
    return out;
  }

  /// Usual intervals since the sample before.
  [[nodiscard]] double steps(const std::optional<double>& time) const {
    if (!variable_ || !time || times_.empty() || !times_.back()) return 1.0;
    return std::clamp((*time - *times_.back()) * rate_ * static_cast<double>(fields()), 0.1, 1000.0);
  }

  void add(const Frame& frame, const Lines& lines) {
    const TrackedSample& sample = tracker_.add(lines.followed, frame.repeated, steps(lines.time));
    shots_.offer(frame, lines.shown, times_.size(), sample);
    times_.push_back(lines.time);
  }

  const MarkerSurvey& survey_;
  Tracker tracker_;
  FieldOrder order_;
  Shots shots_;
  double rate_;
  bool variable_;
  std::vector<std::optional<double>> times_;  ///< one per sample
};

TrackFacts facts_of(const MarkerSurvey& survey, const VideoFacts& video, FieldOrder order, const std::vector<TrackedSample>& samples) {
  TrackFacts f = facts_of(video, samples);
  f.fields = words(order);
  f.fields_shown = words(survey.evidence.order);
  f.fields_evidence = survey.evidence.text();
  const Marker& marker = survey.look.marker;
  f.marker = survey.moving ? "moving" : name_of(marker.kind);
  f.chosen = survey.chosen;
  if (marker.kind != MarkerKind::picture) f.outer = marker.outer;
  if (survey.moving) f.outer = survey.radius();
  if (marker.kind == MarkerKind::ring) f.inner = marker.inner;
  return f;
}

FieldOrder order_from(const std::string& name) {
  for (FieldOrder order : {FieldOrder::progressive, FieldOrder::top_first, FieldOrder::bottom_first}) {
    if (name == words(order)) return order;
  }
  return FieldOrder::unknown;
}

}  // namespace

Marker marker_of(const MarkerStudy& study) {
  Marker marker;
  if (study.picture) {
    marker.kind = MarkerKind::picture;
    marker.picture = read_image(*study.picture);
    marker.levels = {0.0, 1.0, 0.0};
    if (marker.picture.width < 5 || marker.picture.height < 5)
      throw RunError(study.picture->string() + ": a marker cut from a frame needs at least 5 x 5 pixels");
  } else {
    marker.kind = study.kind == "bright" ? MarkerKind::bright : study.kind == "dark" ? MarkerKind::dark : MarkerKind::ring;
  }
  return marker;
}

FieldOrder choose_fields(const VideoStudy& study, const FieldEvidence& evidence, std::vector<std::string>& warnings) {
  const FieldOrder said = order_from(study.fields), shown = evidence.order;
  if (said == FieldOrder::unknown) {
    if (shown != FieldOrder::unknown) return shown;
    if (evidence.motion < 1.0) return FieldOrder::progressive;
    warnings.push_back("no evidence whether the video is interlaced (" + evidence.text() +
                       "): it is read as progressive; [video] fields sets it");
    return FieldOrder::progressive;
  }
  if (shown == FieldOrder::unknown || shown == said) return said;
  std::string contradiction =
      fmt::format("[video] fields = \"{}\" contradicts the pictures, which show {}: {}", words(said), words(shown), evidence.text());
  if (evidence.decisive && study.check_fields) {
    const double wrong = said == FieldOrder::progressive || shown == FieldOrder::progressive ? 0.25 : 0.5;
    warnings.push_back(
        contradiction +
        fmt::format("; the video is read as {}, since the study's way would put every sample about {:.0f} px wrong. Correct the "
                    "study, or insist with check_fields = false",
                    words(shown), wrong * evidence.motion));
    return shown;
  }
  warnings.push_back(contradiction + "; the setting of the study is used" +
                     (study.check_fields ? ", as the evidence is not conclusive" : ", as check_fields = false asks for"));
  return said;
}

VideoTrack track_video(const std::filesystem::path& path, const VideoStudy& study,
                       const std::function<void(std::size_t, std::size_t)>& progress) {
  if (study.marker.kind == "aruco") return track_tag(path, study, progress);
  const MarkerSurvey survey = learn(path, study);
  std::vector<std::string> warnings;
  const FieldOrder order = choose_fields(study, survey.evidence, warnings);
  Video video(path, survey.colours());
  Run run(survey, study, order, video.facts());
  while (auto frame = video.next()) {
    stop_if_interrupted();
    const std::size_t number = frame->number;
    run.add(std::move(*frame));
    if (progress) progress(number, std::max(video.facts().declared, 1L));
  }
  std::vector<TrackedSample> samples = run.finish();
  const std::vector<double> times = sample_times(run.times(), video.facts(), run.fields(), warnings);
  samples.resize(times.size());
  VideoTrack out;
  out.track = track_of(samples, video.facts(), times);
  out.facts = facts_of(survey, video.facts(), order, samples);
  out.facts.sigma = median(out.track.sigma);
  out.facts.warnings.insert(out.facts.warnings.begin(), warnings.begin(), warnings.end());
  if (out.facts.ok == 0)
    throw RunError(path.string() + ": the marker was seen in some frames, but could not be followed through any three of them");
  out.shots = run.shots().finish(samples, times, survey.radius());
  return out;
}

}  // namespace misfit
