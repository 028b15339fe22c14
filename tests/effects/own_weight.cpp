#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// Reads a constant that only one system has, and may act on two ports.
struct OwnWeight {
  static constexpr const char* formula = "F = share mass g on `port`, and the same on `also`";
  static constexpr const char* symbols = "share [-], mass [kg], g = 9.80665 m/s^2";
  static constexpr const char* valid = "always";
  static constexpr const char* size = "9.8 N for 1 kg";
  static constexpr const char* source = "made up for the tests";
  static constexpr const char* excludes = "everything else";

  enum Port { port, also };
  static constexpr Role ports[] = {{.name = "port", .unit = "*"}, {.name = "also", .unit = "*", .optional = true}};
  enum Constant { mass };
  static constexpr const char* constants[] = {"mass"};
  enum Coefficient { share };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "share", .unit = "-", .lower = -2.0, .upper = 2.0, .scale = 0.5, .doc = "part of the weight that acts"},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    F[port] = in.c[share] * (in.k[mass] * 9.80665);
    F[also] = F[port];
  }

  static std::vector<Example> examples() {
    return {{.constants = {2.0}, .coefficients = {0.5}, .ports = {9.80665, 9.80665}, .source = "half of 2 kg"},
            {.constants = {1.0}, .coefficients = {-1.0}, .ports = {-9.80665, -9.80665}, .source = "upwards"}};
  }
};

}  // namespace

MISFIT_EFFECT(own_weight, OwnWeight)
