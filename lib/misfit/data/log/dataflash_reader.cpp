// read_dataflash of readers.h. The format: ArduPilot, libraries/AP_Logger/README.md and LogStructure.h.

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "misfit/core/shown.h"
#include "misfit/data/log/readers.h"
#include "misfit/data/log/record_reader.h"

namespace misfit {
namespace {

constexpr std::size_t head_size = 3, format_size = 89;
constexpr std::uint64_t format_type = 128;

/// A letter of a format: bytes, and the number they are; text and arrays are no numbers.
struct Letter {
  char letter;
  std::size_t size;
  bool number;
  NumberKind kind;
  double divisor;
};
constexpr std::array<Letter, 21> letters = {{{'a', 64, false, NumberKind::signed_integer, 1.0},
                                             {'b', 1, true, NumberKind::signed_integer, 1.0},
                                             {'B', 1, true, NumberKind::unsigned_integer, 1.0},
                                             {'h', 2, true, NumberKind::signed_integer, 1.0},
                                             {'H', 2, true, NumberKind::unsigned_integer, 1.0},
                                             {'i', 4, true, NumberKind::signed_integer, 1.0},
                                             {'I', 4, true, NumberKind::unsigned_integer, 1.0},
                                             {'q', 8, true, NumberKind::signed_integer, 1.0},
                                             {'Q', 8, true, NumberKind::unsigned_integer, 1.0},
                                             {'g', 2, true, NumberKind::real, 1.0},
                                             {'f', 4, true, NumberKind::real, 1.0},
                                             {'d', 8, true, NumberKind::real, 1.0},
                                             {'n', 4, false, NumberKind::real, 1.0},
                                             {'N', 16, false, NumberKind::real, 1.0},
                                             {'Z', 64, false, NumberKind::real, 1.0},
                                             {'c', 2, true, NumberKind::signed_integer, 1e2},
                                             {'C', 2, true, NumberKind::unsigned_integer, 1e2},
                                             {'e', 4, true, NumberKind::signed_integer, 1e2},
                                             {'E', 4, true, NumberKind::unsigned_integer, 1e2},
                                             {'L', 4, true, NumberKind::signed_integer, 1e7},
                                             {'M', 1, true, NumberKind::unsigned_integer, 1.0}}};

/// What a FMT message says of a type of message.
struct MessageFormat {
  std::string name;
  std::size_t size = 0;  ///< with its head
  std::vector<Letter> letters;
  std::vector<std::string> columns;
  std::string units, multipliers;  ///< an identifier per column

  [[nodiscard]] std::size_t offset(std::size_t column) const {
    std::size_t out = 0;
    for (std::size_t i = 0; i < column; ++i) out += letters[i].size;
    return out;
  }
  /// The column that numbers instances of a sensor; columns.size(): none.
  [[nodiscard]] std::size_t instance() const {
    const std::size_t column = units.find('#');
    return column < columns.size() && letters[column].number ? column : columns.size();
  }
};

class DataFlashReader : public RecordReader {
 public:
  explicit DataFlashReader(const Bytes& bytes) : RecordReader(bytes) {
    log_.format = "DataFlash (ArduPilot)";
    if (!bytes_.starts_with("\xA3\x95\x80")) bytes_.fail(0, "a FMT message is expected (A3 95 80): this is no DataFlash log");
    formats_[format_type] = {"FMT", format_size, {}, {}, "", ""};
    each_message([&](std::uint64_t type, std::span<const std::byte> record) { define(type, Bytes(bytes_.source(), record)); });
    note_damage();
    find_topics();
    list_channels();
  }

 protected:
  void each_record(const Take& take) override {
    each_message([&](std::uint64_t type, std::span<const std::byte> record) {
      const auto topic = topic_of_.find({type, instance(formats_[type], record)});
      if (topic != topic_of_.end()) take(topic->second, record);
    });
  }

