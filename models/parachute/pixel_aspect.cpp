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

  enum Quantity { P_y };
  static constexpr Role quantities[] = {{.name = "P_y", .unit = "px"}};
  enum Port { P_y_port };
  static constexpr Role ports[] = {{.name = "P_y", .unit = "px"}};
  enum Constant { centre_y, pixel_aspect };
  static constexpr const char* constants[] = {"centre_y", "pixel_aspect"};
  enum Coefficient { aspect_error };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "aspect_error",
       .unit = "-",
       .lower = -0.5,
       .upper = 0.5,
       .scale = 0.01,
       .doc = "what is to be added to pixel_aspect",
       .calibrated_as = "pixel_aspect"},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* P) {
    P[P_y_port] = in.c[aspect_error] / (1.0 + in.k[pixel_aspect]) * (in.q[P_y] - in.k[centre_y]);
  }

  static std::vector<Example> examples() {
    return {{.constants = {6.0, 0.25}, .quantities = {106.0}, .coefficients = {0.05}, .ports = {4.0}, .source = "by hand: 100 x 0.05/1.25"},
            {.constants = {0.0, 0.0}, .quantities = {-150.0}, .coefficients = {0.023}, .ports = {-3.45}, .source = "150 x 0.023"}};
  }
};

}  // namespace

MISFIT_EFFECT(pixel_aspect, PixelAspect)
