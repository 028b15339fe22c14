#pragma once

// Enumerators as indices of an effect's lists. They are compared with the lists when the effect is compiled, so that the formula and the
// specification cannot drift apart.

#include <bit>
#include <cstddef>
#include <string_view>
#include <type_traits>
#include <utility>

namespace misfit::index_names {

/// The enumerator of this value; for a value without one a text that is no identifier. g++ and clang alone spell a value out in this way.
template <auto Value>
consteval auto enumerator() {
  const std::string_view text = __PRETTY_FUNCTION__;  // "… [with auto Value = {anonymous}::PitchDamping::C_mq]"
  const std::string_view value = text.substr(text.find("Value = "));
  const std::string_view whole = value.substr(0, value.find_first_of(";]"));
  const std::size_t scope = whole.rfind("::");
  return scope == std::string_view::npos ? std::string_view("?") : whole.substr(scope + 2);
}

constexpr std::string_view name_of(const char* constant) { return constant; }
template <class Entry>
constexpr std::string_view name_of(const Entry& entry) {
  return entry.name;
}

/// `rate`, or `rate_port` where a quantity has taken the name.
constexpr bool agrees(std::string_view enumerator, std::string_view name, std::string_view kind) {
  if (enumerator == name) return true;
  return enumerator.size() == name.size() + 1 + kind.size() && enumerator.starts_with(name) && enumerator[name.size()] == '_' &&
         enumerator.ends_with(kind);
}

/// The value behind the last entry: bit_cast, since it may lie outside the enum's range.
template <class Enum, std::size_t N>
concept HasValue = requires { typename std::integral_constant<Enum, std::bit_cast<Enum>(static_cast<std::underlying_type_t<Enum>>(N))>; };

/// There is no enumerator behind the last entry of the list.
template <class Enum, std::size_t N>
consteval bool ends_at() {
  constexpr auto behind = static_cast<std::underlying_type_t<Enum>>(N);
  if constexpr (HasValue<Enum, N>) return enumerator<std::bit_cast<Enum>(behind)>().find(')') != std::string_view::npos;
  return true;
}

/// Enumerators 0, 1, … are the names of the entries, in this order; an entry `x` of a list of ports may be `x` or `x_port`.
template <class Enum, class Entry, std::size_t N>
consteval bool match(const Entry (&list)[N], std::string_view kind) {
  return [&]<std::size_t... I>(std::index_sequence<I...>) {
    return (agrees(enumerator<static_cast<Enum>(I)>(), name_of(list[I]), kind) && ...);
  }(std::make_index_sequence<N>{}) &&
         ends_at<Enum, N>();
}

template <class E>
consteval bool quantities_match() {
  if constexpr (requires { typename E::Quantity; }) return match<typename E::Quantity>(E::quantities, "quantity");
  return true;
}
template <class E>
consteval bool ports_match() {
  if constexpr (requires { typename E::Port; }) return match<typename E::Port>(E::ports, "port");
  return true;
}
template <class E>
consteval bool coefficients_match() {
  if constexpr (requires { typename E::Coefficient; }) return match<typename E::Coefficient>(E::coefficients, "coefficient");
  return true;
}
template <class E>
consteval bool constants_match() {
  if constexpr (requires { typename E::Constant; }) return match<typename E::Constant>(E::constants, "constant");
  return true;
}
template <class E>
consteval bool states_match() {
  if constexpr (requires { typename E::State; }) return match<typename E::State>(E::states, "state");
  return true;
}

}  // namespace misfit::index_names
