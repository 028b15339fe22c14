#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "misfit/data/batch.h"
#include "misfit/report/figure.h"

namespace misfit::report {

/// How the numbers of one method vary over the studies of a batch: one panel each (at most `most`, the trim first), value ± sigma by study,
/// and their mean.
[[nodiscard]] Figure batch_figure(const Batch& batch, const std::string& method, std::size_t most = 8);

/// One figure per method that at least two studies have numbers of, drawn into `dir`; returns the names of the files.
std::vector<std::string> write_batch_figures(const std::filesystem::path& dir, const Batch& batch);

}  // namespace misfit::report
