// read_mat5 of readers.h. The format: MathWorks, MAT-File Format (R2021a), chapter 1.

#include <algorithm>
#include <array>
#include <map>

#include "misfit/core/shown.h"
#include "misfit/data/log/arrays.h"
#include "misfit/data/log/inflate.h"
#include "misfit/data/log/readers.h"

namespace misfit {
namespace {

constexpr std::size_t bytes_of_head = 128;
constexpr std::uint64_t matrix = 14, compressed = 15;

enum class MatClass : std::uint8_t { cell = 1, structure = 2, object = 3, text = 4, sparse = 5, first_number = 6, last_number = 15 };

/// One data element: its type and where its bytes stand.
struct Element {
  std::uint64_t type = 0;
  std::size_t at = 0, size = 0;
  std::size_t next = 0;  ///< where the next one begins
};

/// An array of numbers, and where it stands in its variable.
struct Numbers {
  std::size_t variable = 0, at = 0;
  NumberType type;
};

class Mat5Reader : public LogReader {
 public:
  explicit Mat5Reader(const Bytes& bytes) : bytes_(bytes) {
    log_.source = bytes.source();
    log_.format = "MAT (MATLAB, version 5)";
    read_head();
    for (std::size_t at = bytes_of_head; at < bytes_.size();) {
      const Element variable = element(bytes_, at);
      if (variable.type != matrix && variable.type != compressed)
        bytes_.fail(at, "a matrix is expected, not an element of type " + std::to_string(variable.type));
      variables_.push_back(variable);
      std::vector<std::byte> storage;
      const Bytes content = content_of(variable, storage);
      add_matrix(content, {matrix, 0, content.size(), 0}, Place{"", "", 0});
      at = variable.next;
    }
    find_clocks(log_);
  }

 protected:
  void read_values(const std::vector<std::size_t>& channels) override {
    std::map<std::size_t, std::vector<std::size_t>> by_variable;
    for (const std::size_t c : channels) by_variable[numbers_[columns_[c].array].variable].push_back(c);
    for (const auto& [v, wanted] : by_variable) {
      std::vector<std::byte> storage;
      const Bytes content = content_of(variables_[v], storage);
      for (const std::size_t c : wanted) {
        const Numbers& numbers = numbers_[columns_[c].array];
        log_.channels[c].values =
            column_values(columns_[c], log_.channels[c].samples, content.data().data() + numbers.at, numbers.type.size, numbers.type);
      }
    }
  }

 private:
  struct Place {
    std::string name, group;  ///< of a matrix inside another; empty: its own name
    int depth = 0;
  };

  void read_head() {
    const std::string mark = bytes_.text(126, 2, "the mark of its byte order");
    if (mark != "IM" && mark != "MI") bytes_.fail(126, "the letters IM or MI are expected: this is no MAT file of version 5");
    big_endian_ = mark == "MI";
    const std::uint64_t version = bytes_.unsigned_at(124, 2, "its version", big_endian_);
    if (version != 0x0100) bytes_.fail(124, "version 5 (0x0100) is expected");
  }

  [[nodiscard]] std::uint64_t word(const Bytes& b, std::size_t at, const std::string& what) const {
    return b.unsigned_at(at, 4, what, big_endian_);
  }

  /// The tag at `at`: eight bytes, or four before up to four bytes of data.
  [[nodiscard]] Element element(const Bytes& b, std::size_t at) const {
    const std::uint64_t first = word(b, at, "the type of an element");
    if (first >> 16U != 0) {
      const std::size_t size = first >> 16U;
      constexpr std::size_t most = 4;
      if (size > most) b.fail(at, "a small element of at most 4 bytes is expected");
      static_cast<void>(b.part(at + 4, 4, "a small element"));
      return {first & 0xFFFFU, at + 4, size, at + 8};
    }
    const std::size_t size = word(b, at + 4, "the size of an element");
    static_cast<void>(b.part(at + 8, size, "an element"));
    const std::size_t padded = first == compressed ? size : (size + 7) / 8 * 8;
    return {first, at + 8, size, std::min(at + 8 + padded, b.size())};
  }

  /// The matrix itself, inflated if it is compressed.
  Bytes content_of(const Element& variable, std::vector<std::byte>& storage) const {
    const auto stored = bytes_.data().subspan(variable.at, variable.size);
    if (variable.type == matrix) return {bytes_.source() + ": variable at byte " + std::to_string(variable.at), stored};
    const Bytes stream(bytes_.source() + ": compressed variable at byte " + std::to_string(variable.at), stored);
    constexpr std::size_t tag = 8, most_ratio = 1032;  // of deflate
    storage = inflated(stream, Deflated::zlib, tag, false);
    const Bytes front(stream.source(), storage);
    const std::size_t size = word(front, 4, "the size of a matrix");
    if (word(front, 0, "a matrix") != matrix || size / most_ratio > stored.size())
      front.fail(0, "a matrix is expected, of no more than its " + std::to_string(stored.size()) + " bytes can hold");
    storage = inflated(stream, Deflated::zlib, tag + size);
    if (storage.size() != tag + size) stream.fail(stored.size(), std::to_string(tag + size) + " bytes are expected when inflated");
    return {stream.source(), std::span<const std::byte>(storage).subspan(tag)};
  }

  void leave_out(const std::string& name, const std::string& why) {
    if (!name.empty()) log_.notes.push_back("'" + shown(name) + "' is left out: " + why);
  }

