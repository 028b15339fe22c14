#include "misfit/track/background.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "misfit/math/statistics.h"

namespace misfit {
namespace {

constexpr std::size_t min_samples = 5;
constexpr double light_points = 700.0;   // of the frame, where the light is compared
constexpr float darkest = 8.0F;          // [grey levels] where a gain still shows
constexpr std::uint8_t brightest = 250;  // beyond, the sensor is saturated
constexpr float least_noise = 3.0F;      // [grey levels over three channels] rounding and compression
constexpr double quantile = 0.4;         // of the differences in a pixel: what moves may be there in more than half of the frames' rest
constexpr LightGain same_light{1.0, 0.0, 0.0, 0.0, 0.0, 0.0};

using Terms = Eigen::Matrix<double, 6, 1>;

Terms terms(double x, double y) {
  Terms t;
  t << 1.0, x, y, x * x, x * y, y * y;
  return t;
}

/// A place where frame and background are compared: its terms times the background, and the frame.
struct LightPoint {
  Terms row;
  double grey = 0.0;
};

double relative(int i, int n) { return n > 1 ? 2.0 * i / (n - 1) - 1.0 : 0.0; }

double robust_scale(std::vector<double> sizes) { return std::max(1.4826 * median(std::move(sizes)), 0.7); }

/// Tukey's weight, c = 4.7 robust standard deviations.
double weight_of(double residual, double scale) {
  const double u = residual / (4.7 * scale);
  return std::abs(u) < 1.0 ? (1.0 - u * u) * (1.0 - u * u) : 0.0;
}

LightGain fitted_gain(const std::vector<LightPoint>& points) {
  if (points.size() < 60) return same_light;
  std::vector<double> ratios, sizes(points.size());
  for (const LightPoint& p : points) ratios.push_back(p.grey / p.row(0));
  Terms q = Terms::Zero();
  q(0) = median(ratios);
  for (int pass = 0; pass < 4; ++pass) {
    for (std::size_t k = 0; k < points.size(); ++k) sizes[k] = std::abs(points[k].grey - points[k].row.dot(q));
    const double scale = robust_scale(sizes);
    Eigen::Matrix<double, 6, 6> H = Eigen::Matrix<double, 6, 6>::Zero();
    Terms g = Terms::Zero();
    for (std::size_t k = 0; k < points.size(); ++k) {
      const double w = weight_of(sizes[k], scale);
      H.noalias() += w * points[k].row * points[k].row.transpose();
      g.noalias() += w * points[k].grey * points[k].row;
    }
    const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> solver(H);
    if (solver.info() != Eigen::Success || solver.rcond() < 1e-12) break;
    q = solver.solve(g);
  }
  return {q(0), q(1), q(2), q(3), q(4), q(5)};
}

/// Gain along a row: a + b x + c x².
std::array<float, 3> along_row(const LightGain& q, double y) {
  return {static_cast<float>(q[0] + q[2] * y + q[5] * y * y), static_cast<float>(q[1] + q[4] * y), static_cast<float>(q[3])};
}

std::uint8_t median_byte(std::vector<std::uint8_t>& values) {
  const auto middle = values.begin() + values.size() / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Mean of the most values that lie within 12 grey levels: what stands still, even where something of many colours is in front of it in
/// half of the frames.
float most_common(std::vector<std::uint8_t>& values) {
  constexpr int width = 12;
  std::sort(values.begin(), values.end());
  std::size_t from = 0, best = 0, count = 0;
  for (std::size_t to = 0; to < values.size(); ++to) {
    while (values[to] - values[from] > width) ++from;
    if (to + 1 - from <= count) continue;
    best = from;
    count = to + 1 - from;
  }
  float sum = 0.0F;
  for (std::size_t k = best; k < best + count; ++k) sum += values[k];
  return sum / static_cast<float>(count);
}

std::vector<float> medians(const std::vector<ColourImage>& samples) {
  std::vector<float> out(samples.front().bgr.size());
  std::vector<std::uint8_t> values(samples.size());
  for (std::size_t at = 0; at < out.size(); ++at) {
    for (std::size_t k = 0; k < samples.size(); ++k) values[k] = samples[k].bgr[at];
    out[at] = median_byte(values);
  }
  return out;
}

/// A pixel's value divided by the gain of its row (along_row) at the relative column x.
std::uint8_t in_base_light(std::uint8_t value, const std::array<float, 3>& row, float x) {
  const float gain = row[0] + x * (row[1] + x * row[2]);
  return static_cast<std::uint8_t>(std::clamp(static_cast<float>(value) / gain + 0.5F, 0.0F, 255.0F));
}

}  // namespace

Background::Background(const std::vector<ColourImage>& samples) {
  if (samples.size() < min_samples) throw std::logic_error("a background needs five frames");
  width_ = samples.front().width;
  height_ = samples.front().height;
  base_ = medians(samples);
  std::vector<std::array<LightGain, 3>> gains;
  for (const ColourImage& s : samples) gains.push_back(light_of(s));
  learn_base(samples, gains);
  learn_noise(samples);
  constexpr double before_known = 120.0;
  set_contrast(before_known);
}

void Background::set_contrast(double contrast) {
  const auto half = static_cast<float>(0.5 * contrast);
  low_.clear();
  scale_.clear();
  for (const float noise : noise_) {
    low_.push_back(2.0F * noise);
    scale_.push_back(255.0F / std::max(half - low_.back(), 6.0F));
  }
}

/// What most of the samples share once they are brought to one light.
void Background::learn_base(const std::vector<ColourImage>& samples, const std::vector<std::array<LightGain, 3>>& gains) {
  std::vector<float> base(samples.front().bgr.size());
  std::vector<std::uint8_t> values(samples.size());
  std::vector<std::array<std::array<float, 3>, 3>> rows(samples.size());
  for (int r = 0; r < height_; ++r) {
    for (std::size_t k = 0; k < gains.size(); ++k)
      for (std::size_t c = 0; c < 3; ++c) rows[k][c] = along_row(gains[k][c], relative(r, height_));
    for (int i = 0; i < width_; ++i) {
      const auto x = static_cast<float>(relative(i, width_));
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t at = samples.front().at(i, r) + c;
        for (std::size_t k = 0; k < samples.size(); ++k) values[k] = in_base_light(samples[k].bgr[at], rows[k][c], x);
        base[at] = most_common(values);
      }
    }
  }
  base_ = std::move(base);
}

void Background::learn_noise(const std::vector<ColourImage>& samples) {
  std::vector<std::vector<float>> all;
  for (const ColourImage& s : samples) all.push_back(differences(s));
  std::vector<float> values(samples.size()), raw(all.front().size());
  const auto place = static_cast<std::ptrdiff_t>(quantile * static_cast<double>(samples.size()));
  for (std::size_t p = 0; p < raw.size(); ++p) {
    for (std::size_t k = 0; k < all.size(); ++k) values[k] = all[k][p];
    std::nth_element(values.begin(), values.begin() + place, values.end());
    raw[p] = values[place];
  }
  noise_.assign(raw.size(), least_noise);
  for (int r = 0; r < height_; ++r) {  // the largest mean of two neighbouring pixels: a single one of few samples says little
    for (int c = 0; c + 1 < width_; ++c) {
      const std::size_t p = std::size_t{1} * r * width_ + c;
      const float mean = 0.5F * (raw[p] + raw[p + 1]);
      noise_[p] = std::max(noise_[p], mean);
      noise_[p + 1] = std::max(noise_[p + 1], mean);
    }
  }
}

double Background::noise() const {
  std::vector<double> values(noise_.begin(), noise_.end());
  return median(values);
}

std::array<LightGain, 3> Background::light_of(const ColourImage& frame) const {
  const int step = std::max(1, static_cast<int>(std::sqrt(1.0 * width_ * height_ / light_points)));
  std::array<std::vector<LightPoint>, 3> points;
  for (int r = step / 2; r < height_; r += step) {
    for (int i = step / 2; i < width_; i += step) {
      const Terms t = terms(relative(i, width_), relative(r, height_));
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t at = frame.at(i, r) + c;
        if (base_[at] < darkest || base_[at] > brightest || frame.bgr[at] > brightest) continue;
        points[c].push_back({base_[at] * t, 1.0 * frame.bgr[at]});
      }
    }
  }
  return {fitted_gain(points[0]), fitted_gain(points[1]), fitted_gain(points[2])};
}

