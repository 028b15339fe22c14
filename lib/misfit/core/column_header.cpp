#include "misfit/core/column_header.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "misfit/core/error.h"
#include "misfit/core/units.h"

namespace misfit {
namespace {

struct Spelling {
  std::string_view written, unit;
};
/// Units as they are written behind an underscore, where neither blanks nor '/' may stand.
constexpr std::array<Spelling, 46> spellings = {{{"s", "s"},         {"sec", "s"},       {"seconds", "s"},   {"ms", "ms"},
                                                 {"min", "min"},     {"h", "h"},         {"Hz", "Hz"},       {"V", "V"},
                                                 {"volt", "V"},      {"volts", "V"},     {"mV", "mV"},       {"A", "A"},
                                                 {"N", "N"},         {"kN", "kN"},       {"Nm", "N m"},      {"m", "m"},
                                                 {"mm", "mm"},       {"cm", "cm"},       {"km", "km"},       {"kg", "kg"},
                                                 {"g", "g"},         {"Pa", "Pa"},       {"kPa", "kPa"},     {"bar", "bar"},
                                                 {"K", "K"},         {"W", "W"},         {"J", "J"},         {"rad", "rad"},
                                                 {"deg", "deg"},     {"radps", "rad/s"}, {"rad_s", "rad/s"}, {"radps2", "rad/s^2"},
                                                 {"degps", "deg/s"}, {"deg_s", "deg/s"}, {"mps", "m/s"},     {"m_s", "m/s"},
                                                 {"mps2", "m/s^2"},  {"m_s2", "m/s^2"},  {"px", "px"},       {"pix", "px"},
                                                 {"us", "us"},       {"ns", "ns"},       {"rpm", "rpm"},     {"kW", "kW"},
                                                 {"pct", "%"},       {"percent", "%"}}};

bool is_unit(const std::string& text) {
  try {
    static_cast<void>(parse_unit(text));
    return !text.empty();
  } catch (const InputError&) {
    return false;
  }
}

/// Letters, digits and '_', beginning with a letter; umlauts and the like become '_'.
std::string as_name(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const bool plain = (std::isalnum(static_cast<unsigned char>(c)) != 0) && static_cast<unsigned char>(c) < 128;
    if (plain || (!out.empty() && out.back() != '_')) out += plain ? c : '_';
  }
  while (!out.empty() && out.back() == '_') out.pop_back();
  if (out.empty()) return "column";
  return std::isdigit(static_cast<unsigned char>(out.front())) != 0 ? "c" + out : out;
}

}  // namespace

NameAndUnit read_header(const std::string& header) {
  for (const auto& [open, close] : {std::pair{'[', ']'}, std::pair{'(', ')'}}) {
    const auto from = header.rfind(open), to = header.rfind(close);
    if (from == std::string::npos || to == std::string::npos || to < from || from == 0) continue;
    const std::string inside = header.substr(from + 1, to - from - 1);
    NameAndUnit out{as_name(header.substr(0, from)), "", ""};
    const auto spelt = std::find_if(spellings.begin(), spellings.end(), [&](const Spelling& s) { return s.written == inside; });
    if (is_unit(inside)) {
      out.unit = inside;
    } else if (spelt != spellings.end()) {
      out.unit = spelt->unit;
    } else {
      out.not_understood = inside;
    }
    return out;
  }
  const std::string name = as_name(header);
  std::size_t best = 0;
  NameAndUnit out{name, "", ""};
  for (const Spelling& s : spellings) {
    const std::string tail = "_" + std::string(s.written);
    if (name.size() <= tail.size() || !name.ends_with(tail) || tail.size() <= best) continue;
    best = tail.size();
    out = {name.substr(0, name.size() - tail.size()), std::string(s.unit), ""};
  }
  return out;
}

}  // namespace misfit
