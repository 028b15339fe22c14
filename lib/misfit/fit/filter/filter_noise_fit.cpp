#include "misfit/fit/filter/filter_noise_fit.h"

#include <algorithm>
#include <cmath>

#include "misfit/jobs/work_queue.h"
#include "misfit/math/decompositions.h"

namespace misfit {
namespace {

void append(const Innovations& more, Innovations& out) {
  for (const auto of : {&Innovations::e, &Innovations::S, &Innovations::departures, &Innovations::variances, &Innovations::minus_log})
    (out.*of).insert((out.*of).end(), (more.*of).begin(), (more.*of).end());
}

/// All experiments, one after the other.
Innovations run_all(const LinearisedRuns& runs, const FilterNoise& noise) {
  Innovations out;
  for (std::size_t k = 0; k < runs.data->size(); ++k) {
    append(run_linear(*runs.model, (*runs.data)[k], (*runs.traces)[k], noise), out);
  }
  return out;
}

std::vector<bool> counted_innovations(const LinearisedRuns& runs) {
  std::vector<bool> out;
  for (const auto& data : *runs.data) {
    for (SampleRole use : data.use) out.push_back(use == SampleRole::counted);
  }
  return out;
}

double cost(const Innovations& s, const std::vector<bool>& counts) {
  double sum = 0.0;
  for (std::size_t i = 0; i < s.e.size(); ++i) {
    if (counts[i]) sum += s.minus_log_density(i);
  }
  return std::isfinite(sum) ? sum : std::numeric_limits<double>::infinity();
}

class Scoring {
 public:
  Scoring(const LinearisedRuns& runs, const NoiseVector& start, int threads)
      : runs_(runs), vector_(start), threads_(threads), counts_(counted_innovations(runs)) {}

  Eigen::MatrixXd information(const std::vector<double>& at) {
    derivatives(at, run_all(runs_, unpacked(at)));
    return information_;
  }

  NoiseFit run(int max_iterations) {
    NoiseFit out;
    std::vector<double> at = vector_.value;
    Innovations present = run_all(runs_, unpacked(at));
    double best = cost_at(at, present);
    double damping = 1e-3;
    bool fresh = false;  // derivatives are those at `at`
    for (int iteration = 0; iteration < max_iterations; ++iteration) {
      derivatives(at, present);
      fresh = true;
      bool moved = false;
      double expected = 0.0;
      for (int attempt = 0; attempt < 6 && !moved; ++attempt) {
        const std::vector<double> next = step(at, damping, expected);
        if (expected < 1e-3) break;
        Innovations there = run_all(runs_, unpacked(next));
        const double value = cost_at(next, there);
        if (value < best) {
          moved = true;
          fresh = false;
          damping = std::max(damping * 0.2, 1e-6);
          at = next;
          present = std::move(there);
          best = value;
        } else {
          damping = std::max(damping * 8.0, 1e-3);
        }
      }
      if (!moved) {
        out.converged = expected < 1e-2;
        break;
      }
    }
    if (!fresh && max_iterations > kRefinements) derivatives(at, present);
    out.logs = at;
    out.noise = unpacked(at);
    out.minus_log_density = best;
    out.information = information_;
    for (std::size_t i = 0; i < at.size(); ++i) out.at_bound.push_back(stuck(at, i));
    return out;
  }

 private:
  [[nodiscard]] FilterNoise unpacked(const std::vector<double>& logs) const { return unpack(logs, runs_.model->model.system->spec()); }

  static Eigen::Map<const Eigen::VectorXd> vector(const std::vector<double>& v) { return {v.data(), std::ssize(v)}; }

  [[nodiscard]] double cost_at(const std::vector<double>& logs, const Innovations& there) const {
    return cost(there, counts_) - vector_.prior.log_density(vector(logs));
  }

  [[nodiscard]] bool stuck(const std::vector<double>& at, std::size_t i) const {
    constexpr double near = 1e-6;
    return at[i] < vector_.lower[i] + near || at[i] > vector_.upper[i] - near;
  }

