#include "misfit/data/log/zip.h"

#include <algorithm>

#include "misfit/core/shown.h"

namespace misfit {
namespace {

constexpr std::size_t end_size = 22, entry_size = 46, local_size = 30;
constexpr std::uint64_t in_zip64 = 0xFFFFFFFFU;

struct Directory {
  std::size_t entries = 0, begin = 0;
};

/// The end of the directory stands at the end of the file, before a comment of at most 65535 bytes.
Directory find_directory(const Bytes& zip) {
  constexpr std::size_t longest_comment = 65535;
  const std::size_t lowest = zip.size() - std::min(zip.size(), end_size + longest_comment);
  for (std::size_t at = zip.size() - std::min(zip.size(), end_size);; --at) {
    if (zip.has(at, end_size) && zip.unsigned_at(at, 4, "") == 0x06054b50U) {
      Directory out{zip.unsigned_at(at + 10, 2, "entries"), zip.unsigned_at(at + 16, 4, "directory")};
      constexpr std::size_t locator = 20;
      const bool zip64 = at >= locator && zip.unsigned_at(at - locator, 4, "") == 0x07064b50U;
      if (!zip64 || (out.begin != in_zip64 && out.entries != 0xFFFFU)) return out;
      const std::size_t end64 = zip.unsigned_at(at - locator + 8, 8, "ZIP64 directory");
      return {zip.unsigned_at(end64 + 32, 8, "entries"), zip.unsigned_at(end64 + 48, 8, "directory")};
    }
    if (at <= lowest) zip.fail(zip.size(), "the directory of a ZIP archive is expected at the end: the file is cut off or damaged");
  }
}

/// Sizes of 64 bits stand in an extra field, in this order, where those of 32 are full.
void read_extra(const Bytes& zip, std::size_t at, std::size_t end, const std::vector<std::uint64_t*>& full) {
  while (at + 4 <= end) {
    const std::uint64_t tag = zip.unsigned_at(at, 2, "extra field"), length = zip.unsigned_at(at + 2, 2, "extra field");
    at += 4;
    if (tag == 1) {
      std::size_t from = at;
      for (std::uint64_t* value : full) {
        if (*value != in_zip64) continue;
        *value = zip.unsigned_at(from, 8, "size of 64 bits");
        from += 8;
      }
      return;
    }
    at += length;
  }
}

ZipMember read_member(const Bytes& zip, std::size_t at, std::size_t& next) {
  if (zip.unsigned_at(at, 4, "an entry of the directory") != 0x02014b50U) zip.fail(at, "an entry of the ZIP directory is expected");
  const std::uint64_t flags = zip.unsigned_at(at + 8, 2, "flags"), method = zip.unsigned_at(at + 10, 2, "method");
  std::uint64_t stored = zip.unsigned_at(at + 20, 4, "size"), size = zip.unsigned_at(at + 24, 4, "size");
  const std::size_t name = zip.unsigned_at(at + 28, 2, "name"), extra = zip.unsigned_at(at + 30, 2, "extra");
  std::uint64_t local = zip.unsigned_at(at + 42, 4, "place");
  next = at + entry_size + name + extra + zip.unsigned_at(at + 32, 2, "comment");
  ZipMember out;
  out.name = zip.text(at + entry_size, name, "the name of a member");
  const std::string quoted = "member '" + shown(out.name) + "'";
  read_extra(zip, at + entry_size + name, at + entry_size + name + extra, {&size, &stored, &local});
  if ((flags & 1U) != 0) zip.fail(at, quoted + " is encrypted: save it without a password");
  if (method != 0 && method != 8) zip.fail(at, quoted + " is compressed by method " + std::to_string(method) + ", deflate is expected");
  if (zip.unsigned_at(local, 4, quoted) != 0x04034b50U) zip.fail(local, "the head of " + quoted + " is expected");
  const std::size_t begin = local + local_size + zip.unsigned_at(local + 26, 2, "name") + zip.unsigned_at(local + 28, 2, "extra");
  out.crc = static_cast<std::uint32_t>(zip.unsigned_at(at + 16, 4, "check sum"));
  out.deflated = method == 8;
  out.stored = Bytes(zip.source() + ": " + quoted, zip.part(begin, stored, "the content of " + quoted));
  out.size = size;
  constexpr std::size_t most_ratio = 1032;  // of deflate
  if (out.deflated ? size / most_ratio > stored + 1 : size != stored)
    zip.fail(at, quoted + " cannot have " + std::to_string(size) + " bytes, " + std::to_string(stored) + " are stored");
  return out;
}

}  // namespace

std::vector<ZipMember> zip_members(const Bytes& archive) {
  const Directory directory = find_directory(archive);
  if (directory.entries > archive.size() / entry_size) archive.fail(archive.size(), "a directory of fewer entries is expected");
  std::vector<ZipMember> out;
  std::size_t at = directory.begin;
  for (std::size_t i = 0; i < directory.entries; ++i) out.push_back(read_member(archive, at, at));
  return out;
}

}  // namespace misfit
