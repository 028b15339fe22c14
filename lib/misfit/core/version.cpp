#include "misfit/core/version.h"

#include "misfit_commit.h"  // made at build time by commit.cmake

namespace misfit {

const char* version() { return MISFIT_VERSION; }
const char* commit() { return MISFIT_COMMIT; }

}  // namespace misfit
