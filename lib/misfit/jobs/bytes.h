#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "misfit/core/error.h"
#include "misfit/core/fields.h"

namespace misfit {

// Plain data as bytes of this machine's order, to the last bit: for results that only the same program reads again (checkpoints). A struct
// joins by a function beside it,
//
//   template <class Bytes>
//   void fields(Bytes& bytes, MaybeConst<Point> auto& point) { auto& [x, y] = point; bytes(x, y); }
//
// whose structured binding no longer compiles when the struct gets a field more.

/// Appends what it is called with.
class ByteWriter {
 public:
  template <class... Data>
  void operator()(const Data&... data) {
    (put(data), ...);
  }
  [[nodiscard]] std::string take() { return std::move(bytes_); }

 private:
  template <class T>
  static constexpr bool is_plain = std::is_arithmetic_v<T> || std::is_enum_v<T>;

  void raw(const void* from, std::size_t size) { bytes_.append(static_cast<const char*>(from), size); }
  void put_size(std::size_t n) { put(static_cast<std::uint64_t>(n)); }

  template <class T>
  void put(const T& data) {
    if constexpr (is_plain<T>) {
      raw(&data, sizeof data);
    } else {
      fields(*this, data);
    }
  }
  void put(const std::string& text) {
    put_size(text.size());
    raw(text.data(), text.size());
  }
  template <class T>
  void put(const std::vector<T>& all) {
    put_size(all.size());
    if constexpr (is_plain<T> && !std::is_same_v<T, bool>) {
      raw(all.data(), all.size() * sizeof(T));
    } else {
      for (const T& one : all) put(one);
    }
  }
  template <class T>
  void put(const std::optional<T>& data) {
    put(data.has_value());
    if (data) put(*data);
  }
  template <class A, class B>
  void put(const std::pair<A, B>& data) {
    put(data.first);
    put(data.second);
  }
  template <class K, class V>
  void put(const std::map<K, V>& all) {
    put_size(all.size());
    for (const auto& one : all) {
      put(one.first);
      put(one.second);
    }
  }
  template <int R, int C, int O>
  void put(const Eigen::Matrix<double, R, C, O>& m) {
    put_size(m.rows());
    put_size(m.cols());
    raw(m.data(), m.size() * sizeof(double));
  }

  std::string bytes_;
};

/// Fills what it is called with, in the order in which it was written. RunError where the bytes end before.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  template <class... Data>
  void operator()(Data&... data) {
    (get(data), ...);
  }
  [[nodiscard]] bool at_end() const { return at_ == bytes_.size(); }

 private:
  template <class T>
  static constexpr bool is_plain = std::is_arithmetic_v<T> || std::is_enum_v<T>;

  void need(std::size_t size) const {
    if (size > bytes_.size() - at_) throw RunError("a stored result ends too early");
  }
  void raw(void* to, std::size_t size) {
    need(size);
    if (size > 0) std::memcpy(to, bytes_.data() + at_, size);
    at_ += size;
  }
  /// Of things of at least `each` bytes: a size that is not there is never reserved.
  std::size_t get_size(std::size_t each = 1) {
    std::uint64_t n = 0;
    get(n);
    if (n > (bytes_.size() - at_) / each) throw RunError("a stored result ends too early");
    return static_cast<std::size_t>(n);
  }

  template <class T>
  void get(T& data) {
    if constexpr (is_plain<T>) {
      raw(&data, sizeof data);
    } else {
      fields(*this, data);
    }
  }
  void get(std::string& text) {
    text.resize(get_size());
    raw(text.data(), text.size());
  }
  template <class T>
  void get(std::vector<T>& all) {
    if constexpr (std::is_same_v<T, bool>) {
      all.resize(get_size());
      for (std::size_t i = 0; i < all.size(); ++i) {
        bool one = false;
        get(one);
        all[i] = one;
      }
    } else if constexpr (is_plain<T>) {
      all.resize(get_size(sizeof(T)));
      raw(all.data(), all.size() * sizeof(T));
    } else {
      all.resize(get_size());
      for (T& one : all) get(one);
    }
  }
  template <class T>
  void get(std::optional<T>& data) {
    bool there = false;
    get(there);
    data.reset();
    if (there) get(data.emplace());
  }
  template <class A, class B>
  void get(std::pair<A, B>& data) {
    get(data.first);
    get(data.second);
  }
  template <class K, class V>
  void get(std::map<K, V>& all) {
    all.clear();
    const std::size_t n = get_size();
    for (std::size_t i = 0; i < n; ++i) {
      K key{};
      get(key);
      get(all[key]);
    }
  }
  template <int R, int C, int O>
  void get(Eigen::Matrix<double, R, C, O>& m) {
    std::uint64_t rows = 0, columns = 0;
    get(rows);
    get(columns);
    const std::uint64_t most = (bytes_.size() - at_) / sizeof(double);
    if (rows > most || columns > most || rows * columns > most) throw RunError("a stored result ends too early");
    m.resize(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
    raw(m.data(), m.size() * sizeof(double));
  }

  std::string_view bytes_;
  std::size_t at_ = 0;
};

}  // namespace misfit
