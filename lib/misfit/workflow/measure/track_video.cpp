#include "misfit/workflow/measure/track_video.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "misfit/core/error.h"
#include "misfit/jobs/interrupt.h"
#include "misfit/math/statistics.h"
#include "misfit/track/survey.h"
#include "misfit/track/tracker.h"
#include "misfit/video/video.h"

namespace misfit {
namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();
constexpr double max_doubled_share = 0.15;
constexpr long regular_shots = 15;
constexpr std::size_t lost_shots = 5, trail_length = 40;

std::optional<Region> region_of(const VideoStudy& study) {
  if (!study.region) return std::nullopt;
  const auto& r = *study.region;
  return Region{r[0], r[1], r[2], r[3]};
}

struct MarkerSurvey {
  Appearance look;
  FieldEvidence evidence;
  std::vector<PixelPoint> still;
};

void check_frames(const std::filesystem::path& path, const VideoFacts& facts) {
  if (!facts.finished || facts.decoded > 1) return;
  if (facts.decoded == 0)
    throw RunError(fmt::format("{}: not a single frame can be decoded (the file declares {})", path.string(), facts.declared));
  throw RunError(path.string() + ": the video has one frame only: a track needs at least two");
}

MarkerSurvey learn(const std::filesystem::path& path, const VideoStudy& study) {
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
        fmt::format("{}: {} was found in none of the {} frames searched; is [video] marker right (ring, bright, dark, or a PNG cut from a "
                    "frame)? start = [column, row] or region = [left, top, right, bottom] gives its place",
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

/// Collects what the contact sheet will show.
class Shots {
 public:
  explicit Shots(long declared) : every_(declared / regular_shots + 1) {}

  void offer(const Frame& frame, const Field& field, std::size_t sample, const TrackedSample& found) {
    const bool lost = found.loss != Loss::none;
    const bool begins = lost && !was_lost_ && lost_ < lost_shots;
    was_lost_ = lost;
    const bool due = frame.number >= next_ && field_before_ != frame.number;
    field_before_ = frame.number;
    if (!due && !begins) return;
    if (due) next_ = frame.number - frame.number % every_ + every_;
    if (begins && !due) ++lost_;
    shots_.push_back({field, 0.0, {}, {}, 0.0, {}, {}, {}});
    samples_.push_back(sample);
    if (std::ssize(shots_) > 4 * regular_shots) halve();  // the container did not declare how many there are
  }

  std::vector<Shot> finish(const std::vector<TrackedSample>& track, double rate, double radius) {
    for (std::size_t k = 0; k < shots_.size(); ++k) {
      shots_[k].t = static_cast<double>(samples_[k]) / rate;
      shots_[k].radius = radius;
      complete(shots_[k], track, samples_[k]);
    }
    return std::move(shots_);
  }

 private:
  void halve() {
    every_ *= 2;
    std::size_t kept = 0;
    for (std::size_t k = 0; k < shots_.size(); k += 2, ++kept) {
      shots_[kept] = std::move(shots_[k]);
      samples_[kept] = samples_[k];
    }
    shots_.resize(kept);
    samples_.resize(kept);
  }

  static void complete(Shot& shot, const std::vector<TrackedSample>& track, std::size_t sample) {
    shot.label = fmt::format("{:.2f} s", shot.t);
    for (std::size_t k = sample > trail_length ? sample - trail_length : 0; k <= sample; ++k) {
      if (track[k].loss == Loss::none) shot.trail.push_back(track[k].at);
    }
    if (!shot.trail.empty()) shot.zoom_at = shot.trail.back();
    if (track[sample].loss == Loss::none) {
      shot.at = {track[sample].at};
    } else {
      shot.lost = "lost: " + words(track[sample].loss);
    }
  }

  long every_, next_ = 0, field_before_ = -1;
  std::size_t lost_ = 0;
  bool was_lost_ = false;
  std::vector<Shot> shots_;
  std::vector<std::size_t> samples_;
};

/// Feeds the fields of all frames, in the order of time.
class Run {
 public:
  Run(const MarkerSurvey& survey, const VideoStudy& study, FieldOrder order, long declared)
      : tracker_({survey.look, study.start, region_of(study), survey.still}), order_(order), shots_(declared) {}

  void add(Frame frame) {
    const std::size_t first = frame.number * fields();
    while (samples_ < first) {
      tracker_.add_missing();
      ++samples_;
    }
    if (fields() == 1) {
      add(frame, {std::move(frame.image), 0, 1});
      return;
    }
    const int first_row = order_ == FieldOrder::top_first ? 0 : 1;
    add(frame, field_of(frame.image, first_row));
    add(frame, field_of(frame.image, 1 - first_row));
  }

  [[nodiscard]] std::size_t fields() const { return order_ == FieldOrder::progressive ? 1 : 2; }
  std::vector<TrackedSample> finish() { return tracker_.finish(); }
  Shots& shots() { return shots_; }

 private:
  void add(const Frame& frame, const Field& field) {
    const TrackedSample& sample = tracker_.add(field, frame.repeated);
    shots_.offer(frame, field, samples_, sample);
    ++samples_;
  }

  Tracker tracker_;
  FieldOrder order_;
  Shots shots_;
  std::size_t samples_ = 0;
};

Track track_of(const std::vector<TrackedSample>& samples, const VideoFacts& facts, double rate) {
  Track track;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const TrackedSample& s = samples[k];
    const bool ok = s.loss == Loss::none;
    track.t.push_back(static_cast<double>(k) / rate);
    track.P_y.push_back(ok ? 0.5 * facts.width - s.at.column : missing);
    track.P_z.push_back(ok ? s.at.row - 0.5 * facts.height : missing);
    track.sigma.push_back(ok ? s.sigma : missing);
    track.ok.push_back(ok);
  }
  return track;
}

TrackFacts facts_of(const MarkerSurvey& survey, const VideoFacts& video, FieldOrder order, const std::vector<TrackedSample>& samples) {
  TrackFacts f;
  f.video = video.file;
  f.width = video.width;
  f.height = video.height;
  f.rate = video.rate;
  f.declared = video.declared;
  f.decoded = video.decoded;
  f.missing = video.missing;
  f.repeated = video.repeated;
  f.fields = words(order);
  f.fields_shown = words(survey.evidence.order);
  f.fields_evidence = survey.evidence.text();
  const Marker& marker = survey.look.marker;
  f.marker = name_of(marker.kind);
  if (marker.kind != MarkerKind::picture) f.outer = marker.outer;
  if (marker.kind == MarkerKind::ring) f.inner = marker.inner;
  f.samples = samples.size();
  for (const TrackedSample& s : samples) {
    if (s.loss == Loss::none) {
      ++f.ok;
    } else {
      ++f.lost[words(s.loss)];
    }
  }
  const auto notes = notes_of(video);
  f.warnings.insert(f.warnings.end(), notes.begin(), notes.end());
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
  const MarkerSurvey survey = learn(path, study);
  std::vector<std::string> warnings;
  const FieldOrder order = choose_fields(study, survey.evidence, warnings);
  Video video(path);
  Run run(survey, study, order, video.facts().declared);
  while (auto frame = video.next()) {
    stop_if_interrupted();
    const std::size_t number = frame->number;
    run.add(std::move(*frame));
    if (progress) progress(number, std::max(video.facts().declared, 1L));
  }
  const std::vector<TrackedSample> samples = run.finish();
  const double rate = video.facts().rate * static_cast<double>(run.fields());
  VideoTrack out;
  out.track = track_of(samples, video.facts(), rate);
  out.facts = facts_of(survey, video.facts(), order, samples);
  out.facts.sigma = median(out.track.sigma);
  out.facts.warnings.insert(out.facts.warnings.begin(), warnings.begin(), warnings.end());
  if (out.facts.ok == 0)
    throw RunError(path.string() + ": the marker was seen in some frames, but could not be followed through any three of them");
  out.shots = run.shots().finish(samples, rate, std::max(survey.look.marker.reach_x(), survey.look.marker.reach_y()));
  return out;
}

}  // namespace misfit
