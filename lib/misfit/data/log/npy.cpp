#include "misfit/data/log/npy.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <string_view>

#include "misfit/core/shown.h"

namespace misfit {
namespace {

/// A literal of Python as NPY's heads have them: text, whole numbers, True and False, tuples, lists and one dict.
struct Literal {
  enum class Kind { text, number, list, dict } kind = Kind::number;
  std::string text;
  std::size_t number = 0;
  std::vector<Literal> items;  ///< of a dict: key, value, key, value

  [[nodiscard]] const Literal* at(std::string_view key) const {
    for (std::size_t i = 0; kind == Kind::dict && i + 1 < items.size(); i += 2) {
      if (items[i].text == key) return &items[i + 1];
    }
    return nullptr;
  }
};

class LiteralReader {
 public:
  LiteralReader(const Bytes& bytes, std::size_t begin, std::string_view text) : bytes_(bytes), begin_(begin), text_(text) {}

  Literal read() {
    Literal out = value(0);
    skip();
    if (at_ < text_.size()) fail("the end of the head");
    return out;
  }

 private:
  [[noreturn]] void fail(const std::string& expected) const {
    bytes_.fail(begin_ + at_, expected + " is expected in the head of an NPY file");
  }

  void skip() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\n' || text_[at_] == ',')) ++at_;
  }
  char next() {
    skip();
    if (at_ >= text_.size()) fail("more");
    return text_[at_];
  }

  Literal value(int depth) {
    constexpr int deepest = 8;
    if (depth > deepest) fail("something less deep");
    const char c = next();
    if (c == '\'' || c == '"') return quoted(c);
    if (c == '(') return many(Literal::Kind::list, ')', depth);
    if (c == '[') return many(Literal::Kind::list, ']', depth);
    if (c == '{') return many(Literal::Kind::dict, '}', depth);
    return word();
  }

  Literal quoted(char mark) {
    const auto end = text_.find(mark, at_ + 1);
    if (end == std::string_view::npos) fail("a quotation mark");
    Literal out{Literal::Kind::text, std::string(text_.substr(at_ + 1, end - at_ - 1)), 0, {}};
    at_ = end + 1;
    return out;
  }

  Literal many(Literal::Kind kind, char end, int depth) {
    Literal out{kind, "", 0, {}};
    for (++at_; next() != end;) {
      out.items.push_back(value(depth + 1));
      skip();
      if (kind == Literal::Kind::dict && at_ < text_.size() && text_[at_] == ':') ++at_;
    }
    ++at_;
    return out;
  }

  Literal word() {
    for (const auto& [name, number] : {std::pair<std::string_view, std::size_t>{"True", 1}, {"False", 0}}) {
      if (!text_.substr(at_).starts_with(name)) continue;
      at_ += name.size();
      return {Literal::Kind::number, "", number, {}};
    }
    Literal out;
    const char* last = text_.data() + text_.size();
    const auto [end, error] = std::from_chars(text_.data() + at_, last, out.number);
    if (error != std::errc()) fail("a value");
    at_ = static_cast<std::size_t>(end - text_.data());
    if (at_ < text_.size() && text_[at_] == 'L') ++at_;  // Python 2
    return out;
  }

  const Bytes& bytes_;
  std::size_t begin_;
  std::string_view text_;
  std::size_t at_ = 0;
};

std::vector<std::size_t> shape_of(const Literal& list) {
  std::vector<std::size_t> out;
  for (const Literal& n : list.items) out.push_back(n.number);
  return out;
}

class HeaderReader {
 public:
  explicit HeaderReader(const Bytes& bytes) : bytes_(bytes) {}

  NpyHeader read() {
    if (!bytes_.starts_with("\x93NUMPY")) bytes_.fail(0, "an NPY file is expected (\\x93NUMPY)");
    const std::uint64_t version = bytes_.unsigned_at(6, 1, "its version");
    if (version < 1 || version > 3) bytes_.fail(6, "version 1, 2 or 3 of NPY is expected, not " + std::to_string(version));
    const std::size_t width = version == 1 ? 2 : 4, at = 8 + width;
    const std::size_t length = bytes_.unsigned_at(8, width, "the length of its head");
    const auto text = bytes_.part(at, length, "a head");
    const Literal head = LiteralReader(bytes_, at, {reinterpret_cast<const char*>(text.data()), text.size()}).read();
    const Literal *descr = head.at("descr"), *order = head.at("fortran_order"), *shape = head.at("shape");
    if (descr == nullptr || order == nullptr || shape == nullptr) bytes_.fail(at, "descr, fortran_order and shape are expected");
    add_fields(*descr, "", 1);
    out_.shape = shape_of(*shape);
    out_.column_major = order->number != 0;
    out_.begin = at + length;
    return std::move(out_);
  }

