#pragma once

#include "misfit/video/backend.h"

namespace misfit {

/// The video module, loaded at the first call: misfit_video_opencv.so, looked for where the program's run path and LD_LIBRARY_PATH say,
/// beside the program, one folder above it, and in ../lib*/misfit. RunError naming the places if it is not there or of another version.
[[nodiscard]] video_module::Backend& video_backend();

}  // namespace misfit
