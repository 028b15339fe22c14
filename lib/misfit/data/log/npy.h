#pragma once

#include <optional>
#include <string>
#include <vector>

#include "misfit/data/log/arrays.h"
#include "misfit/data/log/bytes.h"

namespace misfit {

/// A number within an item of a NumPy array: the item itself, or a field of it.
struct NpyField {
  std::string name;  ///< empty: the item itself
  NumberType type;
  std::size_t offset = 0;               ///< in the item [bytes]
  std::size_t count = 1;                ///< numbers, one after the other
  std::optional<std::string> not_read;  ///< why its values cannot be channels: "text"
  std::string unit;                     ///< of times ("ns")
};

/// What the head of an NPY file says (NumPy Enhancement Proposal 1, versions 1 to 3).
struct NpyHeader {
  std::vector<NpyField> fields;
  std::size_t item = 0;  ///< bytes of an item
  std::vector<std::size_t> shape;
  bool column_major = false;
  std::size_t begin = 0;  ///< byte of the first item
};

/// InputError: no such head, a type of object (pickled), fewer or more bytes behind it than the shape says (`size`: of the whole file,
/// of which `bytes` may be the beginning).
[[nodiscard]] NpyHeader read_npy_header(const Bytes& bytes, std::size_t size);

}  // namespace misfit
