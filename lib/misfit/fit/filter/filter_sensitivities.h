#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "misfit/fit/filter/filter_run.h"
#include "misfit/model/evaluator.h"

namespace misfit {

/// Derivatives of the filter's state by the free parameters, the gains fixed, along one pass over an experiment.
class FilterSensitivities {
 public:
  struct Sizes {
    int states = 0, outputs = 0, columns = 0, past = 0;  ///< past: inputs whose past is estimated (unknown_past.h)
  };
  /// First. `jacobian`, which outlives this, gets whitened rows.
  void begin(FilterJacobian& jacobian, const FilterData& data, const Sizes& sizes);

  /// Derivatives of the predicted output o: `a` = ∂h/∂x; `direct`: ∂h/∂θ, one value for each of `slots`.
  void predict_output(const double* a, int o, const double* direct, const Slots& slots);
  /// The row of the measurement at this place of the trace; after predict_output().
  void keep(std::size_t place, const FilterTrace& trace);
  /// By the gains of the model's states and of the coloured noise; after predict_output().
  void update(const double* gain, const double* gain_coloured);
  /// By the gains of the past of inputs; after update().
  void update_past(const double* gain);
  /// After step(): what the past of inputs does in it, ∂(state)/∂(past) in columns.
  template <class Response>
  void add_past(const Response& response) {
    model_ += response.lazyProduct(past_);
  }
  /// Over a step: `D`: kRowStride per state, ∂(state)/∂(state before) and then a value for each of `slots`.
  void step(const double* D, const Slots& slots, const NoiseStep& noise);

 private:
  FilterJacobian* jacobian_ = nullptr;
  RowMatrix model_, coloured_, past_, work_;  ///< a row per state or input; columns that fill the last block are 0
  Eigen::RowVectorXd row_;                    ///< of the output that was predicted last
};

}  // namespace misfit
