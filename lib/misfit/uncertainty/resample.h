#pragma once

// References
//   [K]  H. R. Künsch, Ann. Statist. 17 (1989): the jackknife and the bootstrap for stationary observations (moving blocks).
//   [DH] A. C. Davison, D. V. Hinkley, Bootstrap Methods and their Application (1997), ch. 8.

#include <random>
#include <string>
#include <vector>

#include "misfit/data/fit.h"
#include "misfit/data/signals.h"

namespace misfit {

/// What is drawn anew.
enum class Resampled {
  residuals,  ///< measured = predicted + residuals in blocks: methods that predict the motion from its start alone (output_error)
  rows        ///< blocks of the measured samples, each an experiment of its own: regressions, and the filter, which starts anew in each
};

/// Residuals of equations: experiment, equation, sample; NaN where not used.
using EquationResiduals = std::vector<std::vector<std::vector<double>>>;

/// How long the blocks are.
struct BlockLength {
  int samples = 0;              ///< 0: from the memory of the residuals
  EquationResiduals equations;  ///< whose memory it is where the fit predicts no motion (equation_error)
};

/// Replicas of experiments that keep the residuals' memory, by blocks of consecutive samples [K].
///
/// A sample counts where any channel is measured that is neither excluded nor held out; rows without a measurement are in no block's
/// length. Residuals: of the counted samples, centred, brought up to the fit's noise sigma (a fit takes part of the noise), drawn in blocks
/// over all channels at once, so that correlation between channels stays. Where channels are measured at different samples, each takes its
/// own residuals one after the other from the time on at which the block starts. Blocks wrap around the end [DH]. Samples that are missing
/// stay missing; held-out ones stay as they are. Rows: blocks without a held-out sample, until they have as many counted samples as the
/// experiments; the last ones are shortened for that (two share what one and a part would leave). A stencil reaches over a block's ends, so
/// each brings up to `kReach` further samples at either end, which are not counted.
///
/// Block length, unless given: five times the lag up to which the residuals' correlation stands out (correlation_length()), at least
/// n^(1/3); for rows 50 samples more. At most an eighth of the samples, given or not: note() says so.
class Resampler {
 public:
  static constexpr std::size_t kReach = 4;

  /// InputError: a length below 0. RunError: fewer than 16 counted samples; a fit without predictions or of other experiments
  /// where residuals are to be drawn.
  Resampler(Resampled what, const Fit& fit, const std::vector<Signals>& experiments, const BlockLength& length = {});

  [[nodiscard]] int block() const { return block_; }
  /// What a reader must know of the length; empty: nothing.
  [[nodiscard]] const std::string& note() const { return note_; }
  [[nodiscard]] std::vector<Signals> draw(std::mt19937_64& random) const;

 private:
  void choose_length(const BlockLength& length);
  void collect_residuals(const Fit& fit);
  void collect_equations(const EquationResiduals& equations);
  void collect_rows();
  void group_channels(std::size_t channels);
  [[nodiscard]] std::vector<Signals> draw_residuals(std::mt19937_64& random) const;
  [[nodiscard]] std::vector<Signals> draw_rows(std::mt19937_64& random) const;
  struct Place {
    std::size_t experiment, sample;
  };
  /// Channels whose residuals are drawn together, in the order of the samples of the pool at which they are known.
  struct Group {
    std::vector<std::size_t> channels, known;
    [[nodiscard]] std::size_t first_from(std::size_t sample) const;
  };
  /// Draws residual `at` of the group where its channels are measured; returns the one that is next.
  [[nodiscard]] std::size_t draw_group(const Group& group, std::size_t at, const Place& place, Signals& out) const;
  [[nodiscard]] Signals part(const Signals& whole, std::size_t first, std::size_t last) const;

  Resampled what_;
  const std::vector<Signals>& experiments_;
  int block_ = 0;
  std::string note_;
  std::vector<std::vector<std::vector<double>>> predicted_;  ///< experiment, channel, sample
  std::vector<std::vector<double>> pool_;  ///< used sample over all experiments → residual per channel (NaN: not measured) or equation
  std::vector<Group> groups_;
  std::vector<Place> starts_;  ///< of blocks of rows
  std::size_t counted_ = 0;
};

}  // namespace misfit
