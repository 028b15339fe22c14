#include "misfit/core/iso_date.h"

#include <algorithm>
#include <charconv>
#include <chrono>

namespace misfit {
namespace {

/// Takes numbers and signs off the front of a text.
class Cursor {
 public:
  explicit Cursor(std::string_view text) : rest_(text) {}

  [[nodiscard]] bool done() const { return rest_.empty(); }
  [[nodiscard]] bool ok() const { return ok_; }

  bool take_any(std::string_view signs) {
    if (rest_.empty() || signs.find(rest_.front()) == std::string_view::npos) return false;
    last_ = rest_.front();
    rest_.remove_prefix(1);
    return true;
  }
  [[nodiscard]] char last() const { return last_; }

  /// Exactly `digits` of them, at most `most`.
  int number(std::size_t digits, int least, int most) {
    int value = 0;
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + std::min(digits, rest_.size()), value);
    ok_ = ok_ && error == std::errc() && end == rest_.data() + digits && value >= least && value <= most;
    if (ok_) rest_.remove_prefix(digits);
    return value;
  }

  /// The digits behind a decimal sign.
  double part() {
    double digits = 0.0, scale = 1.0;
    for (; !rest_.empty() && rest_.front() >= '0' && rest_.front() <= '9'; rest_.remove_prefix(1)) {
      digits = 10.0 * digits + (rest_.front() - '0');
      scale *= 10.0;
    }
    return digits / scale;
  }

 private:
  std::string_view rest_;
  char last_ = '\0';
  bool ok_ = true;
};

/// Of a zone "+01:00", "+0100", "+01"; 0 for Z or none [s].
int zone(Cursor& text) {
  text.take_any(" ");
  if (text.take_any("Zz") || !text.take_any("+-")) return 0;
  const int sign = text.last() == '-' ? -1 : 1;
  constexpr int most_hours = 14;
  const int hours = text.number(2, 0, most_hours);
  text.take_any(":");
  return sign * (3600 * hours + (text.done() ? 0 : 60 * text.number(2, 0, 59)));
}

}  // namespace

std::optional<IsoDate> read_iso_date(std::string_view text) {
  using namespace std::chrono;
  constexpr std::size_t longest = 40;
  if (text.size() > longest) return std::nullopt;
  Cursor in(text);
  const bool day_first = text.size() > 2 && text[2] == '.';
  int y = 0, m = 0, d = 0;
  if (day_first) {
    d = in.number(2, 1, 31);
    if (!in.take_any(".")) return std::nullopt;
    m = in.number(2, 1, 12);
    if (!in.take_any(".")) return std::nullopt;
    y = in.number(4, 1, 9999);
  } else {
    y = in.number(4, 1, 9999);
    if (!in.take_any("-/")) return std::nullopt;
    const char between = in.last();
    m = in.number(2, 1, 12);
    if (!in.take_any({&between, 1})) return std::nullopt;
    d = in.number(2, 1, 31);
  }
  const year_month_day day{year(y), month(static_cast<unsigned>(m)), std::chrono::day(static_cast<unsigned>(d))};
  if (!in.ok() || !day.ok() || !in.take_any("Tt ")) return std::nullopt;
  const int h = in.number(2, 0, 23);
  if (!in.take_any(":")) return std::nullopt;
  const int minute = in.number(2, 0, 59);
  const int second = in.take_any(":") ? in.number(2, 0, 60) : 0;
  const double part = in.take_any(".,") ? in.part() : 0.0;
  const int offset = zone(in);
  if (!in.ok() || !in.done()) return std::nullopt;
  const std::int64_t days = sys_days(day).time_since_epoch().count();
  const int since_midnight = 3600 * h + 60 * minute + second;
  return IsoDate{86400 * days + since_midnight - offset, part, since_midnight};
}

double seconds_between(const IsoDate& from, const IsoDate& to) {
  return static_cast<double>(to.seconds - from.seconds) + (to.part - from.part);
}

}  // namespace misfit
