#pragma once

#include "misfit/model/registry.h"

namespace misfit {

/// The program: parses the command line, runs one verb, returns the exit status (0 done, 1 the data or the model cannot do what was asked,
/// 2 bad command line or study). Never throws. Results go to files and a summary to stdout; progress and errors to stderr.
int run_command_line(int argc, char** argv, const Registry& registry);

}  // namespace misfit
