#include "misfit/workflow/measure/moving_object.h"

#include <algorithm>
#include <cstdint>

#include "misfit/jobs/interrupt.h"
#include "misfit/track/survey.h"
#include "misfit/video/video.h"

namespace misfit {
namespace {

constexpr std::size_t most_bytes = 256'000'000, least_samples = 8, most_samples = 32;
constexpr std::size_t first_frames = 16;  // in which the order of fields is looked for
constexpr double most_doubled = 0.15;     // of the frames may show two of it
constexpr double least_part = 0.4;        // of the object's area that a field must show

/// A number that looks random, the same for the same k.
std::size_t scrambled(std::size_t k) {
  constexpr std::uint64_t odd = 0x9E3779B97F4A7C15ULL;
  const std::uint64_t z = (k + 1) * odd;
  return (z ^ (z >> 29U)) * odd >> 33U;
}

/// Frames spread over a video whose length is not known: of every stretch of n frames one, at a random place of it (at equal intervals a
/// swing could be caught at the same places again and again); n is doubled whenever there are too many.
class SpreadFrames {
 public:
  explicit SpreadFrames(std::size_t most) : most_(most) {}
  void offer(std::size_t count, ColourImage&& frame) {
    const std::size_t stretch = count / every_;
    if (count % every_ != scrambled(stretch) % every_) return;
    frames_.push_back(std::move(frame));
    if (frames_.size() <= most_) return;
    every_ *= 2;
    std::size_t kept = 0;
    for (std::size_t k = 0; k < frames_.size(); k += 2, ++kept) {
      const std::size_t one = std::min(k + scrambled(k + every_) % 2, frames_.size() - 1);
      if (one != kept) frames_[kept] = std::move(frames_[one]);
    }
    frames_.resize(kept);
  }
  [[nodiscard]] const std::vector<ColourImage>& frames() const { return frames_; }

 private:
  std::size_t most_, every_ = 1;
  std::vector<ColourImage> frames_;
};

struct Samples {
  std::vector<ColourImage> spread, first;
};

Samples samples_of(const std::filesystem::path& path) {
  Video video(path, Colours::bgr);
  const std::size_t bytes = std::size_t{3} * video.facts().width * video.facts().height;
  SpreadFrames spread(std::clamp(most_bytes / bytes, least_samples, most_samples));
  Samples out;
  std::size_t count = 0;
  while (auto frame = video.next()) {
    stop_if_interrupted();
    if (out.first.size() < first_frames) out.first.push_back(frame->colour);
    spread.offer(count++, std::move(frame->colour));
  }
  out.spread = spread.frames();
  return out;
}

/// The part of a field's foreground that is the object: as large as it, as far as the field shows it.
std::optional<PixelPoint> object_in(const Field& field, const Silhouette& silhouette) {
  const double area = least_part * silhouette.width * silhouette.height / field.row_step;
  const std::vector<Blob> blobs = blobs_of(field.image, area);
  if (blobs.size() != 1) return std::nullopt;
  return PixelPoint{blobs.front().at.column, field.row_of(blobs.front().at.row)};
}

FieldEvidence evidence_in(const std::vector<ColourImage>& frames, const Background& background, const Silhouette& silhouette) {
  std::vector<FieldPair> pairs;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const Image foreground = background.foreground(frames[k]);
    pairs.push_back({static_cast<long>(k), object_in(field_of(foreground, 0), silhouette), object_in(field_of(foreground, 1), silhouette)});
  }
  return field_evidence(pairs);
}

std::optional<Region> in_picture(const std::optional<Region>& r, double shrink) {
  if (!r) return r;
  return Region{r->left / shrink, r->top / shrink, r->right / shrink, r->bottom / shrink};
}

}  // namespace

PixelPoint MovingObject::in_frame(const PixelPoint& at) const {
  const double s = silhouette.shrink;
  return {(at.column + 0.5) * s - 0.5, (at.row + 0.5) * s - 0.5};
}

PixelPoint MovingObject::in_picture(const PixelPoint& at) const {
  const double s = silhouette.shrink;
  return {(at.column + 0.5) / s - 0.5, (at.row + 0.5) / s - 0.5};
}

std::optional<Region> region_of(const VideoStudy& study) {
  if (!study.region) return std::nullopt;
  const auto& r = *study.region;
  return Region{r[0], r[1], r[2], r[3]};
}

std::optional<MovingObject> find_moving_object(const std::filesystem::path& path, const VideoStudy& study, std::string& why) {
  const Samples samples = samples_of(path);
  if (samples.spread.size() < least_samples) {
    why = "the film has too few frames to tell what moves in it from what does not";
    return std::nullopt;
  }
  Background background(samples.spread);
  SilhouetteOptions options{region_of(study), 0};
  auto silhouette = find_silhouette(samples.spread, background, options, why);
  if (!silhouette) return std::nullopt;
  FieldEvidence evidence = evidence_in(samples.first, background, *silhouette);
  if (evidence.order != FieldOrder::progressive && evidence.order != FieldOrder::unknown && silhouette->shrink > 1) {
    options.most_shrink = 1;  // fields are lines of the frame
    silhouette = find_silhouette(samples.spread, background, options, why);
    if (!silhouette) return std::nullopt;
  }
  Survey survey({silhouette->marker, std::nullopt, in_picture(options.region, silhouette->shrink)});
  for (std::size_t k = 0; k < samples.spread.size(); ++k)
    survey.add(background.foreground(samples.spread[k], silhouette->shrink), static_cast<long>(2 * k));
  const auto look = survey.appearance();
  if (!look) {
    why = "what moves never looks alike in two frames";
    return std::nullopt;
  }
  if (survey.doubled() > most_doubled && !study.start && !options.region) {
    why = "two objects of one size move; start = [column, row] or region = [left, top, right, bottom] of [video] chooses one";
    return std::nullopt;
  }
  return MovingObject{std::move(background), *silhouette, *look, evidence, survey.still()};
}

}  // namespace misfit
