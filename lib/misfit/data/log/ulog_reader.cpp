// read_ulog of readers.h. The format: PX4 Guide, "ULog File Format".

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <optional>

#include "misfit/core/shown.h"
#include "misfit/data/log/readers.h"
#include "misfit/data/log/record_reader.h"

namespace misfit {
namespace {

constexpr std::size_t file_head = 16, message_head = 3;
constexpr std::string_view sync_message("\x08\x00S\x2F\x73\x13\x20\x25\x0C\xBB\x12", 11);  // with its zero byte
constexpr std::string_view known_messages = "BFIMPQARDLCSO";

struct Basic {
  std::string_view name;
  NumberType type;
};
constexpr std::array<Basic, 12> basic_types = {{{"int8_t", {NumberKind::signed_integer, 1}},
                                                {"uint8_t", {NumberKind::unsigned_integer, 1}},
                                                {"int16_t", {NumberKind::signed_integer, 2}},
                                                {"uint16_t", {NumberKind::unsigned_integer, 2}},
                                                {"int32_t", {NumberKind::signed_integer, 4}},
                                                {"uint32_t", {NumberKind::unsigned_integer, 4}},
                                                {"int64_t", {NumberKind::signed_integer, 8}},
                                                {"uint64_t", {NumberKind::unsigned_integer, 8}},
                                                {"float", {NumberKind::real, 4}},
                                                {"double", {NumberKind::real, 8}},
                                                {"bool", {NumberKind::unsigned_integer, 1}},
                                                {"char", {NumberKind::unsigned_integer, 1}}}};

/// A field as its format declares it: "float[4] q".
struct Declared {
  std::string type, name;
  std::optional<std::size_t> count;
};

struct Message {
  char type = 0;
  std::size_t at = 0;  ///< of its content
  std::span<const std::byte> content;
};

class UlogReader : public RecordReader {
 public:
  explicit UlogReader(const Bytes& bytes) : RecordReader(bytes) {
    log_.format = "ULog (PX4)";
    if (!bytes_.starts_with("ULog\x01\x12\x35")) bytes_.fail(0, "a ULog file is expected");
    static_cast<void>(bytes_.part(0, file_head, "the head of a ULog file"));
    each_message([&](const Message& m) { define(m); });
    note_damage();
    list_channels();
    if (wrong_size_ > 0)
      log_.notes.push_back(std::to_string(wrong_size_) + " records are of another size than their format, the first at byte " +
                           std::to_string(first_wrong_size_) + ": left out");
  }

 protected:
  void each_record(const Take& take) override {
    topic_of_.clear();
    next_topic_ = 0;
    wrong_size_ = 0;
    each_message([&](const Message& m) {
      if (m.type == 'A' && m.content.size() > 3) subscribe(m);
      if (m.type != 'D' || m.content.size() < 2) return;
      const auto found = topic_of_.find(Bytes("", m.content).unsigned_at(0, 2, ""));
      if (found == topic_of_.end()) return;
      const auto record = m.content.subspan(2);
      if (record.size() >= least_[found->second] && record.size() <= most_[found->second]) return take(found->second, record);
      if (wrong_size_++ == 0) first_wrong_size_ = m.at;
    });
  }

 private:
  /// In the order of the file, from one part that was appended to the next. Damaged stretches are passed over, to the next mark.
  template <class Take>
  void each_message(Take&& take) {
    std::size_t at = file_head;
    std::size_t part = 0;
    skipped_ = 0;
    while (at + message_head <= bytes_.size()) {
      if (part < parts_.size() && at >= parts_[part]) at = parts_[part++];
      const Message m = message(at);
      const bool before_part = part < parts_.size();
      if (m.type == 0 || (before_part && m.at + m.content.size() > parts_[part])) {
        const std::size_t next = before_part ? std::min(parts_[part], next_mark(at)) : next_mark(at);
        if (skipped_ == 0) first_skipped_ = at;
        skipped_ += next - at;
        at = next;
        continue;
      }
      take(m);
      at = m.at + m.content.size();
    }
  }

