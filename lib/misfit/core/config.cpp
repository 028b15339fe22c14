#include "misfit/core/config.h"

#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <sstream>

#include "misfit/core/files.h"
#include "misfit/core/shown.h"
#include "misfit/core/toml_depth.h"
#include "misfit/core/toml_document.h"
#include "misfit/core/toml_outline.h"
#include "misfit/core/toml_text.h"
#include "misfit/core/units.h"
#include "misfit/core/utf8.h"

namespace misfit::config {

namespace {

/// Without the line breaks and indents of a table or an array as TOML.
std::string on_one_line(const std::string& text) {
  std::string out;
  bool indent = false;
  for (const char c : text) {
    indent = c == '\n' || (indent && c == ' ');
    if (c == '\n') out += ' ';
    if (!indent) out += c;
  }
  return out;
}

}  // namespace

/// One table of the document. Children are kept, so that all views of one table share their notes.
struct Section::State {
  std::shared_ptr<const toml::table> root;  ///< keeps `table` alive
  const toml::table* table = nullptr;
  std::string file;
  std::string path;  ///< "" at the top
  Source where;
  std::vector<std::string> asked;  ///< keys that a reader knows, in order of asking
  std::set<std::string> known;     ///< the same, to look up
  std::set<std::string> read;      ///< of these, those that stand in the file
  std::map<std::string, std::shared_ptr<State>> children;

  const toml::node* node(std::string_view key) const { return table->get(key); }

  /// The node of `key`, noted as read; nullptr if absent.
  const toml::node* take(std::string_view key) {
    if (known.emplace(key).second) asked.emplace_back(key);
    const toml::node* found = node(key);
    if (found) read.emplace(key);
    return found;
  }

  std::string full(std::string_view key) const { return path.empty() ? std::string(key) : path + "." + std::string(key); }

