#include "misfit/page/packed.h"

#include <zlib.h>

#include "misfit/core/base64.h"
#include "misfit/core/error.h"

namespace misfit::page {

std::string packed(const std::string& text) {
  uLongf size = compressBound(text.size());
  std::string bytes(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(bytes.data()), &size, reinterpret_cast<const Bytef*>(text.data()), text.size(),
                Z_BEST_COMPRESSION) != Z_OK)
    throw RunError("the results cannot be packed into the report: zlib has not enough memory");
  bytes.resize(size);
  return base64(bytes);
}

}  // namespace misfit::page
