#pragma once

#include <optional>
#include <string>

#include "misfit/discover/candidate_model.h"

namespace misfit {

/// Of an effect that is a sensor which reads the size of its output alone.
struct SizeReading {
  std::string output;
  Eigen::VectorXd strengths;  ///< with which it is whole (CoefficientSpec::whole)
};

/// Does the whole of the model's last effect read |y|, from outputs y far larger than its shapes? nullopt: it does not.
[[nodiscard]] std::optional<SizeReading> reads_size_alone(const CandidateModel& candidate_model);

}  // namespace misfit
