#include "misfit/show/blocks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>

#include "misfit/core/text.h"

namespace misfit {
namespace {

/// Writes one block after the other to text.
class TextWriter {
 public:
  void operator()(const Heading& heading) {
    if (!text.empty()) text += "\n";
    text += heading.text + "\n";
    last_ = Last::heading;
  }
  void operator()(const Paragraph& paragraph) {
    if (last_ == Last::table && paragraph.tone != Tone::warning) text += "\n";
    line(paragraph.text, paragraph.tone);
  }
  void operator()(const List& list) {
    if (last_ == Last::table && list.tone != Tone::warning) text += "\n";
    const std::size_t shown = std::min(list.excerpt.most, list.items.size());
    for (std::size_t k = 0; k < shown; ++k) line(list.items[k], list.tone);
    rest(list.items.size() - shown, shown, list.excerpt);
  }
  void operator()(const TableBlock& table) {
    if (last_ == Last::line || last_ == Last::table) text += "\n";
    std::vector<std::vector<std::string>> cells(1);
    std::vector<bool> right;
    for (const Column& column : table.columns) {
      cells.front().push_back(column.heading);
      right.push_back(column.align == Align::right);
    }
    const std::size_t shown = std::min(table.excerpt.most, table.rows.size());
    for (std::size_t k = 0; k < shown; ++k) cells.push_back(table.rows[k]);
    text += align_columns(cells, "  ", right);
    rest(table.rows.size() - shown, shown, table.excerpt);
    last_ = Last::table;
  }
  void operator()(const FigurePlace&) {}

  std::string text;

 private:
  enum class Last { nothing, heading, line, table };

  void line(const std::string& words, Tone tone) {
    constexpr std::size_t width = 110;
    constexpr std::string_view mark = "  ! ";
    if (tone == Tone::warning) {
      text += std::string(mark) + wrap_text(words, width, std::string(mark.size(), ' ')).substr(mark.size()) + "\n";
    } else {
      text += wrap_text(words, width, tone == Tone::lead ? "" : "  ") + "\n";
    }
    last_ = Last::line;
  }
  void rest(std::size_t left, std::size_t shown, const Excerpt& excerpt) {
    if (left > 0) text += fmt::format("  {}{}{} in {}\n", shown > 0 ? "… and " : "", left, shown > 0 ? " more" : "", excerpt.file);
  }

  Last last_ = Last::nothing;
};

}  // namespace

std::vector<Column> columns(std::string_view headings) {
  std::vector<Column> out;
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

std::string as_text(const Blocks& blocks) {
  TextWriter writer;
  for (const Block& block : blocks.all()) std::visit(writer, block);
  return writer.text;
}

}  // namespace misfit
