#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "misfit/data/image.h"

namespace misfit {

/// Ids that a dictionary has here.
inline constexpr int tag_ids = 100;

/// Cells of the tags inside their black border, as tag_codes.cpp has them. `cells`: 4 to 7, of one side.
[[nodiscard]] const std::array<std::uint64_t, tag_ids>& tag_codes(int cells);

using Corners = std::array<PixelPoint, 4>;

/// A square tag in a picture.
struct Tag {
  int id = 0;
  Corners corners;     ///< of the black square: as the tag stands upright, upper left, upper right, lower right, lower left
  PixelPoint centre;   ///< where its diagonals meet: the middle of the square, however obliquely it is seen
  double sigma = 0.0;  ///< [px] of one coordinate of the centre
};

/// Smallest side [px] of a tag that can be read: two and a half pixels to a cell.
[[nodiscard]] inline double least_tag_side(int cells) { return 2.5 * (cells + 2); }

/// The tag inside of four corners, given clockwise and good to about a pixel. Each side is a line fitted to the places where the grey level
/// passes the middle between those on its two sides; sigma comes from what these lie off the lines (two neighbouring places counted as
/// one), and 0.02 px for what no residual shows. nullopt: a side is not straight or covered, a cell is neither clearly black nor clearly
/// white, the border is not black, or the cells are not exactly those of a tag: a doubtful one is none.
[[nodiscard]] std::optional<Tag> read_tag(const Image& image, const Corners& about, int cells);

}  // namespace misfit
