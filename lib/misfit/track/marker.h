#pragma once

#include <array>
#include <string>
#include <vector>

#include "misfit/data/image.h"

namespace misfit {

enum class MarkerKind {
  ring,    ///< a bright ring with a dark middle on a darker ground
  bright,  ///< a bright disc
  dark,    ///< a dark disc
  picture  ///< as a picture cut from a frame shows it
};

/// How a marker looks: a few fixed shapes about its centre, added with levels that are found anew in every field (so that brightness may
/// drift):
///   I(x, y) = levels[0] + levels[1] phi_1 + levels[2] phi_2
/// ring: phi_1 = disc of radius `outer`, phi_2 = disc of radius `inner`; bright, dark: phi_1 alone; picture: phi_1 = the picture, grey
/// 0…255. A disc's edge rises over ± `edge` as (8 + 15 u − 10 u³ + 3 u⁵)/16, u = distance inside the edge / `edge`: close to a Gaussian
/// blur of standard deviation 0.38 `edge`.
struct Marker {
  MarkerKind kind = MarkerKind::ring;
  double outer = 0.0, inner = 0.0, edge = 1.0;  ///< [px]
  Image picture = {};                           ///< its centre ((w−1)/2, (h−1)/2) is the marker's position
  std::array<double, 3> levels{0, 0, 0};        ///< [grey levels] as learnt

  [[nodiscard]] int shapes() const { return kind == MarkerKind::ring ? 2 : 1; }
  [[nodiscard]] double reach_x() const;  ///< half width of what it covers [px]
  [[nodiscard]] double reach_y() const;
};

/// The shapes at one place and their slopes by that place.
struct ShapeValue {
  std::array<double, 2> value{0, 0}, by_x{0, 0}, by_y{0, 0};
  std::array<double, 2> by_radius{0, 0}, by_edge{0, 0};  ///< of shape 1 by `outer`, of shape 2 by `inner`; both by `edge`
};

/// At (x, y) from the marker's centre [px].
[[nodiscard]] ShapeValue shape_at(const Marker& marker, double x, double y);

/// A disc marker of diameter `diameter` before anything is learnt: hole 0.45 of it, sharp edges, levels of a fair contrast.
[[nodiscard]] Marker nominal_marker(MarkerKind kind, double diameter);

[[nodiscard]] const char* name_of(MarkerKind kind);

}  // namespace misfit
