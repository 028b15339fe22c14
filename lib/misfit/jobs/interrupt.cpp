#include "misfit/jobs/interrupt.h"

#include "misfit/core/error.h"

namespace misfit {
namespace {

std::atomic<bool> flag{false};  // not in the function: a signal handler must not run an initialisation

}  // namespace

std::atomic<bool>& interrupted() { return flag; }

void stop_if_interrupted() {
  if (flag) throw RunError("interrupted; finished work is in the run folder, and the same command continues from there");
}

}  // namespace misfit
