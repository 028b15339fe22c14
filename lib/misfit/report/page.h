#pragma once

#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "misfit/core/unique_name.h"
#include "misfit/report/figure.h"
#include "misfit/show/blocks.h"

namespace misfit::report {

/// How a text stands on a page: with its symbols typeset (symbols.h), or letter by letter, for what a reader copies or looks up.
enum class Texts { typeset, as_written };

/// An HTML page under construction. Every text given to it is plain and is escaped here; only `html` takes markup.
class Page {
 public:
  explicit Page(std::string title, std::string date = "") : title_(std::move(title)), date_(std::move(date)) {}

  void question(const std::string& text) { question_ = text; }  ///< below the title
  /// Markup with scripts, behind all else. A page with it allows them, and lets nothing be sent or fetched.
  void explorer(const std::string& markup) { explorer_ = markup; }
  /// Sections that begin from now on are folded: their heading opens them. In print they are open.
  void fold_sections() { folds_ = true; }
  /// What follows up to unfold() is folded, under `summary`.
  void fold(const std::string& summary);
  /// The same as one of several of `group`, of which a reader opens one at a time; `open`: this one to begin with.
  void choice(const std::string& group, const std::string& summary, bool open);
  void unfold() { body_ += "</div></details>\n"; }

  /// `figures` draws what belongs to a place; `note` is added to the headings of sections.
  void show(const Blocks& blocks, const std::function<void(const std::string& place)>& figures = {}, const std::string& note = "");
  void section(const std::string& heading);
  void subsection(const std::string& heading);
  void paragraph(const Paragraph& paragraph);  ///< a command as it is written
  void table(const TableBlock& table, Texts texts = Texts::typeset);
  void figure(const Figure& figure);  ///< caption, notes and the place of its drawing
  /// Draws all figures together, into `dir` (write_figures()) and onto the page.
  void draw(const std::filesystem::path& dir);
  /// A name for the next figure: `name`, or if a figure of the page has it one with a number behind.
  [[nodiscard]] std::string free_figure_name(const std::string& name) { return unique_name(name, figure_names_, "."); }
  void html(const std::string& markup) { body_ += markup; }

  /// The whole page: title, style and a list of its sections included.
  [[nodiscard]] std::string text() const;

 private:
  void list(const List& list);

  void end_section();

  std::string title_, date_, question_, body_, explorer_;
  bool folds_ = false, folded_ = false;
  std::vector<std::string> sections_;
  std::set<std::string> figure_names_;
  std::vector<Figure> figures_;  // that are not drawn yet, and where in the body they belong
  std::vector<std::size_t> places_;
};

/// What a figure shows, in a sentence for those who do not see it: title, axes with the ranges that are drawn, curves by their names.
[[nodiscard]] std::string alt_text(const Figure& figure);

/// An SVG file as an element of a page: dots that follow each other in one path, without prolog and namespaces, scaling with the page,
/// every id and reference to it led by `prefix` (ids are shared by all drawings of a page), named `label` for screen readers.
[[nodiscard]] std::string inline_svg(const std::string& svg, const std::string& prefix, const std::string& label);

}  // namespace misfit::report
