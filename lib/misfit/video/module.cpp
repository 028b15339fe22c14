#include "misfit/video/module.h"

#include "misfit/core/module.h"

namespace misfit {
namespace {

video_module::Backend& load() {
  const void* entry = load_module({"misfit_video_opencv.so", "misfit_video_module", video_module::interface_version, false,
                                   "videos and images are read by a module of misfit that cannot be loaded"});
  return *static_cast<const video_module::Entry*>(entry)->make();
}

}  // namespace

video_module::Backend& video_backend() {
  static video_module::Backend& backend = load();
  return backend;
}

}  // namespace misfit
