#include "misfit/inference/output_weights.h"

#include <algorithm>
#include <cmath>

#include "misfit/core/display.h"
#include "misfit/core/text.h"

namespace misfit {

std::vector<Weighing> other_weighings(const Model& model) {
  constexpr double ratio = 0.02;
  std::vector<Weighing> out;
  for (std::size_t o = 0; o < model.known_noise.size(); ++o) {
    if (!model.known_noise[o].fixed) out.push_back({o, ratio});
  }
  const std::size_t outputs = out.size();
  if (outputs < 2) return {};
  for (std::size_t i = 0; i < outputs && outputs > 2; ++i) out.push_back({out[i].output, 1.0 / ratio});
  return out;
}

std::vector<std::string> other_maxima_in_words(const Model& model, const WeighedMaximum& best, std::vector<WeighedMaximum> others) {
  constexpr double nearly = 5.0;   // [log-likelihood]
  constexpr double another = 0.1;  // relative difference of a noise
  const auto& outputs = model.system->spec().outputs;
  const auto same_noise = [](const WeighedMaximum& a, const WeighedMaximum& b) {
    return std::equal(a.sigma.begin(), a.sigma.end(), b.sigma.begin(), [](double x, double y) { return std::abs(x / y - 1.0) < another; });
  };
  std::sort(others.begin(), others.end(), [](const auto& a, const auto& b) { return a.height > b.height; });
  std::vector<WeighedMaximum> known = {best};
  std::vector<std::string> words;
  for (const WeighedMaximum& other : others) {
    if (other.height < best.height - nearly) break;
    if (std::any_of(known.begin(), known.end(), [&](const WeighedMaximum& k) { return same_noise(k, other); })) continue;
    known.push_back(other);
    std::string noise;
    for (std::size_t o = 0; o < outputs.size(); ++o)
      noise += (o == 0 ? "" : ", ") + outputs[o].name + ": " + in_display_unit(other.sigma[o], outputs[o].unit);
    words.push_back("the likelihood has another maximum, lower by " + format_value(2.0 * (best.height - other.height)) +
                    " in 2 log L, that follows the outputs in another proportion (noise of " + noise + ")");
  }
  return words;
}

}  // namespace misfit
