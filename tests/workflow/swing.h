#pragma once

// A swing under a held force, its angle sampled so often that its second differences are mostly noise; and a valve that nothing feels.

#include <algorithm>
#include <array>
#include <cstdio>
#include <random>
#include <string>

namespace misfit::testing_swing {

inline constexpr double stiffness = 40.0, damping = 0.8, gain = 25.0;

/// By Runge and Kutta's steps of a twentieth of a sample. The sensor shows no more than `reach` [m].
inline std::string recording(unsigned seed, double reach = 100.0) {
  std::string text = "t[s],u[V],valve[V],x[m]\n";
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 0.004);
  std::uniform_real_distribution<double> force(-1.0, 1.0);
  constexpr int samples = 1500, steps = 20, hold = 70;
  constexpr double step = 0.01, h = step / steps;
  using State = std::array<double, 2>;
  State x{0.3, 0.0};
  double u = 0.0;
  const auto after = [](const State& from, const State& rate, double by) { return State{from[0] + by * rate[0], from[1] + by * rate[1]}; };
  const auto rate = [&](const State& at) { return State{at[1], gain * u - stiffness * at[0] - damping * at[1]}; };
  for (int i = 0; i < samples; ++i) {
    if (i % hold == 0) u = 0.01 * static_cast<int>(100.0 * force(random));
    char row[80];
    std::snprintf(row, sizeof row, "%.2f,%.2f,%d,%.5f\n", step * i, u, i / 50 % 3, std::clamp(x[0], -reach, reach) + noise(random));
    text += row;
    for (int k = 0; k < steps; ++k) {
      const State a = rate(x), b = rate(after(x, a, 0.5 * h)), c = rate(after(x, b, 0.5 * h)), d = rate(after(x, c, h));
      for (std::size_t s = 0; s < 2; ++s) x[s] += h / 6.0 * (a[s] + 2.0 * b[s] + 2.0 * c[s] + d[s]);
    }
  }
  return text;
}

/// With these lines under [inputs], too.
inline std::string system(const std::string& more_inputs = "") {
  return R"toml([system]
doc = "a swing under a force"
[states]
x = { unit = "m", initial = "free" }
v = { unit = "m/s", rate_of = "x", initial = "free" }
[inputs]
u = { unit = "V", hold = "zero_order" }
)toml" + more_inputs +
         R"toml([parameters]
k = { unit = "1/s^2", value = 30.0, bounds = [1.0, 400.0], free = true }
d = { unit = "1/s", value = 0.5, bounds = [0.0, 40.0], free = true }
b = { unit = "m/s^2/V", value = 20.0, free = true }
[equations]
v = "b*u - k*x - d*v"
[outputs]
x = { unit = "m", noise = 0.004 }
)toml";
}

}  // namespace misfit::testing_swing
