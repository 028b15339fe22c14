#pragma once

#include <optional>

#include "misfit/data/signals.h"
#include "misfit/discover/discover.h"
#include "misfit/discover/unknown_curves.h"

namespace misfit {

/// A dependence that no known effect describes: of a force on a port, of a parameter, or of the error of an output.
struct Unexplained {
  PortKind kind = PortKind::dynamic;
  std::string port, quantity;
  double p_value = 1.0;
  std::vector<EffectPlace> effects = {};             ///< that add it to the model as a curve
  std::optional<UnknownCurve> curve = std::nullopt;  ///< it is this one, of the model without any effect
  std::vector<std::string> alike = {};               ///< what these data cannot tell from it, in words
};

/// The same with what these data cannot tell from it (curves_alike()) among all curves, where it is one of them.
[[nodiscard]] std::optional<Unexplained> with_curves_alike(std::optional<Unexplained> unexplained, const std::vector<UnknownCurve>& all,
                                                           const ScoreWork& work, double p_accept);

/// The verdict in one sentence, and what would separate a group; `camera`: the measurements are those of a calibrated one.
void write_verdict(Discovery& out, const std::optional<Unexplained>& unexplained, double p_accept, bool camera);

/// "its strength friction ends at its bound 40 N m" for the first of these parameters that lies within a thousandth of its
/// scale of a bound other than 0; nullopt if none does. A strength at 0 is an effect that is off, and its drop says so.
[[nodiscard]] std::optional<std::string> ends_at_bound(const Model& model, const std::vector<int>& strengths);

/// "with it in the model gain is no longer determined: 594 ± 268 V, without it 20.00 ± 0.06 V: …" for the first parameter whose sigma is
/// below 5 % of its value without the effect and, with it, above 50 % of that value and 20 % of the new one: the effect does what that
/// parameter does. One that had taken what the effect does may move far and be known as well. nullopt: none is. `with` has the parameters
/// of `without` first.
[[nodiscard]] std::optional<std::string> no_longer_determined(const FilterEstimate& with, const FilterEstimate& without);

/// "its strength is not determined: lag_stiffness = 140 ± 920 N m/rad" where every one of these parameters is smaller than two sigmas: a
/// drop that no strength shows by itself, but only something like their ratio to a shape (a lag of a time constant beyond the record is an
/// integral), so that the effect is not what its name says. nullopt: it is determined, or `covariance` (of the free parameters) is not
/// known.
[[nodiscard]] std::optional<std::string> undetermined_strengths(const Model& model, const Eigen::MatrixXd& covariance,
                                                                const std::vector<int>& strengths);

/// "its time is not determined: sensor_tau = 0.16 ± 0.11 s" where a time of the model's last effect, which remembers, is smaller than two
/// sigmas: at a time of 0 there is nothing to remember, and its interval reaches that. So a gain of the fit is not that of a memory of this
/// form. Of linear memories and delays: a limit of a rate is one whatever the time of following within it. nullopt: none is, or
/// `covariance` (of the free parameters) is not known.
[[nodiscard]] std::optional<std::string> undetermined_time(const Model& model, const Eigen::MatrixXd& covariance);

/// "its step = 0.77 V, but the measurements are 0.11 V (RMS) from multiples of it" where the model's last effect reads an output in whole
/// steps (CoefficientSpec::measured_as is OfMeasurements::step) and the measurements that enter the fit are not in such steps, whatever the
/// first of them is: further off than 0.05 of a step and twice their white noise (measurement_noise()), which may come after the rounding.
/// nullopt: they are, or no effect says so.
[[nodiscard]] std::optional<std::string> off_whole_steps(const Model& model, const std::vector<Signals>& experiments);

/// "the measurements are in whole steps of 0.059 K all the same, noise of 0.017 K to a filter" where the model's last effect reads an
/// output in whole steps and all measurements that enter the fit are within 0.05 of a step (RMS) from them: step/sqrt(12) as in B. Widrow,
/// I. Kollar, Quantization Noise (2008), ch. 4, where the output passes through many steps. nullopt: no such effect, or they are not.
[[nodiscard]] std::optional<std::string> on_whole_steps(const Model& model, const std::vector<Signals>& experiments);
/// Whether they are in such steps, of which the noise is more than half of what `without` does not predict one sample ahead (RMS, each
/// weighted by the inverse variance of its prediction: what an unknown initial state takes to be found is no matter of the sensor).
[[nodiscard]] bool are_coarse_steps(const Model& model, const FilterEstimate& without);

/// "its threshold = -1.9 K is not among the values of Tc, 3.1 to 22 K" where an edge of the model's last effect lies further than a tenth
/// of the visited range outside of it: there the effect is on, or off, all the time. nullopt: all lie inside, or it has none.
[[nodiscard]] std::optional<std::string> edge_not_visited(const FilterEstimate& estimate);

/// "its spacing = 0.89 V is more than two thirds of the 0.37 V that were visited: …" where the model's last effect recurs along a way of
/// which less than one and a half of its spacings was visited: there it is one of many curves. nullopt: more, or it does not recur.
[[nodiscard]] std::optional<std::string> recurs_nowhere(const FilterEstimate& estimate);

/// "its rate_limit = 930 N/s is reached in 0.4 % of the samples alone" where a limit of the rate of an own state of the model's last effect
/// (ScanSpec::over is "|ROLE|/step") is reached in less than 2 % of the filtered samples: the effect is what it is without the limit, and
/// what that gains is a few samples. nullopt: it is reached more often, or no such limit is among its coefficients.
[[nodiscard]] std::optional<std::string> hardly_reached(const FilterEstimate& estimate);

/// Remarks on the camera: parameters that are significant in the sweep but not in the camera (kept in Discovery::sweep_asks). Nothing is
/// accepted then: the drop of a sensor effect comes from its prior, the sweep's, so that the remedy is to calibrate again; and a physical
/// effect may describe the error of the camera. Where the flight gives evidence of physics too, be it refused, of unknown form or not yet
/// refitted (p below `p_accept`), sweep and flight disagree.
void add_camera_remarks(const Calibration* calibration, double p_accept, Discovery& out);

}  // namespace misfit
