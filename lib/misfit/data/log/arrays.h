#pragma once

// Files of arrays (NPY, NPZ, MAT, HDF5): which of their numbers make up a channel, and which of the channels is the time of others.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "misfit/data/log/bytes.h"
#include "misfit/data/log/log.h"

namespace misfit {

/// An array as its file describes it.
struct ArrayInfo {
  std::string name;   ///< whole
  std::string group;  ///< what stands before its last part
  std::string unit;   ///< empty: none given
  std::vector<std::size_t> shape;
  bool column_major = false;  ///< the first index runs fastest (Fortran, MATLAB)
};

/// Which of an array's numbers, in the order of the file, are a channel's: first, first + stride, …
struct ArrayColumn {
  std::size_t array = 0;
  std::size_t first = 0, stride = 1;
};

/// Product of the shape; nullopt where it is beyond `most`.
[[nodiscard]] std::optional<std::size_t> count_of(const std::vector<std::size_t>& shape, std::size_t most);

/// Adds the array's channels to the log, and what of the array each of them is to `columns`. A matrix has a channel per column, NAME[0],
/// NAME[1] and so on; per row, if it has more columns than rows: time runs along the longer side. Single numbers, arrays of more than two
/// dimensions and those of more than 1000 channels are left out; the latter two are said in the notes.
void add_array(Log& log, std::vector<ArrayColumn>& columns, const ArrayInfo& array, std::size_t index);

/// Takes the column's values out of the numbers at `data`, `step` bytes apart.
[[nodiscard]] std::vector<double> column_values(const ArrayColumn& column, std::size_t samples, const std::byte* data, std::size_t step,
                                                const NumberType& type);

/// Gives channels without a clock the time of their length that stands nearest: in their group, or in one around it. A time is called t,
/// time, timestamp or the like ("time_us", "t[ms]").
void find_clocks(Log& log);

/// Is a channel's last part the name of a time?
[[nodiscard]] bool is_time_name(const std::string& channel);

}  // namespace misfit
