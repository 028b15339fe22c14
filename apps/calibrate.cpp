#include <iostream>

#include "apps/print.h"
#include "apps/verbs.h"
#include "misfit/core/error.h"
#include "misfit/workflow/stages.h"

namespace misfit {

int calibrate_verb(const Options& options, const Registry& registry) {
  Session session(options.session, registry);
  const auto calibration = calibrate_stage(session);
  if (!calibration) throw InputError({session.study.file.string(), 0, 0}, "the study has no [camera]: there is nothing to calibrate");
  if (options.json) {
    print_file(session.folder.file("camera.json"));
  } else {
    print(*calibration);
  }
  return calibration->converged ? 0 : 1;
}

}  // namespace misfit
