#include <cmath>
#include <numbers>

#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// An output in whole steps of a converter or an encoder: what rounding to the next of them adds, its first three harmonics, since a jump
/// has no derivative. Step and level are usually known or seen at once (the smallest difference of two measurements, and any of them) and
/// are held; where the output's own noise is above a third of a step, rounding is only a little more noise (step/sqrt(12)).
/// With `rounded` held at 1, filter_error predicts no rounding: it takes each measurement for the interval of a step that it stands for
/// (lib/misfit/README.md, 5.6), and what is simulated is rounded to it; this formula is for output error alone.
struct SensorQuantisation {
  static constexpr const char* formula = "y = h + rounded step/pi sum_{k=1..3} (-1)^k/k sin(2 pi k (h - level)/step)";
  static constexpr const char* symbols =
      "h predicted output [output], rounded share [-] (1: whole steps are read), step [output], "
      "level a value that is read [output]";
  static constexpr const char* valid =
      "outputs that cross steps slowly; within 0.1 step of the rounded one up to 0.4 step from its middle, smooth where that jumps; "
      "with rounded held at 1, filter_error takes each measurement for an interval of one step, which holds at any speed";
  static constexpr const char* size = "at most half a step, on average step/sqrt(12): 2.9 mV for steps of 10 mV";
  static constexpr const char* source =
      "B. Widrow, I. Kollar, Quantization Noise (2008), ch. 2: the rounding error as a sawtooth; its Fourier series";
  static constexpr const char* excludes = "steps that are not even, hysteresis between steps (backlash)";

  enum Quantity { signal };
  static constexpr Role quantities[] = {{.name = "signal", .unit = "*"}};
  enum Port { output };
  static constexpr Role ports[] = {{.name = "output", .unit = "{signal}"}};
  enum Coefficient { rounded, step, level };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "rounded", .unit = "-", .lower = 0.0, .upper = 2.0, .scale = 0.1, .doc = "share of the rounding", .whole = 1.0},
      {.name = "step",
       .kind = CoefficientKind::shape,
       .value = 0.1,
       .unit = "{output}",
       .lower = 1e-12,
       .upper = 1e12,
       .scale = 0.1,
       .doc = "smallest difference of two measurements",
       .fixed = true,
       .scan = {.from = 0.05, .to = 0.2, .count = 3, .over = "|signal|"},
       .measured_as = OfMeasurements::step},
      {.name = "level",
       .kind = CoefficientKind::shape,
       .unit = "{output}",
       .lower = -1e12,
       .upper = 1e12,
       .doc = "one of the values that are read",
       .fixed = true,
       .scan = {.from = 0.0, .to = 0.0, .count = 1},
       .measured_as = OfMeasurements::level},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* y) {
    using std::sin;
    constexpr int harmonics = 3;
    constexpr double pi = std::numbers::pi;
    T sum(0.0);
    for (int k = 1; k <= harmonics; ++k)
      sum += T((k % 2 == 0 ? 1.0 : -1.0) / k) * sin(2.0 * pi * k * (in.q[signal] - in.c[level]) / in.c[step]);
    y[output] = in.c[rounded] * in.c[step] / pi * sum;
  }

  static std::vector<Example> examples() {
    return {{.quantities = {0.3},
             .coefficients = {1.0, 1.0, 0.0},
             .ports = {-0.3339136},
             .source = "(-0.951057 - 0.587785/2 + 0.587785/3)/pi, by hand; the sawtooth: -0.3"},
            {.quantities = {0.7},
             .coefficients = {0.5, 0.5, 0.1},
             .ports = {-0.03670395},
             .source = "0.25 (-0.951057 + 0.587785/2 + 0.587785/3)/pi at 0.6 from the level, by hand"}};
  }
};

}  // namespace

MISFIT_EFFECT(sensor_quantisation, SensorQuantisation)
