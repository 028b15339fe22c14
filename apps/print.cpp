#include "apps/print.h"

#include <nlohmann/json.hpp>

namespace misfit {

void print_files(const std::vector<std::pair<std::string, std::filesystem::path>>& files) {
  if (files.size() == 1) return print_file(files.front().second);
  nlohmann::ordered_json all = nlohmann::ordered_json::object();
  for (const auto& [name, path] : files) all[name] = nlohmann::ordered_json::parse(read_file(path));
  std::cout << all.dump(1) << '\n';
}

}  // namespace misfit
