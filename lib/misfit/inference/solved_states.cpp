#include "misfit/inference/solved_states.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "misfit/inference/states.h"
#include "misfit/math/decompositions.h"
#include "misfit/math/statistics.h"
#include "misfit/model/limits.h"
#include "misfit/sim/trajectory.h"

namespace misfit {
namespace {

using States = std::array<double, kMaxStates>;

class OutputSolver {
 public:
  OutputSolver(const Model& model, const Signals& signals, const std::vector<bool>& shown)
      : model_(model), spec_(model.system->spec()), signals_(signals), inputs_(input_table(signals, model)), constants_(model.values()) {
    for (std::size_t j = 0; j < spec_.states.size(); ++j) start_[j] = start_of(model.state_specs[j]);
    for (const Signal& channel : signals.measured) weight_.push_back(1.0 / std::max(standard_deviation(channel.values), 1e-300));
    for (std::size_t j = 0; j < spec_.states.size(); ++j) {
      if (!shown[j] && depends_on(j)) unknown_.push_back(static_cast<int>(j));
    }
    if (unknown_.size() > spec_.outputs.size()) unknown_.clear();
    for (int o = 0; o < int_size(spec_.outputs); ++o) {
      const int state = spec_.outputs[o].observes;
      if (state >= 0 && shown[state]) observed_.push_back({o, state});
    }
  }

  SolvedStates run() {
    SolvedStates out{unknown_, std::vector<std::vector<double>>(unknown_.size(), std::vector<double>(signals_.samples(), std::nan("")))};
    std::optional<States> last;
    for (std::size_t i = 0; i < signals_.samples() && !unknown_.empty(); ++i) {
      if (!all_measured(i)) continue;
      std::optional<States> x = last ? solve(i, *last) : std::nullopt;
      if (!x) x = solve_from_grid(i);
      if (!x) continue;
      last = x;
      for (std::size_t u = 0; u < unknown_.size(); ++u) out.values[u][i] = (*x)[unknown_[u]];
    }
    return out;
  }

 private:
  struct Linear {
    Eigen::VectorXd residual;  ///< weighted
    Eigen::MatrixXd jacobian;
  };

  [[nodiscard]] bool all_measured(std::size_t i) const {
    return std::all_of(signals_.measured.begin(), signals_.measured.end(), [i](const Signal& s) { return std::isfinite(s.values[i]); });
  }

  [[nodiscard]] Linear linearise(std::size_t i, const States& x) const {
    std::array<double, kMaxOutputs> y{};
    std::array<double, std::size_t{kMaxOutputs} * kMaxStates> slope{};
    model_.system->linearise_outputs({x.data(), inputs_.at(i).values, signals_.t[i], constants_.data()}, y.data(), {.x = slope.data()});
    Linear out{Eigen::VectorXd(spec_.outputs.size()), Eigen::MatrixXd(spec_.outputs.size(), unknown_.size())};
    for (Eigen::Index o = 0; o < out.residual.size(); ++o) {
      out.residual[o] = weight_[o] * (signals_.measured[o].values[i] - y[o]);
      for (Eigen::Index u = 0; u < out.jacobian.cols(); ++u) out.jacobian(o, u) = weight_[o] * slope[o * spec_.states.size() + unknown_[u]];
    }
    return out;
  }

  /// At the start or half a scale of all states beside it.
  [[nodiscard]] bool depends_on(std::size_t state) const {
    std::array<double, kMaxOutputs> y{};
    std::array<double, std::size_t{kMaxOutputs} * kMaxStates> slope{};
    for (const double beside : {0.0, 0.5, -0.5}) {
      States x = start_;
      for (std::size_t j = 0; j < spec_.states.size(); ++j) x[j] += beside * spec_.states[j].scale;
      model_.system->linearise_outputs({x.data(), inputs_.at(0).values, signals_.t[0], constants_.data()}, y.data(), {.x = slope.data()});
      for (std::size_t o = 0; o < spec_.outputs.size(); ++o) {
        const double by = slope[o * spec_.states.size() + state];
        if (std::isfinite(by) && by != 0.0) return true;
      }
    }
    return false;
  }

