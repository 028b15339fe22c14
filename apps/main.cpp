#include <misfit_models_registry.h>

#include "apps/command_line.h"

int main(int argc, char** argv) {
  misfit::Registry registry;
  misfit_models_register(registry);
  return misfit::run_command_line(argc, argv, registry);
}