  /// Of type 0 if there is none.
  [[nodiscard]] Message message(std::size_t at) const {
    if (!bytes_.has(at, message_head)) return {};
    const std::size_t size = bytes_.unsigned_at(at, 2, "");
    const char type = static_cast<char>(bytes_.unsigned_at(at + 2, 1, ""));
    if (known_messages.find(type) == std::string_view::npos || !bytes_.has(at + message_head, size)) return {};
    return {type, at + message_head, bytes_.data().subspan(at + message_head, size)};
  }

  /// The next mark of synchronisation behind `at`, or the end.
  [[nodiscard]] std::size_t next_mark(std::size_t at) const {
    const std::string_view all(reinterpret_cast<const char*>(bytes_.data().data()), bytes_.size());
    return std::min(all.find(sync_message, at + 1), all.size());
  }

  void note_damage() {
    if (skipped_ == 0) return;
    const bool at_end = first_skipped_ + skipped_ == bytes_.size();
    if (topics_.empty())
      bytes_.fail(first_skipped_, "a message of ULog is expected (its size, and a letter of " + std::string(known_messages) + ")");
    log_.notes.push_back("byte " + std::to_string(first_skipped_) + ": " +
                         (at_end ? "no whole message is there, the last " : "no message is there, up to where the log goes on ") +
                         std::to_string(skipped_) + " bytes are left out");
  }

  void define(const Message& m) {
    const Bytes content(bytes_.source(), m.content);
    if (m.type == 'B') read_flags(m, content);
    if (m.type == 'F') read_format(m, content);
    if (m.type == 'A') add_topic(m, content);
  }

  void read_flags(const Message& m, const Bytes& content) {
    constexpr std::size_t size = 40;
    if (m.at != file_head + message_head) return;  // only the first message has them
    if (content.size() < size) bytes_.fail(m.at, "40 bytes of flags are expected");
    for (std::size_t i = 8; i < 16; ++i) {
      if ((content.unsigned_at(i, 1, "") & (i == 8 ? ~std::uint64_t{1} : ~std::uint64_t{0})) != 0)
        bytes_.fail(m.at + i, "flags of this version of ULog are expected: the log is of a newer one");
    }
    parts_.clear();
    for (std::size_t i = 16; i < size; i += 8) {
      const std::size_t part = content.unsigned_at(i, 8, "");
      if (part > (parts_.empty() ? m.at : parts_.back()) && part < bytes_.size()) parts_.push_back(part);
    }
  }

  /// "vehicle_attitude:uint64_t timestamp;float[4] q;"
  void read_format(const Message& m, const Bytes& content) {
    const std::string text = content.text(0, content.size(), "a format");
    const auto colon = text.find(':');
    if (colon == std::string::npos) bytes_.fail(m.at, "a format NAME:TYPE FIELD;… is expected");
    std::vector<Declared> fields;
    for (std::size_t at = colon + 1; at < text.size();) {
      const std::size_t end = std::min(text.find(';', at), text.size());
      const std::string field = text.substr(at, end - at);
      at = end + 1;
      if (field.empty()) continue;
      fields.push_back(declared(m, field));
    }
    formats_[text.substr(0, colon)] = std::move(fields);
  }

  [[nodiscard]] Declared declared(const Message& m, const std::string& field) const {
    const auto blank = field.find(' ');
    if (blank == std::string::npos) bytes_.fail(m.at, "TYPE FIELD is expected in a format, not '" + shown(field) + "'");
    Declared out{field.substr(0, blank), field.substr(blank + 1), std::nullopt};
    const auto open = out.type.find('[');
    if (open == std::string::npos) return out;
    std::size_t count = 0;
    const auto [end, error] = std::from_chars(out.type.data() + open + 1, out.type.data() + out.type.size(), count);
    if (error != std::errc() || *end != ']' || count > 65535) bytes_.fail(m.at, "TYPE[COUNT] is expected, not '" + shown(out.type) + "'");
    out.count = count;
    out.type.resize(open);
    return out;
  }

