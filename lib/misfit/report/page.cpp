#include "misfit/report/page.h"

#include <fmt/format.h>

#include "misfit/report/style.h"
#include "misfit/report/symbols.h"

namespace misfit::report {
namespace {

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

std::string table_row(const std::vector<std::string>& cells, const std::vector<Column>& columns, const char* tag) {
  std::string html = "<tr>";
  constexpr std::size_t short_cell = 32;  // bytes that are not broken into lines
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const bool number = k < columns.size() && columns[k].align == Align::right;
    const char* css = number ? " class=\"number\"" : cells[k].size() < short_cell ? " class=\"short\"" : "";
    html += fmt::format("<{0}{1}>{2}</{0}>", tag, css, html_text(cells[k]));
  }
  return html + "</tr>\n";
}

}  // namespace

void Page::show(const Blocks& blocks, const std::function<void(const std::string& place)>& figures, const std::string& note) {
  for (const Block& block : blocks.all()) {
    if (const auto* heading = std::get_if<Heading>(&block)) {
      heading->level == 1 ? section(heading->text + note) : subsection(heading->text);
    } else if (const auto* text = std::get_if<Paragraph>(&block)) {
      paragraph(text->text, text->tone == Tone::lead ? "question" : text->tone == Tone::warning ? "bad" : "");
    } else if (const auto* items = std::get_if<List>(&block)) {
      list(*items);
    } else if (const auto* rows = std::get_if<TableBlock>(&block)) {
      table(*rows);
    } else if (const auto* place = std::get_if<FigurePlace>(&block); place != nullptr && figures) {
      figures(place->name);
    }
  }
}

void Page::section(const std::string& heading) {
  if (!sections_.empty()) body_ += "</section>\n";
  body_ += fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n", anchor(sections_.size()), html_text(heading));
  sections_.push_back(heading);
}

void Page::subsection(const std::string& heading) { body_ += "<h3>" + html_text(heading) + "</h3>\n"; }

void Page::paragraph(const std::string& text, const std::string& css_class) {
  body_ += fmt::format("<p{}>{}</p>\n", css_class.empty() ? "" : " class=\"" + css_class + "\"", html_text(text));
}

void Page::list(const List& list) {
  body_ += list.tone == Tone::warning ? "<ul class=\"warnings\">\n" : "<ul>\n";
  for (const std::string& item : list.items) body_ += "<li>" + html_text(item) + "</li>\n";
  body_ += "</ul>\n";
}

void Page::table(const TableBlock& table) {
  std::vector<std::string> header;
  for (const Column& column : table.columns) header.push_back(column.heading);
  body_ += "<div class=\"wide\"><table><thead>" + table_row(header, table.columns, "th") + "</thead><tbody>\n";
  for (const auto& row : table.rows) body_ += table_row(row, table.columns, "td");
  body_ += "</tbody></table></div>\n";
}

void Page::figure(const Figure& figure, const std::string& svg) {
  body_ += "<figure>\n" + inline_svg(svg, figure.name, figure.title) + "<figcaption>" + html_text(figure.caption);
  for (const std::string& note : figure.notes) body_ += " <span class=\"note\">" + html_text(note) + "</span>";
  body_ += fmt::format(" <span class=\"files\">figures/{0}.svg, .csv, .gp</span></figcaption>\n</figure>\n", escape_html(figure.name));
}

std::string Page::text() const {
  std::string contents = "<nav><ul>\n";
  for (std::size_t k = 0; k < sections_.size(); ++k)
    contents += fmt::format("<li><a href=\"#{}\">{}</a></li>\n", anchor(k), html_text(sections_[k]));
  contents += "</ul></nav>\n";
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" content=\"width=device-width, "
         "initial-scale=1\">\n<title>" +
         escape_html(title_) + "</title>\n<style>\n" + page_style + "</style>\n</head>\n<body>\n<header><p class=\"brand\">misfit</p><h1>" +
         html_text(title_) + "</h1></header>\n" + contents + "<main>\n" + body_ + (sections_.empty() ? "" : "</section>\n") +
         "</main>\n</body>\n</html>\n";
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
  replace_all(body, "id='", "id='" + prefix + "-");
  replace_all(body, "id=\"", "id=\"" + prefix + "-");
  replace_all(body, "href='#", "href='#" + prefix + "-");
  replace_all(body, "url(#", "url(#" + prefix + "-");
  return fmt::format("<svg {} style=\"max-width:{}px\" role=\"img\" aria-label=\"{}\">{}", box, width, escape_html(label), body);
}

}  // namespace misfit::report
