#include "misfit/workflow/measure/plane_patterns.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "misfit/core/error.h"
#include "misfit/core/text.h"
#include "misfit/jobs/interrupt.h"
#include "misfit/math/statistics.h"
#include "misfit/video/module.h"
#include "misfit/video/video.h"
#include "misfit/workflow/measure/tags.h"

namespace misfit {
namespace {

using Eigen::Vector2d;
using Sighting = std::vector<Vector2d>;  ///< places in one frame, always in the same order

constexpr long frames_searched = 16;
constexpr double corner_error = 0.1;  // [px] of a tag: an assumption, as large as found in rendered films
constexpr double stands_still = 1.0;  // [px] median of what a frame may differ

/// About so many frames spread over the film; how many were looked at.
std::size_t look_at_frames(const std::filesystem::path& path, PictureSize& picture, const std::function<void(const Image&)>& look) {
  constexpr long where_unknown = 10;  // every so many frames, where the file does not say how many it has
  Video video(path);
  picture = {static_cast<double>(video.facts().width), static_cast<double>(video.facts().height)};
  const long declared = video.facts().declared, every = declared > 0 ? std::max(1L, declared / frames_searched) : where_unknown;
  std::size_t looked = 0;
  for (long k = 0; looked < static_cast<std::size_t>(2 * frames_searched); ++k) {
    const auto frame = video.next();
    if (!frame) break;
    stop_if_interrupted();
    if (k % every != every / 2) continue;
    look(frame->image);
    ++looked;
  }
  return looked;
}

/// Each place in the median of the frames: what covers a corner in one of them has no say.
Sighting middle_of(const std::vector<Sighting>& seen) {
  Sighting middle = seen.front();
  for (std::size_t k = 0; k < middle.size(); ++k) {
    for (int i = 0; i < 2; ++i) {
      std::vector<double> values;
      for (const Sighting& s : seen) values.push_back(s[k](i));
      middle[k](i) = median(values);
    }
  }
  return middle;
}

/// The places without the frames in which they are elsewhere. RunError where these are half of them or more.
Sighting still_places(const std::vector<Sighting>& seen, const std::string& what, const std::filesystem::path& path, KnownPlaces& out) {
  const Sighting middle = middle_of(seen);
  std::vector<Sighting> kept;
  double farthest = 0.0;
  for (const Sighting& s : seen) {
    std::vector<double> distances;
    for (std::size_t k = 0; k < s.size(); ++k) distances.push_back((s[k] - middle[k]).norm());
    farthest = std::max(farthest, median(distances));
    if (median(distances) <= stands_still) kept.push_back(s);
  }
  out.frames = kept.size();
  const std::string moves = fmt::format("{} stands elsewhere in {} of {} frames in which it is seen, by up to {:.1f} px", what,
                                        seen.size() - kept.size(), seen.size(), farthest);
  if (2 * kept.size() <= seen.size())
    throw RunError(path.string() + ": " + moves +
                   ": it must stand still in the picture, in the plane of the motion, and so must the camera");
  if (kept.size() < seen.size()) out.warnings.push_back(moves + "; these frames are not used");
  return middle_of(kept);
}

/// The inner corners of a board, corner (i, j) at i + columns * j.
struct Corners2d {
  int columns = 0, rows = 0;
  Sighting at;

