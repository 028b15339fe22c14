#pragma once

#include <cstddef>

#include "misfit/data/candidates.h"
#include "misfit/data/diagnosis.h"
#include "misfit/data/fit.h"

namespace misfit::page {

/// Recordings of more than `most` samples with about that many: of every stretch of equal count those stay at which what is drawn is least
/// and largest (as a screen shows a long recording) or missing, all quantities of a sample together. Nothing else changes.
void thin(Fit& fit, std::size_t most);
void thin(Diagnosis& diagnosis, std::size_t most);
void thin(Discovery& discovery, std::size_t most);

}  // namespace misfit::page
