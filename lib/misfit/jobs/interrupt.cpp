#include "misfit/jobs/interrupt.h"

namespace misfit {

void stop_if_interrupted() {
  if (interrupted()) throw Interrupted();
}

}  // namespace misfit
