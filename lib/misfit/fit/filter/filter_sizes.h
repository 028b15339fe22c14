#pragma once

#include <Eigen/Core>

namespace misfit {

/// Calls run.operator()<M, NY>() with the numbers of model states and outputs as constants, where a filter of that size has been compiled
/// by itself, else with Eigen::Dynamic twice: the same result to rounding, slower (a flight of 8 × 2 takes a third longer). Compiled are
/// one output with up to two states of the system, a random force and two memories of effects, two outputs with two states and as much
/// beside them, and the parachute with and without memories: other sizes cost compile time alone.
template <class Run>
auto with_filter_size(int states, int outputs, const Run& run) {
  if (outputs == 1) {
    switch (states) {
      case 2:
        return run.template operator()<2, 1>();
      case 3:
        return run.template operator()<3, 1>();
      case 4:
        return run.template operator()<4, 1>();
      case 5:
        return run.template operator()<5, 1>();
      default:
        break;
    }
  }
  if (outputs == 2) {
    switch (states) {
      case 3:
        return run.template operator()<3, 2>();
      case 4:
        return run.template operator()<4, 2>();
      case 5:
        return run.template operator()<5, 2>();
      case 6:
        return run.template operator()<6, 2>();
      case 7:
        return run.template operator()<7, 2>();
      case 8:
        return run.template operator()<8, 2>();
      default:
        break;
    }
  }
  return run.template operator()<Eigen::Dynamic, Eigen::Dynamic>();
}

}  // namespace misfit
