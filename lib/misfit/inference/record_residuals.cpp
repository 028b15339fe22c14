#include "misfit/inference/record_residuals.h"

#include <cmath>

#include "misfit/core/display.h"
#include "misfit/core/text.h"

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
  if (!(part.spread > 0.0)) return out;
  const double percent = 100.0 * std::sqrt(part.squares / part.spread), step = std::pow(10.0, std::floor(std::log10(percent)) - 1.0);
  return out + ", " + format_value(percent > 0.0 ? std::round(percent / step) * step : 0.0) + " % of the motion";
}

void RecordResiduals::describe(const ChannelPrediction& prediction, Fit& fit) const {
  std::string words = fitted_.count > 0.0 ? in_words(fitted_, prediction.unit) : "";
  if (held_out_.count > 0.0) words += (words.empty() ? "held out: " : "; held out: ") + in_words(held_out_, prediction.unit);
  if (!words.empty()) fit.facts["residuals of " + prediction.channel + " in '" + prediction.experiment + "'"] = words;
}

}  // namespace misfit
