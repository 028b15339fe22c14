#include <cmath>

#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// The two fields of interlaced video are not where they are thought to be: every second sample is shifted up, the others down.
struct FieldOffset {
  static constexpr const char* formula = "P_z = P_z0 + (-1)^round(t field_rate) field_shift";
  static constexpr const char* symbols =
      "P_z0 pixels by the calibrated camera, t time of the recording [s], field_rate [Hz], field_shift [px]";
  static constexpr const char* valid = "samples at the fields' rate, from t = 0; field_rate is that of the samples";
  static constexpr const char* size =
      "0.5 px where fields are taken for frames: as large as the measurement noise, at half the sampling rate";
  static constexpr const char* source = "ITU-R BT.601: a field holds every second line";
  static constexpr const char* excludes = "fields that are not equally spaced in time";

  enum Port { P_z };
  static constexpr Role ports[] = {{.name = "P_z", .unit = "px"}};
  enum Coefficient { field_shift, field_rate };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "field_shift", .unit = "px", .lower = -100.0, .upper = 100.0, .scale = 0.2, .doc = "shift of the first field, downwards"},
      {.name = "field_rate",
       .kind = CoefficientKind::shape,
       .value = 59.94,
       .unit = "Hz",
       .lower = 1e-3,
       .upper = 1e6,
       .scale = 1.0,
       .doc = "fields per second",
       .fixed = true,
       .scan = {.from = 1.0, .to = 1.0, .count = 1, .over = "1/step"}},
  };

  static constexpr bool traceable = false;  // the field is rounded off the number itself

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* P) {
    const double field = std::round(in.t * value_of(in.c[field_rate]));
    P[P_z] = std::fmod(std::abs(field), 2.0) == 0.0 ? T(in.c[field_shift]) : T(-in.c[field_shift]);
  }

  static std::vector<Example> examples() {
    return {{.coefficients = {0.5, 59.94}, .ports = {0.5}, .source = "the first field"},
            {.coefficients = {0.5, 59.94}, .t = 1001.0 / 60000.0, .ports = {-0.5}, .source = "the second"},
            {.coefficients = {-0.3, 59.94}, .t = 79.4127458, .ports = {-0.3}, .source = "sample 4760 of a flight"}};
  }
};

}  // namespace

MISFIT_EFFECT(field_offset, FieldOffset)
