#pragma once

#include <optional>
#include <string>

#include "misfit/data/fit.h"

namespace misfit {

/// Residuals of one output in one experiment beside the size of what was measured there.
class RecordResiduals {
 public:
  /// Values that are not finite do not count.
  void add(double measured, double predicted, bool held_out);
  /// Into the prediction's rms and nrmse, and into facts as "residuals of OUTPUT in 'EXPERIMENT'": "RMS 0.6 V, 28 % of the motion",
  /// held-out samples by themselves. Per cent: the RMS over the standard deviation of the same measurements (NRMSE); left out where they do
  /// not vary. Nothing where none counts.
  void describe(ChannelPrediction& prediction, Fit& fit) const;

 private:
  struct Part {
    double count = 0.0, squares = 0.0, mean = 0.0, spread = 0.0;  ///< spread: Σ (measured − mean)²
    [[nodiscard]] std::optional<double> nrmse() const;
  };
  [[nodiscard]] static std::string in_words(const Part& part, const std::string& unit);

  Part fitted_, held_out_;
};

}  // namespace misfit
