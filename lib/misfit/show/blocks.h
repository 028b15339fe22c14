#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace misfit {

// What is shown of a result: a list of blocks, written to a terminal by as_text() and to a page by report/page.h.

enum class Tone { plain, lead, warning, command };  ///< lead: the answer itself, before everything else; command: what to type

/// Level 1: of a result; 2: of a part of it.
struct Heading {
  std::string text;
  int level = 1;
};

struct Paragraph {
  std::string text;
  Tone tone = Tone::plain;
};

/// How much of a long block a terminal gets; a page gets all of it.
struct Excerpt {
  std::size_t most = std::numeric_limits<std::size_t>::max();
  std::string file = {};  ///< that has the rest
};

struct List {
  std::vector<std::string> items;
  Tone tone = Tone::plain;
  Excerpt excerpt = {};
  std::string folded = {};  ///< the items in a line: a page folds them under it, a terminal shows it alone
};

enum class Align { left, right };

struct TableColumn {
  std::string heading;
  Align align = Align::left;
};

/// From their headings, parted by '|'; those that begin with '>' are aligned to the right: "effect|>drop|accepted".
[[nodiscard]] std::vector<TableColumn> columns(std::string_view headings);

/// A value stands with its unit in its cell, or the heading has the unit.
struct TableBlock {
  std::vector<TableColumn> columns = {};
  std::vector<std::vector<std::string>> rows = {};
  Excerpt excerpt = {};
};

/// Where a page puts figures of its own choice.
struct FigurePlace {
  std::string name;
};

using Block = std::variant<Heading, Paragraph, List, TableBlock, FigurePlace>;

/// Blocks under construction. A table or list without content is left out.
class Blocks {
 public:
  void heading(const std::string& text) { all_.emplace_back(Heading{text, 1}); }
  void subheading(const std::string& text) { all_.emplace_back(Heading{text, 2}); }
  void paragraph(const std::string& text, Tone tone = Tone::plain);
  void list(List list);
  void warnings(const std::vector<std::string>& sentences) { list({sentences, Tone::warning}); }
  void table(TableBlock table);
  void figures(const std::string& place) { all_.emplace_back(FigurePlace{place}); }
  void append(const Blocks& more) { all_.insert(all_.end(), more.all_.begin(), more.all_.end()); }

  [[nodiscard]] const std::vector<Block>& all() const { return all_; }

 private:
  std::vector<Block> all_;
};

/// "A sentence." from "a sentence": with a capital letter and a full stop. A first word with '_', a name of a study, stays as it is.
[[nodiscard]] std::string as_sentence(std::string text);
[[nodiscard]] std::vector<std::string> as_sentences(std::vector<std::string> texts);

/// How a terminal gets text.
struct TextStyle {
  std::size_t width = 110;                                      ///< [characters] of a line
  std::size_t table = std::numeric_limits<std::size_t>::max();  ///< of a line of a table
  bool colour = false;  ///< headings, the answer and warnings stand out (bold, colours of the terminal)
};

/// For a terminal: paragraphs and the longest cells of tables wrapped at the width, columns aligned, warnings led by "! ". With colour all
/// texts are printable (core/shown.h), and the only control characters are those of terminal_colours.
[[nodiscard]] std::string as_text(const Blocks& blocks, const TextStyle& style = {});

/// What a line of a stage begins with, and what it says, wrapped beside it: "  calibrate     h_c 0.152 m, …".
[[nodiscard]] std::string stage_line(const std::string& stage, const std::string& words, const TextStyle& style = {});

namespace terminal_colours {
inline constexpr std::string_view bold = "\033[1m", green = "\033[1;32m", yellow = "\033[33m", faint = "\033[2m", off = "\033[0m";
inline constexpr std::array all{bold, green, yellow, faint, off};
}  // namespace terminal_colours

}  // namespace misfit