  Source place(const toml::source_region& region) const {
    return {file, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
  }

  std::shared_ptr<State> child(const std::string& name, const toml::table& of, const Source& at) {
    std::shared_ptr<State>& slot = children[name];
    if (!slot) slot = std::make_shared<State>(State{root, &of, file, full(name), at, {}, {}, {}, {}});
    return slot;
  }

  /// Each element of an array of numbers as `from` has it.
  template <class T, class Read>
  std::optional<std::vector<T>> elements(std::string_view key, const Read& from);

  [[noreturn]] void fail(std::string_view key, const toml::node& node, const std::string& expected) const {
    std::ostringstream text;
    node.visit([&text](const auto& value) { text << value; });  // as TOML
    throw InputError(place(node.source()), shown(full(key)) + " = " + shown(on_one_line(text.str())) + ": " + expected);
  }
};

template <class T, class Read>
std::optional<std::vector<T>> Section::State::elements(std::string_view key, const Read& from) {
  const toml::node* node = take(key);
  if (!node) return std::nullopt;
  if (!node->is_array()) fail(key, *node, "an array of numbers is expected, as [0, 0.5, 1]");
  std::vector<T> out;
  for (const toml::node& element : *node->as_array()) {
    try {
      out.push_back(from(element));
    } catch (const InputError& error) {
      fail(std::string(key) + "[" + std::to_string(out.size()) + "]", element, error.what());
    }
  }
  return out;
}

namespace {

/// A number, or a string "24 in", in `unit`. InputError (without place) saying what is wrong.
double number_of(const toml::node& node, std::string_view unit) {
  const std::string wanted = unit.empty() ? "" : " in '" + std::string(unit) + "'";
  double value = 0.0;
  if (node.is_integer() || node.is_floating_point()) {
    value = *node.value<double>();
  } else if (node.is_string()) {
    const Quantity quantity = parse_quantity(node.as_string()->get());
    value = quantity.value;
    if (!quantity.unit.empty()) value = convert(quantity.value / parse_unit(quantity.unit).to_si, quantity.unit, unit);
  } else {
    throw InputError("a number" + wanted + " is expected, as 0.5 or \"0.5 " + std::string(unit) + "\"");
  }
  if (!std::isfinite(value)) throw InputError("a finite number" + wanted + " is expected");
  return value;
}

toml::table parse_document(std::string_view text, const std::string& name) {
  check_toml_depth(text, name);
  try {
    return toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    const auto& begin = error.source().begin;
    throw InputError({name, static_cast<int>(begin.line), static_cast<int>(begin.column)},
                     "not valid TOML: " + shown(error.description(), longest_message / 2));
  }
}

/// In file order (by line).
std::vector<std::string> keys_of(const toml::table& table) {
  std::vector<std::pair<toml::source_position, std::string>> found;
  for (const auto& [key, node] : table) found.emplace_back(key.source().begin, std::string(key.str()));
  std::sort(found.begin(), found.end());
  std::vector<std::string> out;
  for (auto& [position, key] : found) out.push_back(std::move(key));
  return out;
}

void append(const toml::table& table, const std::string& path, const std::vector<std::string>& without, std::ostringstream& out);

void append(const toml::node& node, const std::string& path, const std::vector<std::string>& without, std::ostringstream& out) {
  if (const toml::table* table = node.as_table()) {
    append(*table, path, without, out);
  } else if (const toml::array* array = node.as_array()) {
    out << '[';
    for (const toml::node& element : *array) {
      append(element, path, without, out);
      out << ',';
    }
    out << ']';
  } else {
    node.visit([&](const auto& value) {
      if constexpr (toml::is_floating_point<decltype(value)>) {
        out << std::hexfloat << value.get() << std::defaultfloat;
      } else if constexpr (toml::is_value<decltype(value)>) {
        out << toml::json_formatter(value);
      }
    });
  }
}

void append(const toml::table& table, const std::string& path, const std::vector<std::string>& without, std::ostringstream& out) {
  out << '{';
  for (const std::string& key : keys_of(table)) {
    const std::string there = path.empty() ? key : path + "." + key;
    if (std::find(without.begin(), without.end(), there) != without.end()) continue;
    out << toml::json_formatter(toml::value<std::string>(key)) << ':';
    append(*table.get(key), there, without, out);
    out << ',';
  }
  out << '}';
}

}  // namespace

Section Section::load(const std::filesystem::path& path) { return parse(read_file(path), path.string()); }

Section Section::parse(std::string_view text, const std::string& name) {
  auto root = std::make_shared<const toml::table>(parse_document(text, name));
  const toml::table* table = root.get();
  return Section(std::make_shared<State>(State{std::move(root), table, name, "", {name, 0, 0}, {}, {}, {}, {}}));
}

bool Section::has(std::string_view key) const { return state_->node(key) != nullptr; }

std::vector<std::string> Section::keys() const { return keys_of(*state_->table); }

Source Section::where(std::string_view key) const {
  const auto found = state_->table->find(key);
  return found == state_->table->end() ? state_->where : state_->place(found->first.source());
}

Source Section::where_text(std::string_view key) const {
  const toml::node* node = state_->node(key);
  if (node == nullptr || !node->is_string()) return where(key);
  Source place = state_->place(node->source());
  ++place.column;
  return place;
}

Source Section::where() const { return state_->where; }
std::string Section::path() const { return state_->path; }
std::filesystem::path Section::file() const { return state_->file; }

std::optional<Number> Section::number(std::string_view key, std::string_view unit, bool sigma_allowed) const {
  const toml::node* node = state_->take(key);
  if (!node) return std::nullopt;
  Number out;
  out.unit = unit;
  out.where = where(key);
  if (sigma_allowed && node->is_table()) {
    const Section parts = *table(key);
    const auto value = parts.number("value", unit);
    const auto sigma = parts.number("sigma", unit);
    parts.finish();
    if (!value) state_->fail(key, *node, "{ value = …, sigma = … } needs a value");
    if (sigma && sigma->value <= 0.0) parts.fail("sigma", "must be above 0; leave it out where it is not known");
    out.value = value->value;
    if (sigma) out.sigma = sigma->value;
    return out;
  }
  try {
    out.value = number_of(*node, unit);
  } catch (const InputError& error) {
    state_->fail(key, *node, error.what() + std::string(sigma_allowed && !node->is_string() ? ", or { value = …, sigma = … }" : ""));
  }
  return out;
}

std::optional<bool> Section::flag(std::string_view key) const {
  const toml::node* node = state_->take(key);
  if (!node) return std::nullopt;
  if (!node->is_boolean()) state_->fail(key, *node, "true or false is expected");
  return node->as_boolean()->get();
}

std::optional<long> Section::integer(std::string_view key, long least, long most) const {
  const toml::node* node = state_->take(key);
  if (!node) return std::nullopt;
  const bool fits = node->is_integer() && node->as_integer()->get() >= least && node->as_integer()->get() <= most;
  const bool limited = most < std::numeric_limits<long>::max();
  const std::string range =
      limited ? "from " + std::to_string(least) + " to " + std::to_string(most) : "from " + std::to_string(least) + " on";
  if (!fits) state_->fail(key, *node, "a whole number " + range + " is expected");
  return static_cast<long>(node->as_integer()->get());
}

std::optional<std::string> Section::text(std::string_view key) const {
  const toml::node* node = state_->take(key);
  if (!node) return std::nullopt;
  if (!node->is_string()) state_->fail(key, *node, "a text in quotation marks is expected");
  return node->as_string()->get();
}

std::optional<std::string> Section::choice(std::string_view key, const std::vector<std::string>& allowed) const {
  auto chosen = text(key);
  if (chosen && std::find(allowed.begin(), allowed.end(), *chosen) == allowed.end()) {
    state_->fail(key, *state_->node(key), "not one of the choices" + suggest(*chosen, allowed));
  }
  return chosen;
}

std::optional<std::vector<double>> Section::numbers(std::string_view key, std::string_view unit) const {
  return state_->elements<double>(key, [unit](const toml::node& element) { return number_of(element, unit); });
}

std::optional<std::vector<Number>> Section::quantities(std::string_view key) const {
  return state_->elements<Number>(key, [this](const toml::node& element) -> Number {
    const Source at = state_->place(element.source());
    if (!element.is_string()) return {number_of(element, ""), std::nullopt, "", at};
    const Quantity quantity = parse_quantity(element.as_string()->get());
    return {quantity.value, std::nullopt, quantity.unit, at};
  });
}

std::optional<std::vector<std::string>> Section::texts(std::string_view key) const {
  const toml::node* node = state_->take(key);
  if (!node) return std::nullopt;
  if (!node->is_array()) state_->fail(key, *node, "an array of texts is expected, as [\"a\", \"b\"]");
  std::vector<std::string> out;
  for (const toml::node& element : *node->as_array()) {
    const std::string name = std::string(key) + "[" + std::to_string(out.size()) + "]";
    if (!element.is_string()) state_->fail(name, element, "a text in quotation marks is expected");
    out.push_back(element.as_string()->get());
  }
  return out;
}

std::optional<Section> Section::table(std::string_view key) const {
  const toml::node* node = state_->take(key);
  if (!node) return std::nullopt;
  if (!node->is_table()) state_->fail(key, *node, "a table is expected, as { … }");
  return Section(state_->child(std::string(key), *node->as_table(), where(key)));
}

std::vector<Section> Section::tables(std::string_view key) const {
  const toml::node* node = state_->take(key);
  if (!node) return {};
  if (node->is_table()) return {*table(key)};
  if (!node->is_array()) state_->fail(key, *node, "a table or an array of tables is expected, as [[" + state_->full(key) + "]]");
  std::vector<Section> out;
  for (const toml::node& element : *node->as_array()) {
    const std::string name = std::string(key) + "[" + std::to_string(out.size()) + "]";
    if (!element.is_table()) state_->fail(name, element, "a table is expected, as { … }");
    out.push_back(Section(state_->child(name, *element.as_table(), state_->place(element.source()))));
  }
  return out;
}

bool Section::is_text(std::string_view key) const { return has(key) && state_->node(key)->is_string(); }
bool Section::is_number(std::string_view key) const { return has(key) && state_->node(key)->is_number(); }
bool Section::is_table(std::string_view key) const { return has(key) && state_->node(key)->is_table(); }
bool Section::is_array(std::string_view key) const { return has(key) && state_->node(key)->is_array(); }
bool Section::is_flag(std::string_view key) const { return has(key) && state_->node(key)->is_boolean(); }

void Section::finish() const { finish(state_->asked); }

void Section::finish(const std::vector<std::string>& valid) const {
  for (const std::string& key : keys()) {
    if (state_->read.count(key) == 0) fail_unknown(key, valid);
  }
}

void Section::fail_unknown(const std::string& key, const std::vector<std::string>& valid) const {
  const std::string what = state_->node(key)->is_table() && state_->path.empty() ? "unknown section [" : "unknown key '";
  const std::string end = what.back() == '[' ? "]" : "'";
  const std::string inside = state_->path.empty() ? "" : " in " + section_in_words(state_->path);
  throw InputError(where(key), what + shown(key) + end + inside + suggest(key, valid));
}

void Section::fail(std::string_view key, const std::string& message) const {
  const std::string path = key.empty() ? state_->path : state_->full(key);
  throw InputError(where(key), path.empty() ? message : shown(path) + ": " + message);
}

void Section::fail_value(std::string_view key, const std::string& expected) const { state_->fail(key, *state_->take(key), expected); }

std::string content_of(const std::string& text, const std::vector<std::string>& without) {
  std::ostringstream out;
  append(parse_document(text, ""), "", without, out);
  return out.str();
}

}  // namespace misfit::config

// What else needs the TOML library, which has this one includer: toml_text.h and toml_outline.h.

namespace misfit {
namespace {

/// Bytes of a text by line and column, the latter counted in code points.
class Places {
 public:
  explicit Places(const std::string& text) : text_(text), first_(text.starts_with("\xEF\xBB\xBF") ? 3 : 0) {
    lines_.push_back(first_);
    for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 1)) lines_.push_back(at + 1);
  }

