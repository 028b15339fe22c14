#include "misfit/discover/screen.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "misfit/core/lists.h"
#include "misfit/discover/wave_scan.h"
#include "misfit/jobs/work_queue.h"
#include "misfit/math/statistics.h"

namespace misfit {
namespace {

double log_tail(const CandidateModel& candidate_model, double chi2, double dof) {
  if (!(chi2 > 0.0) || !(dof > 0.0)) return 0.0;
  const bool one_side = candidate_model.strengths.size() == 1 && candidate_model.one_sided.front();
  return log_chi_square_tail(chi2, dof) + (one_side ? std::log(0.5) : 0.0);
}

}  // namespace

double log_score_tail(const CandidateModel& candidate_model, const ScoreResult& score) {
  return log_tail(candidate_model, score.chi2, static_cast<double>(score.dof));
}

double log_drop_tail(const CandidateModel& candidate_model, double drop) {
  return log_tail(candidate_model, drop, static_cast<double>(candidate_model.strengths.size()));
}

CellScore score_cell(const FilterEstimate& estimate, const ScoreTest& score, const CandidateModel& candidate_model,
                     const std::vector<double>& at) {
  CellScore cell;
  cell.columns = sensitivity_columns(estimate, candidate_model, at);
  if (cell.columns.size() == 0) return cell;
  cell.result = score.test(cell.columns, candidate_model.has_priors ? &candidate_model.priors : nullptr);
  if (candidate_model.strengths.size() == 1 && candidate_model.one_sided.front() && cell.result.amplitude[0] < 0.0) {
    cell.result.chi2 = 0.0;
    cell.result.amplitude.setZero();
  }
  return cell;
}

namespace {

/// 1 − mean squared correlation of two cells' columns, free parameters projected out: how much a new cell adds.
double one_minus_squared_correlation(const ScoreTest& score, const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  if (a.size() == 0 || b.size() == 0) return 1.0;
  const Eigen::MatrixXd pa = score.projected(a), pb = score.projected(b);
  double shared = 0.0;
  Eigen::Index known = 0;
  for (Eigen::Index i = 0; i < pa.cols(); ++i) {
    const double na = pa.col(i).squaredNorm(), nb = pb.col(i).squaredNorm();
    if (!(na > 0.0) || !(nb > 0.0)) continue;
    const double product = pa.col(i).dot(pb.col(i));
    shared += product * product / (na * nb);
    ++known;
  }
  return known > 0 ? std::max(1.0 - shared / static_cast<double>(known), 0.0) : 1.0;
}

/// The nearest scanned value on one side of `from`; `from` if there is none.
double neighbour(const CandidateModel& candidate_model, std::size_t shape, double from, double side) {
  double best = from;
  for (const auto& cell : candidate_model.cells) {
    const bool beyond = side * (cell[shape] - from) > 0.0;
    if (beyond && (best == from || std::abs(cell[shape] - from) < std::abs(best - from))) best = cell[shape];
  }
  return best;
}

/// Tests values between the best cell and its neighbours, halving the distance each time: the score of a shape between two cells is lower
/// at the cells.
void refine_cell(const FilterEstimate& estimate, const ScoreTest& score, ScreeningResult& best) {
  const CandidateModel& candidate_model = *best.candidate_model;
  const std::vector<double> grid = best.cell;
  constexpr double fractions[] = {0.5, 0.25};
  for (const double fraction : fractions) {
    for (std::size_t i = 0; i < candidate_model.shapes.size(); ++i) {
      const Parameter& p = candidate_model.model.parameters[candidate_model.shapes[i]];
      const std::vector<double> middle = best.cell;
      const double between[] = {neighbour(candidate_model, i, grid[i], -1.0), neighbour(candidate_model, i, grid[i], 1.0)};
      for (const double to : between) {
        std::vector<double> at = middle;
        at[i] = std::clamp(at[i] + fraction * (to - grid[i]), p.lower, p.upper);
        if (at[i] == middle[i]) continue;
        CellScore cell = score_cell(estimate, score, candidate_model, at);
        if (cell.columns.size() == 0 || !(cell.result.chi2 > best.result.chi2)) continue;
        best.result = cell.result;
        best.columns = std::move(cell.columns);
        best.cell = at;
      }
    }
  }
}

constexpr std::size_t most_lines = 8;  // of a scan, that are tested exactly

/// Of the ports that an effect acts on: dynamic ones, or parameters.
std::vector<Eigen::VectorXd> scores_of_steps(const BoundEffect& effect, const ForceSensitivity& force) {
  std::vector<Eigen::VectorXd> out;
  for (const int port : effect.ports) {
    const int index = effect.kind == PortKind::quantity ? place_of(force.parameters(), port) : port;
    if (index >= 0 && effect.kind != PortKind::sensor) out.push_back(force.score_of_steps(effect.kind, index));
  }
  return out;
}

/// Spacings whose waves in the score of the force steps stand out most.
std::vector<double> spacing_peaks(const FilterEstimate& estimate, const CandidateModel& candidate_model, const ForceSensitivity& force,
                                  FrequencyGrid& grid) {
  const auto& [quantity, integrated] = *candidate_model.recurs_along;
  const std::vector<Eigen::VectorXd> scores = scores_of_steps(candidate_model.model.effects.back(), force);
  const Course course = course_of(estimate, force, quantity, integrated);
  grid = wave_grid(course, candidate_model.frequency_from, candidate_model.frequency_to, scores.size());
  std::vector<double> power(grid.count, 0.0), out;
  for (const Eigen::VectorXd& score : scores) add_over_background(wave_power(score, course, grid), power);
  for (const std::size_t f : strongest_lines(power, most_lines)) out.push_back(1.0 / grid.at(f));
  return out;
}

/// Frequencies whose line in the score of the force steps stands out most.
std::vector<double> frequency_peaks(const FilterEstimate& estimate, const CandidateModel& candidate_model, const ForceSensitivity& force,
                                    FrequencyGrid& grid) {
  if (candidate_model.recurs_along) return spacing_peaks(estimate, candidate_model, force, grid);
  SampleTimes times;
  for (std::size_t e = 0, from = 0; e < estimate.traces.size(); from += estimate.traces[e++].samples) {
    const auto first = force.times().begin() + from;
    times.emplace_back(first, first + estimate.traces[e].samples);
  }
  const std::vector<Eigen::VectorXd> scores = scores_of_steps(candidate_model.model.effects.back(), force);
  grid = frequency_grid(times, candidate_model.frequency_from, candidate_model.frequency_to, scores.size());
  std::vector<double> power(grid.count, 0.0);
  for (const Eigen::VectorXd& score : scores) add_over_background(periodogram(score, times, grid), power);
  std::vector<double> out;
  for (const std::size_t f : strongest_lines(power, most_lines)) out.push_back(grid.at(f));
  return out;
}

/// The cells of a candidate model; one with a frequency has each of its other cells at every peak.
std::vector<std::vector<double>> cells_of(const FilterEstimate& estimate, const CandidateModel& candidate_model,
                                          const ForceSensitivity& force, FrequencyGrid& frequencies) {
  if (candidate_model.frequency < 0) return candidate_model.cells;
  std::vector<std::vector<double>> out;
  for (double f : frequency_peaks(estimate, candidate_model, force, frequencies)) {
    for (auto cell : candidate_model.cells) {
      cell.push_back(f);
      out.push_back(std::move(cell));
    }
  }
  return out;
}

/// Independent lines in a scan of the range Δf, as far as the tail of its largest chi² is concerned: 1.02 Δf T √(chi²/2), which grows with
/// the height since a high line is a narrow one (Baluev, Mon. Not. R. Astron. Soc. 385 (2008) 1279: Rice's formula, T = √(12 var t), the
/// length of a recording of even density); never below the 2 Δf T of a line as wide as 1/(2T).
double independent_frequencies(const FrequencyGrid& grid, double chi2) {
  constexpr double of_even_density = 1.0233;  // sqrt(4 pi/12)
  const double lines = static_cast<double>(grid.count) * grid.step * grid.even_length;
  return std::max({of_even_density * lines * std::sqrt(0.5 * std::max(chi2, 0.0)), 2.0 * lines, 1.0});
}

}  // namespace

double family_wise_p(double log_p, double families) { return sidak(std::min(1.0, std::exp(log_p)), families); }

std::vector<ScreeningResult> screen(const ScoreWork& work, const std::vector<CandidateModel>& candidate_models,
                                    const ProgressFn& progress) {
  std::vector<ScreeningResult> out(candidate_models.size());
  std::vector<std::vector<std::vector<double>>> cells(candidate_models.size());
  std::vector<FrequencyGrid> frequencies(candidate_models.size());
  std::vector<std::pair<std::size_t, std::size_t>> jobs;  // candidate model, cell
  for (std::size_t s = 0; s < candidate_models.size(); ++s) {
    cells[s] = cells_of(work.estimate, candidate_models[s], work.force, frequencies[s]);
    for (std::size_t c = 0; c < cells[s].size(); ++c) jobs.emplace_back(s, c);
  }
  std::vector<std::vector<CellScore>> results;
  for (const auto& own : cells) results.emplace_back(own.size());
  run_jobs(
      jobs.size(), work.threads,
      [&](std::size_t j) {
        const auto [s, c] = jobs[j];
        results[s][c] = score_cell(work.estimate, work.score, candidate_models[s], cells[s][c]);
      },
      progress);
  run_jobs(candidate_models.size(), work.threads, [&](std::size_t s) {
    ScreeningResult& best = out[s];
    best.candidate_model = &candidate_models[s];
    best.runs = false;
    best.cells = cells[s].size();
    for (std::size_t c = 0; c < cells[s].size(); ++c) {
      CellScore& cell = results[s][c];
      if (cell.columns.size() == 0) continue;
      if (!best.runs || cell.result.chi2 > best.result.chi2) {
        best.result = cell.result;
        best.cell = cells[s][c];
        best.columns = cell.columns;
      }
      best.runs = true;
      if (c > 0 && candidate_models[s].frequency < 0)
        best.cells_effective += one_minus_squared_correlation(work.score, results[s][c - 1].columns, cell.columns);
    }
    if (candidate_models[s].frequency >= 0) {
      best.frequencies = frequencies[s];
      best.cells_effective =
          independent_frequencies(frequencies[s], best.result.chi2) * static_cast<double>(candidate_models[s].cells.size());
    }
    if (!best.runs || best.result.dof == 0) return;
    constexpr double max_p_refined = 0.1;
    if (!candidate_models[s].shapes.empty() &&
        sidak(chi_square_tail(best.result.chi2, best.result.dof), best.cells_effective) < max_p_refined)
      refine_cell(work.estimate, work.score, best);
    best.log_p = log_score_tail(candidate_models[s], best.result);
    best.p_value = sidak(std::exp(best.log_p), best.cells_effective);
    best.log_p += std::log(best.cells_effective);
  });
  return out;
}

}  // namespace misfit
