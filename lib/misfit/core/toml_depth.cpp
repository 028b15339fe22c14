#include "misfit/core/toml_depth.h"

#include <algorithm>
#include <vector>

#include "misfit/core/error.h"

namespace misfit::config {
namespace {

class Scan {
 public:
  Scan(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  void run() {
    while (place_ < text_.size()) {
      const char c = text_[place_];
      if (c == '#') {
        place_ = std::min(text_.find('\n', place_), text_.size());
      } else if (c == '"' || c == '\'') {
        pass_string(c);
      } else {
        take(c);
        ++place_;
      }
      if (depth_ + points_ > deepest_nesting) fail();
    }
  }

 private:
  void take(char c) {
    switch (c) {
      case '.':
        if (in_key_) ++points_;
        break;
      case '=':
        in_key_ = false;  // the points stay: what the value holds is below all parts of the key
        break;
      case '[':
      case '{':
        opened_.push_back(depth_);
        depth_ += points_ + 1;
        begin_key();
        break;
      case ']':
      case '}':
        close();
        break;
      case ',':
      case '\n':
        begin_key();
        break;
      default:
        break;
    }
  }

  void begin_key() {
    points_ = 0;
    in_key_ = true;
  }

  void close() {
    if (!opened_.empty()) {
      depth_ = opened_.back();
      opened_.pop_back();
    }
    begin_key();
  }

  /// From the quotation mark at place_ to behind the one that ends it.
  void pass_string(char mark) {
    const std::string three(3, mark);
    const bool long_string = text_.substr(place_).starts_with(three);
    place_ += long_string ? 3 : 1;
    for (; place_ < text_.size(); ++place_) {
      if (text_[place_] == '\\' && mark == '"') {
        ++place_;
      } else if (long_string && text_.substr(place_).starts_with(three)) {
        place_ += 3;
        while (place_ < text_.size() && text_[place_] == mark) ++place_;  // up to two marks may belong to the text
        return;
      } else if (!long_string && (text_[place_] == mark || text_[place_] == '\n')) {
        place_ += text_[place_] == mark ? 1 : 0;
        return;
      }
    }
  }

  [[noreturn]] void fail() const {
    const std::string_view before = text_.substr(0, std::min(place_, text_.size()));
    const auto line = static_cast<int>(std::count(before.begin(), before.end(), '\n')) + 1;
    const auto column = static_cast<int>(before.size() - (before.rfind('\n') + 1));
    throw InputError({name_, line, std::max(column, 1)}, "tables, arrays or parts of a key stand in one another more than " +
                                                             std::to_string(deepest_nesting) + " deep; at most " +
                                                             std::to_string(deepest_nesting) + " are possible");
  }

  std::string_view text_;
  const std::string& name_;
  std::size_t place_ = 0;
  int depth_ = 0, points_ = 0;
  bool in_key_ = true;
  std::vector<int> opened_;  ///< depth outside of each open bracket
};

}  // namespace

void check_toml_depth(std::string_view text, const std::string& name) { Scan(text, name).run(); }

}  // namespace misfit::config
