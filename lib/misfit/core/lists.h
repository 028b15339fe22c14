#pragma once

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>

namespace misfit {

/// Number of elements as an int: places of states, ports, coefficients and parameters are ints.
template <class List>
constexpr int int_size(const List& list) {
  return static_cast<int>(std::size(list));
}

/// Place of the element of that name; −1: none is called so.
template <class List>
int index_of(const List& list, std::string_view name) {
  for (int i = 0; i < int_size(list); ++i) {
    if (list[i].name == name) return i;
  }
  return -1;
}

/// Place of an element equal to `value`; −1: there is none.
template <class List, class Value>
int place_of(const List& list, const Value& value) {
  for (int i = 0; i < int_size(list); ++i) {
    if (list[i] == value) return i;
  }
  return -1;
}

/// How many numbers are finite: a value that is missing is NaN.
template <class List>
std::size_t count_finite(const List& list) {
  return static_cast<std::size_t>(std::count_if(std::begin(list), std::end(list), [](double v) { return std::isfinite(v); }));
}

}  // namespace misfit
