#include "misfit/report/page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <regex>

#include "misfit/report/style.h"
#include "misfit/report/symbols.h"
#include "misfit/report/unbroken.h"
#include "misfit/show/rows.h"

namespace misfit::report {
namespace {

const char* css_of(Tone tone) {
  switch (tone) {
    case Tone::lead:
      return "answer";
    case Tone::warning:
      return "bad";
    case Tone::command:
      return "command";
    default:
      return "";
  }
}

std::string anchor(std::size_t number) { return "section-" + std::to_string(number + 1); }

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) text.replace(at, from.size(), to);
}

void remove_between(std::string& text, const std::string& begin, const std::string& end) {
  for (std::size_t at = text.find(begin); at != std::string::npos; at = text.find(begin, at)) {
    const std::size_t stop = text.find(end, at + begin.size());
    if (stop == std::string::npos) return;
    text.erase(at, stop + end.size() - at);
  }
}

/// Filled circles of one size and colour that follow each other, in one path: a sixth of the bytes, one element for thousands of samples.
/// gnuplot defines them as gpPt5 (outline, radius 1) and gpPt6 (filled); where it does otherwise, nothing changes.
void join_dots(std::string& svg) {
  static const std::regex outline(R"(<circle id='gpPt5' [^>]*cx='0' cy='0' r='1'/>)");
  static const std::regex size_and_colour(R"(\) scale\(([\d.]+)\)' color='rgb\( *(\d+), *(\d+), *(\d+)\)')");
  if (!std::regex_search(svg, outline) ||
      svg.find("<use xlink:href='#gpPt5' id='gpPt6' fill='currentColor' stroke='none'/>") == std::string::npos)
    return;
  const std::string begin = "<use xlink:href='#gpPt6' transform='translate(";
  std::string out, like;  // like: what the dots of the open path have in common
  std::size_t done = 0;
  for (std::size_t at = svg.find(begin); at != std::string::npos; at = svg.find(begin, at)) {
    const std::size_t from = at + begin.size(), middle = svg.find(") scale(", from), end = svg.find("/>", from);
    const std::string place = svg.substr(from, middle - from), rest = svg.substr(middle, end - middle);
    if (rest != like || svg.find_first_not_of(" \t\n", done) != at) {
      std::smatch match;
      if (!std::regex_match(rest, match, size_and_colour)) return;
      out += (like.empty() ? "" : "\"/>") + svg.substr(done, at - done);
      out += fmt::format(R"svg(<path stroke="rgb({},{},{})" stroke-width="{:.3g}" stroke-linecap="round" d=")svg", match[2].str(),
                         match[3].str(), match[4].str(), 2.0 * std::stod(match[1].str()));
      like = rest;
    }
    out += "M" + place + "h0";
    done = at = end + 2;
  }
  if (!like.empty()) svg = out + "\"/>" + svg.substr(done);
}

/// "12.0 ± 0.1", "−3", "< 1e-300", "(1.2 ± 0.1)e7": text that begins as a number does.
bool is_number(const std::string& cell) {
  const std::size_t first = cell.find_first_not_of(" +-(<≈");
  return first != std::string::npos && std::isdigit(static_cast<unsigned char>(cell[first])) != 0;
}

bool holds_nothing(const std::string& cell) { return cell.empty() || cell == kMissing; }

/// Columns that are marked so, and those that hold nothing but numbers.
std::vector<bool> number_columns(const TableBlock& table) {
  std::vector<bool> out;
  for (std::size_t j = 0; j < table.columns.size(); ++j) {
    bool any = false, all = true;
    for (const auto& row : table.rows) {
      if (j >= row.size() || holds_nothing(row[j])) continue;
      any = true;
      all = all && is_number(row[j]);
    }
    out.push_back(table.columns[j].align == Align::right || (j > 0 && any && all));
  }
  return out;
}

/// Of the longest piece of a cell that no line end may part.
std::size_t letters_of_longest_word(const std::string& cell) {
  std::size_t most = 0, letters = 0;
  for (const char c : unbroken(cell)) {
    const bool begins_a_letter = (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
    letters = c == ' ' ? 0 : letters + (begins_a_letter ? 1 : 0);
    most = std::max(most, letters);
  }
  return most;
}

/// How wide a table is at least: the style sheet fits it to the paper by its size of letters, so that no word is parted and nothing cut
/// off.
std::size_t least_letters(const TableBlock& table) {
  constexpr std::size_t between = 2;
  std::size_t all = 0;
  for (std::size_t j = 0; j < table.columns.size(); ++j) {
    std::size_t most = letters_of_longest_word(table.columns[j].heading);
    for (const auto& row : table.rows) most = std::max(most, j < row.size() ? letters_of_longest_word(row[j]) : 0);
    all += most + between;
  }
  return std::max<std::size_t>(all, 1);
}

std::string in_html(const std::string& text, Texts texts) { return texts == Texts::as_written ? escape_html(text) : html_text(text); }

std::string table_row(const std::vector<std::string>& cells, const std::vector<bool>& numbers, bool head, Texts texts) {
  std::string html = "<tr>";
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const bool number = k < numbers.size() && numbers[k];
    const char* css = number ? " class=\"number\"" : "";
    html += head ? fmt::format("<th scope=\"col\"{}>{}</th>", css, in_html(cells[k], texts))
                 : fmt::format("<td{}>{}</td>", css, in_html(cells[k], texts));
  }
  return html + "</tr>\n";
}

