#pragma once

#include "misfit/model/model.h"

namespace misfit {

/// assemble() where knots are still to be chosen: any stand for them. For what needs the system, names and units, and not the curves.
[[nodiscard]] Model provisional_model(ModelRequest request, const Registry& registry);

}  // namespace misfit
