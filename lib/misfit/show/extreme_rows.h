#pragma once

#include <cstddef>
#include <vector>

namespace misfit {

/// Rows that stand for all when lists of equal length are drawn as lines: of every stretch of equal count those at which one of the lists
/// is least or largest, no more than `most`; and besides, no more than as many again, the first and the last at which it has no number, so
/// that a gap breaks the line. In order, each once; all rows where they are no more than `most`.
[[nodiscard]] std::vector<std::size_t> extreme_rows(const std::vector<const std::vector<double>*>& lists, std::size_t most);

}  // namespace misfit
