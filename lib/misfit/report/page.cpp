#include "misfit/report/page.h"

#include <fmt/format.h>

#include <string_view>

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

std::string table_row(const std::vector<std::string>& cells, const char* tag) {
  std::string html = "<tr>";
  for (const std::string& cell : cells) {
    const char* css = std::string_view(tag) == "td" && cell.size() < 32 ? " class=\"short\"" : "";
    html += fmt::format("<{}{}>{}</{}>", tag, css, html_text(cell), tag);
  }
  return html + "</tr>\n";
}

}  // namespace

void Page::section(const std::string& heading) {
  if (!sections_.empty()) body_ += "</section>\n";
  body_ += fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n", anchor(sections_.size()), html_text(heading));
  sections_.push_back(heading);
}

void Page::subsection(const std::string& heading) { body_ += "<h3>" + html_text(heading) + "</h3>\n"; }

void Page::paragraph(const std::string& text, const std::string& css_class) {
  body_ += fmt::format("<p{}>{}</p>\n", css_class.empty() ? "" : " class=\"" + css_class + "\"", html_text(text));
}

void Page::list(const std::vector<std::string>& items) {
  if (items.empty()) return;
  body_ += "<ul>\n";
  for (const std::string& item : items) body_ += "<li>" + html_text(item) + "</li>\n";
  body_ += "</ul>\n";
}

void Page::table(const std::vector<std::vector<std::string>>& rows) {
  if (rows.size() < 2) return;
  body_ += "<div class=\"wide\"><table><thead>" + table_row(rows.front(), "th") + "</thead><tbody>\n";
  for (std::size_t k = 1; k < rows.size(); ++k) body_ += table_row(rows[k], "td");
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
