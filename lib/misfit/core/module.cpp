#include "misfit/core/module.h"

#include <dlfcn.h>

#include <filesystem>
#include <vector>

#include "misfit/core/error.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

/// In the order in which they are tried; a bare name is looked for by the dynamic linker.
std::vector<std::string> places(const std::string& file) {
  std::vector<std::string> out{file};
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error).parent_path();
  if (error) return out;
  for (const char* folder : {".", "..", "../lib/misfit", "../lib/x86_64-linux-gnu/misfit", "../lib64/misfit"})
    out.push_back((program / folder / file).lexically_normal().string());
  return out;
}

}  // namespace

const void* load_module(const ModuleRequest& request) {
  std::string tried;
  for (const std::string& place : places(request.file)) {
    if (place.find('/') != std::string::npos && !fs::exists(place)) {
      tried += "\n  " + place + ": no such file";
      continue;
    }
    void* handle = ::dlopen(place.c_str(), RTLD_NOW | (request.global ? RTLD_GLOBAL : RTLD_LOCAL));
    if (handle == nullptr) {
      tried += std::string("\n  ") + ::dlerror();
      continue;
    }
    const void* entry = ::dlsym(handle, request.symbol.c_str());
    if (entry != nullptr && *static_cast<const int*>(entry) == request.version) return entry;
    tried += "\n  " + place + ": of another version of misfit";
  }
  throw RunError(request.complaint + ":" + tried);
}

}  // namespace misfit
