#include "misfit/report/unbroken.h"

#include <algorithm>
#include <cctype>
#include <string_view>

#include "misfit/core/error.h"
#include "misfit/core/units.h"

namespace misfit::report {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view minus = "\u2212", no_break = "\u00a0", plus_minus = "±";

bool is_decimal(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// Whether the hyphen at `at` is the sign of a number or of its exponent.
bool is_sign(const std::string& text, std::size_t at) {
  if (at + 1 >= text.size() || (!is_decimal(text[at + 1]) && text[at + 1] != '.')) return false;
  if (at == 0) return true;
  const std::string_view so_far = std::string_view(text).substr(0, at);
  for (const std::string_view before : {" "sv, "("sv, "["sv, "<"sv, "|"sv, "≈"sv, plus_minus, no_break}) {
    if (so_far.ends_with(before)) return true;
  }
  return text[at - 1] == 'e' && at > 1 && is_decimal(text[at - 2]);
}

/// "12.0", "(−3", "1e−60", "0.1)e7": what a unit or a ± may follow.
bool ends_a_number(std::string_view word) {
  for (const std::string_view sign : {minus, "≈"sv}) {
    if (const std::size_t at = word.find(sign); at < 2) word.remove_prefix(at + sign.size());
  }
  while (word.starts_with('(') || word.starts_with('+') || word.starts_with('<')) word.remove_prefix(1);
  if (word.empty() || !is_decimal(word.front()) || (!is_decimal(word.back()) && word.back() != ')')) return false;
  for (std::size_t at = 0; at < word.size(); ++at) {
    if (word.substr(at).starts_with(minus)) {
      at += minus.size() - 1;
    } else if (!is_decimal(word[at]) && ".e)+"sv.find(word[at]) == std::string_view::npos) {
      return false;
    }
  }
  return true;
}

std::string_view without_punctuation(std::string_view word) {
  while (!word.empty() && ".,;:)]"sv.find(word.back()) != std::string_view::npos) word.remove_suffix(1);
  return word;
}

/// "in" behind a number is nearly always the preposition.
bool is_unit(std::string_view word) {
  constexpr std::size_t longest = 24;
  if (word.empty() || word.size() > longest || word == "in" || word == "-" || is_decimal(word.front())) return word.starts_with("1/");
  try {
    static_cast<void>(parse_unit(word));
    return true;
  } catch (const InputError&) {
    return false;
  }
}

std::string with_minus_signs(const std::string& text) {
  std::string out;
  for (std::size_t at = 0; at < text.size(); ++at) text[at] == '-' && is_sign(text, at) ? out += minus : out += text[at];
  return out;
}

enum class Last { other, number, unit };  ///< of the words before a blank: which its last one is

}  // namespace

std::string unbroken(const std::string& text) {
  const std::string whole = with_minus_signs(text);
  std::string out;
  Last last = Last::other;
  std::string_view before;
  bool of_p = false;  // "p =", "(p <"
  for (std::size_t at = 0; at <= whole.size();) {
    const std::size_t end = std::min(whole.find(' ', at), whole.size());
    const std::string_view word = std::string_view(whole).substr(at, end - at), bare = without_punctuation(word);
    const bool number = ends_a_number(word), unit = last != Last::other && is_unit(bare);
    const bool relation = (before == "p" || before == "(p") && (word == "=" || word == "<");
    const bool joined = unit || relation || (of_p && !word.empty()) || (last == Last::number && word == plus_minus) ||
                        (before == plus_minus && ends_a_number(bare));
    if (at > 0) out += joined ? no_break : std::string_view(" ");
    out += word;
    last = number ? Last::number : unit && bare == word ? Last::unit : Last::other;
    before = word;
    of_p = relation;
    at = end + 1;
  }
  return out;
}

}  // namespace misfit::report
