#include "misfit/report/symbols.h"

#include <array>
#include <cctype>
#include <string_view>

#include "misfit/report/unbroken.h"

namespace misfit::report {
namespace {

struct Symbol {
  std::string_view word, base, index;
};

constexpr std::array<Symbol, 13> symbols = {{{"C_m_alphadot", "C", "m α̇"},
                                             {"C_m_alpha", "C", "mα"},
                                             {"C_mq", "C", "mq"},
                                             {"C_m", "C", "m"},
                                             {"C_n", "C", "n"},
                                             {"alpha_T", "α", "T"},
                                             {"alpha", "α", ""},
                                             {"beta", "β", ""},
                                             {"theta", "θ", ""},
                                             {"psi", "ψ", ""},
                                             {"phi", "φ", ""},
                                             {"P_y", "P", "y"},
                                             {"P_z", "P", "z"}}};

bool word_character(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || (static_cast<unsigned char>(c) & 0x80U) != 0;
}

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

const Symbol* symbol_at(const std::string& text, std::size_t at) {
  if (at > 0 && word_character(text[at - 1])) return nullptr;
  for (const Symbol& symbol : symbols) {
    const std::size_t end = at + symbol.word.size();
    if (text.compare(at, symbol.word.size(), symbol.word) == 0 && (end >= text.size() || !word_character(text[end]))) return &symbol;
  }
  return nullptr;
}

/// Length of "^2" or "^-2" at `at`, 0 if it is none.
std::size_t power_length(const std::string& text, std::size_t at) {
  if (text[at] != '^') return 0;
  std::size_t end = at + 1;
  if (end < text.size() && text[end] == '-') ++end;
  const std::size_t digits = end;
  while (end < text.size() && is_digit(text[end])) ++end;
  if (end > digits && end + 1 < text.size() && text[end] == '.' && is_digit(text[end + 1])) {  // V^0.5
    for (++end; end < text.size() && is_digit(text[end]);) ++end;
  }
  return end > digits ? end - at : 0;
}

void append(std::vector<Run>& runs, Run::Place place, std::string_view text) {
  if (text.empty()) return;
  if (runs.empty() || runs.back().place != place) runs.push_back({place, ""});
  runs.back().text += text;
}

std::string escape_gnuplot(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '\n' || c == '\r') {
      result += ' ';
    } else if (c == '\'') {
      result += "’";  // gnuplot misreads a doubled quote that begins a string
    } else if (std::string_view("^_{}@&~\\").find(c) != std::string_view::npos) {
      result += '\\';
      result += c;
    } else {
      result += c;
    }
  }
  return result;
}

}  // namespace

std::vector<Run> typeset(const std::string& plain) {
  const std::string text = unbroken(plain);
  std::vector<Run> runs;
  for (std::size_t at = 0; at < text.size();) {
    if (const Symbol* symbol = symbol_at(text, at)) {
      append(runs, Run::Place::line, symbol->base);
      append(runs, Run::Place::below, symbol->index);
      at += symbol->word.size();
    } else if (const std::size_t length = power_length(text, at); length > 0) {
      const bool negative = text[at + 1] == '-';
      if (negative) append(runs, Run::Place::above, "\u2212");
      append(runs, Run::Place::above, std::string_view(text).substr(at + (negative ? 2 : 1), length - (negative ? 2 : 1)));
      at += length;
    } else {
      append(runs, Run::Place::line, std::string_view(text).substr(at, 1));
      ++at;
    }
  }
  return runs;
}

std::string gnuplot_text(const std::string& text) {
  std::string result;
  for (const Run& run : typeset(text)) {
    std::string escaped = escape_gnuplot(run.text);
    if (escaped.starts_with(' ') && !result.empty()) escaped.insert(0, "\u200b");  // viewers drop a blank that begins a piece
    result += run.place == Run::Place::line ? escaped : (run.place == Run::Place::below ? "_{" : "^{") + escaped + "}";
  }
  return result;
}

std::string escape_html(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\'':
        result += "&#39;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string html_text(const std::string& text) {
  std::string result;
  for (const Run& run : typeset(text)) {
    const std::string escaped = escape_html(run.text);
    if (run.place == Run::Place::line) {
      result += escaped;
    } else {
      const std::string tag = run.place == Run::Place::below ? "sub" : "sup";
      result += "<" + tag + ">" + escaped + "</" + tag + ">";
    }
  }
  return result;
}

}  // namespace misfit::report
