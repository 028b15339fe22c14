#include "misfit/recording/column_facts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>

#include "misfit/core/column_header.h"
#include "misfit/core/text.h"
#include "misfit/math/statistics.h"

namespace misfit {
namespace {

constexpr std::array<std::string_view, 38> input_words = {
    "u",          "in",         "input",    "force",   "torque",   "voltage", "cmd",      "command", "ref",     "setpoint",
    "valve",      "pump",       "drive",    "motor",   "throttle", "heater",  "power",    "pwm",     "control", "stimulus",
    "excitation", "demand",     "actuator", "duty",    "rudder",   "aileron", "elevator", "flap",    "flaps",   "sun",
    "solar",      "irradiance", "ambient",  "outdoor", "outside",  "wind",    "heating",  "cooling"};
/// Behind another word: "roll_cmd", "motor_voltage".
constexpr std::array<std::string_view, 8> last_words = {"cmd", "command", "setpoint", "demand", "pwm", "duty", "voltage", "input"};
constexpr std::array<std::string_view, 7> segment_words = {"segment", "seg", "trial", "run", "episode", "block", "id"};

/// One of the words of the name begins so: "outdoor_temperature", "Aussentemperatur".
constexpr std::array<std::string_view, 8> weather = {"outdoor", "outside", "ambient", "exterior", "aussen", "weather", "solar", "irradia"};
constexpr std::array<std::string_view, 6> weather_names = {"t_out", "tout", "t_amb", "tamb", "t_ext", "temp_out"};

bool is_weather(const std::string& name) {
  const std::string all = lower_case(name);
  if (std::find(weather_names.begin(), weather_names.end(), all) != weather_names.end()) return true;
  for (std::size_t at = 0; at < all.size(); at = all.find('_', at)) {
    at += all[at] == '_' ? 1 : 0;
    const std::string_view word = std::string_view(all).substr(at);
    if (std::any_of(weather.begin(), weather.end(), [&](std::string_view w) { return word.starts_with(w); })) return true;
  }
  return false;
}

/// How many samples in a row stand at one value: the longest stand at `value`, and the longest at any other.
struct Stands {
  std::size_t at = 0, elsewhere = 0;
};

Stands longest_stands(const std::vector<double>& values, double value) {
  Stands out;
  std::size_t run = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) continue;
    run = i > 0 && values[i] == values[i - 1] ? run + 1 : 1;
    std::size_t& longest = values[i] == value ? out.at : out.elsewhere;
    longest = std::max(longest, run);
  }
  return out;
}

}  // namespace

std::vector<double> finite(const std::vector<double>& values) {
  std::vector<double> out = values;
  std::erase_if(out, [](double v) { return !std::isfinite(v); });
  return out;
}

bool is_integer(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return v == std::round(v); });
}

bool is_coarsely_digitised(const std::vector<double>& values, double resolution) {
  if (!(resolution > 0.0)) return false;
  const std::vector<double> known = finite(values);
  std::set<long> levels;
  std::size_t changes = 0, single = 0, turns = 0;
  double before = 0.0;  // the change before this one [steps]
  for (std::size_t i = 0; i < known.size(); ++i) {
    levels.insert(std::lround((known[i] - known.front()) / resolution));
    const double change = i > 0 ? std::round((known[i] - known[i - 1]) / resolution) : 0.0;
    if (change == 0.0) continue;
    ++changes;
    single += std::abs(change) == 1.0 ? 1U : 0U;
    turns += change * before < 0.0 ? 1U : 0U;
    before = change;
  }
  constexpr std::size_t of_a_staircase = 21, few = 5;
  const bool flickers = levels.size() >= few && 2 * turns > changes;
  return 2 * single > changes && (levels.size() > of_a_staircase || flickers);
}

bool comes_back(const std::vector<double>& values) {
  std::set<double> seen;
  double last = std::nan("");
  for (const double v : finite(values)) {
    if (v != last && !seen.insert(v).second) return true;
    last = v;
  }
  return false;
}

bool is_smooth(const std::vector<double>& values) {
  double squares = 0.0, products = 0.0;
  for (std::size_t i = 2; i < values.size(); ++i) {
    const double now = values[i] - values[i - 1], before = values[i - 1] - values[i - 2];
    if (!std::isfinite(now) || !std::isfinite(before)) continue;
    squares += now * now;
    products += now * before;
  }
  constexpr double alike = 0.5;
  return squares > 0.0 && products > alike * squares;
}

bool jumps(const std::vector<double>& values) {
  std::vector<double> sizes;
  for (std::size_t i = 1; i < values.size(); ++i) {
    const double change = std::abs(values[i] - values[i - 1]);
    if (std::isfinite(change)) sizes.push_back(change);
  }
  if (sizes.empty()) return false;
  constexpr double large = 10.0, nearly_all = 0.8, few = 0.1;
  const double usual = median(sizes);
  double squares = 0.0, of_large = 0.0, count = 0.0;
  for (const double size : sizes) {
    squares += size * size;
    if (size > large * usual) of_large += size * size, count += 1.0;
  }
  return squares > 0.0 && of_large > nearly_all * squares && count < few * static_cast<double>(sizes.size());
}

std::vector<std::string> limit_remarks(const std::string& header, const std::vector<double>& values) {
  std::vector<std::string> out;
  const std::vector<double> known = finite(values);
  if (known.empty()) return out;
  const auto [low, high] = std::minmax_element(known.begin(), known.end());
  for (const bool upper : {true, false}) {
    const Stands stands = longest_stands(values, upper ? *high : *low);
    constexpr std::size_t fewest_at_limit = 10;
    if (stands.at < fewest_at_limit || stands.at < 2 * stands.elsewhere) continue;
    out.push_back(fmt::format("column '{}' stays at its {} value, {}, for up to {} samples: the signal may saturate, or simply rest there",
                              header, upper ? "highest" : "lowest", format_value(upper ? *high : *low), stands.at));
  }
  return out;
}

bool is_called_input(const std::string& name) {
  const auto before = name.rfind('_');
  return is_called(name, input_words) || is_weather(name) ||
         (before != std::string::npos && is_called(name.substr(before + 1), last_words));
}
bool are_called_in_and_out(const std::string& in, const std::string& out) {
  const std::string end = lower_case(out);
  return end.ends_with("out") && lower_case(in) == end.substr(0, end.size() - 3) + "in";
}
bool are_numbered_alike(const std::string& a, const std::string& b) {
  const auto before_number = [](const std::string& name) { return lower_case(name.substr(0, name.find_last_not_of("0123456789") + 1)); };
  const std::string kind = before_number(a);
  return a != b && kind.size() < a.size() && kind == before_number(b);
}
bool is_called_segment(const std::string& name) { return is_called(name, segment_words); }

}  // namespace misfit