 private:
  void add_fields(const Literal& descr, const std::string& name, std::size_t count) {
    if (descr.kind == Literal::Kind::text) return add_field(descr.text, name, count);
    if (descr.kind != Literal::Kind::list || count != 1) bytes_.fail(10, "a type of number is expected in descr");
    for (const Literal& field : descr.items) {
      if (field.items.size() < 2) bytes_.fail(10, "fields of a name and a type are expected in descr");
      const Literal& title = field.items[0];
      const std::string& own = title.kind == Literal::Kind::list && title.items.size() == 2 ? title.items[1].text : title.text;
      constexpr std::size_t most = 1'000'000;
      const auto numbers = field.items.size() > 2 ? count_of(shape_of(field.items[2]), most) : std::size_t{1};
      if (!numbers) bytes_.fail(10, "field '" + shown(own) + "' has more than a million numbers");
      add_fields(field.items[1], name.empty() ? own : name + "." + own, *numbers);
    }
  }

  /// "<f8", "|b1", ">i4", "<M8[ns]", "<U10".
  void add_field(const std::string& descr, const std::string& name, std::size_t count) {
    const bool marked = !descr.empty() && std::string_view("<>|=").find(descr[0]) != std::string_view::npos;
    const std::string_view type = std::string_view(descr).substr(marked ? 1 : 0);
    std::size_t size = 0;
    if (type.size() >= 2) std::from_chars(type.data() + 1, type.data() + type.size(), size);
    constexpr std::size_t longest = 1'000'000;
    if (type.empty() || type[0] == 'O')
      bytes_.fail(10,
                  "numbers are expected, this array holds objects of Python: save numbers, or read it with Python and save them as CSV");
    if (size > longest) bytes_.fail(10, "type '" + shown(descr) + "' is not known");
    if (type[0] == 'U') size *= 4;
    NpyField field{name, {}, out_.item, count, std::nullopt, ""};
    field.type = {kind_of(type[0]), size, marked && descr[0] == '>'};
    if (type[0] == 'M' || type[0] == 'm') field.unit = time_unit(type);
    if (std::string_view("SUVac").find(type[0]) != std::string_view::npos) {
      field.not_read = type[0] == 'c' ? "complex numbers" : "text";
    } else if (!known(type[0], size)) {
      bytes_.fail(10, "numbers of 1, 2, 4 or 8 bytes are expected, not type '" + shown(descr) + "'");
    }
    out_.item += size * count;
    if (type[0] != 'V') out_.fields.push_back(std::move(field));
  }

  static NumberKind kind_of(char c) {
    if (c == 'f') return NumberKind::real;
    return c == 'u' || c == 'b' ? NumberKind::unsigned_integer : NumberKind::signed_integer;
  }

  static bool known(char c, std::size_t size) {
    const bool power = size == 1 || size == 2 || size == 4 || size == 8;
    return power && std::string_view("iufbmM").find(c) != std::string_view::npos && (c != 'f' || size > 1);
  }

  static std::string time_unit(std::string_view type) {
    const auto open = type.find('['), close = type.find(']');
    if (open == std::string_view::npos || close == std::string_view::npos || close < open) return "";
    const std::string unit(type.substr(open + 1, close - open - 1));
    return unit == "m" ? "min" : unit;
  }

  const Bytes& bytes_;
  NpyHeader out_;
};

}  // namespace

NpyHeader read_npy_header(const Bytes& bytes, std::size_t size) {
  NpyHeader out = HeaderReader(bytes).read();
  const std::size_t rest = size - std::min(size, out.begin);
  const auto items = count_of(out.shape, rest / std::max<std::size_t>(out.item, 1));
  const bool empty = out.item == 0 || items == std::optional<std::size_t>(0);
  if (!items || (!empty && *items * out.item != rest)) {
    bytes.fail(out.begin, (items ? std::to_string(*items * out.item) : std::string("more")) +
                              " bytes of numbers are expected, as the shape says; the file has " + std::to_string(rest));
  }
  return out;
}

}  // namespace misfit
