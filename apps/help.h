#pragma once

#include <string>
#include <vector>

#include "misfit/model/registry.h"

namespace misfit {

/// Topics of `misfit help` beside the verbs, with what they are about.
[[nodiscard]] const std::vector<std::pair<std::string, std::string>>& help_topics();

/// The text of one of them, in lines of at most 100 characters.
[[nodiscard]] std::string help_text(const std::string& topic, const Registry& registry);

}  // namespace misfit
