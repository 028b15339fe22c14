#pragma once

#include <set>
#include <string>

namespace misfit {

/// `stem`, or the first of stem + between + "2", "3", … that is not in `taken`, where it is put.
inline std::string unique_name(const std::string& stem, std::set<std::string>& taken, const std::string& between = "_") {
  std::string name = stem;
  for (int number = 2; !taken.insert(name).second; ++number) name = stem + between + std::to_string(number);
  return name;
}

}  // namespace misfit
