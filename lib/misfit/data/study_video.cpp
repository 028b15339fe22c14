// [video] of a study, and the pictures of the sweep.

#include <algorithm>
#include <cctype>

#include "misfit/data/study_parts.h"
#include "misfit/math/homography.h"

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
  if (const auto id = section.integer("id")) followed.marker.id = static_cast<int>(*id);
  if (const auto start = pixels(section, "start", 2, "[column, row]")) followed.start = PixelPoint{(*start)[0], (*start)[1]};
  if (const auto r = pixels(section, "region", 4, "[left, top, right, bottom]")) {
    if (!((*r)[0] < (*r)[2]) || !((*r)[1] < (*r)[3])) section.fail("region", "left must be below right, and top below bottom");
    followed.region = {(*r)[0], (*r)[1], (*r)[2], (*r)[3]};
  }
}

/// What a tag needs, known when all of [video] has been read: of several markers it may stand in the table above.
void check_tag(const DescribedSection& section, const VideoStudy& video, const MarkerStudy& marker) {
  if (marker.kind != "aruco") {
    if (section.has("id")) section.fail("id", "only marker = \"aruco\" has an id");
    return;
  }
  if (!marker.id) section.fail("marker", "marker = \"aruco\" needs the id of the tag to follow, as id = 7");
  if (video.fields == "top_first" || video.fields == "bottom_first")
    section.fail("marker", "a tag is read from whole frames: fields = \"" + video.fields + "\" is not possible with it");
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
    check_tag(section, study.video, marker.marker);
    section.finish();
    study.video.markers.push_back(std::move(marker));
  }
  markers->finish();
  for (const char* key : {"start", "region"}) {
    if (video.has(key) && !study.video.markers.empty()) video.fail(key, "with [video.markers] each marker has its own " + std::string(key));
  }
}

void read_chessboard(const DescribedSection& video, VideoStudy& v) {
  if (!video.has("chessboard")) return;
  const DescribedSection board = described(video, "chessboard", "video.chessboard");
  const auto columns = board.integer("columns"), rows = board.integer("rows");
  const auto square = board.value("square");
  for (const char* key : {"columns", "rows", "square"}) {
    if (!board.has(key)) board.fail(key, "it is needed: columns and rows of squares, and the square's side, as square = \"30 mm\"");
  }
  v.chessboard = ChessboardStudy{static_cast<int>(*columns), static_cast<int>(*rows), *square};
  board.finish();
}

KnownPoint known_point(const DescribedSection& section, const std::string& name) {
  KnownPoint out;
  out.name = name;
  if (const auto at = pixels(section, "pixel", 2, "[column, row]")) out.at = PixelPoint{(*at)[0], (*at)[1]};
  if (const auto tag = section.integer("tag")) out.tag = static_cast<int>(*tag);
  const auto place = section.numbers("place");
  if (out.at.has_value() == out.tag.has_value()) section.fail("pixel", "either pixel = [column, row] or tag = ID is expected");
  if (!place || place->size() != 2) section.fail("place", "[x, y] is expected, in metres, as [\"0 m\", \"250 mm\"]");
  out.x = (*place)[0];
  out.y = (*place)[1];
  section.finish();
  return out;
}

void read_points(const DescribedSection& video, VideoStudy& v) {
  const auto points = video.table("points");
  if (!points) return;
  for (const std::string& name : points->keys()) v.points.push_back(known_point(described(*points, name, "video.points.NAME"), name));
  points->finish();
  constexpr std::size_t least = 4;
  if (v.points.size() < least) video.fail("points", "four points at least are needed to know a plane");
  std::vector<PlanePoint> given;
  for (const KnownPoint& p : v.points) {
    if (p.at) given.push_back({{p.x, p.y}, {p.at->column, p.at->row}});
  }
  if (given.size() == v.points.size() && on_one_line(given))
    video.fail("points", "all of the points, or all but one, lie on one line, and no map of a plane is known by these");
}

void read_aruco(const DescribedSection& video, VideoStudy& v) {
  const DescribedSection aruco = described(video, "aruco", "video.aruco");
  v.aruco.dictionary = *aruco.choice("dictionary");
  if (const auto plane = aruco.integer("plane")) v.aruco.plane = static_cast<int>(*plane);
  v.aruco.side = aruco.value("side");
  aruco.finish();
}

/// Places in metres have one source.
void check_sources(const DescribedSection& video, const VideoStudy& v) {
  std::vector<std::string> sources;
  if (v.length) sources.emplace_back("length");
  if (v.chessboard) sources.emplace_back("chessboard");
  if (!v.points.empty()) sources.emplace_back("points");
  if (v.aruco.plane) sources.emplace_back("aruco");
  if (sources.size() > 1)
    video.fail(sources.back(),
               "places in metres come from one of length, chessboard, points and aruco.plane; here also from " + sources.front());
  if (v.origin && !v.points.empty()) video.fail("origin", "the points say where x_m and y_m are 0");
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
  read_chessboard(video, v);
  read_points(video, v);
  read_aruco(video, v);
  check_sources(video, v);
  if (v.markers.empty()) check_tag(video, v, v.marker);
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
