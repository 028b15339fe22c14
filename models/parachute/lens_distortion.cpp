#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A lens that bends straight lines beyond what the calibration says: radial distortion of third order.
struct LensDistortion {
  static constexpr const char* formula = "P = P0 + k1_error r^2 (P0 - c), r = |P0 - c|/(l_b K)";
  static constexpr const char* symbols =
      "P0 pixels by the calibrated camera, c its centre [px], l_b K focal length [px], k1_error [-]: negative is a barrel";
  static constexpr const char* valid = "to first order in k1: |k1| r^2 << 1 (r is 0.2 at 150 px)";
  static constexpr const char* size = "k1 = -0.1: 0.6 px at 150 px, 5 px at 300 px";
  static constexpr const char* source = "Brown, Close-range camera calibration, Photogrammetric Engineering 37 (1971)";
  static constexpr const char* excludes = "higher orders, tangential distortion";
  static constexpr Role quantities[] = {{"P_y", "px"}, {"P_z", "px"}, {"focal_length", "px", false, true}};
  static constexpr Role ports[] = {{"P_y", "px"}, {"P_z", "px"}};
  static constexpr const char* constants[] = {"centre_y", "centre_z"};
  static constexpr CoefficientSpec coefficients[] = {{"k1_error", CoefficientKind::strength, 0.0, "-", -10.0, 10.0, 0.1,
                                                      "what is to be added to lens_k1", Parity::none, "", false, false, ScanSpec{},
                                                      "lens_k1"}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* P) {
    const T y = in.q[0] - in.k[0], z = in.q[1] - in.k[1];
    const T stretch = in.c[0] * (y * y + z * z) / (in.q[2] * in.q[2]);
    P[0] = stretch * y;
    P[1] = stretch * z;
  }

  static std::vector<Example> examples() {
    return {{{6.0, -4.0}, {36.0, 36.0, 100.0}, {-0.2}, {}, 0.0, {-1.5, -2.0}, {}, "by hand: (30, 40) at 0.5 focal lengths: -0.05"},
            {{0.0, 0.0}, {0.0, 150.0, 761.6634}, {0.1}, {}, 0.0, {0.0, 0.581765018}, {}, "150^3 x 0.1/761.6634^2"}};
  }
};

}  // namespace

MISFIT_EFFECT(lens_distortion, LensDistortion)
