#include "tests/paths.h"

namespace paths {

std::filesystem::path source() { return MISFIT_SOURCE_DIR; }
std::filesystem::path program() { return MISFIT_PROGRAM; }

}  // namespace paths
