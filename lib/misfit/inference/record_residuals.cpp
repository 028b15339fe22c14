#include "misfit/inference/record_residuals.h"

#include <cmath>

#include "misfit/core/display.h"

namespace misfit {

void RecordResiduals::add(double measured, double predicted, bool held_out) {
  const double residual = measured - predicted;
  if (!std::isfinite(residual)) return;
  Part& part = held_out ? held_out_ : fitted_;
  part.count += 1.0;
  part.squares += residual * residual;
  const double deviation = measured - part.mean;
  part.mean += deviation / part.count;
  part.spread += deviation * (measured - part.mean);
}

std::string RecordResiduals::in_words(const Part& part, const std::string& unit) {
  std::string out = "RMS " + in_display_unit(std::sqrt(part.squares / part.count), unit);
  if (const auto share = part.nrmse()) out += ", " + share_of_motion_in_words(*share);
  return out;
}

std::optional<double> RecordResiduals::Part::nrmse() const {
  return spread > 0.0 ? std::optional(std::sqrt(squares / spread)) : std::nullopt;
}

void RecordResiduals::describe(ChannelPrediction& prediction, Fit& fit) const {
  if (fitted_.count > 0.0) prediction.rms = std::sqrt(fitted_.squares / fitted_.count);
  prediction.nrmse = fitted_.nrmse();
  std::string words = fitted_.count > 0.0 ? in_words(fitted_, prediction.unit) : "";
  if (held_out_.count > 0.0) words += (words.empty() ? "held out: " : "; held out: ") + in_words(held_out_, prediction.unit);
  if (!words.empty()) fit.facts["residuals of " + prediction.channel + " in '" + prediction.experiment + "'"] = words;
}

}  // namespace misfit
