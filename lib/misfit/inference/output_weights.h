#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "misfit/model/model.h"

// Outputs that a model cannot all follow at once: the likelihood has a maximum for each that it could follow best, and which of them a
// search ends at hangs on the noise it began with.
namespace misfit {

/// The noise of one output, to begin another search with.
struct Weighing {
  std::size_t output;
  double factor;  ///< of its sigma
};

/// Each output whose noise is not given with a fiftieth of its sigma and, of three or more, with fifty times; fewer than two: none.
[[nodiscard]] std::vector<Weighing> other_weighings(const Model& model);

/// A maximum of the likelihood.
struct WeighedMaximum {
  double height;              ///< [log-likelihood] by which they are compared
  std::vector<double> sigma;  ///< noise of every output
};

/// Those of `others` within 10 in 2 log L of the best and with another noise, each once.
[[nodiscard]] std::vector<std::string> other_maxima_in_words(const Model& model, const WeighedMaximum& best,
                                                             std::vector<WeighedMaximum> others);

/// What weigh_outputs_otherwise() needs of a search whose ends have `height`, `sigma` as above, and `settled`: a maximum, not only a point.
template <class End>
struct WeighedSearch {
  std::function<std::optional<End>(const Weighing&, const End& from)> end_from;  ///< nullopt: it leads nowhere, or back
  std::function<void(const End&)> return_to;
};

/// Searches from `here` with every other weighing and ends at the highest. Other maxima nearly as high, in words.
template <class End>
std::vector<std::string> weigh_outputs_otherwise(const Model& model, End here, const WeighedSearch<End>& search) {
  constexpr double clearly_higher = 0.5;  // [log-likelihood]
  std::vector<WeighedMaximum> others;
  for (const Weighing& weighing : other_weighings(model)) {
    std::optional<End> end = search.end_from(weighing, here);
    if (end && end->height > here.height + clearly_higher) std::swap(*end, here);
    if (end && end->settled) others.push_back({end->height, end->sigma});
    search.return_to(here);
  }
  return other_maxima_in_words(model, {here.height, here.sigma}, std::move(others));
}

}  // namespace misfit
