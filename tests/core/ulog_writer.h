#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>

/// Writes a ULog file (PX4 guide, "ULog File Format").
class UlogWriter {
 public:
  UlogWriter() { text_ += bytes(std::uint64_t{0}); }

  /// `fields`: "float x;float y;", behind the time.
  void topic(std::uint16_t number, const std::string& name, const std::string& fields) {
    message('F', name + ":uint64_t timestamp;" + fields);
    message('A', std::string(1, '\0') + bytes(number) + name);
  }
  /// Values of the types that the topic's fields have, in their order.
  template <class... Values>
  void record(std::uint16_t number, double seconds, Values... values) {
    message('D', bytes(number) + bytes(static_cast<std::uint64_t>(std::llround(1e6 * seconds))) + (bytes(values) + ...));
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  template <class T>
  static std::string bytes(T value) {
    std::string out(sizeof value, '\0');
    std::memcpy(out.data(), &value, sizeof value);
    return out;
  }
  void message(char type, const std::string& content) {
    text_ += bytes(static_cast<std::uint16_t>(content.size()));
    text_ += type;
    text_ += content;
  }
  std::string text_ = "ULog\x01\x12\x35\x01";
};
