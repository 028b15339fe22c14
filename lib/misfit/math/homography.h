#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace misfit {

/// From a plane [m] to a picture [px] and back: a homography H, q ~ H (X, Y, 1), and radial distortion of the lens about the picture's
/// middle, p = middle + (q − middle)(1 + k1 |q − middle|²/radius²).
struct PlaneMap {
  Eigen::Matrix3d homography = Eigen::Matrix3d::Identity();
  double k1 = 0.0;
  Eigen::Vector2d middle{0.0, 0.0};
  double radius = 1.0;  ///< [px]

  /// nullopt: behind the camera.
  [[nodiscard]] std::optional<Eigen::Vector2d> pixel(const Eigen::Vector2d& place) const;
  /// nullopt: beyond the horizon of the plane, or where the distortion cannot be undone.
  [[nodiscard]] std::optional<Eigen::Vector2d> place(const Eigen::Vector2d& pixel) const;
  /// Derivative of pixel() by the place [px/m].
  [[nodiscard]] Eigen::Matrix2d slope(const Eigen::Vector2d& place) const;
  /// Standard deviations [m] of both coordinates of a place whose pixel has `sigma` [px] per coordinate.
  [[nodiscard]] Eigen::Vector2d sigmas_at(const Eigen::Vector2d& place, double sigma) const;
};

/// From the unit square to a picture: (0, 0), (1, 0), (1, 1), (0, 1) come to these four corners.
[[nodiscard]] Eigen::Matrix3d homography_of_square(const std::array<Eigen::Vector2d, 4>& corners);

/// One place of the plane [m] and where it is in the picture [px].
struct PlanePoint {
  Eigen::Vector2d place, pixel;
};

/// Do all of these, or all but one, lie on one line (within 1 % of their extent), in the picture or in the plane? Then no homography is
/// determined by them.
[[nodiscard]] bool on_one_line(const std::vector<PlanePoint>& points);

struct PlaneFit {
  PlaneMap map;
  std::vector<double> distances;  ///< [px] of the points from where the map has them
  double rms = 0.0;               ///< of these
  double sigma = 0.0;             ///< [px] per coordinate, by the degrees of freedom; where there are none as it was said
  /// Standard deviation [m] of one coordinate of a place, as the map itself is uncertain (root mean square of both).
  std::function<double(const Eigen::Vector2d& place)> sigma_at;
};

/// The picture whose middle is that of the distortion.
struct PictureSize {
  double width = 0.0, height = 0.0;  ///< [px]
};

/// By least squares of distances in the picture, from the linear solution with normalised coordinates [29]. k1 is free where there
/// are twelve points or more and it explains them better (F test, p < 10⁻³). nullopt with `why`: fewer than four, on one line, no camera
/// sees them so. `pixel_sigma`: of four points, whose residuals are 0; 0: not known.
[[nodiscard]] std::optional<PlaneFit> fit_plane(const std::vector<PlanePoint>& points, const PictureSize& picture, std::string& why,
                                                double pixel_sigma = 0.0);

}  // namespace misfit
