#include "misfit/video/module.h"

#include <dlfcn.h>

#include <filesystem>
#include <string>
#include <vector>

#include "misfit/core/error.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

constexpr const char* file_name = "misfit_video_opencv.so";

/// In the order in which they are tried; a bare name is looked for by the dynamic linker.
std::vector<std::string> places() {
  std::vector<std::string> out{file_name};
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error).parent_path();
  if (error) return out;
  for (const char* folder : {".", "..", "../lib/misfit", "../lib/x86_64-linux-gnu/misfit", "../lib64/misfit"})
    out.push_back((program / folder / file_name).lexically_normal().string());
  return out;
}

/// Never closed: the libraries behind it keep threads and static objects.
video_module::Backend& load() {
  std::string tried;
  for (const std::string& place : places()) {
    if (place.find('/') != std::string::npos && !fs::exists(place)) {
      tried += "\n  " + place + ": no such file";
      continue;
    }
    void* handle = ::dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (handle == nullptr) {
      tried += std::string("\n  ") + ::dlerror();
      continue;
    }
    const auto* entry = static_cast<const video_module::Entry*>(::dlsym(handle, "misfit_video_module"));
    if (entry != nullptr && entry->version == video_module::interface_version) return *entry->make();
    tried += "\n  " + place + ": of another version of misfit";
  }
  throw RunError("videos and images are read by a module of misfit that cannot be loaded:" + tried);
}

}  // namespace

video_module::Backend& video_backend() {
  static video_module::Backend& backend = load();
  return backend;
}

}  // namespace misfit
