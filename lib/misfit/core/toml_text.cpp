#include "misfit/core/toml_text.h"

#include <toml++/toml.h>

#include <algorithm>
#include <sstream>

#include "misfit/core/printable.h"

namespace misfit {
namespace {

bool may_be_bare(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-'; }

}  // namespace

std::string toml_string(std::string_view text) {
  const toml::value<std::string> value(valid_utf8(text));
  std::ostringstream out;
  out << toml::toml_formatter(value, toml::format_flags::allow_unicode_strings);
  return out.str();
}

std::string toml_key(std::string_view name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), may_be_bare) ? std::string(name) : toml_string(name);
}

std::string toml_comment(std::string_view text) { return printable(text); }

}  // namespace misfit
