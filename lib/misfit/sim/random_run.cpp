#include "misfit/sim/random_run.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "misfit/sim/planner.h"

namespace misfit {
namespace {

/// Inputs within an interval, as each input's Hold says.
void inputs_at(const Model& model, const Interval& within, double fraction, double* u) {
  const auto& specs = model.system->spec().inputs;
  for (int i = 0; i < std::ssize(specs); ++i)
    u[i] = input_within(specs[i].hold, within.u0, within.u1, i, fraction, within.t1 - within.t0).value;
}

/// One realisation in progress.
class RandomRun {
 public:
  RandomRun(Stepper& stepper, std::mt19937_64& random, const std::vector<double>& further)
      : stepper_(stepper), random_(random), further_(further), model_(stepper.evaluator().model()), nx_(model_.system_states()) {}

  bool advance(double* x, const Interval& whole) {
    stepper_.prepare(x, whole.u0, whole.t0);
    stepper_.evaluator().diffusion(x, whole.u0, whole.t0, intensity_.data());
    for (std::size_t i = 0; i < further_.size(); ++i) intensity_[i] = std::hypot(intensity_[i], further_[i]);
    constexpr double largest_product = 0.1, stiff = 1e3;
    const double h = whole.t1 - whole.t0;
    const double parts = std::max(std::ceil(stepper_.fastest_rate() * h / largest_product), 1.0);
    if (parts > stiff) return advance_planned(x, whole);
    std::array<double, kMaxInputs> from{}, to{};
    for (double part = 0.0; part < parts; part += 1.0) {
      inputs_at(model_, whole, part / parts, from.data());
      inputs_at(model_, whole, (part + 1.0) / parts, to.data());
      add_noise(x, 0.5 * h / parts);
      const RecordedInputs* record = whole.u0.record;
      if (!stepper_.step(x, {whole.t0 + h * part / parts, whole.t0 + h * (part + 1.0) / parts, {from.data(), record}, {to.data(), record}}))
        return false;
      add_noise(x, 0.5 * h / parts);
    }
    return true;
  }

 private:
  /// In the parts of a plan made for this interval from here.
  bool advance_planned(double* x, const Interval& whole) {
    constexpr double tolerance = 1e-6;
    Interval interval = whole;
    interval.rate = stepper_.fastest_rate();
    double from = 0.0;
    for (const StepPart& part : plan_interval(stepper_, interval, x, tolerance)) {
      const double noisy = 0.5 * (part.to - from) * (whole.t1 - whole.t0);
      add_noise(x, noisy);
      if (!stepper_.advance(x, whole, from, part)) return false;
      add_noise(x, noisy);
      from = part.to;
    }
    return true;
  }

  void add_noise(double* x, double h) {
    for (int i = nx_; i < model_.states(); ++i) {
      const double intensity = intensity_[i - nx_];
      if (intensity > 0.0) x[i] += intensity * std::sqrt(h) * normal_(random_);
    }
  }

  Stepper& stepper_;
  std::mt19937_64& random_;
  const std::vector<double>& further_;
  const Model& model_;
  int nx_;
  std::array<double, kMaxStates> intensity_{};
  std::normal_distribution<double> normal_;
};

}  // namespace

bool has_random_states(Evaluator& evaluator, const double* x, const InputsAt& u, double t) {
  std::array<double, kMaxStates> intensity{};
  evaluator.diffusion(x, u, t, intensity.data());
  return std::any_of(intensity.begin(), intensity.end(), [](double value) { return value > 0.0; });
}

void run_randomly(const Simulation& simulation, const double* x0, std::mt19937_64& random, Segment& out,
                  const std::vector<double>& further) {
  const auto& [stepper, signals, inputs] = simulation;
  RandomRun run(stepper, random, further);
  std::array<double, kMaxStates> x{};
  std::copy_n(x0, stepper.states(), x.begin());
  out.first = 0;
  out.last = signals.samples();
  out.finite = false;
  out.y.resize(out.last, stepper.evaluator().outputs());
  std::array<double, kMaxSensorPorts> y{};
  for (std::size_t i = 0; i < out.last; ++i) {
    out.failed_at = i;
    prepare_at(simulation, i, x.data());  // where its time is shifted
    if (!predict_at(simulation, i, x.data(), y.data())) return;
    std::copy_n(y.begin(), out.y.cols(), out.y.row(i).data());
    if (!out.y.row(i).allFinite()) return;
    if (i + 1 == out.last) break;
    out.failed_at = i + 1;
    if (!run.advance(x.data(), {signals.t[i], signals.t[i + 1], inputs.at(i), inputs.at(i + 1)})) return;
  }
  out.end = Eigen::Map<const Eigen::VectorXd>(x.data(), stepper.states());
  out.finite = true;
}

}  // namespace misfit
