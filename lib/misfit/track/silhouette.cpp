#include "misfit/track/silhouette.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "misfit/math/statistics.h"
#include "misfit/track/locate.h"

namespace misfit {
namespace {

constexpr int block = 4;                 // [px] parts closer than this are one
constexpr int least_in_block = 3;        // pixels
constexpr std::uint8_t half_full = 127;  // of the foreground
constexpr double least_area = 30.0;      // [px]
constexpr double size_spread = 1.6;      // factor by which the area of one object may differ from its median
constexpr double least_share = 0.5;      // of the frames
constexpr double most_covered = 0.35;    // of the frame: more is no object, but a camera that moves
constexpr double most_noise = 30.0;      // [grey levels over three channels] of the ground, where it stands still
constexpr double picture_size = 14.0;    // [px] the smaller side of the picture's object, where the frame's is larger
constexpr double margin = 0.2;           // about it, of its size

/// Union-find over blocks.
class Parts {
 public:
  explicit Parts(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }
  std::size_t root(std::size_t k) {
    while (parent_[k] != k) k = parent_[k] = parent_[parent_[k]];
    return k;
  }
  void join(std::size_t a, std::size_t b) { parent_[root(a)] = root(b); }

 private:
  std::vector<std::size_t> parent_;
};

struct Blocks {
  int width = 0, height = 0;
  std::vector<bool> full;
  [[nodiscard]] std::size_t at(int i, int j) const { return j * width + i; }
};

Blocks blocks_of(const Image& foreground) {
  Blocks out{(foreground.width + block - 1) / block, (foreground.height + block - 1) / block, {}};
  std::vector<int> count(std::size_t{1} * out.width * out.height, 0);
  for (int r = 0; r < foreground.height; ++r) {
    const std::uint8_t* line = foreground.pixels.data() + foreground.at(0, r);
    int* to = count.data() + out.at(0, r / block);
    for (int c = 0; c < foreground.width; ++c) to[c / block] += line[c] > half_full ? 1 : 0;
  }
  for (const int n : count) out.full.push_back(n >= least_in_block);
  return out;
}

Parts joined(const Blocks& blocks) {
  Parts parts(blocks.full.size());
  for (int j = 0; j < blocks.height; ++j) {
    for (int i = 0; i < blocks.width; ++i) {
      if (!blocks.full[blocks.at(i, j)]) continue;
      if (i > 0 && blocks.full[blocks.at(i - 1, j)]) parts.join(blocks.at(i, j), blocks.at(i - 1, j));
      for (int k = std::max(0, i - 1); j > 0 && k <= std::min(blocks.width - 1, i + 1); ++k) {
        if (blocks.full[blocks.at(k, j - 1)]) parts.join(blocks.at(i, j), blocks.at(k, j - 1));
      }
    }
  }
  return parts;
}

struct Sums {
  double area = 0.0, weight = 0.0, x = 0.0, y = 0.0;
  Blob blob;
};

void add(Sums& s, int c, int r, int value) {
  if (s.area == 0.0) s.blob = {{}, 0.0, 1.0 * c, 1.0 * c, 1.0 * r, 1.0 * r};
  s.area += 1.0;
  s.weight += value;
  s.x += 1.0 * value * c;
  s.y += 1.0 * value * r;
  s.blob.left = std::min<double>(s.blob.left, c);
  s.blob.right = std::max<double>(s.blob.right, c);
  s.blob.bottom = std::max<double>(s.blob.bottom, r);
}

bool in_region(const Blob& blob, const std::optional<Region>& region) { return !region || contains(*region, blob.at); }

/// One sample frame and the part of it that is the object.
struct Seen {
  std::size_t frame = 0;
  Blob blob;
};

double covered(const Image& foreground) {
  const auto n = std::count_if(foreground.pixels.begin(), foreground.pixels.end(), [](std::uint8_t v) { return v > half_full; });
  return static_cast<double>(n) / static_cast<double>(foreground.pixels.size());
}

double median_area(const std::vector<Seen>& seen) {
  std::vector<double> areas;
  for (const Seen& s : seen) areas.push_back(s.blob.area);
  return median(areas);
}

/// The largest part of every frame, then of every frame the part whose size is most like their median.
std::vector<Seen> object_in(const std::vector<Image>& foregrounds, const std::optional<Region>& region) {
  std::vector<std::vector<Blob>> all;
  std::vector<Seen> largest, seen;
  for (const Image& f : foregrounds) {
    all.push_back(blobs_of(f, least_area));
    std::erase_if(all.back(), [&](const Blob& b) { return !in_region(b, region); });
    if (!all.back().empty()) largest.push_back({all.size() - 1, all.back().front()});
  }
  if (largest.empty()) return {};
  const double area = median_area(largest);
  for (std::size_t k = 0; k < all.size(); ++k) {
    const auto unlike = [&](const Blob& b) { return std::abs(std::log(b.area / area)); };
    const auto best = std::min_element(all[k].begin(), all[k].end(), [&](const Blob& a, const Blob& b) { return unlike(a) < unlike(b); });
    if (best != all[k].end() && unlike(*best) < std::log(size_spread)) seen.push_back({k, *best});
  }
  return seen;
}

double median_of(const std::vector<Seen>& seen, double (Blob::*size)() const) {
  std::vector<double> values;
  for (const Seen& s : seen) values.push_back((s.blob.*size)());
  return median(values);
}

/// Does it move by more than half its size?
bool moves(const std::vector<Seen>& seen, double width, double height) {
  std::vector<double> x, y;
  for (const Seen& s : seen) {
    x.push_back(s.blob.at.column);
    y.push_back(s.blob.at.row);
  }
  const auto [x0, x1] = std::minmax_element(x.begin(), x.end());
  const auto [y0, y1] = std::minmax_element(y.begin(), y.end());
  return *x1 - *x0 > 0.5 * width || *y1 - *y0 > 0.5 * height;
}

double contrast_of(const std::vector<ColourImage>& samples, const Background& background, const std::vector<Seen>& seen) {
  std::vector<double> values;
  for (const Seen& s : seen) {
    const std::vector<float> d = background.differences(samples[s.frame]);
    const std::size_t width = background.width();
    const auto r = static_cast<std::size_t>(s.blob.at.row), c = static_cast<std::size_t>(s.blob.at.column);
    const auto reach = static_cast<std::size_t>(0.3 * std::min(s.blob.width(), s.blob.height()));
    for (std::size_t j = r - std::min(r, reach); j <= r + reach && j < d.size() / width; ++j)
      for (std::size_t i = c - std::min(c, reach); i <= c + reach && i < width; ++i) values.push_back(d[j * width + i]);
  }
  return median(values);
}

double bilinear(const Image& image, double column, double row) {
  const double c = std::clamp(column, 0.0, image.width - 1.001), r = std::clamp(row, 0.0, image.height - 1.001);
  const int i = static_cast<int>(c), j = static_cast<int>(r);
  const double x = c - i, y = r - j;
  return (1.0 - y) * ((1.0 - x) * image(i, j) + x * image(i + 1, j)) + y * ((1.0 - x) * image(i, j + 1) + x * image(i + 1, j + 1));
}

/// Median of the foregrounds about these places (a mean would keep what passed beside the object once).
Image mean_about(const std::vector<Image>& foregrounds, const std::vector<std::pair<std::size_t, PixelPoint>>& places, const Image& size) {
  Image out = size;
  std::vector<double> values;
  for (int r = 0; r < out.height; ++r) {
    for (int c = 0; c < out.width; ++c) {
      values.clear();
      for (const auto& [k, at] : places)
        values.push_back(bilinear(foregrounds[k], at.column + c - 0.5 * (out.width - 1), at.row + r - 0.5 * (out.height - 1)));
      out(c, r) = static_cast<std::uint8_t>(std::lround(median(values)));
    }
  }
  return out;
}

/// Foreground's centroid, from the picture's middle.
PixelPoint off_centre(const Image& picture) {
  double sum = 0.0, x = 0.0, y = 0.0;
  for (int r = 0; r < picture.height; ++r) {
    for (int c = 0; c < picture.width; ++c) {
      sum += picture(c, r);
      x += picture(c, r) * (c - 0.5 * (picture.width - 1));
      y += picture(c, r) * (r - 0.5 * (picture.height - 1));
    }
  }
  return sum > 0.0 ? PixelPoint{x / sum, y / sum} : PixelPoint{};
}

bool whole_in(const Image& foreground, const PixelPoint& at, const Image& picture) {
  return at.column > 0.5 * picture.width && at.row > 0.5 * picture.height && at.column < foreground.width - 0.5 * picture.width &&
         at.row < foreground.height - 0.5 * picture.height;
}

/// The picture, sharpened by placing it in every frame and taking the median again.
Image picture_of(const std::vector<Image>& foregrounds, const std::vector<Seen>& seen, int shrink, Image picture) {
  std::vector<std::pair<std::size_t, PixelPoint>> places;
  const double s = shrink;
  for (const Seen& one : seen) {
    const PixelPoint at{(one.blob.at.column + 0.5) / s - 0.5, (one.blob.at.row + 0.5) / s - 0.5};
    if (whole_in(foregrounds[one.frame], at, picture)) places.emplace_back(one.frame, at);
  }
  if (places.size() < 3) return {};
  for (int pass = 0; pass < 3; ++pass) {
    picture = mean_about(foregrounds, places, picture);
    const PixelPoint off = off_centre(picture);
    Marker marker;
    marker.kind = MarkerKind::picture;
    marker.picture = picture;
    for (auto& [k, at] : places) {
      const Location found = locate({foregrounds[k], 0, 1}, marker, at);
      if (found.converged) at = found.at;
      at = {at.column + off.column, at.row + off.row};
    }
  }
  return mean_about(foregrounds, places, picture);
}

int odd(double size) { return 2 * static_cast<int>(std::lround(0.5 * size)) + 1; }

std::vector<Image> foregrounds_of(const std::vector<ColourImage>& samples, const Background& background, int shrink) {
  std::vector<Image> out;
  for (const ColourImage& s : samples) out.push_back(background.foreground(s, shrink));
  return out;
}

}  // namespace

std::vector<Blob> blobs_of(const Image& foreground, double least) {
  const Blocks blocks = blocks_of(foreground);
  Parts parts = joined(blocks);
  std::vector<Sums> sums(blocks.full.size());
  for (int r = 0; r < foreground.height; ++r) {
    for (int c = 0; c < foreground.width; ++c) {
      const std::size_t b = blocks.at(c / block, r / block);
      if (foreground(c, r) > half_full && blocks.full[b]) add(sums[parts.root(b)], c, r, foreground(c, r));
    }
  }
  std::vector<Blob> out;
  for (Sums& s : sums) {
    if (s.area < least) continue;
    s.blob.area = s.area;
    s.blob.at = {s.x / s.weight, s.y / s.weight};
    out.push_back(s.blob);
  }
  std::stable_sort(out.begin(), out.end(), [](const Blob& a, const Blob& b) { return a.area > b.area; });
  return out;
}

std::optional<Silhouette> find_silhouette(const std::vector<ColourImage>& samples, Background& background, const SilhouetteOptions& options,
                                          std::string& why) {
  std::vector<Image> foregrounds = foregrounds_of(samples, background, 1);
  std::vector<double> shares;
  for (const Image& f : foregrounds) shares.push_back(covered(f));
  if (median(shares) > most_covered || background.noise() > most_noise) {
    why = "most of the picture changes from frame to frame: the camera moves, or the film was cut, or is very noisy";
    return std::nullopt;
  }
  const std::vector<Seen> seen = object_in(foregrounds, options.region);
  Silhouette out;
  out.share = static_cast<double>(seen.size()) / static_cast<double>(samples.size());
  if (out.share < least_share) {
    why = "no object of one size moves before a ground that stands still";
    return std::nullopt;
  }
  out.width = median_of(seen, &Blob::width);
  out.height = median_of(seen, &Blob::height);
  if (!moves(seen, out.width, out.height)) {
    why = "what moves does so by less than half its size";
    return std::nullopt;
  }
  out.contrast = contrast_of(samples, background, seen);
  background.set_contrast(out.contrast);
  out.shrink = std::max(1, static_cast<int>(std::min(out.width, out.height) / picture_size));
  if (options.most_shrink > 0) out.shrink = std::min(out.shrink, options.most_shrink);
  foregrounds = foregrounds_of(samples, background, out.shrink);
  const double s = out.shrink, edge = 1.0 + 2.0 * margin;
  out.marker.kind = MarkerKind::picture;
  out.marker.picture = picture_of(foregrounds, seen, out.shrink, Image(odd(edge * out.width / s + 4.0), odd(edge * out.height / s + 4.0)));
  out.marker.levels = {0.0, 1.0, 0.0};
  if (!out.marker.picture.empty()) return out;
  why = "what moves is hardly ever wholly in the frame";
  return std::nullopt;
}

}  // namespace misfit
