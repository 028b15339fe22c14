#include "misfit/core/column_header.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "misfit/core/error.h"
#include "misfit/core/text.h"
#include "misfit/core/units.h"

namespace misfit {
namespace {

struct Spelling {
  std::string_view written, unit;
};
/// Units as they are written behind an underscore, where neither blanks nor '/' may stand, and in words.
constexpr std::array<Spelling, 86> spellings = {
    {{"s", "s"},         {"sec", "s"},       {"secs", "s"},      {"second", "s"},     {"seconds", "s"},
     {"ms", "ms"},       {"msec", "ms"},     {"us", "us"},       {"usec", "us"},      {"ns", "ns"},
     {"nsec", "ns"},     {"min", "min"},     {"minutes", "min"}, {"h", "h"},          {"hr", "h"},
     {"hours", "h"},     {"days", "d"},      {"Hz", "Hz"},       {"kHz", "kHz"},      {"V", "V"},
     {"volt", "V"},      {"volts", "V"},     {"mV", "mV"},       {"kV", "kV"},        {"A", "A"},
     {"amp", "A"},       {"amps", "A"},      {"mA", "mA"},       {"N", "N"},          {"kN", "kN"},
     {"Nm", "N m"},      {"mNm", "mN m"},    {"m", "m"},         {"mm", "mm"},        {"cm", "cm"},
     {"um", "um"},       {"km", "km"},       {"kg", "kg"},       {"g", "g"},          {"Pa", "Pa"},
     {"kPa", "kPa"},     {"hPa", "hPa"},     {"MPa", "MPa"},     {"bar", "bar"},      {"mbar", "mbar"},
     {"psi", "psi"},     {"K", "K"},         {"degC", "degC"},   {"celsius", "degC"}, {"Celsius", "degC"},
     {"degF", "degF"},   {"W", "W"},         {"kW", "kW"},       {"mW", "mW"},        {"J", "J"},
     {"kJ", "kJ"},       {"rad", "rad"},     {"mrad", "mrad"},   {"deg", "deg"},      {"degrees", "deg"},
     {"rpm", "rpm"},     {"RPM", "rpm"},     {"radps", "rad/s"}, {"rad_s", "rad/s"},  {"radps2", "rad/s^2"},
     {"degps", "deg/s"}, {"deg_s", "deg/s"}, {"dps", "deg/s"},   {"mps", "m/s"},      {"m_s", "m/s"},
     {"mps2", "m/s^2"},  {"m_s2", "m/s^2"},  {"kmh", "km/h"},    {"kph", "km/h"},     {"km_h", "km/h"},
     {"mph", "mph"},     {"knots", "knot"},  {"px", "px"},       {"pix", "px"},       {"pct", "%"},
     {"percent", "%"},   {"uT", "uT"},       {"L", "l"},         {"mL", "ml"},        {"litre", "l"},
     {"liter", "l"}}};

/// Units that are no usual name of anything else: a header may be just one of them.
constexpr std::array<std::string_view, 18> units_as_names = {"sec", "secs",  "seconds", "ms",  "msec", "us",    "usec", "ns",   "minutes",
                                                             "hr",  "hours", "days",    "rpm", "RPM",  "volts", "amps", "degC", "celsius"};

bool is_unit(const std::string& text) {
  try {
    static_cast<void>(parse_unit(text));
    return !text.empty();
  } catch (const InputError&) {
    return false;
  }
}

/// Letters with marks as people write them without: "Außen" → "Aussen".
std::string without_marks(std::string_view text) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 18> letters = {{{"ß", "ss"},
                                                                                             {"ä", "ae"},
                                                                                             {"ö", "oe"},
                                                                                             {"ü", "ue"},
                                                                                             {"Ä", "Ae"},
                                                                                             {"Ö", "Oe"},
                                                                                             {"Ü", "Ue"},
                                                                                             {"é", "e"},
                                                                                             {"è", "e"},
                                                                                             {"ê", "e"},
                                                                                             {"à", "a"},
                                                                                             {"â", "a"},
                                                                                             {"ç", "c"},
                                                                                             {"ñ", "n"},
                                                                                             {"å", "aa"},
                                                                                             {"ø", "oe"},
                                                                                             {"æ", "ae"},
                                                                                             {"ó", "o"}}};
  std::string out;
  while (!text.empty()) {
    const auto letter = std::find_if(letters.begin(), letters.end(), [&](const auto& l) { return text.starts_with(l.first); });
    out += letter == letters.end() ? text.substr(0, 1) : letter->second;
    text.remove_prefix(letter == letters.end() ? 1 : letter->first.size());
  }
  return out;
}

/// Letters, digits and '_', beginning with a letter; any other sign becomes '_'.
std::string as_name(std::string_view header) {
  const std::string text = without_marks(header);
  std::string out;
  for (const char c : text) {
    const bool plain = (std::isalnum(static_cast<unsigned char>(c)) != 0) && static_cast<unsigned char>(c) < 128;
    if (plain || (!out.empty() && out.back() != '_')) out += plain ? c : '_';
  }
  while (!out.empty() && out.back() == '_') out.pop_back();
  if (out.empty()) return "column";
  return std::isdigit(static_cast<unsigned char>(out.front())) != 0 ? "c" + out : out;
}

/// "temp_min", "T_s": the end of a name is a subscript, though it reads as a unit.
bool is_subscript(const std::string& name, std::string_view end) {
  std::string word = name;
  std::transform(word.begin(), word.end(), word.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  constexpr std::array<std::string_view, 6> of_time = {"timestamp", "elapsed", "duration", "dauer", "temps", "tijd"};
  const bool is_time =
      name == "t" || word.ends_with("time") || word.ends_with("zeit") || std::find(of_time.begin(), of_time.end(), word) != of_time.end();
  if (end == "min") return !is_time;
  const bool bare = name.front() == 'T' && name.find_first_not_of("0123456789_", 1) == std::string::npos;
  return end.size() == 1 && end != "K" && !is_time && (bare || word.starts_with("temp"));
}

}  // namespace

NameAndUnit read_header(const std::string& header) {
  for (const auto& [open, close] : {std::pair{'[', ']'}, std::pair{'(', ')'}}) {
    const auto from = header.rfind(open), to = header.rfind(close);
    if (from == std::string::npos || to == std::string::npos || to < from || from == 0) continue;
    const std::string inside = plain_unit(header.substr(from + 1, to - from - 1));
    NameAndUnit out;
    out.name = as_name(header.substr(0, from));
    const auto spelt = std::find_if(spellings.begin(), spellings.end(), [&](const Spelling& s) { return s.written == inside; });
    if (is_unit(inside)) {
      out.unit = inside;
    } else if (inside == "C") {  // degrees: nobody logs coulombs
      out.unit = "degC";
    } else if (spelt != spellings.end()) {
      out.unit = spelt->unit;
    } else {
      out.not_understood = inside;
    }
    return out;
  }
  const std::string name = as_name(plain_unit(header));
  std::size_t best = 0;
  NameAndUnit out;
  out.name = name;
  for (const Spelling& s : spellings) {
    if (name == s.written && std::find(units_as_names.begin(), units_as_names.end(), name) != units_as_names.end()) out.unit = s.unit;
    const std::string tail = "_" + std::string(s.written);
    if (name.size() <= tail.size() || !name.ends_with(tail) || tail.size() <= best) continue;
    const std::string front = name.substr(0, name.size() - tail.size());
    if (is_subscript(front, s.written)) continue;
    best = tail.size();
    out = {front, std::string(s.unit), "", s.written.size() == 1};
  }
  return out;
}

bool is_called(const std::string& name, std::span<const std::string_view> words) {
  std::string word = lower_case(name);
  while (!word.empty() && ((word.back() >= '0' && word.back() <= '9') || word.back() == '_')) word.pop_back();
  return std::find(words.begin(), words.end(), word) != words.end();
}

bool is_called_time(const std::string& name) {
  static constexpr std::array<std::string_view, 8> words = {"t", "time", "zeit", "timestamp", "sec", "seconds", "tijd", "temps"};
  return is_called(name, words);
}

bool may_be_temperature(const std::string& name) {
  static constexpr std::array<std::string_view, 1> word = {"t"};
  return name != "t" && is_called(name, word);
}

}  // namespace misfit
