#pragma once

#include <string>
#include <utility>
#include <vector>

namespace misfit {

/// Words that misfit uses in a sense of its own, each with its meaning.
using Words = std::vector<std::pair<const char*, std::string>>;

/// Those of lib/misfit/README.md, 2, that a user meets first: misfit help words, and the end of a report.
[[nodiscard]] Words twelve_words();
[[nodiscard]] Words further_words();

}  // namespace misfit
