#pragma once

// Terms and hidden effects that many of the systems share.
#include <cmath>
#include <string>

#include "tests/benchmark/strangers/world.h"

namespace strangers {

inline double sign(double v) { return v > 0.0 ? 1.0 : v < 0.0 ? -1.0 : 0.0; }
inline double dry(double rate, const Values& p) { return p("coulomb") > 0.0 ? p("coulomb") * std::tanh(rate / p("width")) : 0.0; }
inline double beyond(double v, double edge) { return v > edge ? v - edge : v < -edge ? v + edge : 0.0; }

inline Effect slow_actuator(const std::string& name, double low = 0.3, double high = 1.5) {
  return {name, Site::input, 0, {{"slew", low, high}}, {}, ""};
}
inline Effect late_input(const std::string& port, const std::string& gain) {
  return {"input_delay",
          Site::input,
          0,
          {{"delay", 0.6, 6.0}},
          {"delay@" + port, "time_offset"},
          "delay = { port = \"" + port + "\", start = { delayed_gain = {" + gain + "}, delay = {delay} } }"};
}
inline Effect limited_input(const std::string& port, const std::string& gain) {
  return {"input_saturation",
          Site::input,
          0,
          {{"limit", 0.4, 0.85}},
          {"saturation@" + port},
          "saturation = { port = \"" + port + "\", start = { saturated_gain = {" + gain + "}, limit = {limit} } }"};
}
inline Effect shifted_sensor(int index, const std::string& output) {
  return {"bias_" + output,
          Site::sensor,
          index,
          {{"bias", 0.01, 0.3, true}},
          {"bias@" + output},
          "bias = { output = \"" + output + "\", start = { offset = {bias} } }"};
}
inline Effect late_sensor(int index, const std::string& output) {
  return {"delay_" + output,
          Site::sensor,
          index,
          {{"delay", 0.6, 6.0}},
          {"sensor_delay@" + output},
          "sensor_delay = { output = \"" + output + "\", start = { late_share = 1, sensor_delay = {delay} } }"};
}
inline Effect slow_sensor(int index, const std::string& output) {
  return {"lag_" + output,
          Site::sensor,
          index,
          {{"lag", 0.6, 8.0}},
          {"sensor_lag@" + output},
          "sensor_lag = { output = \"" + output + "\", start = { share = 1, sensor_tau = {lag} } }"};
}
inline Effect clipped_sensor(int index, const std::string& output) {
  return {"clipped_" + output,
          Site::sensor,
          index,
          {{"ceiling", 0.6, 0.92}},
          {"sensor_saturation@" + output},
          "sensor_saturation = { output = \"" + output + "\", start = { clipped = 1, ceiling = {ceiling} } }"};
}

}  // namespace strangers
