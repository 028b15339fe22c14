#pragma once

#include <string>

namespace misfit {

/// "0.64 s", "5.33 h", "8 d": the largest unit of which there are two.
[[nodiscard]] std::string duration_in_words(double seconds);

}  // namespace misfit
