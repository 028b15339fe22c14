// read_npy and read_npz of readers.h.

#include <algorithm>
#include <cmath>
#include <map>

#include "misfit/core/column_header.h"
#include "misfit/core/shown.h"
#include "misfit/data/log/arrays.h"
#include "misfit/data/log/inflate.h"
#include "misfit/data/log/npy.h"
#include "misfit/data/log/readers.h"
#include "misfit/data/log/zip.h"

namespace misfit {
namespace {

/// An NPY file, in memory or to be inflated.
struct Member {
  Bytes stored;
  bool deflated = false;
  std::size_t size = 0;
  NpyHeader header;
  std::optional<std::uint32_t> crc;
};

/// One field of one member: an array.
struct Part {
  std::size_t member = 0, field = 0;
};

/// "w[rad/s]" → "w" in rad/s.
void take_unit_from_name(ArrayInfo& info) {
  const auto open = info.name.rfind('[');
  if (open == std::string::npos || open == 0 || !info.name.ends_with(']')) return;
  const std::string inside = info.name.substr(open + 1, info.name.size() - open - 2);
  if (inside.find_first_not_of("0123456789") == std::string::npos || read_header("x[" + inside + "]").unit.empty()) return;
  info.unit = inside;
  info.name.resize(open);
}

class NumpyReader : public LogReader {
 public:
  explicit NumpyReader(std::string format, const std::string& source) {
    log_.format = std::move(format);
    log_.source = source;
  }

  void add(const std::string& name, const Member& member) {
    members_.push_back(member);
    const NpyHeader& h = members_.back().header;
    for (std::size_t f = 0; f < h.fields.size(); ++f) {
      const NpyField& field = h.fields[f];
      const std::string whole = field.name.empty() ? name : name.empty() ? field.name : name + "." + field.name;
      if (field.not_read) {
        log_.notes.push_back("'" + shown(whole) + "' is left out: " + *field.not_read);
        continue;
      }
      ArrayInfo info{whole, field.name.empty() ? "" : name, field.unit, h.shape, h.column_major};
      take_unit_from_name(info);
      if (field.count > 1) info.shape.push_back(field.count);
      if (field.count > 1) info.column_major = false;  // the numbers of a record stand together
      parts_.push_back({members_.size() - 1, f});
      add_array(log_, columns_, info, parts_.size() - 1);
    }
  }

  void finish() { find_clocks(log_); }

 protected:
  void read_values(const std::vector<std::size_t>& channels) override {
    std::map<std::size_t, std::vector<std::size_t>> by_member;
    for (const std::size_t c : channels) by_member[parts_[columns_[c].array].member].push_back(c);
    for (const auto& [m, wanted] : by_member) {
      const Member& member = members_[m];
      std::vector<std::byte> storage;
      if (member.deflated) storage = inflated(member.stored, Deflated::raw, member.size);
      if (member.deflated && storage.size() != member.size)
        member.stored.fail(member.stored.size(),
                           std::to_string(member.size) + " bytes are expected when inflated, not " + std::to_string(storage.size()));
      const auto all = member.deflated ? std::span<const std::byte>(storage) : member.stored.data();
      if (member.crc && *member.crc != crc32_of(all)) member.stored.fail(0, "its check sum (CRC-32) is another: the file is damaged");
      for (const std::size_t c : wanted) log_.channels[c].values = values(member, all, c);
    }
  }

 private:
  [[nodiscard]] std::vector<double> values(const Member& member, std::span<const std::byte> all, std::size_t channel) const {
    const ArrayColumn& column = columns_[channel];
    const NpyField& field = member.header.fields[parts_[column.array].field];
    const std::size_t samples = log_.channels[channel].samples;
    const std::byte* begin = all.data() + member.header.begin + field.offset;
    if (field.count == 1) {
      std::vector<double> out = column_values(column, samples, begin, member.header.item, field.type);
      constexpr double not_a_time = -9223372036854775808.0;
      if (!field.unit.empty()) std::replace(out.begin(), out.end(), not_a_time, std::nan(""));
      return out;
    }
    std::vector<double> out;  // numbers of a record stand together, records an item apart
    for (std::size_t i = 0; i < samples; ++i) {
      const std::size_t n = column.first + i * column.stride;
      out.push_back(decode_number(begin + n / field.count * member.header.item + n % field.count * field.type.size, field.type));
    }
    return out;
  }

  std::vector<Member> members_;
  std::vector<Part> parts_;
  std::vector<ArrayColumn> columns_;
};

/// The head of a deflated NPY file, from what its first 64 KiB say.
NpyHeader header_of(const ZipMember& member) {
  if (!member.deflated) return read_npy_header(member.stored, member.size);
  constexpr std::size_t enough = 65536 + 10;
  const std::vector<std::byte> front = inflated(member.stored, Deflated::raw, std::min(enough, member.size), false);
  return read_npy_header(Bytes(member.stored.source(), front), member.size);
}

}  // namespace

std::unique_ptr<LogReader> read_npy(const Bytes& bytes, const std::string& name) {
  auto out = std::make_unique<NumpyReader>("NPY (NumPy)", bytes.source());
  const NpyHeader header = read_npy_header(bytes, bytes.size());
  const bool record = !header.fields.empty() && !header.fields.front().name.empty();
  out->add(record ? "" : name, {.stored = bytes, .size = bytes.size(), .header = header, .crc = std::nullopt});
  out->finish();
  return out;
}

std::unique_ptr<LogReader> read_npz(const Bytes& bytes) {
  auto out = std::make_unique<NumpyReader>("NPZ (NumPy)", bytes.source());
  for (const ZipMember& member : zip_members(bytes)) {
    std::string name = member.name;
    if (!name.ends_with(".npy")) continue;
    name.resize(name.size() - 4);
    out->add(name,
             {.stored = member.stored, .deflated = member.deflated, .size = member.size, .header = header_of(member), .crc = member.crc});
  }
  out->finish();
  return out;
}

}  // namespace misfit
