#include "misfit/video/opencv/patterns.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <new>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace misfit::video_module {
namespace {

/// What `find` returns, nothing where OpenCV fails.
template <class Find>
auto or_none(const Find& find) -> decltype(find()) {
  try {
    return find();
  } catch (const cv::Exception& error) {
    if (error.code == cv::Error::StsNoMem) throw std::bad_alloc();
    return {};
  }
}

/// Clockwise in the picture, whose rows go down.
std::array<Place, 4> clockwise(const std::vector<cv::Point>& corners) {
  std::array<Place, 4> out;
  double area = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    const cv::Point &a = corners[k], &b = corners[(k + 1) % 4];
    area += static_cast<double>(a.x) * b.y - static_cast<double>(b.x) * a.y;
    out[k] = {static_cast<double>(a.x), static_cast<double>(a.y)};
  }
  if (area < 0.0) std::reverse(out.begin(), out.end());
  return out;
}

void add_quadrilaterals(const cv::Mat& dark, double least_side, std::vector<std::array<Place, 4>>& found) {
  constexpr double tolerance = 0.03;  // of the outline's length
  std::vector<std::vector<cv::Point>> outlines;
  cv::findContours(dark, outlines, cv::RETR_LIST, cv::CHAIN_APPROX_NONE);
  std::vector<cv::Point> corners;
  for (const std::vector<cv::Point>& outline : outlines) {
    if (static_cast<double>(outline.size()) < 3.0 * least_side) continue;
    cv::approxPolyDP(outline, corners, tolerance * static_cast<double>(outline.size()), true);
    if (corners.size() != 4 || !cv::isContourConvex(corners)) continue;
    const std::array<Place, 4> quad = clockwise(corners);
    bool large = true;
    for (std::size_t k = 0; k < 4; ++k)
      large = large && std::hypot(quad[k].x - quad[(k + 1) % 4].x, quad[k].y - quad[(k + 1) % 4].y) >= least_side;
    if (large) found.push_back(quad);
  }
}

/// Smallest distance [px] of a corner from the next one in its row or column.
double spacing_of(const std::vector<cv::Point2f>& corners, int columns) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < corners.size(); ++k) {
    for (const std::size_t next : {k + 1, k + static_cast<std::size_t>(columns)})
      if (next < corners.size()) least = std::min(least, cv::norm(corners[next] - corners[k]));
  }
  return least;
}

/// Moves corners to the saddle of a quadratic fitted to the blurred picture. findChessboardCornersSB is off by 0.05 px in one direction and
/// 0.08 px at random even without noise, cornerSubPix by 0.06 px; this by 0.01 px (measured in rendered boards of squares of 20 px, seen
/// obliquely).
void refine(const cv::Mat& grey, std::vector<cv::Point2f>& corners, double spacing) {
  constexpr double blur = 1.5, least_spacing = 10.0, farthest = 1.0;  // [px]
  constexpr int half = 4, side = 2 * half + 1, steps = 5;
  if (spacing < least_spacing) return;
  cv::Mat smooth, patch, terms(side * side, 6, CV_64F);
  grey.convertTo(smooth, CV_32F);
  cv::GaussianBlur(smooth, smooth, cv::Size(), blur);
  for (int k = 0; k < side * side; ++k) {
    const int right = k % side - half, down = k / side - half;
    const double x = right, y = down;
    const std::array<double, 6> row{x * x, x * y, y * y, x, y, 1.0};
    std::copy(row.begin(), row.end(), terms.ptr<double>(k));
  }
  const cv::Mat solve = terms.inv(cv::DECOMP_SVD);
  for (cv::Point2f& corner : corners) {
    cv::Point2d at = corner;
    bool found = true;
    for (int step = 0; step < steps && found; ++step) {
      cv::getRectSubPix(smooth, cv::Size(side, side), cv::Point2f(at), patch);
      cv::Mat levels;
      patch.reshape(1, side * side).convertTo(levels, CV_64F);
      const cv::Mat q = solve * levels;
      const double a = 2.0 * q.at<double>(0), b = q.at<double>(1), c = 2.0 * q.at<double>(2), d = q.at<double>(3), e = q.at<double>(4);
      const double curvature = a * c - b * b;  // negative at a saddle
      found = curvature < 0.0;
      if (found) at += cv::Point2d((b * e - c * d) / curvature, (b * d - a * e) / curvature);
      found = found && cv::norm(at - cv::Point2d(corner)) < farthest;
    }
    if (found) corner = at;
  }
}

}  // namespace

Chessboard chessboard_in(const cv::Mat& grey, int columns, int rows) {
  return or_none([&] {
    Chessboard out;
    std::vector<cv::Point2f> corners;
    cv::Mat cells;
    if (columns == 0) {
      if (!cv::findChessboardCornersSB(grey, cv::Size(3, 3), corners, cv::CALIB_CB_LARGER | cv::CALIB_CB_NORMALIZE_IMAGE, cells))
        return out;
      out = {cells.cols + 1, cells.rows + 1, {}};
    } else {
      const cv::Size inner(columns - 1, rows - 1);
      if (!cv::findChessboardCornersSB(grey, inner, corners, 0) &&
          !cv::findChessboardCornersSB(grey, inner, corners, cv::CALIB_CB_NORMALIZE_IMAGE))
        return out;
      refine(grey, corners, spacing_of(corners, columns - 1));
      out = {columns, rows, {}};
    }
    for (const cv::Point2f& p : corners) out.corners.push_back({p.x, p.y});
    return out;
  });
}

std::vector<std::array<Place, 4>> dark_quadrilaterals_in(const cv::Mat& grey, double least_side) {
  return or_none([&] {
    constexpr std::array<int, 3> windows{11, 25, 61};  // [px] over which light may change
    constexpr double darker = 7.0;                     // [grey levels] than its surroundings
    std::vector<std::array<Place, 4>> out;
    cv::Mat dark;
    for (int window : windows) {
      cv::adaptiveThreshold(grey, dark, 255, cv::ADAPTIVE_THRESH_MEAN_C, cv::THRESH_BINARY_INV, window, darker);
      add_quadrilaterals(dark, least_side, out);
    }
    return out;
  });
}

}  // namespace misfit::video_module
