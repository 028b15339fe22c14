#include "misfit/data/log/inflate.h"

#include <zlib.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "misfit/core/error.h"

namespace misfit {
namespace {

constexpr std::size_t block = std::size_t{1} << 20U;

struct End {
  void operator()(z_stream* stream) const {
    ::inflateEnd(stream);
    delete stream;  // NOLINT(cppcoreguidelines-owning-memory): of the unique_ptr
  }
};

std::unique_ptr<z_stream, End> begin(Deflated form) {
  std::unique_ptr<z_stream, End> stream(new z_stream{});
  if (::inflateInit2(stream.get(), form == Deflated::raw ? -MAX_WBITS : MAX_WBITS) != Z_OK) throw RunError("zlib cannot be started");
  return stream;
}

}  // namespace

std::vector<std::byte> inflated(const Bytes& stream, Deflated form, std::size_t size, bool more_is_damage) {
  const auto z = begin(form);
  std::vector<std::byte> out;
  std::size_t taken = 0;
  int state = Z_OK;
  while (state == Z_OK && out.size() < size) {
    const std::size_t before = out.size();
    out.resize(before + std::min(block, size - before));
    if (z->avail_in == 0) {
      const std::size_t next = std::min(block, stream.size() - taken);
      z->next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(stream.data().data() + taken));  // NOLINT: zlib's z_const
      z->avail_in = static_cast<uInt>(next);
      taken += next;
    }
    z->next_out = reinterpret_cast<Bytef*>(out.data() + before);
    z->avail_out = static_cast<uInt>(out.size() - before);
    state = ::inflate(z.get(), Z_NO_FLUSH);
    out.resize(out.size() - z->avail_out);
    if (state == Z_BUF_ERROR && taken < stream.size()) state = Z_OK;
  }
  if (state != Z_OK && state != Z_STREAM_END)
    stream.fail(taken - z->avail_in, "a deflated stream is expected, this one is damaged or cut off");
  if (more_is_damage && out.size() == size && state == Z_OK) {
    std::byte more{};
    z->next_out = reinterpret_cast<Bytef*>(&more);
    z->avail_out = 1;
    if (::inflate(z.get(), Z_NO_FLUSH) == Z_OK && z->avail_out == 0) stream.fail(0, "a stream of more bytes than it should have");
  }
  return out;
}

std::uint32_t crc32_of(std::span<const std::byte> data) {
  uLong crc = ::crc32(0, nullptr, 0);
  for (std::size_t at = 0; at < data.size(); at += block) {
    const auto piece = data.subspan(at, std::min(block, data.size() - at));
    crc = ::crc32(crc, reinterpret_cast<const Bytef*>(piece.data()), static_cast<uInt>(piece.size()));
  }
  return static_cast<std::uint32_t>(crc);
}

}  // namespace misfit