std::vector<float> Background::differences(const ColourImage& frame) const { return differences(frame, light_of(frame)); }

std::vector<float> Background::differences(const ColourImage& frame, const std::array<LightGain, 3>& light) const {
  const std::size_t width = width_;
  std::vector<float> out(width * height_), x(width);
  for (int i = 0; i < width_; ++i) x[i] = static_cast<float>(relative(i, width_));
  for (int r = 0; r < height_; ++r) {
    std::array<std::array<float, 3>, 3> q{};
    for (std::size_t c = 0; c < 3; ++c) q[c] = along_row(light[c], relative(r, height_));
    const std::uint8_t* pixel = frame.bgr.data() + frame.at(0, r);
    const float* base = base_.data() + frame.at(0, r);
    float* to = out.data() + r * width;
    for (std::size_t i = 0; i < width; ++i) {
      float sum = 0.0F;
      for (std::size_t c = 0; c < 3; ++c) {
        const float gain = q[c][0] + x[i] * (q[c][1] + x[i] * q[c][2]);
        sum += std::abs(static_cast<float>(pixel[3 * i + c]) - gain * base[3 * i + c]);
      }
      to[i] = sum;
    }
  }
  return out;
}

Image Background::foreground(const ColourImage& frame, int shrink) const {
  const std::vector<float> all = differences(frame);
  Image out(width_ / shrink, height_ / shrink);
  std::vector<float> line(width_), sums(out.width);
  const float share = 1.0F / static_cast<float>(shrink * shrink);
  for (int r = 0; r < out.height; ++r) {
    std::fill(sums.begin(), sums.end(), 0.5F);
    for (int k = 0; k < shrink; ++k) {
      const std::size_t from = std::size_t{1} * (r * shrink + k) * width_;
      for (std::size_t i = 0; i < line.size(); ++i) {
        const float value = scale_[from + i] * (all[from + i] - low_[from + i]);
        line[i] = share * std::min(255.0F, std::max(0.0F, value));
      }
      for (std::size_t i = 0, k0 = 0; i < sums.size(); ++i, k0 += shrink)
        for (std::size_t m = 0; m < static_cast<std::size_t>(shrink); ++m) sums[i] += line[k0 + m];
    }
    for (int i = 0; i < out.width; ++i) out(i, r) = static_cast<std::uint8_t>(sums[i]);
  }
  return out;
}

}  // namespace misfit
