#include "misfit/inference/beyond_record.h"

#include "misfit/core/display.h"
#include "misfit/model/memory.h"

namespace misfit {

std::optional<std::string> outlasts_recording(const Model& model, const BoundEffect& effect, double seconds) {
  constexpr double longest = 0.5;  // of the recording
  const EffectSpec& spec = effect.effect->spec();
  for (std::size_t c = 0; c < effect.coefficients.size(); ++c) {
    if (effect.coefficients[c].parameter < 0) continue;
    const Parameter& p = model.parameters[effect.coefficients[c].parameter];
    const std::string value = p.name + " = " + in_display_unit(p.value, p.unit), recording = in_display_unit(seconds, "s");
    if (spec.coefficients[c].scan.is_in_time() && p.value * seconds < 1.0)
      return value + " is less than one period in the recording, " + recording;
    if (has_memory(spec) && p.unit == "s" && p.value >= longest * seconds)
      return value + " is longer than half of the recording, " + recording;
  }
  return std::nullopt;
}

}  // namespace misfit
