#include "misfit/core/shown.h"

#include <algorithm>
#include <numeric>

#include "misfit/core/edit_distance.h"
#include "misfit/core/error.h"
#include "misfit/core/utf8.h"

namespace misfit {
namespace {

unsigned char byte_at(std::string_view text, std::size_t i) { return static_cast<unsigned char>(text[i]); }

/// Bytes of a character of UTF-8 that begins with `first`; 0 if none does.
std::size_t bytes_of_character(unsigned char first) {
  if (first < 0x80U) return 1;
  if (first >= 0xC2U && first <= 0xDFU) return 2;
  if (first >= 0xE0U && first <= 0xEFU) return 3;
  return first >= 0xF0U && first <= 0xF4U ? 4 : 0;
}

bool continues_character(unsigned char byte) { return (byte & 0xC0U) == 0x80U; }

void append_escape(std::string& out, unsigned char byte, Escapes escapes) {
  constexpr std::string_view digits = "0123456789abcdef";
  out.append(escapes == Escapes::json ? "\\u00" : "\\x").append(1, digits[byte >> 4U]).append(1, digits[byte & 15U]);
}

/// C0 but newline and tab, DEL, C1.
bool is_control(std::string_view character) {
  const unsigned char first = byte_at(character, 0);
  if (character.size() == 1) return (first < 0x20U && first != '\n' && first != '\t') || first == 0x7FU;
  return character.size() == 2 && first == 0xC2U && byte_at(character, 1) < 0xA0U;
}

/// Where character number `count` of `text` begins; its size if it has no more.
std::size_t place_of(std::string_view text, std::size_t count) {
  std::size_t i = 0;
  for (; i < text.size() && count > 0; --count) i += std::max<std::size_t>(utf8_length(text.substr(i)), 1);
  return i;
}

std::size_t characters_of(std::string_view text) {
  return std::count_if(text.begin(), text.end(), [](unsigned char c) { return !continues_character(c); });
}

/// The nearest name first and the others by their distance, if one is near; else the order stays.
std::vector<std::string> nearest_first(std::string_view name, const std::vector<std::string>& valid) {
  const std::string nearest = nearest_name(name, valid);
  if (nearest.empty()) return valid;
  std::vector<std::pair<std::size_t, std::string>> order;
  for (const std::string& v : valid) order.emplace_back(v == nearest ? 0 : 1 + edit_distance(name, v), v);
  std::stable_sort(order.begin(), order.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> out;
  for (auto& [distance, v] : order) out.push_back(std::move(v));
  return out;
}

}  // namespace

std::string printable(std::string_view text, Escapes escapes) {
  std::string out;
  while (!text.empty()) {
    const std::size_t bytes = utf8_length(text);
    const std::string_view character = text.substr(0, std::max<std::size_t>(bytes, 1));
    if (bytes == 0) {
      append_escape(out, byte_at(text, 0), escapes);
    } else if (is_control(character)) {
      append_escape(out, byte_at(character, bytes - 1), escapes);
    } else {
      out += character;
    }
    text.remove_prefix(character.size());
  }
  return out;
}

std::string shown(std::string_view text, std::size_t most) {
  const std::size_t end = place_of(text, most);
  std::string out = printable(text.substr(0, end));
  for (std::size_t i = out.find_first_of("\n\t"); i != std::string::npos; i = out.find_first_of("\n\t", i + 2))
    out.replace(i, 1, out[i] == '\n' ? "\\n" : "\\t");
  const bool cut = end < text.size();
  if (!cut && characters_of(out) <= most) return out;
  return out.substr(0, place_of(out, most - 1)) + "…";
}

std::string shortened(std::string_view message, std::size_t most) {
  if (message.size() <= most || characters_of(message) <= most) return std::string(message);
  const std::size_t tail = most / 3, head = most - tail - 3;
  std::size_t from = message.size();
  for (std::size_t left = tail; left > 0 && from > 0; --from) {
    if (!continues_character(byte_at(message, from - 1))) --left;
  }
  return std::string(message.substr(0, place_of(message, head))) + " … " + std::string(message.substr(from));
}

std::string some_names(std::string_view name, const std::vector<std::string>& valid) {
  constexpr std::size_t room = 140, room_of_some = 90;  // characters
  const std::size_t all =
      std::accumulate(valid.begin(), valid.end(), std::size_t{0}, [](std::size_t sum, const auto& v) { return sum + v.size() + 2; });
  const std::vector<std::string> order = all > room ? nearest_first(name, valid) : valid;
  std::string out;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const std::string next = shown(order[i], longest_quote / 2);
    if (i > 0 && all > room && out.size() + next.size() > room_of_some)
      return out + ", … and " + std::to_string(order.size() - i) + " more";
    out += (i == 0 ? "" : ", ") + next;
  }
  return out;
}

std::size_t unfinished_bytes(std::string_view text) {
  for (std::size_t back = 1; back <= std::min<std::size_t>(3, text.size()); ++back) {
    const unsigned char byte = byte_at(text, text.size() - back);
    if (continues_character(byte)) continue;
    return bytes_of_character(byte) > back ? back : 0;
  }
  return 0;
}

}  // namespace misfit
