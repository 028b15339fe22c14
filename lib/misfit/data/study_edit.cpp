#include "misfit/data/study_edit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <vector>

#include "misfit/core/error.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

/// A string on one line, quotes included.
struct Quoted {
  std::size_t begin = 0, end = 0;
};

/// One line of the text as the editor sees it.
struct Line {
  std::size_t begin = 0, end = 0;  ///< without the line's end
  std::string section;             ///< "effects" for lines below [effects]; the header itself counts as below
  std::string key;                 ///< of "KEY = …" and of "[effects.KEY]"; empty for all others
  bool header = false;
  bool continued = false;  ///< inside brackets or a string that an earlier line opened
};

class Reader {
 public:
  explicit Reader(const std::string& text) : text_(text) {
    while (at_ < text_.size()) line();
  }
  std::vector<Line> lines;
  std::vector<Quoted> strings;

 private:
  void line() {
    Line l;
    l.begin = at_;
    l.continued = depth_ > 0 || !fence_.empty();
    if (!l.continued) start_of(l);
    l.section = section_;
    while (at_ < text_.size() && text_[at_] != '\n') token();
    l.end = at_;
    if (at_ < text_.size()) ++at_;
    lines.push_back(l);
  }

  /// A header or a key.
  void start_of(Line& l) {
    std::size_t i = skip_blanks(at_);
    if (i < text_.size() && text_[i] == '[') {
      while (i < text_.size() && text_[i] == '[') ++i;
      const std::size_t end = text_.find_first_of("]\n", i);
      std::string name = trimmed(text_.substr(i, end == std::string::npos ? std::string::npos : end - i));
      const std::size_t dot = name.find('.');
      if (dot != std::string::npos) {
        l.key = bare(name.substr(dot + 1));
        name.resize(dot);
      }
      section_ = bare(name);
      l.header = true;
      const std::size_t line_end = std::min(text_.find('\n', at_), text_.size());
      at_ = end == std::string::npos ? line_end : std::min(text_.find_first_not_of(']', end), line_end);
      return;
    }
    const std::size_t equals = text_.find_first_of("=\n#", i);
    if (equals != std::string::npos && text_[equals] == '=') l.key = bare(trimmed(text_.substr(i, equals - i)));
  }

  void token() {
    if (!fence_.empty()) {
      if (text_.compare(at_, 3, fence_) == 0) {
        fence_.clear();
        at_ += 3;
      } else {
        ++at_;
      }
      return;
    }
    const char c = text_[at_];
    if (c == '#') {
      at_ = std::min(text_.find('\n', at_), text_.size());
    } else if (text_.compare(at_, 3, "\"\"\"") == 0 || text_.compare(at_, 3, "'''") == 0) {
      fence_ = text_.substr(at_, 3);
      at_ += 3;
    } else if (c == '"' || c == '\'') {
      const std::size_t begin = at_++;
      while (at_ < text_.size() && text_[at_] != c && text_[at_] != '\n') at_ += c == '"' && text_[at_] == '\\' ? 2 : 1;
      at_ = std::min(at_ + 1, text_.size());
      strings.push_back({begin, at_});
    } else {
      if (c == '[' || c == '{') ++depth_;
      if (c == ']' || c == '}') depth_ = std::max(depth_ - 1, 0);
      ++at_;
    }
  }

  [[nodiscard]] std::size_t skip_blanks(std::size_t i) const {
    while (i < text_.size() && (text_[i] == ' ' || text_[i] == '\t')) ++i;
    return i;
  }
  static std::string trimmed(const std::string& s) {
    const auto first = s.find_first_not_of(" \t\r");
    return first == std::string::npos ? std::string() : s.substr(first, s.find_last_not_of(" \t\r") - first + 1);
  }
  static std::string bare(const std::string& s) {
    const bool quoted = s.size() >= 2 && (s.front() == '"' || s.front() == '\'') && s.back() == s.front();
    return quoted ? s.substr(1, s.size() - 2) : s;
  }

  const std::string& text_;
  std::size_t at_ = 0;
  std::string section_, fence_;
  int depth_ = 0;
};

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out.push_back('\\');
    out.push_back(c);
  }
  return out + "\"";
}

std::string unquoted(const std::string& text) {
  std::string out;
  for (std::size_t i = 1; i + 1 < text.size(); ++i) {
    if (text.front() == '"' && text[i] == '\\') ++i;
    out.push_back(text[i]);
  }
  return out;
}

std::string key_text(const std::string& name) {
  const bool bare = !name.empty() && std::all_of(name.begin(), name.end(),
                                                 [](unsigned char c) { return c < 128 && (std::isalnum(c) != 0 || c == '_' || c == '-'); });
  return bare ? name : quoted(name);
}

