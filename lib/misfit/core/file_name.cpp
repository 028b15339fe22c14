#include "misfit/core/file_name.h"

#include <algorithm>

#include "misfit/core/files.h"

namespace misfit {
namespace {

constexpr std::size_t longest = 80;  // bytes; a file name of Linux has at most 255, and more than one name may be part of it

bool is_plain(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-'; }

}  // namespace

std::string file_name_for(std::string_view name) {
  if (!name.empty() && name.size() <= longest && std::all_of(name.begin(), name.end(), is_plain)) return std::string(name);
  constexpr std::size_t hash_digits = 16;
  std::string out(name.empty() ? "_" : name.substr(0, longest - 1 - hash_digits));
  std::replace_if(
      out.begin(), out.end(), [](char c) { return !is_plain(c); }, '_');
  return out + "." + hash_text(name);
}

std::string file_suffix(std::size_t number, std::string_view name) { return number == 0 ? "" : "_" + file_name_for(name); }

}  // namespace misfit
