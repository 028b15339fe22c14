#include "misfit/core/shell_word.h"

#include <algorithm>
#include <cctype>
#include <string_view>

namespace misfit {

std::string shell_word(const std::string& text) {
  const bool plain = !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c > 127 || std::string_view("./-_:+,@%").find(static_cast<char>(c)) != std::string_view::npos;
  });
  if (plain) return text;
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::string misfit_command(const std::string& verb, const std::string& study, const std::string& words, const std::string& out) {
  return "misfit " + verb + " " + shell_word(study) + (words.empty() ? "" : " " + words) + (out.empty() ? "" : " --out " + shell_word(out));
}

}  // namespace misfit