/// A text within quotation marks in a style sheet.
std::string css_text(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = byte > 127 || std::isalnum(byte) != 0 || c == ' ' || c == ',' || c == '.' || c == '-';
    out += plain ? std::string(1, c) : fmt::format("\\{:06x}", byte);
  }
  return out;
}

/// Number of the page, name of the study and date in the margins of the paper.
std::string margins_of_paper(const std::string& title, const std::string& date) {
  return fmt::format(
      "@page {{ size: A4; margin: 16mm 15mm 18mm; @bottom-left {{ content: \"{} · {}\"; font: 8pt sans-serif; color: #5b6670; }} "
      "@bottom-right {{ content: counter(page) \" / \" counter(pages); font: 8pt sans-serif; color: #5b6670; }} }}\n",
      css_text(title), css_text(date));
}

/// For a page with scripts: its own, and nothing from elsewhere or to elsewhere.
constexpr const char* content_policy =
    "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; "
    "img-src data:\">\n";

}  // namespace

void Page::show(const Blocks& blocks, const std::function<void(const std::string& place)>& figures, const std::string& note) {
  for (const Block& block : blocks.all()) {
    if (const auto* heading = std::get_if<Heading>(&block)) {
      heading->level == 1 ? section(heading->text + note) : subsection(heading->text);
    } else if (const auto* text = std::get_if<Paragraph>(&block)) {
      paragraph(*text);
    } else if (const auto* items = std::get_if<List>(&block)) {
      list(*items);
    } else if (const auto* rows = std::get_if<TableBlock>(&block)) {
      table(*rows);
    } else if (const auto* place = std::get_if<FigurePlace>(&block); place != nullptr && figures) {
      figures(place->name);
    }
  }
}

void Page::end_section() {
  if (sections_.empty()) return;
  body_ += folded_ ? "</div></details>\n</section>\n" : "</section>\n";
}

void Page::section(const std::string& heading) {
  end_section();
  folded_ = folds_;
  const std::string id = anchor(sections_.size());
  body_ += folded_ ? fmt::format("<section>\n<details><summary><h2>{}</h2></summary><div id=\"{}\">\n", html_text(heading), id)
                   : fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n", id, html_text(heading));
  sections_.push_back(heading);
}

void Page::fold(const std::string& summary) { body_ += "<details class=\"inner\"><summary>" + html_text(summary) + "</summary><div>\n"; }

void Page::choice(const std::string& group, const std::string& summary, bool open) {
  body_ += fmt::format("<details class=\"inner choice\" name=\"{}\"{}><summary>{}</summary><div>\n", escape_html(group),
                       open ? " open" : "", html_text(summary));
}

void Page::subsection(const std::string& heading) { body_ += "<h3>" + html_text(heading) + "</h3>\n"; }

void Page::paragraph(const Paragraph& paragraph) {
  const std::string css_class = css_of(paragraph.tone);
  body_ += fmt::format("<p{}>{}</p>\n", css_class.empty() ? "" : " class=\"" + css_class + "\"",
                       in_html(paragraph.text, paragraph.tone == Tone::command ? Texts::as_written : Texts::typeset));
}

void Page::list(const List& list) {
  if (!list.folded.empty()) fold(list.folded);
  body_ += list.tone == Tone::warning ? "<ul class=\"warnings\">\n" : "<ul>\n";
  for (const std::string& item : list.items) body_ += "<li>" + html_text(item) + "</li>\n";
  body_ += "</ul>\n";
  if (!list.folded.empty()) unfold();
}

void Page::table(const TableBlock& table, Texts texts) {
  if (table.rows.empty()) return;
  std::vector<std::string> header;
  for (const TableColumn& column : table.columns) header.push_back(column.heading);
  const std::vector<bool> numbers = number_columns(table);
  body_ += fmt::format("<div class=\"wide\" tabindex=\"0\"><table style=\"--letters: {}\"><thead>{}</thead><tbody>\n", least_letters(table),
                       table_row(header, numbers, true, texts));
  for (const auto& row : table.rows) body_ += table_row(row, numbers, false, texts);
  body_ += "</tbody></table></div>\n";
}

void Page::figure(const Figure& figure) {
  body_ += "<figure>\n<div class=\"wide drawing\" tabindex=\"0\">";
  places_.push_back(body_.size());
  figures_.push_back(figure);
  body_ += "</div><figcaption>" + html_text(figure.caption);
  for (const std::string& note : figure.notes) body_ += " <span class=\"note\">" + html_text(note) + "</span>";
  body_ += fmt::format(
      " <span class=\"files\"><a href=\"figures/{0}.svg\">SVG</a> <a href=\"figures/{0}.csv\">CSV</a> <a "
      "href=\"figures/{0}.gp\">gnuplot</a></span></figcaption>\n</figure>\n",
      escape_html(figure.name));
}

