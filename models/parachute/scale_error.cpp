#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// The scale K of the camera is not the calibrated one: pixels grow about the image centre.
struct ScaleError {
  static constexpr const char* formula = "P = c + (1 + K_error/K)(P0 - c), c = (centre_y, centre_z)";
  static constexpr const char* symbols = "P0 pixels by the calibrated camera, c its centre [px], K [px/m], K_error [px/m]";
  static constexpr const char* valid = "a lens without distortion (the distortion would grow with the cube)";
  static constexpr const char* size = "1.97 px/m (Table 2) of 134 px/m: 1.5 %, 0.2 deg at 12 deg of tilt";
  static constexpr const char* source = "paper Table 2: K +-1.969 px/m, read as 3 sigma";
  static constexpr const char* excludes = "a wrong distance between rig and camera: a scale that depends on the tilt";
  static constexpr Role quantities[] = {{"P_y", "px"}, {"P_z", "px"}};
  static constexpr Role ports[] = {{"P_y", "px"}, {"P_z", "px"}};
  static constexpr const char* constants[] = {"K", "centre_y", "centre_z"};
  static constexpr CoefficientSpec coefficients[] = {{"K_error", CoefficientKind::strength, 0.0, "px/m", -1e4, 1e4, 1.0,
                                                      "what is to be added to K", Parity::none, "", false, false, ScanSpec{}, "K",
                                                      1.969 / 3.0}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* P) {
    const T more = in.c[0] / in.k[0];
    P[0] = more * (in.q[0] - in.k[1]);
    P[1] = more * (in.q[1] - in.k[2]);
  }

  static std::vector<Example> examples() {
    return {{{133.86, 6.0, -4.0}, {106.0, 146.0}, {1.969}, {}, 0.0, {1.47094, 2.20640968}, {}, "1.969/133.86 = 0.0147094 of (100, 150)"},
            {{100.0, 0.0, 0.0}, {50.0, -20.0}, {-10.0}, {}, 0.0, {-5.0, 2.0}, {}, "by hand: a tenth less"}};
  }
};

}  // namespace

MISFIT_EFFECT(scale_error, ScaleError)
