#pragma once

// Reading numbers from bytes that may be damaged: for the readers of formats.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace misfit {

enum class NumberKind { signed_integer, unsigned_integer, real };

struct NumberType {
  NumberKind kind = NumberKind::real;
  std::size_t size = 8;  ///< bytes: 1, 2, 4 or 8; real: 2, 4 or 8
  bool big_endian = false;
};

/// The number at `at`, which has to have that many bytes. Integers above 2^53 are rounded.
[[nodiscard]] double decode_number(const std::byte* at, const NumberType& type);

/// A stretch of a file, which knows where it is. Whatever leaves it is an InputError "FILE: byte 120: … expected".
class Bytes {
 public:
  Bytes() = default;
  Bytes(std::string source, std::span<const std::byte> data) : source_(std::move(source)), data_(data) {}

  [[nodiscard]] std::size_t size() const { return data_.size(); }
  [[nodiscard]] const std::string& source() const { return source_; }
  [[nodiscard]] std::span<const std::byte> data() const { return data_; }
  [[nodiscard]] bool has(std::size_t at, std::size_t count) const { return at <= size() && count <= size() - at; }
  /// Begins with these bytes?
  [[nodiscard]] bool starts_with(std::string_view text) const;

  /// `count` bytes at `at`; `what` they are is said if they are not there.
  [[nodiscard]] std::span<const std::byte> part(std::size_t at, std::size_t count, const std::string& what) const;
  /// Text up to `count` bytes, ending at the first 0.
  [[nodiscard]] std::string text(std::size_t at, std::size_t count, const std::string& what) const;
  [[nodiscard]] std::uint64_t unsigned_at(std::size_t at, std::size_t width, const std::string& what, bool big_endian = false) const;
  [[nodiscard]] double number(std::size_t at, const NumberType& type, const std::string& what) const {
    return decode_number(part(at, type.size, what).data(), type);
  }

  [[noreturn]] void fail(std::size_t at, const std::string& what) const;

 private:
  std::string source_;
  std::span<const std::byte> data_;
};

}  // namespace misfit