void Page::draw(const std::filesystem::path& dir) {
  const std::vector<std::string> drawings = write_figures(dir, figures_);
  for (std::size_t k = drawings.size(); k-- > 0;) {
    const Figure& figure = figures_[k];
    body_.insert(places_[k], inline_svg(drawings[k], figure.name, alt_text(figure)));
  }
  figures_.clear();
  places_.clear();
}

namespace {

std::string with_unit(const std::string& label, const std::string& unit) {
  return label + (unit.empty() || unit == "-" ? "" : " in " + unit);
}

/// Least and largest of what is drawn, as it comes.
struct Extent {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void add(const std::vector<double>& values) {
    for (const double v : values) {
      if (std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
    }
  }
  [[nodiscard]] std::string words() const { return low > high ? std::string("no data") : fmt::format("{:.3g} to {:.3g}", low, high); }
};

/// What a panel has along y: names where it has names, else its label with the range; empty: its neighbour says it.
std::string along_y(const Panel& panel) {
  if (panel.beside) return "";
  std::vector<std::string> names;
  for (const Mark& mark : panel.y_marks) names.push_back(mark.text);
  if (!names.empty()) return fmt::format("{}", fmt::join(names, ", "));
  Extent y;
  for (const Series& s : panel.series) y.add(s.y);
  return (panel.y_label.empty() ? "y" : with_unit(panel.y_label, panel.y_unit)) + ": " + y.words();
}

}  // namespace

std::string alt_text(const Figure& figure) {
  Extent x;
  std::vector<std::string> curves, panels, further;
  for (const Panel& panel : figure.panels) {
    Extent own;
    for (const Series& s : panel.series) {
      (panel.beside ? own : x).add(s.x);
      if (!s.legend.empty()) curves.push_back(s.legend);
    }
    if (panel.beside) further.push_back(panel.beside->label + ": " + own.words());
    if (std::string words = along_y(panel); !words.empty()) panels.push_back(std::move(words));
  }
  std::string out = figure.title;
  if (!panels.empty()) out += fmt::format("{}{}", out.empty() ? "" : "; ", fmt::join(panels, "; "));
  if (!figure.x_label.empty()) out += fmt::format("; over {}: {}", with_unit(figure.x_label, figure.x_unit), x.words());
  if (!further.empty()) out += fmt::format("; beside it {}", fmt::join(further, "; "));
  return curves.empty() ? out + "." : fmt::format("{}. Drawn: {}.", out, fmt::join(curves, "; "));
}

std::string Page::text() const {
  std::string contents = "<nav><ul>\n";
  for (std::size_t k = 0; k < sections_.size(); ++k)
    contents += fmt::format("<li><a href=\"#{}\">{}</a></li>\n", anchor(k), html_text(sections_[k]));
  contents += "</ul></nav>\n";
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" content=\"width=device-width, "
         "initial-scale=1\">\n" +
         std::string(explorer_.empty() ? "" : content_policy) + "<title>" + escape_html(title_) + "</title>\n<style>\n" + page_style +
         margins_of_paper(title_, date_) + "</style>\n</head>\n<body>\n<header><p class=\"brand\">misfit</p><h1>" + html_text(title_) +
         "</h1>" + (question_.empty() ? "" : "<p class=\"question\">" + html_text(question_) + "</p>") + "</header>\n" + contents +
         "<main>\n" + body_ +
         (sections_.empty() ? ""
          : folded_         ? "</div></details>\n</section>\n"
                            : "</section>\n") +
         "</main>\n" + explorer_ + "</body>\n</html>\n";
}

std::string inline_svg(const std::string& svg, const std::string& prefix, const std::string& label) {
  const std::size_t begin = svg.find("<svg");
  const std::size_t head_end = begin == std::string::npos ? begin : svg.find('>', begin);
  if (head_end == std::string::npos) return "";
  const std::string head = svg.substr(begin, head_end - begin);
  const std::size_t view = head.find("viewBox=\"");
  const std::string box = view == std::string::npos ? "" : head.substr(view, head.find('"', view + 9) + 1 - view);
  const std::size_t wide = head.find(" width=\"");
  const std::string width = wide == std::string::npos ? "900" : head.substr(wide + 8, head.find('"', wide + 8) - wide - 8);
  std::string body = svg.substr(head_end + 1);
  remove_between(body, "<title>", "</title>");  // tooltips with the drawing program's own markup
  remove_between(body, "<desc>", "</desc>");
  join_dots(body);
  replace_all(body, "id='", "id='" + prefix + "-");
  replace_all(body, "id=\"", "id=\"" + prefix + "-");
  replace_all(body, "href='#", "href='#" + prefix + "-");
  replace_all(body, "url(#", "url(#" + prefix + "-");
  return fmt::format("<svg {} style=\"max-width:{}px\" role=\"img\" aria-label=\"{}\">{}", box, width, escape_html(unbroken(label)), body);
}

}  // namespace misfit::report
