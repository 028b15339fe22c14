#pragma once

#include "misfit/video/backend.h"

namespace misfit {

/// The video module, misfit_video_opencv.so, loaded at the first call (core/module.h says from where, and what is thrown).
[[nodiscard]] video_module::Backend& video_backend();

}  // namespace misfit
