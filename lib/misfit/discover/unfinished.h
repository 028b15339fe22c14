#pragma once

#include <string>
#include <vector>

#include "misfit/data/candidates.h"

namespace misfit {

/// Of effects whose refits their time limit has cut off: where none is accepted, the verdict begins with them, so that none is read as
/// evidence against them; else a sentence says that they are tested again.
void say_unfinished(const std::vector<std::string>& effects, Discovery& discovery);

/// Of a search that its own limit has cut off; `spent`: which; `screened`: all candidates had been tested one by one. Where one had been
/// accepted by then, only its group is unfinished.
void say_cut_off(const std::string& spent, bool screened, Discovery& discovery);

}  // namespace misfit
