#pragma once

#include <limits>
#include <string>
#include <vector>

namespace misfit {

/// One measured or input signal on the common time base of its experiment.
struct Signal {
  std::string name;            ///< the system's name for it: "alpha_T"
  std::string unit;            ///< SI unit: "rad"
  std::vector<double> values;  ///< NaN = missing
  double sigma = 0.0;          ///< white measurement noise where known, else 0 [unit]
};

/// One experiment as the fits see it: measured channels in the order of the system's outputs, inputs in the order of its inputs.
struct Signals {
  std::string name;
  std::vector<double> t;  ///< [s], strictly increasing, may be uneven
  std::vector<Signal> measured;
  std::vector<Signal> inputs;  ///< no missing values; empty: not needed by the model, and not recorded whole
  std::size_t exclude = 0;     ///< initial samples not counted in errors
  double validation_from = std::numeric_limits<double>::infinity();  ///< samples with validation_from <= t < validation_to are held out [s]
  double validation_to = std::numeric_limits<double>::infinity();
  bool after_gap = false;  ///< goes on where the one before stops, after a gap too long to be bridged: its initial states are its own
  std::vector<std::string> notes;  ///< what was dropped and why, in words

  [[nodiscard]] std::size_t samples() const { return t.size(); }
  [[nodiscard]] double seconds() const { return t.empty() ? 0.0 : t.back() - t.front(); }  ///< from the first sample to the last
  [[nodiscard]] bool held_out(std::size_t i) const { return t[i] >= validation_from && t[i] < validation_to; }
};

}  // namespace misfit
