#pragma once

#include <vector>

#include "misfit/data/candidates.h"
#include "misfit/data/diagnosis.h"
#include "misfit/data/ladder.h"
#include "misfit/report/figures.h"

namespace misfit::report {

/// What every rung of the ladder brings and leaves unexplained: predicted and actual drop; the random force ± sigma; the RMS of every
/// channel one sample and eight samples ahead, in its unit, or where the systems of the ladder predict different channels over that of the
/// first rung that has the channel; the trim with its 95 % interval.
[[nodiscard]] Figure ladder_figure(const Ladder& ladder);

/// No map over one quantity is significant: of what acts late, or has a memory, a map shows nothing.
[[nodiscard]] bool maps_show_nothing(const Diagnosis& diagnosis);

/// Amplitude of the missing force ± 1 sigma over the places of one quantity; below, how many samples each place has.
[[nodiscard]] Figure map_figure(const ForceMap& map);
/// A map of the study's own model and the same with `added` in it, on one pair of axes.
[[nodiscard]] Figure map_change_figure(const ForceMap& before, const ForceMap& after, const std::string& added);
/// The same over two quantities: the colour is the amplitude.
[[nodiscard]] Figure pair_figure(const PairMap& map);
/// Autocorrelation of the innovations, one panel per channel, with the band that white ones keep to at 95 % of the lags.
[[nodiscard]] Figure innovation_figure(const std::vector<WhitenessReport>& whiteness);
/// Cumulative periodogram of the innovations: white ones stay inside the Kolmogorov–Smirnov band about the diagonal (95 %).
[[nodiscard]] Figure periodogram_figure(const std::vector<WhitenessReport>& whiteness);
/// Normalised innovation squared over time with the band of a right model.
[[nodiscard]] Figure nis_figure(const NisSeries& series);
/// The smoothed random force over time, one panel per port, with ± 1 sigma. `zoom`: that part only.
[[nodiscard]] Figure missing_force_figure(const MissingForce& missing, const std::optional<Interval>& zoom);
/// The same with the force that a refitted candidate adds; candidate.added may have no force of that experiment.
[[nodiscard]] Figure added_force_figure(const MissingForce& missing, const Candidate& candidate, const std::optional<Interval>& zoom);
/// The missing force against one quantity.
[[nodiscard]] Figure missing_force_by_figure(const MissingForce& missing, const std::string& quantity);

/// Predicted and actual drop of the best `most` candidates, the accepted ones in another colour; beside them −log10 of their family-wise
/// p-values (at most 20) with the line at p = 0.01.
[[nodiscard]] Figure candidates_figure(const std::vector<Candidate>& candidates, std::size_t most = 15);

}  // namespace misfit::report
