// Timing on the data on which peers were timed: Eq. 8, 4761 samples, 10 + 10 coefficients. Reported as a ratio to a hand-written kernel,
// both timed interleaved in one process.

#include <benchmark/benchmark.h>
#include <misfit_models_registry.h>

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "misfit/core/table.h"
#include "misfit/fit/regression/equation_error.h"
#include "misfit/fit/shooting/output_error.h"
#include "misfit/fit/shooting/shooting.h"
#include "misfit/inference/curves.h"
#include "tests/benchmark/hand_kernel.h"

namespace misfit {
namespace {

constexpr double degree = 3.14159265358979323846 / 180.0;

struct World {
  Registry registry;
  std::vector<Signals> experiments;
  ModelRequest request;

  explicit World(bool given) {
    misfit_models_register(registry);
    const Table table = read_csv(MISFIT_SOURCE_DIR "/tests/benchmark/data/planar.csv");
    Signals s;
    s.name = "planar";
    s.t = table.values("t", "s");
    s.measured.push_back({"alpha_T", "rad", table.values("alpha_T", "rad"), 0.0});
    s.inputs = {{"phi", "rad", {}, 0.0}, {"phi_rate", "rad/s", {}, 0.0}};
    experiments.push_back(std::move(s));
    request.system = "parachute_planar";
    request.options.flags["induced_angle"] = false;
    request.constants = {{"D", 1.5816}, {"S", 1.9554}, {"R_cp", 3.15}, {"m", 0.206}, {"m_a", 0.294}, {"qbar", 736.0}, {"V", 35.1}};
    request.effects = {{"static_moment", "static_moment", {}, {}}, {"pitch_damping", "pitch_damping", {}, {}}};
    if (given) {
      std::vector<double> knots;
      for (int i = 0; i < 8; ++i) knots.push_back((2.7 + 15.0 * i / 7.0) * degree);  // 8 breakpoints: 10 coefficients
      request.curves["C_m"] = {"alpha_T", knots, 2.5, {}};
      request.curves["C_m_alphadot"] = {"alpha_T", knots, 1e-3, {}};
    } else {
      choose_all_knots(request, registry, experiments, 16);
    }
  }
};

double seconds(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Both kernels at the same parameters, interleaved, best of many: the least disturbed by whatever else the machine does.
void linearisation_against_hand_kernel() {
  const World world(true);
  const FittedModel fitted = output_error(equation_error(assemble(world.request, world.registry), world.experiments), world.experiments);
  const Model& model = fitted.model;
  const Signals& signals = world.experiments.front();
  constexpr int coefficients = 10;
  const double inertia = 0.5 * 3.15 * 3.15, moment = 736.0 * 1.9554 * 1.5816;
  const benchmark_data::HandKernel<coefficients> hand(model.curves.front().spline, moment / inertia, 1.5816 / (2.0 * 35.1));
  const std::vector<double> values = model.values();
  const double* C_m = values.data() + model.find_curve("C_m")->first;
  const double* C_d = values.data() + model.find_curve("C_m_alphadot")->first;
  const Eigen::VectorXd x0 = fitted.initial_states.front();
  const double sigma = fitted.fit.noise.at("alpha_T").value;
  RowMatrix history = RowMatrix::Zero(static_cast<Eigen::Index>(signals.samples()), 2);
  history.row(0) = x0;
  Shooting shooting(model, world.experiments, {sigma}, {1.0, 1.0}, {history});

  benchmark_data::HandKernel<coefficients>::Normal N;
  benchmark_data::HandKernel<coefficients>::Row g;
  NormalEquations general;
  double rss = 0.0;
  std::vector<double> by_hand, by_mechanism;
  constexpr int rounds = 200;
  for (int i = 0; i < rounds; ++i) {
    by_hand.push_back(seconds([&] {
      rss = hand.linearise(signals.t, signals.measured.front().values, sigma, {x0[0], x0[1]}, C_m, C_d, N, g);
    }));
    by_mechanism.push_back(seconds([&] { static_cast<void>(shooting.linearise(general)); }));
  }
  std::sort(by_hand.begin(), by_hand.end());
  std::sort(by_mechanism.begin(), by_mechanism.end());
  const double difference = (general.N - N).norm() / N.norm();
  std::printf("linearisation, 4761 samples, 22 unknowns (state, sensitivities, normal equations; interleaved, %d rounds)\n", rounds);
  std::printf("  hand-written kernel   %7.3f ms best, %7.3f ms median\n", 1e3 * by_hand.front(), 1e3 * by_hand[rounds / 2]);
  std::printf("  misfit                %7.3f ms best, %7.3f ms median\n", 1e3 * by_mechanism.front(), 1e3 * by_mechanism[rounds / 2]);
  std::printf("  ratio                 %7.2f best, %7.2f median   (target 2.5)\n", by_mechanism.front() / by_hand.front(),
              by_mechanism[rounds / 2] / by_hand[rounds / 2]);
  std::printf("  same normal equations to %.1e, residual sums %.6f and %.6f\n\n", difference, rss, general.rss);
}

void whole_fit(benchmark::State& state, bool given) {
  const World world(given);
  int linearisations = 0;
  for ([[maybe_unused]] auto _ : state) {
    const Model model = assemble(world.request, world.registry);
    const FittedModel fitted = output_error(equation_error(model, world.experiments), world.experiments);
    linearisations = fitted.fit.linearisations;
    benchmark::DoNotOptimize(fitted.fit.covariance.data());
  }
  state.counters["linearisations"] = linearisations;
}

}  // namespace
}  // namespace misfit

int main(int argc, char** argv) {
  misfit::linearisation_against_hand_kernel();
  benchmark::RegisterBenchmark("whole_fit/knots_and_roughness_given", misfit::whole_fit, true)->Unit(benchmark::kMillisecond)->MinTime(2.0);
  benchmark::RegisterBenchmark("whole_fit/chosen_from_data", misfit::whole_fit, false)->Unit(benchmark::kMillisecond)->MinTime(2.0);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
