// What is known of the states at the first samples, in the solver's problem and in its linearisation.

#include <algorithm>
#include <cmath>

#include "misfit/fit/shooting/shooting.h"

namespace misfit {

Initial Shooting::kind_of_start(std::size_t experiment, std::size_t state) const {
  const bool of_an_effect = state >= model_.state_specs.size();
  return of_an_effect || experiments_[experiment].after_gap ? Initial::free : model_.state_specs[state].initial;
}

std::optional<double> Shooting::known_start(std::size_t experiment, std::size_t state) const {
  if (kind_of_start(experiment, state) == Initial::fixed) return model_.state_specs[state].start;
  if (!read_from_samples(experiment, state)) return std::nullopt;
  return read_start_[experiment][state];
}

bool Shooting::read_from_samples(std::size_t experiment, std::size_t state) const {
  return held_out_[experiment] && kind_of_start(experiment, state) != Initial::fixed && !shared_start(experiment, state);
}

bool Shooting::shared_start(std::size_t experiment, std::size_t state) const {
  return shared_with_ && kind_of_start(experiment, state) == Initial::shared;
}

double Shooting::holding(std::size_t state) const {
  constexpr double tight = 1e3;   // per sigma of a defect: far below anything the data can show, far above rounding
  constexpr double small = 1e-2;  // of the state's typical size: where nothing measures it, a sigma of a defect is only a guess
  const double scale = state < model_.state_specs.size() ? model_.state_specs[state].scale : 1.0;
  const double weight = tight / std::min(state_scale_[state], small * scale);
  return weight * weight;
}

/// Initial states that are known or shared, by stiff residuals.
void Shooting::add_initial(LeastSquares& problem, const std::vector<Piece>& pieces) const {
  const auto shared = std::find_if(pieces.begin(), pieces.end(), [&](const Piece& piece) { return piece.experiment == shared_with_; });
  const int with = shared == pieces.end() ? -1 : shared->block;
  const std::size_t n = model_.states();
  for (const Piece& piece : pieces) {
    if (piece.first != 0) continue;
    for (std::size_t j = 0; j < n; ++j) {
      const std::optional<double> known = known_start(piece.experiment, j);
      const bool tied = shared_start(piece.experiment, j) && piece.block != with;
      if (!known && !tied) continue;
      const double weight = std::sqrt(holding(j)), value = known.value_or(0.0);
      const auto row = [j, n](double* J, double slope) {
        if (J == nullptr) return;
        std::fill_n(J, n, 0.0);
        J[j] = slope;
      };
      std::vector<int> blocks{piece.block};
      if (tied) blocks.push_back(with);
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

void Shooting::constrain_initial(NormalEquations& out) const {
  const auto columns = std::ssize(free_);
  const Eigen::Index n = model_.states();
  for (std::size_t e = 0; e < experiments_.size(); ++e) {
    for (std::size_t j = 0; j < static_cast<std::size_t>(n); ++j) {
      const auto place_in = [&](std::size_t of) { return columns + n * static_cast<Eigen::Index>(of) + static_cast<Eigen::Index>(j); };
      const Eigen::Index own = place_in(e), with = place_in(shared_with_.value_or(e));
      const double weight = holding(j);
      if (const std::optional<double> known = known_start(e, j)) {
        out.N(own, own) += weight;
        out.g[own] += weight * (out.theta[own] - *known);
        out.constraints += 1.0;
      } else if (shared_start(e, j) && own != with) {
        const double difference = out.theta[own] - out.theta[with];
        out.constraints += 1.0;
        out.N(own, own) += weight;
        out.N(with, with) += weight;
        out.N(own, with) -= weight;
        out.N(with, own) -= weight;
        out.g[own] += weight * difference;
        out.g[with] -= weight * difference;
      }
    }
  }
}

}  // namespace misfit
