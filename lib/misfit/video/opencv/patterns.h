#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <vector>

#include "misfit/video/backend.h"

/// Known patterns in a grey picture, as backend.h says of them. No exception: a picture that OpenCV cannot treat shows none.
namespace misfit::video_module {

[[nodiscard]] Chessboard chessboard_in(const cv::Mat& grey, int columns, int rows);
[[nodiscard]] std::vector<std::array<Place, 4>> dark_quadrilaterals_in(const cv::Mat& grey, double least_side);

}  // namespace misfit::video_module
