#include "misfit/video/contact_sheet.h"

#include <algorithm>
#include <cmath>

#include "misfit/core/lists.h"
#include "misfit/video/canvas.h"

namespace misfit {
namespace {

using video_module::Mark;

constexpr int columns = 5, tile = 240, gap = 5, zoom_side = 84, caption = 22;  // [px of the sheet]

/// Where the magnified cut goes: x, y of its corner in the tile.
std::pair<int, int> zoom_corner(const Shot& shot, double scale, int width, int height) {
  if (!shot.zoom_at) return {0, 0};
  const bool left = shot.zoom_at->column * scale > 0.5 * width, top = shot.zoom_at->row * scale > 0.5 * height;
  return {left ? 0 : width - zoom_side, top ? 0 : height - zoom_side};
}

void add_zoom(Canvas& canvas, const Shot& shot, int x, int y, double scale, int width, int height, std::vector<Mark>& marks) {
  if (!shot.zoom_at) return;
  const auto [dx, dy] = zoom_corner(shot, scale, width, height);
  const double part = std::max(4.0 * shot.radius, 24.0), zoom = zoom_side / part;
  const double left = std::round(shot.zoom_at->column - 0.5 * part), top = std::round(shot.zoom_at->row - 0.5 * part);
  canvas.draw({box(x + dx, y + dy, x + dx + zoom_side, y + dy + zoom_side, {90, 90, 90})});
  canvas.paste(shot.field, left, top, part, part, x + dx, y + dy, zoom);
  const Colour edge = shot.lost.empty() ? found_colour : lost_colour;
  const double x1 = x + dx + zoom_side, y1 = y + dy + zoom_side;
  marks.push_back(line(x + dx, y + dy, x1, y + dy, edge));
  marks.push_back(line(x + dx, y1, x1, y1, edge));
  marks.push_back(line(x + dx, y + dy, x + dx, y1, edge));
  marks.push_back(line(x1, y + dy, x1, y1, edge));
  for (const PixelPoint& p : shot.at) {
    if (std::abs(p.column - shot.zoom_at->column) < 0.5 * part && std::abs(p.row - shot.zoom_at->row) < 0.5 * part)
      marks.push_back(cross(x + dx + (p.column - left + 0.5) * zoom, y + dy + (p.row - top + 0.5) * zoom, 9.0, found_colour));
  }
}

void add_tile(Canvas& canvas, const Shot& shot, int x, int y, double scale, int width, int height) {
  canvas.paste(shot.field, 0.0, 0.0, shot.field.image.width, shot.field.frame_height(), x, y, scale);
  std::vector<Mark> marks;
  for (std::size_t k = 1; k < shot.trail.size(); ++k) {
    const PixelPoint &a = shot.trail[k - 1], &b = shot.trail[k];
    marks.push_back(line(x + a.column * scale, y + a.row * scale, x + b.column * scale, y + b.row * scale, trail_colour));
  }
  for (const PixelPoint& p : shot.at)
    marks.push_back(circle(x + p.column * scale, y + p.row * scale, std::max(5.0, shot.radius * scale), found_colour));
  canvas.draw(marks);
  marks.clear();
  add_zoom(canvas, shot, x, y, scale, width, height, marks);
  marks.push_back(text(x + 4, y + height + caption - 7, 10.0, shot.label, text_colour));
  if (!shot.lost.empty()) marks.push_back(text(x + 80, y + height + caption - 7, 10.0, shot.lost, lost_colour));
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
  const double scale = 1.0 * tile / widest;
  const int height = static_cast<int>(std::lround(highest * scale));
  const int rows = (int_size(shots) + columns - 1) / columns, across = std::min(columns, int_size(shots));
  Canvas canvas(gap + across * (tile + gap), gap + rows * (height + caption + gap));
  for (int k = 0; k < int_size(shots); ++k) {
    const int i = k % columns, j = k / columns;
    add_tile(canvas, shots[k], gap + i * (tile + gap), gap + j * (height + caption + gap), scale, tile, height);
  }
  canvas.write_png(path);
}

}  // namespace misfit