  [[nodiscard]] const Vector2d& operator()(int i, int j) const { return at[static_cast<std::size_t>(i + columns * j)]; }
};

/// Numbered from another of the board's corners: 0 to 3; with 4 added rows are columns.
Corners2d renumbered(const Corners2d& c, int way) {
  const bool turned = (way & 4) != 0, right = (way & 1) != 0, down = (way & 2) != 0;
  Corners2d out{turned ? c.rows : c.columns, turned ? c.columns : c.rows, {}};
  for (int j = 0; j < out.rows; ++j) {
    for (int i = 0; i < out.columns; ++i) {
      const int a = turned ? j : i, b = turned ? i : j;
      out.at.push_back(c(right ? c.columns - 1 - a : a, down ? c.rows - 1 - b : b));
    }
  }
  return out;
}

/// As the first sighting numbers them: a board does not say where it begins.
Corners2d as_first(const Corners2d& c, const Corners2d& first) {
  Corners2d best = c;
  double least = std::numeric_limits<double>::infinity();
  for (int way = 0; way < 8; ++way) {
    Corners2d other = renumbered(c, way);
    if (other.columns != first.columns || other.rows != first.rows) continue;
    double sum = 0.0;
    for (std::size_t k = 0; k < other.at.size(); ++k) sum += (other.at[k] - first.at[k]).squaredNorm();
    if (sum < least) {
      least = sum;
      best = std::move(other);
    }
  }
  return best;
}

/// Columns to the right in the picture, rows upwards.
Corners2d upright(const Corners2d& c) {
  Corners2d best = c;
  double most = -2.0;
  for (int way = 0; way < 8; ++way) {
    Corners2d other = renumbered(c, way);
    const Vector2d along = other(other.columns - 1, 0) + other(other.columns - 1, other.rows - 1) - other(0, 0) - other(0, other.rows - 1);
    const Vector2d up = other(0, other.rows - 1) + other(other.columns - 1, other.rows - 1) - other(0, 0) - other(other.columns - 1, 0);
    const bool seen_from_the_front = along.x() * up.y() - along.y() * up.x() < 0.0;  // rows of the picture go down
    if (!seen_from_the_front || along.normalized().x() <= most) continue;
    most = along.normalized().x();
    best = std::move(other);
  }
  return best;
}

/// Around every corner, two quarters are bright and two dark, and so the other way round at its neighbours: what covers a part of a board
/// has no such corners, though OpenCV may put some there.
bool alternates(const Image& image, const Corners2d& c) {
  constexpr double least_share = 0.5;  // of the usual contrast
  std::vector<double> contrasts;
  for (int j = 0; j < c.rows; ++j) {
    for (int i = 0; i < c.columns; ++i) {
      const int a = std::min(i, c.columns - 2), b = std::min(j, c.rows - 2);
      const Vector2d along = 0.25 * (c(a + 1, j) - c(a, j)), across = 0.25 * (c(i, b + 1) - c(i, b));
      double contrast = 0.0;
      for (const auto& [u, v] : {std::pair{1, 1}, {1, -1}, {-1, -1}, {-1, 1}}) {
        const Vector2d at = c(i, j) + u * along + v * across;
        const auto column = std::lround(at.x()), row = std::lround(at.y());
        if (column < 0 || row < 0 || column >= image.width || row >= image.height) return false;
        contrast += 0.5 * u * v * image(static_cast<int>(column), static_cast<int>(row));
      }
      contrasts.push_back((i + j) % 2 == 0 ? contrast : -contrast);
    }
  }
  const double usual = median(contrasts);
  return std::all_of(contrasts.begin(), contrasts.end(), [&](double one) { return one / usual > least_share; });
}

/// nullopt: none of that size (0 x 0: of any) is seen.
std::optional<Corners2d> board_in(const Image& image, int columns, int rows) {
  const auto board = video_backend().chessboard(image.pixels.data(), image.width, image.height, columns, rows);
  if (board.corners.empty()) return std::nullopt;
  Corners2d out{board.columns - 1, board.rows - 1, {}};
  for (const auto& p : board.corners) out.at.emplace_back(p.x, p.y);
  if (!alternates(image, out)) return std::nullopt;
  return out;
}

std::string no_board(const std::filesystem::path& path, const ChessboardStudy& board, std::size_t looked, const Corners2d& other) {
  const std::string seen =
      other.at.empty() ? "" : fmt::format("; the largest part of one that is seen has {} x {} squares", other.columns + 1, other.rows + 1);
  return fmt::format(
      "{}: in none of {} frames a chessboard of just {} x {} squares is seen whole{}. Are columns and rows of [video.chessboard] counted "
      "in "
      "squares, and is the whole board in the picture in some frames, not hidden by what moves?",
      path.string(), looked, board.columns, board.rows, seen);
}

}  // namespace

KnownPlaces chessboard_places(const std::filesystem::path& path, const ChessboardStudy& board) {
  KnownPlaces out;
  std::vector<Corners2d> seen;
  Corners2d largest;
  const std::size_t looked = look_at_frames(path, out.picture, [&](const Image& image) {
    if (const auto found = board_in(image, board.columns, board.rows)) {
      seen.push_back(seen.empty() ? *found : as_first(*found, seen.front()));
    } else if (const auto other = board_in(image, 0, 0); other && other->at.size() > largest.at.size()) {
      largest = *other;
    }
  });
  // A larger board of which some columns are covered in a frame looks as if it were of the size asked for.
  if (seen.empty() || largest.at.size() > seen.front().at.size()) throw RunError(no_board(path, board, looked, largest));
  std::vector<Sighting> places;
  for (Corners2d& c : seen) places.push_back(std::move(c.at));
  const Corners2d inner = upright({board.columns - 1, board.rows - 1, still_places(places, "the chessboard", path, out)});
  for (int j = 0; j < inner.rows; ++j) {
    for (int i = 0; i < inner.columns; ++i) out.points.push_back({board.square * Vector2d(i, j), inner(i, j)});
  }
  return out;
}

namespace {

/// Centre and corners of every tag wanted, in the median of the frames in which it is seen.
std::map<int, Sighting> still_tags(const std::filesystem::path& path, const std::vector<int>& wanted, int cells, KnownPlaces& out) {
  std::map<int, std::vector<Sighting>> seen;
  const std::size_t looked = look_at_frames(path, out.picture, [&](const Image& image) {
    std::map<int, Sighting> here;
    for (const Tag& tag : tags_in(image, cells)) {
      Sighting s{{tag.centre.column, tag.centre.row}};
      for (const PixelPoint& c : tag.corners) s.emplace_back(c.column, c.row);
      if (!here.emplace(tag.id, s).second)
        throw RunError(
            fmt::format("{}: two tags of id {} are in the picture, and nothing says which one gives places", path.string(), tag.id));
    }
    for (const auto& [id, s] : here) seen[id].push_back(s);
  });
  std::map<int, Sighting> places;
  std::size_t fewest = looked;
  for (int id : wanted) {
    std::vector<std::string> others;
    for (const auto& [other, s] : seen) others.push_back(std::to_string(other));
    if (!seen.contains(id))
      throw RunError(fmt::format("{}: the ArUco tag {}, which gives places in metres, is read in none of {} frames; {}", path.string(), id,
                                 looked, others.empty() ? "no tag of that dictionary is" : "seen are " + join_words(others)));
    out.frames = 0;
    places[id] = still_places(seen[id], fmt::format("the ArUco tag {}", id), path, out);
    fewest = std::min(fewest, out.frames);
  }
  out.frames = fewest;
  return places;
}

}  // namespace

KnownPlaces tag_places(const std::filesystem::path& path, const ArucoStudy& study) {
  KnownPlaces out;
  const int id = study.plane.value();
  const Sighting tag = still_tags(path, {id}, cells_of(study), out).at(id);
  const double half = 0.5 * study.side.value();
  out.sigma = corner_error;
  const std::array<Vector2d, 4> places{Vector2d(-half, half), Vector2d(half, half), Vector2d(half, -half), Vector2d(-half, -half)};
  for (std::size_t k = 0; k < 4; ++k) out.points.push_back({places[k], tag[k + 1]});
  return out;
}

KnownPlaces point_places(const std::filesystem::path& path, const VideoStudy& study) {
  KnownPlaces out;
  std::vector<int> wanted;
  for (const KnownPoint& p : study.points) {
    if (p.tag) wanted.push_back(*p.tag);
  }
  std::map<int, Sighting> tags;
  if (wanted.empty()) {
    const Video video(path);
    out.picture = {static_cast<double>(video.facts().width), static_cast<double>(video.facts().height)};
  } else {
    tags = still_tags(path, wanted, cells_of(study.aruco), out);
  }
  for (const KnownPoint& p : study.points) {
    const Vector2d at = p.tag ? tags.at(*p.tag).front() : Vector2d(p.at->column, p.at->row);
    out.points.push_back({{p.x, p.y}, at});
    out.names.push_back(p.name);
  }
  return out;
}

}  // namespace misfit
