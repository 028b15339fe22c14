#pragma once

#include <string>
#include <vector>

#include "misfit/data/log/bytes.h"

namespace misfit {

/// A file within a ZIP archive.
struct ZipMember {
  std::string name;
  Bytes stored;  ///< as it stands in the archive
  bool deflated = false;
  std::size_t size = 0;   ///< when inflated [bytes]; no more than deflate can make of what is stored
  std::uint32_t crc = 0;  ///< CRC-32 of the inflated bytes
};

/// The members of an archive by its directory (PKWARE APPNOTE 6.3, with ZIP64). InputError: damage, encryption, other compression than
/// deflate.
[[nodiscard]] std::vector<ZipMember> zip_members(const Bytes& archive);

}  // namespace misfit
