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

/// Folders in which the dynamic linker looks: the program's run path among them.
std::vector<std::string> linker_folders() {
  std::vector<std::string> out;
  void* program = ::dlopen(nullptr, RTLD_NOW);
  Dl_serinfo size{};
  if (program == nullptr || ::dlinfo(program, RTLD_DI_SERINFOSIZE, &size) != 0) return out;
  std::vector<Dl_serinfo> room(size.dls_size / sizeof(Dl_serinfo) + 1);  // paths stand behind the structure
  room.front() = size;
  if (::dlinfo(program, RTLD_DI_SERINFO, room.data()) != 0) return out;
  const Dl_serpath* paths = &room.front().dls_serpath[0];
  for (unsigned i = 0; i < size.dls_cnt; ++i) out.emplace_back(paths[i].dls_name);
  return out;
}

}  // namespace

fs::path helper_program(const std::string& file, const std::string& complaint) {
  std::vector<std::string> tried = places(file);
  tried.front() = (fs::path(tried.size() > 1 ? tried[1] : ".").parent_path() / file).string();
  for (const std::string& folder : linker_folders()) tried.push_back(folder + "/" + file);
  std::error_code error;
  for (const std::string& place : tried) {
    if (fs::is_regular_file(place, error)) return place;
  }
  throw RunError(complaint + ": the program " + file + " is not installed beside misfit, as in " + tried.front());
}

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
