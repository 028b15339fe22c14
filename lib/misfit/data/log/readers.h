#pragma once

// The readers of formats, over bytes: for open_log() and for tests. Each throws InputError with a byte and what was expected there.

#include <memory>

#include "misfit/data/log/bytes.h"
#include "misfit/data/log/log.h"

namespace misfit {

/// An array of numbers, or of records whose fields are arrays; its channels are called like the file, or its fields.
[[nodiscard]] std::unique_ptr<LogReader> read_npy(const Bytes& bytes, const std::string& name);
/// Several NPY files in a ZIP archive, stored or deflated.
[[nodiscard]] std::unique_ptr<LogReader> read_npz(const Bytes& bytes);
/// MATLAB version 5 to 7 (save -v6, -v7): arrays of numbers, also in structs and cells; compressed or not.
[[nodiscard]] std::unique_ptr<LogReader> read_mat5(const Bytes& bytes);
/// ULog of PX4, versions 0 and 1.
[[nodiscard]] std::unique_ptr<LogReader> read_ulog(const Bytes& bytes);
/// DataFlash of ArduPilot, binary.
[[nodiscard]] std::unique_ptr<LogReader> read_dataflash(const Bytes& bytes);
/// HDF5 and MATLAB version 7.3, read by misfit_hdf5, a program of its own: what the library does with a damaged file is not ours to know.
[[nodiscard]] std::unique_ptr<LogReader> read_hdf5(const std::filesystem::path& path);

}  // namespace misfit
