#include "misfit/workflow/measure/tags.h"

#include <algorithm>
#include <cmath>

#include "misfit/video/module.h"

namespace misfit {

int cells_of(const ArucoStudy& study) { return study.dictionary.front() - '0'; }

std::vector<Tag> tags_in(const Image& image, int cells) {
  constexpr double same = 2.0;  // [px] between what is found of one tag
  std::vector<Tag> out;
  for (const auto& quad : video_backend().dark_quadrilaterals(image.pixels.data(), image.width, image.height, least_tag_side(cells))) {
    Corners about;
    for (std::size_t k = 0; k < 4; ++k) about[k] = {quad[k].x, quad[k].y};
    const auto tag = read_tag(image, about, cells);
    if (!tag) continue;
    const auto known = std::find_if(out.begin(), out.end(), [&](const Tag& t) {
      return t.id == tag->id && std::hypot(t.centre.column - tag->centre.column, t.centre.row - tag->centre.row) < same;
    });
    if (known == out.end()) {
      out.push_back(*tag);
    } else if (tag->sigma < known->sigma) {
      *known = *tag;
    }
  }
  return out;
}

}  // namespace misfit