  /// A format laid out: fields, and where the padding at its end begins.
  struct Layout {
    std::size_t at = 0;  ///< of the message that adds the topic
    std::vector<RecordField> fields;
    std::size_t size = 0, without_padding = 0;
  };

  void add_topic(const Message& m, const Bytes& content) {
    constexpr std::size_t head = 3;
    if (content.size() <= head) bytes_.fail(m.at, "an instance, a number and a name of a topic are expected");
    const std::string type = content.text(head, content.size() - head, "a name");
    const std::uint64_t instance = content.unsigned_at(0, 1, "");
    Layout layout;
    layout.at = m.at;
    lay_out(layout, type, "", 0);
    RecordTopic topic;
    topic.name = instance == 0 ? type : type + "[" + std::to_string(instance) + "]";
    topic.fields = std::move(layout.fields);
    const auto time = std::find_if(topic.fields.begin(), topic.fields.end(), [](const RecordField& f) { return f.name == "timestamp"; });
    topic.clock = static_cast<std::size_t>(time - topic.fields.begin());
    if (time != topic.fields.end()) time->unit = "us";
    subscriptions_.push_back(topics_.size());
    const auto known = std::find_if(topics_.begin(), topics_.end(), [&](const RecordTopic& t) { return t.name == topic.name; });
    if (known != topics_.end() && least_[known - topics_.begin()] == layout.without_padding) {
      subscriptions_.back() = static_cast<std::size_t>(known - topics_.begin());
      return;
    }
    least_.push_back(layout.without_padding);
    most_.push_back(layout.size);
    topics_.push_back(std::move(topic));
  }

  void lay_out(Layout& layout, const std::string& type, const std::string& prefix, int depth) {
    const auto format = formats_.find(type);
    constexpr int deepest = 8;
    if (format == formats_.end() || depth > deepest)
      bytes_.fail(layout.at, "the format of '" + shown(type) + "' is expected before its use");
    for (const Declared& d : format->second) {
      for (std::size_t i = 0; i < d.count.value_or(1); ++i) {
        constexpr std::size_t most = 300'000;
        if (++laid_out_ > most) bytes_.fail(layout.at, "topics of fewer than 300000 fields in all are expected");
        lay_out_one(layout, d, prefix + d.name + (d.count ? "[" + std::to_string(i) + "]" : ""), depth);
      }
    }
  }

  void lay_out_one(Layout& layout, const Declared& d, const std::string& name, int depth) {
    const auto basic = std::find_if(basic_types.begin(), basic_types.end(), [&](const Basic& b) { return b.name == d.type; });
    if (basic == basic_types.end()) return lay_out(layout, d.type, name + ".", depth + 1);
    const bool padding = d.name.starts_with("_padding");
    if (!padding && d.type != "char") layout.fields.push_back({.name = name, .unit = "", .offset = layout.size, .type = basic->type});
    layout.size += basic->type.size;
    if (!padding) layout.without_padding = layout.size;
  }

  /// The number by which records of the topic added next are marked from here on.
  void subscribe(const Message& m) {
    if (next_topic_ < subscriptions_.size()) topic_of_[Bytes("", m.content).unsigned_at(1, 2, "")] = subscriptions_[next_topic_++];
  }

  std::map<std::string, std::vector<Declared>> formats_;
  std::vector<std::size_t> least_, most_;   // bytes of a record of each topic, without and with padding at its end
  std::vector<std::size_t> subscriptions_;  // topic of each message of addition, in their order
  std::vector<std::size_t> parts_;          // where appended data begin
  std::map<std::uint64_t, std::size_t> topic_of_;
  std::size_t next_topic_ = 0, laid_out_ = 0;
  std::size_t skipped_ = 0, first_skipped_ = 0;
  std::size_t wrong_size_ = 0, first_wrong_size_ = 0;
};

}  // namespace

std::unique_ptr<LogReader> read_ulog(const Bytes& bytes) { return std::make_unique<UlogReader>(bytes); }

}  // namespace misfit
