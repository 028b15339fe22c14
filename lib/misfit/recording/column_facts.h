#pragma once

// What the values and the name of one column say: not for other files than recording.cpp.

#include <string>
#include <vector>

namespace misfit {

/// Without what is not finite.
[[nodiscard]] std::vector<double> finite(const std::vector<double>& values);
[[nodiscard]] bool is_integer(const std::vector<double>& values);

/// A measurement that stands still between steps of its last digit (`resolution`), not a command that jumps: most of its changes are one
/// such step, over more levels than a staircase of 5 % has, or to and fro among a few.
[[nodiscard]] bool is_coarsely_digitised(const std::vector<double>& values, double resolution);

/// The number that came before comes again behind another one: on, off, on.
[[nodiscard]] bool comes_back(const std::vector<double>& values);

/// A sentence for the highest and one for the lowest value, if an otherwise moving column stands there for ten samples or more, and twice
/// as long as anywhere else.
[[nodiscard]] std::vector<std::string> limit_remarks(const std::string& header, const std::vector<double>& values);

/// Neighbouring differences are alike (their autocorrelation is above 0.5): a ramp or a wave, not jumps and not noise.
[[nodiscard]] bool is_smooth(const std::vector<double>& values);

/// Nearly all of its motion is in few changes from one sample to the next, ten times as large as the usual one: steps, whatever a wave
/// beside them does.
[[nodiscard]] bool jumps(const std::vector<double>& values);

// By name, case and a number behind it ("u1") aside.
[[nodiscard]] bool is_called_input(const std::string& name);
/// "t_in" and "t_out": two ends of something.
[[nodiscard]] bool are_called_in_and_out(const std::string& in, const std::string& out);
/// Alike but for the number behind them, case aside: "T_1" and "T_2", two of one kind.
[[nodiscard]] bool are_numbered_alike(const std::string& a, const std::string& b);
[[nodiscard]] bool is_called_segment(const std::string& name);

}  // namespace misfit
