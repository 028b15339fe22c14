#pragma once

namespace misfit {

/// Fixed sizes, so that nothing in the inner loop allocates. Exceeding one is an InputError when the model is assembled.
inline constexpr int kMaxStates = 80;       ///< system's and effects' own together: 40, and a random force on each
inline constexpr int kMaxQuantities = 128;  ///< of the system, predicted outputs included
inline constexpr int kMaxPorts = 128;       ///< of one kind
inline constexpr int kMaxInputs = 16;
inline constexpr int kMaxOutputs = 24;
inline constexpr int kMaxSensorPorts = 2 * kMaxOutputs + 1;  ///< outputs, the time at which all are taken, that of each
inline constexpr int kMaxConstants = 96;                     ///< parameters of the system
inline constexpr int kMaxWidth = 24;                         ///< quantities + coefficients + own states + constants that one effect reads
inline constexpr int kMaxColumns = 256;                      ///< free parameters of a model

}  // namespace misfit