 private:
  /// Of every message whose type is known its content. What is no message is passed over.
  template <class Take>
  void each_message(Take&& take) {
    skipped_ = 0;
    for (std::size_t at = 0; at < bytes_.size();) {
      const auto format = format_at(at);
      if (format == formats_.end() || !bytes_.has(at, format->second.size) || is_cut_off(at, format->second.size)) {
        if (skipped_++ == 0) first_skipped_ = at;
        ++at;
        continue;
      }
      const std::uint64_t type = format->first;
      const std::size_t size = format->second.size;  // a FMT may change it
      take(type, bytes_.data().subspan(at + head_size, size - head_size));
      at += size;
    }
  }

  /// Of the message that begins at `at`; end() if none does.
  [[nodiscard]] std::map<std::uint64_t, MessageFormat>::const_iterator format_at(std::size_t at) const {
    const bool marked = bytes_.has(at, head_size) && bytes_.data()[at] == std::byte{0xA3} && bytes_.data()[at + 1] == std::byte{0x95};
    return marked ? formats_.find(bytes_.unsigned_at(at + 2, 1, "")) : formats_.end();
  }

  /// No message follows, and one begins inside: the rest of this one was lost.
  [[nodiscard]] bool is_cut_off(std::size_t at, std::size_t size) const {
    if (at + size == bytes_.size() || format_at(at + size) != formats_.end()) return false;
    for (std::size_t i = at + 1; i < at + size; ++i) {
      if (format_at(i) != formats_.end()) return true;
    }
    return false;
  }

  void note_damage() {
    constexpr std::size_t most_share = 10;  // a log whose tenth is lost is another file
    if (skipped_ > bytes_.size() / most_share + format_size)
      bytes_.fail(first_skipped_, "a message (A3 95, a known type) is expected; " + std::to_string(skipped_) + " bytes are none");
    if (skipped_ > 0)
      log_.notes.push_back("byte " + std::to_string(first_skipped_) + ": no message is there, " + std::to_string(skipped_) +
                           " bytes of the log are left out");
  }

  void define(std::uint64_t type, const Bytes& record) {
    const std::string& name = formats_[type].name;
    if (type == format_type) return read_format(record);
    if (name == "FMTU" && record.size() >= 41) {
      units_of_[record.unsigned_at(8, 1, "")] = {record.text(9, 16, ""), record.text(25, 16, "")};
    } else if (name == "UNIT" && record.size() >= 73) {
      unit_[static_cast<char>(record.unsigned_at(8, 1, ""))] = record.text(9, 64, "");
    } else if (name == "MULT" && record.size() >= 17) {
      multiplier_[static_cast<char>(record.unsigned_at(8, 1, ""))] = record.number(9, {NumberKind::real, 8}, "");
    }
  }

  void read_format(const Bytes& record) {
    const std::uint64_t type = record.unsigned_at(0, 1, "");
    MessageFormat format{record.text(2, 4, ""), record.unsigned_at(1, 1, ""), {}, {}, "", ""};
    std::size_t size = head_size;
    for (const char c : record.text(6, 16, "")) {
      const auto letter = std::find_if(letters.begin(), letters.end(), [&](const Letter& l) { return l.letter == c; });
      if (letter == letters.end()) break;
      size += letter->size;
      format.letters.push_back(*letter);
    }
    const std::string columns = record.text(22, 64, "");
    for (std::size_t at = 0; at < columns.size() && format.columns.size() < format.letters.size();) {
      const std::size_t end = std::min(columns.find(',', at), columns.size());
      format.columns.push_back(columns.substr(at, end - at));
      at = end + 1;
    }
    if (type == format_type || format.size < head_size) return;
    if (size != format.size) {
      format.columns.clear();
      odd_.insert(format.name);
    }
    formats_[type] = std::move(format);
  }

