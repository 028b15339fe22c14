#include "misfit/video/contact_sheet.h"

#include <algorithm>
#include <cmath>

#include "misfit/core/lists.h"
#include "misfit/video/canvas.h"

namespace misfit {
namespace {

using video_module::Mark;

constexpr int columns = 5, tile_width = 240, gap = 5, zoom_side = 84, caption = 22;  // [px of the sheet]

/// Where a tile stands on the sheet [px of the sheet].
struct Tile {
  int x, y, width, height;
  double scale;  ///< pixels of the sheet per pixel of the frame
  [[nodiscard]] PixelPoint at(const PixelPoint& p) const { return {x + p.column * scale, y + p.row * scale}; }
};

/// Where the magnified cut goes: the corner of the tile farthest from its middle.
PixelPoint zoom_corner(const PixelPoint& middle, const Tile& tile) {
  const bool left = middle.column * tile.scale > 0.5 * tile.width, top = middle.row * tile.scale > 0.5 * tile.height;
  return {1.0 * tile.x + (left ? 0 : tile.width - zoom_side), 1.0 * tile.y + (top ? 0 : tile.height - zoom_side)};
}

void add_frame(const PixelPoint& from, const PixelPoint& to, Colour colour, std::vector<Mark>& marks) {
  marks.push_back(line(from, {to.column, from.row}, colour));
  marks.push_back(line({from.column, to.row}, to, colour));
  marks.push_back(line(from, {from.column, to.row}, colour));
  marks.push_back(line({to.column, from.row}, to, colour));
}

void add_zoom(Canvas& canvas, const Shot& shot, const Tile& tile, std::vector<Mark>& marks) {
  if (!shot.zoom_at) return;
  const PixelPoint from = zoom_corner(*shot.zoom_at, tile), to{from.column + zoom_side, from.row + zoom_side};
  const double part = std::max(4.0 * shot.radius, 24.0), zoom = zoom_side / part;
  const double left = std::round(shot.zoom_at->column - 0.5 * part), top = std::round(shot.zoom_at->row - 0.5 * part);
  canvas.draw({box(from, to, {90, 90, 90})});
  canvas.paste(shot.field, {left, top, part, part}, {static_cast<int>(from.column), static_cast<int>(from.row), zoom});
  add_frame(from, to, shot.lost.empty() ? found_colour : lost_colour, marks);
  for (const PixelPoint& p : shot.at) {
    if (std::abs(p.column - shot.zoom_at->column) < 0.5 * part && std::abs(p.row - shot.zoom_at->row) < 0.5 * part)
      marks.push_back(cross({from.column + (p.column - left + 0.5) * zoom, from.row + (p.row - top + 0.5) * zoom}, 9.0, found_colour));
  }
}

void add_tile(Canvas& canvas, const Shot& shot, const Tile& tile) {
  canvas.paste(shot.field, whole_frame(shot.field), {tile.x, tile.y, tile.scale});
  std::vector<Mark> marks;
  for (std::size_t k = 1; k < shot.trail.size(); ++k)
    marks.push_back(line(tile.at(shot.trail[k - 1]), tile.at(shot.trail[k]), trail_colour));
  for (const PixelPoint& p : shot.at) marks.push_back(circle(tile.at(p), std::max(5.0, shot.radius * tile.scale), found_colour));
  canvas.draw(marks);
  marks.clear();
  add_zoom(canvas, shot, tile, marks);
  const double x = tile.x, y = tile.y + tile.height + caption - 7;
  marks.push_back(text({x + 4, y}, 10.0, shot.label, text_colour));
  if (!shot.lost.empty()) marks.push_back(text({x + 80, y}, 10.0, shot.lost, lost_colour));
  canvas.draw(marks);
}

}  // namespace

void write_contact_sheet(const std::filesystem::path& path, const std::vector<Shot>& shots) {
  if (shots.empty()) return;
  int widest = 1, highest = 1;
  for (const Shot& shot : shots) {
    widest = std::max(widest, shot.field.image.width);
    highest = std::max(highest, shot.field.frame_height());
  }
  const double scale = 1.0 * tile_width / widest;
  const int height = static_cast<int>(std::lround(highest * scale));
  const int rows = (int_size(shots) + columns - 1) / columns, across = std::min(columns, int_size(shots));
  Canvas canvas(gap + across * (tile_width + gap), gap + rows * (height + caption + gap));
  for (int k = 0; k < int_size(shots); ++k) {
    const int i = k % columns, j = k / columns;
    add_tile(canvas, shots[k], {gap + i * (tile_width + gap), gap + j * (height + caption + gap), tile_width, height, scale});
  }
  canvas.write_png(path);
}

}  // namespace misfit
