// What is known of the states at the first samples, in the solver's problem and in its linearisation.

#include <algorithm>
#include <cmath>

#include "misfit/fit/shooting/shooting.h"

namespace misfit {

std::optional<double> Shooting::known_start(std::size_t experiment, std::size_t state) const {
  const StateSpec& spec = model_.state_specs[state];
  const bool goes_on = experiments_[experiment].after_gap;
  if (spec.initial == Initial::fixed && !goes_on) return spec.start;
  if ((spec.initial == Initial::shared && !goes_on) || !held_out_[experiment]) return std::nullopt;
  return read_start_[experiment][state];
}

bool Shooting::shared_start(std::size_t experiment, std::size_t state) const {
  return model_.state_specs[state].initial == Initial::shared && !experiments_[experiment].after_gap;
}

double Shooting::holding(std::size_t state) const {
  constexpr double tight = 1e3;   // per sigma of a defect: far below anything the data can show, far above rounding
  constexpr double small = 1e-2;  // of the state's typical size: where nothing measures it, a sigma of a defect is only a guess
  const double weight = tight / std::min(state_scale_[state], small * model_.state_specs[state].scale);
  return weight * weight;
}

/// Initial states that are known or shared, by stiff residuals.
void Shooting::add_initial(LeastSquares& problem, const std::vector<Piece>& pieces) const {
  int first = -1;
  for (const Piece& piece : pieces) {
    if (piece.first != 0) continue;
    if (first < 0) first = piece.block;
    for (std::size_t j = 0; j < model_.state_specs.size(); ++j) {
      const std::optional<double> known = known_start(piece.experiment, j);
      const bool tied = shared_start(piece.experiment, j) && piece.block != first;
      if (!known && !tied) continue;
      const double weight = std::sqrt(holding(j)), value = known.value_or(0.0);
      const std::size_t n = model_.states();
      const auto row = [j, n](double* J, double slope) {
        if (J == nullptr) return;
        std::fill_n(J, n, 0.0);
        J[j] = slope;
      };
      std::vector<int> blocks{piece.block};
      if (tied) blocks.push_back(first);
      problem.add_residuals(blocks, 1, [weight, value, j, tied, row](const double* const* x, double* r, double** J) {
        r[0] = weight * (x[0][j] - (tied ? x[1][j] : value));
        if (J == nullptr) return true;
        row(J[0], weight);
        if (tied) row(J[1], -weight);
        return true;
      });
    }
  }
}

void Shooting::hold_initial(NormalEquations& out) const {
  const auto columns = std::ssize(free_);
  const Eigen::Index n = model_.states();
  for (std::size_t e = 0; e < experiments_.size(); ++e) {
    for (std::size_t j = 0; j < model_.state_specs.size(); ++j) {
      const Eigen::Index own = columns + n * static_cast<Eigen::Index>(e) + static_cast<Eigen::Index>(j),
                         first = columns + static_cast<Eigen::Index>(j);
      const double weight = holding(j);
      if (const std::optional<double> known = known_start(e, j)) {
        out.N(own, own) += weight;
        out.g[own] += weight * (out.theta[own] - *known);
        out.held += 1.0;
      } else if (shared_start(e, j) && e > 0) {
        const double difference = out.theta[own] - out.theta[first];
        out.held += 1.0;
        out.N(own, own) += weight;
        out.N(first, first) += weight;
        out.N(own, first) -= weight;
        out.N(first, own) -= weight;
        out.g[own] += weight * difference;
        out.g[first] -= weight * difference;
      }
    }
  }
}

}  // namespace misfit