  std::uint64_t instance(const MessageFormat& format, std::span<const std::byte> record) const {
    const std::size_t column = format.instance();
    if (column == format.columns.size()) return 0;
    const Letter& letter = format.letters[column];
    const std::size_t at = format.offset(column);
    constexpr std::size_t most = 2;
    if (letter.size > most || at + letter.size > record.size()) return 0;
    return Bytes("", record).unsigned_at(at, letter.size, "");
  }

  /// A topic for every type of message, and for every instance of it, that occurs.
  void find_topics() {
    for (auto& [type, format] : formats_) {
      const auto units = units_of_.find(type);
      if (units == units_of_.end()) continue;
      format.units = units->second.first;
      format.multipliers = units->second.second;
    }
    std::set<Key> found;
    constexpr std::size_t most = 2000;
    each_message([&](std::uint64_t type, std::span<const std::byte> record) {
      if (found.size() < most) found.insert({type, instance(formats_[type], record)});
    });
    for (const Key& key : found) {
      const MessageFormat& format = formats_[key.first];
      if (format.columns.empty() || is_of_format(format.name)) continue;
      topic_of_[key] = topics_.size();
      topics_.push_back(topic(format, key.second));
    }
    for (const std::string& name : odd_)
      log_.notes.push_back("messages '" + shown(name) + "' are left out: their format is not of their length");
  }

  static bool is_of_format(const std::string& name) {
    return name == "FMT" || name == "FMTU" || name == "UNIT" || name == "MULT" || name == "PARM";
  }

  [[nodiscard]] RecordTopic topic(const MessageFormat& format, std::uint64_t number) const {
    const bool several = format.instance() < format.columns.size();
    RecordTopic out{several ? format.name + "[" + std::to_string(number) + "]" : format.name, {}, 0, 0, 0};
    for (std::size_t i = 0; i < format.columns.size(); ++i) {
      if (!format.letters[i].number) continue;
      const Letter& letter = format.letters[i];
      out.fields.push_back({format.columns[i], unit(format, i), format.offset(i), {letter.kind, letter.size, false}, letter.divisor});
    }
    const auto time =
        std::find_if(out.fields.begin(), out.fields.end(), [](const RecordField& f) { return f.name == "TimeUS" || f.name == "TimeMS"; });
    out.clock = static_cast<std::size_t>(time - out.fields.begin());
    if (time != out.fields.end()) time->unit = time->name == "TimeUS" ? "us" : "ms";
    return out;
  }

  /// "m" with a multiplier of 0.01 is "cm"; letters with a multiplier of their own are in the unit itself.
  [[nodiscard]] std::string unit(const MessageFormat& format, std::size_t column) const {
    if (column >= format.units.size()) return "";
    const auto found = unit_.find(format.units[column]);
    if (found == unit_.end()) return "";
    std::string name = found->second.starts_with("deg") && found->second.ends_with("itude") ? "deg" : found->second;
    if (format.letters[column].divisor != 1.0 || column >= format.multipliers.size()) return name;
    const auto multiplier = multiplier_.find(format.multipliers[column]);
    if (multiplier == multiplier_.end() || multiplier->second == 1.0 || multiplier->second == 0.0) return name;
    for (const auto& [factor, prefix] : {std::pair{1e-1, "d"}, {1e-2, "c"}, {1e-3, "m"}, {1e-6, "u"}, {1e-9, "n"}, {1e3, "k"}}) {
      if (multiplier->second == factor) return prefix + name;
    }
    return "";
  }

  using Key = std::pair<std::uint64_t, std::uint64_t>;  // type and instance
  std::map<std::uint64_t, MessageFormat> formats_;
  std::map<std::uint64_t, std::pair<std::string, std::string>> units_of_;
  std::map<char, std::string> unit_;
  std::map<char, double> multiplier_;
  std::map<Key, std::size_t> topic_of_;
  std::set<std::string> odd_;
  std::size_t skipped_ = 0, first_skipped_ = 0;
};

}  // namespace

std::unique_ptr<LogReader> read_dataflash(const Bytes& bytes) { return std::make_unique<DataFlashReader>(bytes); }

}  // namespace misfit
