#pragma once

#include <optional>
#include <string>
#include <vector>

#include "misfit/data/candidates.h"
#include "misfit/workflow/session/session.h"

namespace misfit::serve {

/// An effect of the program, what it adds, and why `misfit add` refuses it for this model; empty: it does not.
struct Addable {
  std::string effect, formula, refused;
};

/// All effects of the program. `session`: of the last rung, opened to read. An effect that does not suit at its default place, or is there
/// already, can be added where the discovery lists another place of it.
[[nodiscard]] std::vector<Addable> addable_effects(const Session& session, const std::optional<Discovery>& discovery);
[[nodiscard]] std::string json_of(const std::vector<Addable>& effects);

}  // namespace misfit::serve
