#pragma once

#include <cstddef>
#include <vector>

#include "misfit/data/log/bytes.h"

namespace misfit {

enum class Deflated { raw, zlib };  ///< without or with zlib's frame

/// Inflates to `size` bytes, or to less where the stream ends before. Memory is taken as the stream is read, so a size that is not true
/// costs nothing. InputError: no such stream, or more than `size` in it (`more_is_damage`).
[[nodiscard]] std::vector<std::byte> inflated(const Bytes& stream, Deflated form, std::size_t size, bool more_is_damage = true);

/// CRC-32 of ZIP.
[[nodiscard]] std::uint32_t crc32_of(std::span<const std::byte> data);

}  // namespace misfit
