#pragma once

#include <cstddef>

namespace misfit {

/// Of an enumerator, by a list of names in the order of the enumeration. std::out_of_range: it is no value of it.
template <class Names, class Enum>
constexpr const auto& enum_name(const Names& names, Enum value) {
  return names.at(static_cast<std::size_t>(value));
}

}  // namespace misfit
