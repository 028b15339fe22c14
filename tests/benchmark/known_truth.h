#pragma once

// What the benches with a known truth share: chance by number, models set by hand, and parts of a run that are put together.

#include <cstdint>
#include <functional>
#include <map>
#include <numbers>
#include <random>
#include <string>

#include "misfit/model/model.h"

namespace misfit::bench {

inline constexpr double degree = std::numbers::pi / 180.0;

/// The same numbers for the same kind and number of a world.
class Dice {
 public:
  Dice(const std::string& kind, int number);
  double uniform(double from, double to) { return from + (to - from) * std::uniform_real_distribution<double>()(random); }
  double sign() { return uniform(0.0, 1.0) < 0.5 ? -1.0 : 1.0; }
  double angle() { return uniform(-std::numbers::pi, std::numbers::pi); }
  double normal(double sigma) { return std::normal_distribution<double>(0.0, sigma)(random); }
  std::size_t pick(std::size_t count) { return std::uniform_int_distribution<std::size_t>(0, count - 1)(random); }
  std::mt19937_64 random;
};

/// std::logic_error if there is no such parameter.
void set(Model& model, const std::string& name, double value);

/// The curve's coefficients that come nearest to `value` over all of its range, by least squares on a thousand points.
void set_curve(Model& model, const std::string& name, const std::function<double(double)>& value);

/// Value of a curve of a model.
[[nodiscard]] double curve_value(const Model& model, const std::string& name, double x);

/// What a part of a bench is asked for.
struct PartOptions {
  std::string kind = "all", out, summary;
  int from = 0, to = 10, threads = 0;
  double seconds = 0.0;
};

/// --kind, --out, --summary, --seconds, --threads, RANGE A:B (`range`: "--worlds") and the texts of `more`. False: not understood.
[[nodiscard]] bool parse(int argc, char** argv, const std::string& range, PartOptions& options,
                         const std::map<std::string, std::string*>& more = {});

}  // namespace misfit::bench
