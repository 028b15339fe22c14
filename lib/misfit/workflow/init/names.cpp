#include "misfit/workflow/init/names.h"

#include "misfit/core/file_name.h"
#include "misfit/core/shown.h"

namespace misfit {
namespace {

constexpr std::size_t longest = 100;  // bytes

std::string without_front(std::string stem) { return stem.erase(0, std::min(stem.find_first_not_of(".-"), stem.size())); }

bool is_usable(const std::string& stem) {
  return !stem.empty() && stem.size() <= longest && stem == shown(stem, longest) && stem.find('\\') == std::string::npos;
}

}  // namespace

std::string study_name(const std::filesystem::path& data) {
  const std::string name = shown(data.stem().string(), longest);
  return without_front(name).empty() ? "recording" : name;
}

std::vector<std::string> part_names(const std::filesystem::path& data, std::size_t count) {
  std::string stem = without_front(data.stem().string());
  if (stem.empty()) stem = "recording";
  if (!is_usable(stem)) stem = file_name_for(stem);
  std::vector<std::string> names;
  for (std::size_t i = 0; i < count; ++i) names.push_back(count == 1 ? stem : stem + "_" + std::to_string(i + 1));
  return names;
}

}  // namespace misfit