  void add_matrix(const Bytes& b, const Element& whole, const Place& place) {
    constexpr int deepest = 20;
    if (place.depth > deepest) b.fail(whole.at, "structs in structs, less deep, are expected");
    if (whole.size == 0) return;  // an empty matrix
    const Element flags = element(b, whole.at);
    const std::uint64_t bits = word(b, flags.at, "the class of a matrix");
    const auto kind = static_cast<MatClass>(bits & 0xFFU);
    const std::uint64_t opaque = 17;
    if ((bits & 0xFFU) == opaque)
      return leave_out(place.name.empty() ? "an object" : place.name, "objects of MATLAB cannot be read: save a struct, or arrays");
    const Element sides = element(b, flags.next);
    const Element name = element(b, sides.next);
    const std::string own = b.text(name.at, name.size, "the name of a matrix");
    Inside in{b, shape(b, sides), Place{place.name.empty() ? own : place.name, place.group, place.depth}, name.next};
    if (kind == MatClass::cell) return add_cells(in);
    if (kind == MatClass::structure) return add_struct(in);
    if (kind == MatClass::text) return;
    if (kind < MatClass::first_number || kind > MatClass::last_number)
      return leave_out(in.place.name, "only full arrays of numbers are read");
    constexpr std::uint64_t complex = 0x0800;
    if ((bits & complex) != 0) return leave_out(in.place.name, "complex numbers");
    add_numbers(in);
  }

  /// What stands behind the name of a matrix.
  struct Inside {
    const Bytes& bytes;
    std::vector<std::size_t> shape;
    Place place;
    std::size_t at = 0;
  };

  [[nodiscard]] std::vector<std::size_t> shape(const Bytes& b, const Element& sides) const {
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i + 4 <= sides.size; i += 4) out.push_back(word(b, sides.at + i, "a dimension"));
    return out;
  }

  void add_numbers(const Inside& in) {
    const Element data = element(in.bytes, in.at);
    constexpr std::size_t kinds = 14;
    constexpr std::array<NumberType, kinds> types = {{{NumberKind::real, 0},
                                                      {NumberKind::signed_integer, 1},
                                                      {NumberKind::unsigned_integer, 1},
                                                      {NumberKind::signed_integer, 2},
                                                      {NumberKind::unsigned_integer, 2},
                                                      {NumberKind::signed_integer, 4},
                                                      {NumberKind::unsigned_integer, 4},
                                                      {NumberKind::real, 4},
                                                      {NumberKind::real, 0},
                                                      {NumberKind::real, 8},
                                                      {NumberKind::real, 0},
                                                      {NumberKind::real, 0},
                                                      {NumberKind::signed_integer, 8},
                                                      {NumberKind::unsigned_integer, 8}}};
    NumberType type = data.type < kinds ? types[data.type] : NumberType{NumberKind::real, 0};
    if (type.size == 0) in.bytes.fail(data.at, "a type of number is expected, not type " + std::to_string(data.type));
    type.big_endian = big_endian_;
    const auto count = count_of(in.shape, data.size / type.size);
    if (!count || *count * type.size != data.size)
      in.bytes.fail(data.at, "as many numbers as the dimensions of '" + shown(in.place.name) + "' say are expected");
    numbers_.push_back({variables_.size() - 1, data.at, type});
    add_array(log_, columns_, {in.place.name, in.place.group, "", in.shape, true}, numbers_.size() - 1);
  }

  /// Elements of a struct array are numbered if there are several: NAME(2).FIELD.
  void add_struct(const Inside& in) {
    const Element length = element(in.bytes, in.at);
    const std::size_t width = word(in.bytes, length.at, "the length of field names");
    const Element names = element(in.bytes, length.next);
    if (width == 0 || names.size % width != 0) in.bytes.fail(length.at, "a length of field names is expected");
    const std::size_t fields = names.size / width;
    const auto count = count_of(in.shape, in.bytes.size());
    if (!count) in.bytes.fail(in.at, "fewer structs are expected than there are bytes");
    std::size_t at = names.next;
    for (std::size_t i = 0; i < *count; ++i) {
      const std::string group = *count == 1 ? in.place.name : in.place.name + "(" + std::to_string(i + 1) + ")";
      for (std::size_t f = 0; f < fields; ++f) {
        const std::string field = in.bytes.text(names.at + f * width, width, "the name of a field");
        at = add_inner(in.bytes, at, {group + "." + field, group, in.place.depth + 1});
      }
    }
  }

  void add_cells(const Inside& in) {
    const auto count = count_of(in.shape, in.bytes.size());
    if (!count) in.bytes.fail(in.at, "fewer cells are expected than there are bytes");
    std::size_t at = in.at;
    for (std::size_t i = 0; i < *count; ++i) {
      const std::string name = in.place.name + "{" + std::to_string(i + 1) + "}";
      at = add_inner(in.bytes, at, {name, in.place.group, in.place.depth + 1});
    }
  }

  std::size_t add_inner(const Bytes& b, std::size_t at, const Place& place) {
    const Element inner = element(b, at);
    if (inner.type != matrix) b.fail(at, "a matrix is expected as '" + shown(place.name) + "'");
    add_matrix(b, inner, place);
    return inner.next;
  }

  Bytes bytes_;
  bool big_endian_ = false;
  std::vector<Element> variables_;
  std::vector<Numbers> numbers_;
  std::vector<ArrayColumn> columns_;
};

}  // namespace

std::unique_ptr<LogReader> read_mat5(const Bytes& bytes) { return std::make_unique<Mat5Reader>(bytes); }

}  // namespace misfit
