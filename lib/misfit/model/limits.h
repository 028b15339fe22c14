#pragma once

namespace misfit {

/// Fixed sizes, so that nothing in the inner loop allocates. Exceeding one is an InputError when the model is assembled.
inline constexpr int kMaxStates = 16;      ///< system's and effects' own together
inline constexpr int kMaxQuantities = 64;  ///< of the system, predicted outputs included
inline constexpr int kMaxPorts = 24;       ///< of one kind
inline constexpr int kMaxInputs = 8;
inline constexpr int kMaxOutputs = 8;
inline constexpr int kMaxConstants = 32;  ///< parameters of the system
inline constexpr int kMaxWidth = 24;      ///< quantities + coefficients + own states + constants that one effect reads
inline constexpr int kMaxColumns = 256;   ///< free parameters of a model

}  // namespace misfit
