#include "misfit/show/blocks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>

#include "misfit/core/shown.h"
#include "misfit/core/text.h"

namespace misfit {
namespace {

/// Code points of a UTF-8 text.
std::size_t letters(std::string_view text) {
  return std::count_if(text.begin(), text.end(), [](unsigned char c) { return (c & 0xC0U) != 0x80U; });
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> out(1);
  for (const char c : text) {
    if (c == '\n') {
      out.emplace_back();
    } else {
      out.back() += c;
    }
  }
  return out;
}

using Rows = std::vector<std::vector<std::string>>;

/// The widths that columns may have so that all of them take `room` characters: the widest give way, down to what a word needs.
std::vector<std::size_t> widths_within(const Rows& rows, const std::vector<bool>& right, std::size_t room) {
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const auto& row : rows) {
    for (std::size_t j = 0; j < std::min(row.size(), widths.size()); ++j) widths[j] = std::max(widths[j], letters(row[j]));
  }
  constexpr std::size_t gap = 2, least = 16;
  std::size_t total = gap * widths.size();
  for (const std::size_t width : widths) total += width;
  while (total > room) {
    std::size_t widest = widths.size();
    for (std::size_t j = 0; j < widths.size(); ++j) {
      if (!right[j] && widths[j] > least && (widest == widths.size() || widths[j] > widths[widest])) widest = j;
    }
    if (widest == widths.size()) break;
    --widths[widest];
    --total;
  }
  return widths;
}

/// Cells that are too long go on in rows of their own below.
Rows wrapped(const Rows& rows, const std::vector<bool>& right, std::size_t room) {
  if (rows.front().empty()) return rows;
  const std::vector<std::size_t> widths = widths_within(rows, right, room);
  Rows out;
  for (const auto& row : rows) {
    std::vector<std::vector<std::string>> cells;
    std::size_t height = 1;
    for (std::size_t j = 0; j < row.size(); ++j) {
      const bool fits = j >= widths.size() || right[j] || letters(row[j]) <= widths[j];
      cells.push_back(fits ? std::vector<std::string>{row[j]} : lines_of(wrap_text(row[j], widths[j])));
      height = std::max(height, cells.back().size());
    }
    for (std::size_t line = 0; line < height; ++line) {
      out.emplace_back();
      for (const auto& cell : cells) out.back().push_back(line < cell.size() ? cell[line] : "");
    }
  }
  return out;
}

/// Writes one block after the other to text.
class TextWriter {
 public:
  explicit TextWriter(const TextStyle& style) : style_(style) {}

  void operator()(const Heading& heading) {
    if (!text.empty()) text += "\n";
    text += in(heading.level == 1 ? terminal_colours::bold : "", heading.text) + "\n";
    last_ = Last::heading;
  }
  void operator()(const Paragraph& paragraph) {
    if (last_ == Last::table && paragraph.tone != Tone::warning) text += "\n";
    line(paragraph.text, paragraph.tone);
  }
  void operator()(const List& list) {
    if (last_ == Last::table && list.tone != Tone::warning) text += "\n";
    if (!list.folded.empty()) return line(list.folded, list.tone);
    const std::size_t shown = std::min(list.excerpt.most, list.items.size());
    for (std::size_t k = 0; k < shown; ++k) line(list.items[k], list.tone);
    rest(list.items.size() - shown, shown, list.excerpt);
  }
  void operator()(const TableBlock& table) {
    if (last_ == Last::line || last_ == Last::table) text += "\n";
    Rows cells(1);
    std::vector<bool> right;
    for (const TableColumn& column : table.columns) {
      cells.front().push_back(column.heading);
      right.push_back(column.align == Align::right);
    }
    const std::size_t shown = std::min(table.excerpt.most, table.rows.size());
    for (std::size_t k = 0; k < shown; ++k) cells.push_back(table.rows[k]);
    const Rows lines = wrapped(cells, right, style_.table);
    text += printed(align_columns(lines, "  ", right));
    rest(table.rows.size() - shown, shown, table.excerpt);
    last_ = Last::table;
  }
  void operator()(const FigurePlace&) {}

  std::string text;

 private:
  enum class Last { nothing, heading, line, table };

  [[nodiscard]] std::string printed(const std::string& words) const { return style_.colour ? printable(words) : words; }
  [[nodiscard]] std::string in(std::string_view colour, const std::string& words) const {
    if (!style_.colour || colour.empty()) return printed(words);
    return std::string(colour) + printed(words) + std::string(terminal_colours::off);
  }

  void line(const std::string& words, Tone tone) {
    constexpr std::string_view mark = "  ! ";
    if (tone == Tone::warning) {
      text += in(terminal_colours::yellow,
                 std::string(mark) + wrap_text(words, style_.width, std::string(mark.size(), ' ')).substr(mark.size())) +
              "\n";
    } else if (tone == Tone::command) {
      text += "  " + in(terminal_colours::bold, words) + "\n";  // in one piece, to be copied
    } else {
      const bool lead = tone == Tone::lead;
      text += in(lead ? terminal_colours::green : "", wrap_text(words, style_.width, lead ? "" : "  ")) + "\n";
    }
    last_ = Last::line;
  }
  void rest(std::size_t left, std::size_t shown, const Excerpt& excerpt) {
    if (left > 0) text += fmt::format("  {}{}{} in {}\n", shown > 0 ? "… and " : "", left, shown > 0 ? " more" : "", excerpt.file);
  }

  TextStyle style_;
  Last last_ = Last::nothing;
};

}  // namespace

std::vector<TableColumn> columns(std::string_view headings) {
  std::vector<TableColumn> out;
  for (std::size_t at = 0; at <= headings.size();) {
    const std::size_t end = std::min(headings.find('|', at), headings.size());
    const std::string_view heading = headings.substr(at, end - at);
    const bool right = heading.starts_with('>');
    out.push_back({std::string(heading.substr(right ? 1 : 0)), right ? Align::right : Align::left});
    at = end + 1;
  }
  return out;
}

void Blocks::paragraph(const std::string& text, Tone tone) {
  if (!text.empty()) all_.emplace_back(Paragraph{text, tone});
}

void Blocks::list(List list) {
  if (!list.items.empty()) all_.emplace_back(std::move(list));
}

void Blocks::table(TableBlock table) {
  if (!table.rows.empty()) all_.emplace_back(std::move(table));
}

std::string as_sentence(std::string text) {
  if (text.empty()) return text;
  const bool name = text.substr(0, text.find(' ')).find('_') != std::string::npos;
  if (!name) text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  return text.ends_with('.') || text.ends_with('!') || text.ends_with('?') ? text : text + ".";
}

std::vector<std::string> as_sentences(std::vector<std::string> texts) {
  for (std::string& text : texts) text = as_sentence(text);
  return texts;
}

std::string stage_line(const std::string& stage, const std::string& words, const TextStyle& style) {
  constexpr std::size_t column = 18;
  const std::string beside(column, ' ');
  const std::size_t named = 2 + letters(stage);
  const std::string blanks(named < column ? column - named : 1, ' ');
  std::string text = wrap_text(words, style.width, beside);
  text.erase(0, std::min(column, text.size()));
  if (style.colour) text = printable(text);
  const std::string name =
      style.colour ? std::string(terminal_colours::bold) + printable(stage) + std::string(terminal_colours::off) : stage;
  return "  " + name + blanks + text + "\n";
}

std::string as_text(const Blocks& blocks, const TextStyle& style) {
  TextWriter writer(style);
  for (const Block& block : blocks.all()) std::visit(writer, block);
  return writer.text;
}

}  // namespace misfit
