#pragma once

#include <fmt/format.h>

#include <cctype>
#include <set>
#include <string>
#include <vector>

namespace misfit::report {

/// Reads a page strictly and collects its faults: elements that are not closed in their order, blocks inside a paragraph, attributes
/// without quotation marks or given twice, ids given twice, links to ids that are not there, '&' that begins no reference, pictures without
/// a text for those who do not see them, heads of tables without a scope. Stricter than HTML: every element but the void ones must be
/// closed.
class HtmlReader {
 public:
  explicit HtmlReader(const std::string& page) : page_(page) {
    if (!page.starts_with("<!DOCTYPE html>\n<html lang=")) fault("no doctype and language");
    while (at_ < page_.size()) page_[at_] == '<' ? tag() : text();
    for (const std::string& name : open_) fault("not closed: " + name);
    for (const std::string& id : wanted_) {
      if (!ids_.contains(id)) fault("a link to nowhere: #" + id);
    }
  }
  std::vector<std::string> faults;

 private:
  void fault(const std::string& what) { faults.push_back(fmt::format("{} (at {})", what, at_)); }

  void text() {
    if (page_[at_] == '&') {
      const std::size_t end = page_.find(';', at_);
      if (end == std::string::npos || end - at_ > 8) fault("'&' that begins no reference");
    }
    if (page_[at_] == '>') fault("a loose '>'");
    ++at_;
  }

  void tag() {
    if (page_.compare(at_, 2, "<!") == 0) {
      const bool comment = page_.compare(at_, 4, "<!--") == 0;
      const std::size_t end = page_.find(comment ? "-->" : ">", at_);
      at_ = end == std::string::npos ? page_.size() : end + (comment ? 3 : 1);
    } else if (page_.compare(at_, 2, "</") == 0) {
      at_ += 2;
      const std::string name = word();
      if (open_.empty() || open_.back() != name) {
        fault("closed out of order: " + name);
      } else {
        open_.pop_back();
      }
      ++at_;
    } else {
      ++at_;
      element();
    }
  }

  std::string word() {
    std::string out;
    while (at_ < page_.size() &&
           (std::isalnum(static_cast<unsigned char>(page_[at_])) != 0 || std::string("-_:.").find(page_[at_]) != std::string::npos))
      out += page_[at_++];
    return out;
  }
  void blanks() {
    while (at_ < page_.size() && std::isspace(static_cast<unsigned char>(page_[at_])) != 0) ++at_;
  }

  void element() {
    const std::string name = word();
    if (name.empty()) fault("a loose '<'");
    static const std::set<std::string> blocks{"p", "div", "table", "figure", "ul", "section", "details", "h1", "h2", "h3", "nav"};
    if (!open_.empty() && open_.back() == "p" && blocks.contains(name)) fault("<" + name + "> inside a paragraph");
    std::set<std::string> attributes;
    for (blanks(); at_ < page_.size() && page_[at_] != '>' && page_[at_] != '/'; blanks()) attribute(attributes);
    const bool closed = at_ < page_.size() && page_[at_] == '/';
    at_ += closed ? 2 : 1;
    if (name == "th" && !attributes.contains("scope")) fault("<th> without scope");
    if (name == "img" && !attributes.contains("alt")) fault("<img> without alt");
    if (name == "svg" && !(attributes.contains("aria-label") && attributes.contains("role"))) fault("<svg> without a name");
    static const std::set<std::string> voids{"meta", "img", "br", "hr", "link", "input"};
    if (name == "style" || name == "script") {
      at_ = page_.find("</" + name, at_);
      at_ = at_ == std::string::npos ? page_.size() : page_.find('>', at_) + 1;
    } else if (!closed && !voids.contains(name)) {
      open_.push_back(name);
    }
  }

  void attribute(std::set<std::string>& seen) {
    const std::string name = word();
    if (name.empty()) {
      fault("no attribute");
      ++at_;
      return;
    }
    if (!seen.insert(name).second) fault("attribute given twice: " + name);
    blanks();  // gnuplot writes: points = "…"
    if (page_[at_] != '=') return;
    ++at_;
    blanks();
    const char quote = page_[at_];
    if (quote != '"' && quote != '\'') return fault("value without quotation marks: " + name);
    const std::size_t end = page_.find(quote, at_ + 1);
    const std::string value = page_.substr(at_ + 1, end - at_ - 1);
    at_ = end + 1;
    if (name == "id" && !ids_.insert(value).second) fault("id given twice: " + value);
    if (name == "href" && value.starts_with('#')) wanted_.insert(value.substr(1));
  }

  const std::string& page_;
  std::size_t at_ = 0;
  std::vector<std::string> open_;
  std::set<std::string> ids_, wanted_;
};

inline std::vector<std::string> html_faults(const std::string& page) { return HtmlReader(page).faults; }

}  // namespace misfit::report