/// Index of the line with this entry, or the number of lines.
std::size_t find_entry(const std::vector<Line>& lines, const std::string& section, const std::string& key) {
  const auto found = std::find_if(lines.begin(), lines.end(), [&](const Line& l) { return l.section == section && l.key == key; });
  return static_cast<std::size_t>(found - lines.begin());
}

}  // namespace

std::string text_for_folder(const Study& study, const fs::path& folder) {
  const fs::path from = fs::absolute(study.folder).lexically_normal(), to = fs::absolute(folder).lexically_normal();
  const Reader reader(study.text);
  std::string out;
  std::size_t done = 0;
  for (const Quoted& string : reader.strings) {
    const std::string name = unquoted(study.text.substr(string.begin, string.end - string.begin));
    std::error_code error;
    if (name.empty() || fs::path(name).is_absolute() || !fs::is_regular_file(from / name, error)) continue;
    out += study.text.substr(done, string.begin - done);
    out += quoted((from / name).lexically_normal().lexically_relative(to).generic_string());
    done = string.end;
  }
  return out + study.text.substr(done);
}

std::string effect_line(const std::string& name, const std::string& kind, const std::map<std::string, std::string>& roles,
                        const std::map<std::string, double>& start) {
  std::vector<std::string> entries;
  if (kind != name) entries.push_back("kind = " + quoted(kind));
  for (const auto& [role, target] : roles) entries.push_back(key_text(role) + " = " + quoted(target));
  std::vector<std::string> values;
  for (const auto& [parameter, value] : start) values.push_back(fmt::format("{} = {:.6g}", key_text(parameter), value));
  if (!values.empty()) entries.push_back(fmt::format("start = {{ {} }}", fmt::join(values, ", ")));
  if (entries.empty()) return key_text(name) + " = {}";
  return fmt::format("{} = {{ {} }}", key_text(name), fmt::join(entries, ", "));
}

std::string with_effect(const std::string& text, const std::string& line) {
  const Reader reader(text);
  const Line* last = nullptr;
  bool plain = false;  // there is a header [effects] itself
  for (const Line& l : reader.lines) {
    if (l.section != "effects") continue;
    if (l.header && !l.key.empty()) break;  // [effects.NAME]: entries below belong to that table
    plain = plain || l.header;
    if (plain && (l.header || l.continued || !l.key.empty())) last = &l;
  }
  if (last == nullptr) return text + (text.empty() || text.back() == '\n' ? "" : "\n") + "\n[effects]\n" + line + "\n";
  return text.substr(0, last->end) + "\n" + line + text.substr(last->end);
}

std::string without_entry(const std::string& text, const std::string& section, const std::string& key, const std::string& why) {
  const Reader reader(text);
  std::size_t i = find_entry(reader.lines, section, key);
  if (i == reader.lines.size()) return text;
  const bool table = reader.lines[i].header;
  std::string out = text.substr(0, reader.lines[i].begin);
  std::size_t done = reader.lines[i].begin;
  for (bool first = true; i < reader.lines.size(); ++i, first = false) {
    const Line& l = reader.lines[i];
    if (!first && (l.header || (!table && !l.continued))) break;
    out += "# " + text.substr(l.begin, l.end - l.begin) + (first ? "  # " + why : "") + (l.end < text.size() ? "\n" : "");
    done = std::min(l.end + 1, text.size());
  }
  return out + text.substr(done);
}

std::string with_renamed_entry(const std::string& text, const std::string& section, const std::string& key, const std::string& name) {
  const Reader reader(text);
  const std::size_t i = find_entry(reader.lines, section, key);
  if (i == reader.lines.size()) return text;
  const std::size_t at = text.find(key, reader.lines[i].begin);
  return text.substr(0, at) + name + text.substr(at + key.size());
}

std::string with_system(const std::string& text, const std::string& kind) {
  const Reader reader(text);
  const std::size_t i = find_entry(reader.lines, "system", "kind");
  if (i < reader.lines.size()) {
    for (const Quoted& string : reader.strings) {
      if (string.begin < reader.lines[i].begin || string.end > reader.lines[i].end) continue;
      if (text.substr(reader.lines[i].begin, string.begin - reader.lines[i].begin).find('=') == std::string::npos) continue;
      return text.substr(0, string.begin) + quoted(kind) + text.substr(string.end);
    }
  }
  throw InputError("the study has no line kind = \"…\" under [system] that could be changed");
}

}  // namespace misfit
