#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// Pixels that are not square beyond what the calibration says: P_y is stretched. Video standards do this (704 or 720 columns for one
/// width).
struct PixelAspect {
  static constexpr const char* formula = "P_y = centre_y + (P_y0 - centre_y)(1 + aspect_error/(1 + pixel_aspect))";
  static constexpr const char* symbols = "P_y0 pixels by the calibrated camera, centre_y [px], pixel_aspect, aspect_error [-]";
  static constexpr const char* valid = "any camera: the stretch comes last but for the centre";
  static constexpr const char* size = "2.3 % (704 for 720 columns): 3.4 px at 150 px";
  static constexpr const char* source = "ITU-R BT.601: non-square pixels of standard video";
  static constexpr const char* excludes = "skew between rows and columns";
  static constexpr Role quantities[] = {{"P_y", "px"}};
  static constexpr Role ports[] = {{"P_y", "px"}};
  static constexpr const char* constants[] = {"centre_y", "pixel_aspect"};
  static constexpr CoefficientSpec coefficients[] = {{"aspect_error", CoefficientKind::strength, 0.0, "-", -0.5, 0.5, 0.01,
                                                      "what is to be added to pixel_aspect", Parity::none, "", false, false, ScanSpec{},
                                                      "pixel_aspect"}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* P) {
    P[0] = in.c[0] / (1.0 + in.k[1]) * (in.q[0] - in.k[0]);
  }

  static std::vector<Example> examples() {
    return {{{6.0, 0.25}, {106.0}, {0.05}, {}, 0.0, {4.0}, {}, "by hand: 100 x 0.05/1.25"},
            {{0.0, 0.0}, {-150.0}, {0.023}, {}, 0.0, {-3.45}, {}, "150 x 0.023"}};
  }
};

}  // namespace

MISFIT_EFFECT(pixel_aspect, PixelAspect)
