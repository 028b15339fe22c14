/// The files in tests/data/logs, each of which is read in full by one test and damaged by another.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace misfit {

inline auto logs_of_the_tests() {
  return testing::Values("plain.mat", "structs.mat", "big_endian.mat", "version73.mat", "plain.h5", "chunked.h5", "table.h5", "columns.npy",
                         "fortran.npy", "records.npy", "stored.npz", "deflated.npz", "one.npz", "simple.ulg", "instances.ulg",
                         "appended.ulg", "instances.bin", "letters.bin", "damaged.bin");
}

/// Names of tests hold letters, digits and lines only.
inline std::string name_of_log(const testing::TestParamInfo<std::string>& file) {
  std::string name = file.param;
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
}

}  // namespace misfit
