#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "misfit/data/diagnosis.h"
#include "misfit/data/fit.h"
#include "misfit/report/figure.h"

namespace misfit::page {

/// [from, to] [s], half-way to the samples that are not held out.
using Times = std::vector<std::array<double, 2>>;
[[nodiscard]] Times held_out_times(const ChannelPrediction& channel);
/// Of every experiment of the fit.
[[nodiscard]] std::map<std::string, Times> held_out_times(const Fit& fit);

/// Which part of the samples under each hat of a map is held out, 0 to 1; empty: the diagnosis does not have the quantity over time.
[[nodiscard]] std::vector<double> held_out_shares(const ForceMap& map, const Diagnosis& diagnosis,
                                                  const std::map<std::string, Times>& held_out);

/// Says of each place of a map's figure without an estimate whether it is held out or has too few samples, and of each place how many of
/// its samples are held out. `shares`: held_out_shares(); empty: nothing is changed.
void tell_held_out(const ForceMap& map, const std::vector<double>& shares, report::Figure& figure);

}  // namespace misfit::page
