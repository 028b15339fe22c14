#include <malloc.h>
#include <misfit_models_registry.h>

#include "apps/command_line.h"

namespace {

/// Memory that is freed is kept for the next use. The arrays of a filter run are as long as the recording and are made anew thousands of
/// times; given back to the system each time, as glibc does with large ones, they cost a tenth of a search in page faults.
void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int mebibyte = 1 << 20;
  mallopt(M_MMAP_THRESHOLD, 32 * mebibyte);
  mallopt(M_TRIM_THRESHOLD, 256 * mebibyte);
#endif
}

}  // namespace

int main(int argc, char** argv) {
  keep_freed_memory();
  misfit::Registry registry;
  misfit_models_register(registry);
  return misfit::run_command_line(argc, argv, registry);
}
