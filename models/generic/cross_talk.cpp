#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A channel that shows part of another one: axes that are not square, wires beside each other, a gyro whose axis is tilted.
struct CrossTalk {
  static constexpr const char* formula = "y = h + cross_share h_other";
  static constexpr const char* symbols = "h, h_other predicted outputs of one unit [output], cross_share [-]";
  static constexpr const char* valid = "a share that is constant, of what the other channel shows at the same moment";
  static constexpr const char* size = "0.017 for an axis that is tilted by 1 deg towards the other";
  static constexpr const char* source = "IEEE Std 1431-2004, 3.1: cross-axis sensitivity (misalignment)";
  static constexpr const char* excludes = "rotation of both axes (output_rotation), delay between the channels";

  enum Quantity { other_signal };
  static constexpr Role quantities[] = {{.name = "other_signal", .unit = "*"}};
  enum Port { output };
  static constexpr Role ports[] = {{.name = "output", .unit = "{other_signal}"}};
  enum Coefficient { cross_share };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "cross_share", .unit = "-", .lower = -10.0, .upper = 10.0, .scale = 0.01, .doc = "of the other channel that this one shows"},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* y) {
    y[output] = in.c[cross_share] * in.q[other_signal];
  }

  static std::vector<Example> examples() {
    return {{.quantities = {2.0}, .coefficients = {0.03}, .ports = {0.06}, .source = "3 % of 2"},
            {.quantities = {-4.0}, .coefficients = {0.5}, .ports = {-2.0}, .source = "half of -4"}};
  }
};

}  // namespace

MISFIT_EFFECT(cross_talk, CrossTalk)
