// A model as text against the same model in C++: the planar parachute with polynomial moments, five free coefficients (issue 5: a factor
// 5).

#include <benchmark/benchmark.h>
#include <misfit_models_registry.h>
#include <misfit_text_models_registry.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>

#include "misfit/sim/trajectory.h"

namespace misfit {
namespace {

constexpr std::size_t samples = 4761;

struct World {
  Registry registry;
  Model in_cpp, as_text;
  Signals signals;
  InputTable inputs;

  World() {
    misfit_models_register(registry);
    misfit_text_models_register(registry);
    ModelRequest request;
    request.system = "parachute_planar";
    request.constants = {{"D", 1.5816}, {"S", 1.9554}, {"R_cp", 3.15}, {"m", 0.206}, {"m_a", 0.294}, {"qbar", 736.0}, {"V", 35.1}};
    request.effects = {{"polynomial_moment", "polynomial_moment", {}, {}}, {"gravity", "gravity", {}, {}}};
    in_cpp = assemble(request, registry);
    ModelRequest text;
    text.system = "planar_text";
    as_text = assemble(text, registry);
    signals.name = "made up";
    signals.inputs = {{"phi", "rad", {}, 0.0}, {"phi_rate", "rad/s", {}, 0.0}};
    for (std::size_t i = 0; i < samples; ++i) {
      signals.t.push_back(static_cast<double>(i) / 59.94);
      signals.inputs[0].values.push_back(0.8 * signals.t.back());
      signals.inputs[1].values.push_back(0.8);
    }
    inputs = input_table(signals, in_cpp);
  }
};

double seconds(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Both interleaved; best and median of many.
void compare(const char* what, const std::function<void(const Model&)>& work, const World& world) {
  std::vector<double> cpp, text;
  constexpr int rounds = 60;
  for (int i = 0; i < rounds; ++i) {
    cpp.push_back(seconds([&] { work(world.in_cpp); }));
    text.push_back(seconds([&] { work(world.as_text); }));
  }
  std::sort(cpp.begin(), cpp.end());
  std::sort(text.begin(), text.end());
  std::printf("%-44s C++ %7.3f ms, text %7.3f ms; ratio %5.2f best, %5.2f median\n", what, 1e3 * cpp.front(), 1e3 * text.front(),
              text.front() / cpp.front(), text[rounds / 2] / cpp[rounds / 2]);
}

void trajectory(const World& world, const Model& model, bool sensitivities) {
  Stepper stepper(model);
  Segment out;
  const std::array<double, 2> x0 = {0.2, 0.3};
  run_in_batches({stepper, world.signals, world.inputs}, {0, samples, x0.data(), sensitivities, 128}, out, [](Segment&) {});
  if (!out.finite) std::printf("the run left the finite numbers\n");
  benchmark::DoNotOptimize(out.end.data());
}

void right_hand_sides(const World& world, const Model& model) {
  Evaluator evaluator(model);
  std::vector<double> D(2 * std::size_t{kRowStride});
  std::array<double, 2> x = {0.2, 0.3}, dx{};
  Slots slots;
  for (std::size_t i = 0; i < samples; ++i) {
    x[0] = 0.2 + 1e-5 * static_cast<double>(i);
    benchmark::DoNotOptimize(evaluator.linearise_rates_sparsely({x.data(), world.inputs.at(i), 0.0}, slots, dx.data(), D.data()));
  }
}

/// Both must be the same model, or the ratio says nothing.
void check_alike(const World& world) {
  Stepper cpp(world.in_cpp), text(world.as_text);
  const std::array<double, 2> x0 = {0.2, 0.3};
  Segment a, b;
  run_segment({cpp, world.signals, world.inputs}, {0, 300, x0.data(), true}, a);
  run_segment({text, world.signals, world.inputs}, {0, 300, x0.data(), true}, b);
  std::printf("same motion to %.1e, same sensitivities to %.1e (relative)\n", (a.y - b.y).norm() / a.y.norm(),
              (a.end_rows - b.end_rows).norm() / a.end_rows.norm());
}

}  // namespace
}  // namespace misfit

int main() {
  using namespace misfit;
  const World world;
  check_alike(world);
  compare(
      "linearised right-hand sides, 4761", [&](const Model& m) { right_hand_sides(world, m); }, world);
  compare(
      "linearised trajectory, 4761 samples", [&](const Model& m) { trajectory(world, m, true); }, world);
  compare(
      "plain trajectory, 4761 samples", [&](const Model& m) { trajectory(world, m, false); }, world);
  return 0;
}
