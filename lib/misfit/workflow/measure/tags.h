#pragma once

#include <vector>

#include "misfit/data/study.h"
#include "misfit/track/tag.h"

namespace misfit {

/// Cells inside the border of the tags of a dictionary: 4 of "4x4".
[[nodiscard]] int cells_of(const ArucoStudy& study);

/// Every tag of the dictionary that is seen clearly, each once.
[[nodiscard]] std::vector<Tag> tags_in(const Image& image, int cells);

}  // namespace misfit
