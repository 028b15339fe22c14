#include "misfit/data/log/bytes.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>

#include "misfit/core/error.h"
#include "misfit/core/shown.h"

namespace misfit {
namespace {

std::uint64_t bits_at(const std::byte* at, std::size_t width, bool big_endian) {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < width; ++i) bits |= std::to_integer<std::uint64_t>(at[big_endian ? width - 1 - i : i]) << (8 * i);
  return bits;
}

/// IEEE 754 binary16.
double half(std::uint64_t bits) {
  const double sign = (bits & 0x8000U) != 0 ? -1.0 : 1.0;
  const int exponent = static_cast<int>((bits >> 10U) & 0x1FU);
  const auto fraction = static_cast<double>(bits & 0x3FFU);
  constexpr int special = 31;
  if (exponent == special)
    return fraction == 0.0 ? sign * std::numeric_limits<double>::infinity() : std::numeric_limits<double>::quiet_NaN();
  return sign * (exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024.0 + fraction, exponent - 25));
}

double real(std::uint64_t bits, std::size_t size) {
  if (size == 2) return half(bits);
  if (size == 4) return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
  return std::bit_cast<double>(bits);
}

}  // namespace

double decode_number(const std::byte* at, const NumberType& type) {
  const std::uint64_t bits = bits_at(at, type.size, type.big_endian);
  if (type.kind == NumberKind::real) return real(bits, type.size);
  if (type.kind == NumberKind::unsigned_integer) return static_cast<double>(bits);
  const auto unused = static_cast<unsigned>(64 - 8 * type.size);
  return static_cast<double>(static_cast<std::int64_t>(bits << unused) >> unused);
}

bool Bytes::starts_with(std::string_view text) const {
  return has(0, text.size()) && std::memcmp(data_.data(), text.data(), text.size()) == 0;
}

std::span<const std::byte> Bytes::part(std::size_t at, std::size_t count, const std::string& what) const {
  if (!has(at, count))
    fail(at, what + " of " + std::to_string(count) + " bytes is expected, the file has " + std::to_string(size() - std::min(at, size())) +
                 " more");
  return data_.subspan(at, count);
}

std::string Bytes::text(std::size_t at, std::size_t count, const std::string& what) const {
  const auto bytes = part(at, count, what);
  const std::string_view whole(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return std::string(whole.substr(0, whole.find('\0')));
}

std::uint64_t Bytes::unsigned_at(std::size_t at, std::size_t width, const std::string& what, bool big_endian) const {
  return bits_at(part(at, width, what).data(), width, big_endian);
}

void Bytes::fail(std::size_t at, const std::string& what) const {
  throw InputError({source_, 0, 0}, "byte " + std::to_string(at) + ": " + what);
}

}  // namespace misfit
