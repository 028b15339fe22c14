#include "misfit/core/toml_text.h"

#include <algorithm>

#include "misfit/core/utf8.h"

namespace misfit {
namespace {

bool may_be_bare(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-'; }

}  // namespace

// toml_string() is in config.cpp, the one includer of the TOML library.

std::string toml_key(std::string_view name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), may_be_bare) ? std::string(name) : toml_string(name);
}

std::string toml_comment(std::string_view text) {
  std::string out = valid_utf8(text);
  std::replace_if(
      out.begin(), out.end(), [](unsigned char c) { return c < 0x20U || c == 0x7fU; }, ' ');
  return out;
}

}  // namespace misfit
