#pragma once

#include "misfit/data/motion.h"
#include "misfit/report/figure.h"

namespace misfit::report {

/// One group of statistics ("distribution", "autocorrelation", "spectrum") of every series of an experiment that has it, one panel each:
/// measured numbers over the band that 95 % of the simulated motions keep to. Distribution: the quantiles over their share.
[[nodiscard]] Figure simulated_figure(const SimulatedMotion& motion, const std::string& experiment, const std::string& group);

}  // namespace misfit::report
