#pragma once

// References
//   [K]  H. R. Künsch, Ann. Statist. 17 (1989): the jackknife and the bootstrap for stationary observations (moving blocks).
//   [DH] A. C. Davison, D. V. Hinkley, Bootstrap Methods and their Application (1997), ch. 8.

#include <random>
#include <vector>

#include "misfit/data/fit.h"
#include "misfit/data/signals.h"

namespace misfit {

/// What is drawn anew.
enum class Resampled {
  residuals,  ///< measured = predicted + residuals in blocks: methods that predict the motion from its start alone (output_error)
  rows        ///< blocks of the measured samples, each an experiment of its own: regressions, and the filter, which starts anew in each
};

/// Replicas of experiments that keep the residuals' memory, by blocks of consecutive samples [K].
///
/// Residuals: of the counted samples (not excluded, not held out, every channel known), centred, brought up to the fit's noise sigma (a
/// fit takes part of the noise), drawn in blocks over all channels at once, so that correlation between channels stays. Blocks wrap around
/// the end [DH]. Samples that are missing stay missing; held-out ones stay as they are.
/// Rows: as many blocks as fill the counted samples. A stencil reaches over a block's ends, so each brings `kReach` further samples at
/// either end, which are not counted.
///
/// Block length, unless given: five times the lag up to which the residuals' correlation stands out (memory_of()), at least n^(1/3); for
/// rows 50 samples more; at most an eighth of the samples.
class Resampler {
 public:
  static constexpr std::size_t kReach = 4;

  /// InputError: a block that is not positive. RunError: fewer than 16 counted samples; a fit without predictions or of other experiments
  /// where residuals are to be drawn.
  Resampler(Resampled what, const Fit& fit, const std::vector<Signals>& experiments, int block = 0);

  [[nodiscard]] int block() const { return block_; }
  [[nodiscard]] std::vector<Signals> draw(std::mt19937_64& random) const;

 private:
  void collect_residuals(const Fit& fit);
  void collect_rows();
  [[nodiscard]] std::vector<Signals> draw_residuals(std::mt19937_64& random) const;
  [[nodiscard]] std::vector<Signals> draw_rows(std::mt19937_64& random) const;
  [[nodiscard]] Signals part(const Signals& whole, std::size_t first, std::size_t last) const;

  Resampled what_;
  const std::vector<Signals>& experiments_;
  int block_ = 0;
  std::vector<std::vector<std::vector<double>>> predicted_;  ///< experiment, channel, sample
  std::vector<std::vector<double>> pool_;                    ///< counted sample over all experiments → residual per channel
  struct Start {
    std::size_t experiment, sample;
  };
  std::vector<Start> starts_;  ///< of blocks of rows
  std::size_t counted_ = 0;
};

}  // namespace misfit
