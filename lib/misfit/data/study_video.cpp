// [video] of a study, and the pictures of the sweep.

#include <algorithm>
#include <cctype>

#include "misfit/data/study_parts.h"

namespace misfit::study_parts {
namespace {

using config::DescribedSection;
using config::Section;

void read_marker(const DescribedSection& section, std::string_view key, const Study& study, MarkerStudy& marker) {
  const auto name = section.text(key);
  if (!name) return;
  if (name->ends_with(".png")) {
    marker.picture = existing_file(section, key, study.folder);
    marker.kind = "picture";
  } else {
    marker.picture.reset();
    marker.kind = *section.choice(key);
  }
}

std::optional<std::vector<double>> pixels(const DescribedSection& section, std::string_view key, std::size_t count, const char* form) {
  auto values = section.numbers(key);
  if (values && values->size() != count) section.fail(key, std::string(form) + " is expected, in pixels of the frame");
  return values;
}

/// A known length and its ends; the keys' table says that neither comes alone.
void read_length(const DescribedSection& video, VideoStudy& v) {
  const auto length = video.number("length");
  if (const auto ends = pixels(video, "length_ends", 4, "[column, row, column, row]")) {
    if (!length) video.fail("length_ends", "the length between them is not given: length = \"0.2 m\"");
    if (!(length->value > 0.0)) video.fail("length", "a length above 0 m is expected");
    const PixelPoint from{(*ends)[0], (*ends)[1]}, to{(*ends)[2], (*ends)[3]};
    if (from.column == to.column && from.row == to.row) video.fail("length_ends", "two different places are expected");
    v.length = KnownLength{from, to, length->value};
  } else if (length) {
    video.fail("length", "its ends in the picture are not given: length_ends = [column, row, column, row]");
  }
  if (const auto origin = pixels(video, "origin", 2, "[column, row]")) v.origin = PixelPoint{(*origin)[0], (*origin)[1]};
}

/// What is followed and where it is looked for: of [video], or of one of its markers.
template <class Followed>
void read_followed(const DescribedSection& section, const Study& study, Followed& followed) {
  read_marker(section, "marker", study, followed.marker);
  if (const auto start = pixels(section, "start", 2, "[column, row]")) followed.start = PixelPoint{(*start)[0], (*start)[1]};
  if (const auto r = pixels(section, "region", 4, "[left, top, right, bottom]")) {
    if (!((*r)[0] < (*r)[2]) || !((*r)[1] < (*r)[3])) section.fail("region", "left must be below right, and top below bottom");
    followed.region = {(*r)[0], (*r)[1], (*r)[2], (*r)[3]};
  }
}

void read_markers(const DescribedSection& video, Study& study) {
  const auto markers = video.table("markers");
  if (!markers) return;
  for (const std::string& name : markers->keys()) {
    const bool plain = std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
    if (!plain || name.empty())
      markers->fail(name, "the name of a marker has letters, digits and '_': it is part of those of its channels");
    const DescribedSection section = described(*markers, name, "video.markers.NAME");
    NamedMarker marker{name, study.video.marker, {}, {}};
    read_followed(section, study, marker);
    section.finish();
    study.video.markers.push_back(std::move(marker));
  }
  markers->finish();
  for (const char* key : {"start", "region"}) {
    if (video.has(key) && !study.video.markers.empty()) video.fail(key, "with [video.markers] each marker has its own " + std::string(key));
  }
}

}  // namespace

void read_video(const Section& root, Study& study) {
  const DescribedSection video = described(root, "video");
  VideoStudy& v = study.video;
  v.fields = *video.choice("fields");
  v.check_fields = *video.flag("check_fields");
  read_followed(video, study, v);
  read_markers(video, study);
  read_length(video, v);
  video.finish();
}

void read_sweep_images(const DescribedSection& camera, Study& study) {
  CameraStudy& c = study.camera;
  c.sweep_images = existing_file(camera, "sweep_images", study.folder);
  c.sweep_marker = study.video.marker;
  read_marker(camera, "sweep_marker", study, c.sweep_marker);
  if (const auto p = pixels(camera, "sweep_points", 6, "[column, row, column, row, column, row]")) {
    for (std::size_t k = 0; k < 6; k += 2) c.sweep_points.push_back({(*p)[k], (*p)[k + 1]});
  }
}

}  // namespace misfit::study_parts