  [[nodiscard]] std::size_t byte(const toml::source_position& place) const {
    std::size_t at = lines_.at(std::min<std::size_t>(place.line, lines_.size()) - 1);
    for (toml::source_index column = 1; column < place.column && at < text_.size(); ++column) {
      ++at;
      while (at < text_.size() && (static_cast<unsigned char>(text_[at]) & 0xC0U) == 0x80U) ++at;
    }
    return at;
  }

 private:
  const std::string& text_;
  std::size_t first_;
  std::vector<std::size_t> lines_;
};

class Outliner {
 public:
  explicit Outliner(const std::string& text) : text_(text), places_(text) {}

  std::vector<TomlNode> run() {
    const toml::table root = config::parse_document(text_, "text");
    add_entries(root, {});
    return std::move(nodes_);
  }

 private:
  void add_entries(const toml::table& table, const std::vector<std::string>& path) {
    for (const std::string& name : config::keys_of(table)) {
      const auto entry = table.find(name);
      TomlNode node;
      node.path = path;
      node.path.push_back(name);
      node.key_begin = places_.byte(entry->first.source().begin);
      node.key_end = places_.byte(entry->first.source().end);
      add(entry->second, std::move(node));
    }
  }

  void add(const toml::node& found, TomlNode node) {
    node.begin = places_.byte(found.source().begin);
    node.end = places_.byte(found.source().end);
    node.inline_table = found.is_table() && found.as_table()->is_inline();
    node.kind = found.is_string()  ? TomlNode::Kind::text
                : found.is_table() ? TomlNode::Kind::table
                : found.is_array() ? TomlNode::Kind::array
                                   : TomlNode::Kind::other;
    if (found.is_string()) node.value = found.as_string()->get();
    if (node.kind == TomlNode::Kind::other) node.value = text_.substr(node.begin, node.end - node.begin);
    const std::vector<std::string> path = node.path;
    nodes_.push_back(std::move(node));
    if (found.is_table()) add_entries(*found.as_table(), path);
    if (found.is_array()) add_elements(*found.as_array(), path);
  }

  void add_elements(const toml::array& array, const std::vector<std::string>& path) {
    std::size_t number = 0;
    for (const toml::node& element : array) {
      TomlNode node;
      node.path = path;
      node.path.push_back(std::to_string(number++));
      add(element, std::move(node));
    }
  }

  const std::string& text_;
  Places places_;
  std::vector<TomlNode> nodes_;
};

}  // namespace

std::vector<TomlNode> toml_outline(const std::string& text) { return Outliner(text).run(); }

std::string toml_string(std::string_view text) {
  const toml::value<std::string> value(valid_utf8(text));
  std::ostringstream out;
  out << toml::toml_formatter(value, toml::format_flags::allow_unicode_strings);
  return out.str();
}

bool is_toml_value(const std::string& text) {
  if (text.find('\n') != std::string::npos) return false;
  try {
    const std::string line = "x = " + text;
    return toml_outline(line).front().end == line.size();
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace misfit