  /// Of innovations and variances.
  struct Whitened {
    std::vector<double> e, S;
  };
  [[nodiscard]] Whitened whitened_change(const Innovations& here, const Innovations& there, double scale) const {
    Whitened out{std::vector<double>(here.e.size(), 0.0), std::vector<double>(here.e.size(), 0.0)};
    for (std::size_t k = 0; k < here.e.size(); ++k) {
      if (!counts_[k]) continue;
      out.e[k] = (there.departure(k) - here.departure(k)) * scale / std::sqrt(here.S[k]);
      out.S[k] = (there.variance(k) - here.variance(k)) * scale / here.S[k];
    }
    return out;
  }

  void derivatives(const std::vector<double>& at, const Innovations& here) {
    constexpr double difference = 1e-4;
    const std::size_t n = at.size();
    std::vector<Whitened> moved(n);
    run_jobs(n, threads_, [&](std::size_t i) {
      std::vector<double> there = at;
      there[i] += there[i] + difference < vector_.upper[i] ? difference : -difference;
      moved[i] = whitened_change(here, run_all(runs_, unpacked(there)), 1.0 / (there[i] - at[i]));
    });
    gradient_ = Eigen::VectorXd::Zero(n);
    information_ = Eigen::MatrixXd::Zero(gradient_.size(), gradient_.size());
    for (std::size_t k = 0; k < here.e.size(); ++k) {
      if (!counts_[k]) continue;
      const double w = here.e[k] / std::sqrt(here.S[k]);
      for (std::size_t i = 0; i < n; ++i) {
        const Eigen::Index row = i;
        gradient_[row] += w * moved[i].e[k] + 0.5 * (1.0 - w * w) * moved[i].S[k];
        for (std::size_t j = 0; j <= i; ++j) information_(row, j) += moved[i].e[k] * moved[j].e[k] + 0.5 * moved[i].S[k] * moved[j].S[k];
      }
    }
    information_ = Eigen::MatrixXd(information_.selfadjointView<Eigen::Lower>());
    gradient_ -= vector_.prior.gradient(vector(at));
    information_.diagonal() += vector_.prior.precision;
  }

  /// A damped step inside the bounds, each logarithm by at most 1; what it is expected to gain.
  std::vector<double> step(const std::vector<double>& at, double damping, double& expected) const {
    Eigen::MatrixXd A = information_;
    for (Eigen::Index i = 0; i < A.rows(); ++i) {
      A(i, i) += damping * A(i, i) + 1e-6;
      const std::size_t k = i;
      const bool outward =
          (at[k] <= vector_.lower[k] + 1e-9 && gradient_[i] > 0.0) || (at[k] >= vector_.upper[k] - 1e-9 && gradient_[i] < 0.0);
      if (outward) A(i, i) += 1e12;
    }
    const Eigen::VectorXd d = symmetric_solve(A, gradient_);
    expected = 0.5 * gradient_.dot(d);
    std::vector<double> next = at;
    for (std::size_t i = 0; i < at.size(); ++i)
      next[i] = std::clamp(at[i] - std::clamp(d[i], -1.0, 1.0), vector_.lower[i], vector_.upper[i]);
    return next;
  }

  const LinearisedRuns& runs_;
  const NoiseVector& vector_;
  int threads_;
  std::vector<bool> counts_;
  Eigen::VectorXd gradient_;
  Eigen::MatrixXd information_;
};

}  // namespace

NoiseFit fit_noise(const LinearisedRuns& runs, const FilterNoise& start, const NoiseSearch& search) {
  const NoiseVector vector = pack(start, runs.model->model.system->spec(), search.reference);
  return Scoring(runs, vector, search.threads).run(search.max_iterations);
}

Eigen::MatrixXd noise_information(const LinearisedRuns& runs, const std::vector<double>& logs, const FilterNoise& reference, int threads) {
  const NoiseVector vector = pack(unpack(logs, runs.model->model.system->spec()), runs.model->model.system->spec(), reference);
  return Scoring(runs, vector, threads).information(logs);
}

namespace {

constexpr double pin = 1e12;

}  // namespace

std::vector<bool> pin_unknown(const NoiseFit& fit, Eigen::MatrixXd& information) {
  constexpr double determined = 1.0;
  const Eigen::Index first = information.rows() - fit.at_bound.size();
  std::vector<bool> known;
  for (std::size_t i = 0; i < fit.at_bound.size(); ++i) {
    double& own = information(first + i, first + i);
    known.push_back(!fit.at_bound[i] && own > determined);
    if (!known.back()) own += pin;
  }
  return known;
}

bool pinned(double variance) { return variance < 100.0 / pin; }

}  // namespace misfit
