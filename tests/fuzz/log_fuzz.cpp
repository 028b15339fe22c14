// Whatever bytes come in, the readers of logs answer with channels or with an InputError: no crash, no hang, no leak, no memory beyond what
// the bytes can hold. HDF5 is read by a program of its own and is not in here.
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <numeric>
#include <string>

#include "misfit/core/error.h"
#include "misfit/data/log/log.h"
#include "misfit/data/log/readers.h"

namespace {

using namespace misfit;

void read_all(LogReader& reader) {
  std::vector<std::size_t> all(reader.log().channels.size());
  std::iota(all.begin(), all.end(), 0U);
  reader.read(all);
  for (const LogChannel& c : reader.log().channels) {
    if (c.values.size() != c.samples || (c.clock && *c.clock >= all.size())) std::abort();
  }
}

/// As a file: recognised by its first bytes, CSV where they are none's.
void read_file_of(const std::string& content) {
  static const std::string file = "/dev/shm/misfit_log_fuzz_" + std::to_string(getpid());
  std::ofstream(file, std::ios::binary) << content;
  if (content.find("HDF") != std::string::npos || content.starts_with("MATLAB 7.3")) return;
  read_all(*open_log(file));
}

void read_bytes(std::uint8_t format, const Bytes& bytes) {
  switch (format) {
    case 'm':
      return read_all(*read_mat5(bytes));
    case 'n':
      return read_all(*read_npy(bytes, "x"));
    case 'z':
      return read_all(*read_npz(bytes));
    case 'u':
      return read_all(*read_ulog(bytes));
    default:
      return read_all(*read_dataflash(bytes));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::span<const std::byte> rest(reinterpret_cast<const std::byte*>(data) + 1, size - 1);
  try {
    if (data[0] == 'f') {
      read_file_of({reinterpret_cast<const char*>(rest.data()), rest.size()});
    } else {
      read_bytes(data[0], Bytes("fuzz", rest));
    }
  } catch (const InputError&) {  // refused in words
  }
  return 0;
}
