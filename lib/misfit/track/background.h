#pragma once

#include <array>
#include <vector>

#include "misfit/data/image.h"

namespace misfit {

/// How much brighter a frame is than the background, in one channel: a gain per pixel,
/// g = q0 + q1 x + q2 y + q3 x² + q4 x y + q5 y², with x, y from −1 to 1 over the frame.
using LightGain = std::array<double, 6>;

/// What stands still in the frames of a camera that does not move: in every pixel the value that most frames taken from all of the video
/// share, each brought to the same light first. Light and exposure may change: what changes smoothly over the whole frame is no object
/// (gain of second order in x and y per channel, by least squares with Tukey's weights over about 1500 points).
class Background {
 public:
  /// At least five frames of one size. std::logic_error: fewer.
  explicit Background(const std::vector<ColourImage>& samples);

  /// What differs from the background: 0 … 255 over the differences from 2 noises up to half of `contrast`, both summed over the three
  /// channels. `shrink`: every pixel of the picture is the mean of shrink x shrink of the frame (what is left over at its right and bottom
  /// is cut off).
  [[nodiscard]] Image foreground(const ColourImage& frame, int shrink = 1) const;
  /// Differences themselves [grey levels, summed over the channels].
  [[nodiscard]] std::vector<float> differences(const ColourImage& frame) const;
  void set_contrast(double contrast);
  /// Of the difference where nothing moves: its median over all pixels.
  [[nodiscard]] double noise() const;
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }

 private:
  void learn_base(const std::vector<ColourImage>& samples, const std::vector<std::array<LightGain, 3>>& gains);
  void learn_noise(const std::vector<ColourImage>& samples);
  [[nodiscard]] std::array<LightGain, 3> light_of(const ColourImage& frame) const;
  [[nodiscard]] std::vector<float> differences(const ColourImage& frame, const std::array<LightGain, 3>& light) const;

  int width_ = 0, height_ = 0;
  std::vector<float> base_;         ///< three per pixel
  std::vector<float> noise_;        ///< per pixel, of the difference
  std::vector<float> low_, scale_;  ///< per pixel: foreground = scale (difference − low)
};

}  // namespace misfit