  [[nodiscard]] std::optional<States> solve(std::size_t i, States x) const {
    constexpr int most_steps = 30;
    constexpr double still = 1e-10;
    for (const Observed& known : observed_) x[known.state] = signals_.measured[known.output].values[i];
    Linear here = linearise(i, x);
    double damping = 1e-6;
    for (int step = 0; step < most_steps && here.residual.allFinite(); ++step) {
      Eigen::MatrixXd N = here.jacobian.transpose() * here.jacobian;
      N.diagonal() += damping * N.diagonal();
      const Eigen::VectorXd d = symmetric_solve(N, Eigen::VectorXd(here.jacobian.transpose() * here.residual));
      if (!d.allFinite()) return std::nullopt;
      States next = x;
      for (std::size_t u = 0; u < unknown_.size(); ++u) next[unknown_[u]] += d[u];
      Linear there = linearise(i, next);
      if (!there.residual.allFinite() || there.residual.squaredNorm() > here.residual.squaredNorm()) {
        constexpr double hopeless = 1e8;
        damping *= 10.0;
        if (damping > hopeless) break;
        continue;
      }
      damping *= 0.1;
      x = next;
      here = std::move(there);
      if (d.norm() < still * scale_norm()) break;
    }
    return counts(here) ? std::optional(x) : std::nullopt;
  }

  [[nodiscard]] double scale_norm() const {
    double squares = 0.0;
    for (const int j : unknown_) squares += std::pow(spec_.states[j].scale, 2);
    return std::sqrt(squares);
  }

  [[nodiscard]] bool counts(const Linear& at) const {
    constexpr double most_left = 0.5, least_share = 1e-6;
    if (!(at.residual.cwiseAbs().maxCoeff() < most_left)) return false;
    const Eigen::VectorXd values = right_singular(at.jacobian).values;
    return values[values.size() - 1] > least_share * values[0];
  }

  /// The best of a grid of starts, the nearest first.
  [[nodiscard]] std::optional<States> solve_from_grid(std::size_t i) const {
    constexpr std::array<double, 9> places{0.0, 0.3, -0.3, 1.0, -1.0, 2.0, -2.0, 4.0, -4.0};
    std::size_t starts = 1;
    for (std::size_t u = 0; u < unknown_.size(); ++u) starts *= places.size();
    constexpr std::size_t most_starts = 729;
    std::optional<States> best;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < std::min(starts, most_starts); ++k) {
      States x = start_;
      std::size_t rest = k;
      for (const int j : unknown_) {
        x[j] += places[rest % places.size()] * spec_.states[j].scale;
        rest /= places.size();
      }
      const std::optional<States> found = solve(i, x);
      if (!found) continue;
      constexpr double clearly = 0.99;
      const double left = linearise(i, *found).residual.squaredNorm();
      if (left < clearly * least) least = left, best = found;
    }
    return best;
  }

  const Model& model_;
  const SystemSpec& spec_;
  const Signals& signals_;
  InputTable inputs_;
  std::vector<double> constants_, weight_;
  States start_{};
  std::vector<int> unknown_;
  struct Observed {
    int output, state;
  };
  std::vector<Observed> observed_;  // known at every sample: other outputs may depend on them
};

}  // namespace

SolvedStates solve_outputs(const Model& model, const Signals& signals, const std::vector<bool>& shown) {
  const std::size_t outputs = model.system->spec().outputs.size();
  const bool all = std::all_of(shown.begin(), shown.begin() + model.system_states(), [](bool s) { return s; });
  if (all || signals.measured.size() != outputs || signals.samples() == 0) return {};
  return OutputSolver(model, signals, shown).run();
}

}  // namespace misfit
