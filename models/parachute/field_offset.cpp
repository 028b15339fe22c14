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
  static constexpr const char* size = "0.5 px where fields are taken for frames: as large as the reading noise, at half the sampling rate";
  static constexpr const char* source = "ITU-R BT.601: a field holds every second line";
  static constexpr const char* excludes = "fields that are not equally spaced in time";
  static constexpr Role ports[] = {{"P_z", "px"}};
  static constexpr CoefficientSpec coefficients[] = {
      {"field_shift", CoefficientKind::strength, 0.0, "px", -100.0, 100.0, 0.2, "shift of the first field, downwards"},
      {"field_rate", CoefficientKind::shape, 59.94, "Hz", 1e-3, 1e6, 1.0, "fields per second", Parity::none, "", false, true}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* P) {
    const double field = std::round(in.t * value_of(in.c[1]));
    P[0] = std::fmod(std::abs(field), 2.0) == 0.0 ? T(in.c[0]) : T(-in.c[0]);
  }

  static std::vector<Example> examples() {
    return {{{}, {}, {0.5, 59.94}, {}, 0.0, {0.5}, {}, "the first field"},
            {{}, {}, {0.5, 59.94}, {}, 1001.0 / 60000.0, {-0.5}, {}, "the second"},
            {{}, {}, {-0.3, 59.94}, {}, 79.4127458, {-0.3}, {}, "sample 4760 of a flight"}};
  }
};

}  // namespace

MISFIT_EFFECT(field_offset, FieldOffset)
