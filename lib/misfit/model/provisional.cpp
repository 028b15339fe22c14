#include "misfit/model/provisional.h"

namespace misfit {

Model provisional_model(ModelRequest request, const Registry& registry) {
  for (const auto& [name, of] : curves_without_knots(request, registry)) {
    request.curves[name].of = of;
    request.curves[name].knots = {1.0, 2.0};
  }
  return assemble(request, registry);
}

}  // namespace misfit
