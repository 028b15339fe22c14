#include "misfit/fit/regression/sliding_bin.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "misfit/core/display.h"
#include "misfit/core/error.h"
#include "misfit/core/stopwatch.h"
#include "misfit/core/text.h"
#include "misfit/core/units.h"
#include "misfit/data/estimators.h"
#include "misfit/fit/regression/bin_equations.h"
#include "misfit/inference/curves.h"
#include "misfit/inference/driven.h"

namespace misfit {
namespace {

void check(const SlidingBinOptions& options) {
  const auto need = [](bool holds, const std::string& what, double value) {
    if (!holds) throw InputError("sliding_bin: " + what + ", not " + format_value(value));
  };
  need(options.width > 0.0 && std::isfinite(options.width), "the width of a bin must be positive", options.width);
  need(options.step > 0.0 && std::isfinite(options.step), "the step of the bins must be positive", options.step);
  need(options.minimum_samples >= 4, "a bin of three unknowns needs at least 4 samples", static_cast<double>(options.minimum_samples));
}

/// Σ x'' x' over all usable samples, with a sigma from the scatter of its blocks.
struct TelescopedSum {
  double value = 0.0, sigma = 0.0;
  std::size_t count = 0;
  bool known = false;  ///< that sigma: there are two blocks or more
  [[nodiscard]] bool zero() const { return !known || std::abs(value) < 2.0 * sigma; }
  /// "0.20 ± 0.31 rad^2/s^3, within 2 sigma of 0".
  [[nodiscard]] std::string in_words(const std::string& unit) const {
    if (known) return format_value(value, sigma) + " " + unit + ", " + (zero() ? "within" : "beyond") + " 2 sigma of 0";
    return format_value(value) + " " + unit +
           ", not to be distinguished from 0: the record is too short for a sigma, which takes two periods";
  }
};

/// Blocks of one period (one second where no frequency is known): within them samples may be correlated as they like. Blocks that follow
/// one another share the rate at their border, with opposite sign, so that sigma is rather too wide than too narrow.
TelescopedSum telescoped_sum(const BinForm& form, const Signals& signals, const ReconstructedStates& states, double frequency) {
  const double block = frequency > 0.0 ? 2.0 * std::numbers::pi / frequency : 1.0;
  std::vector<double> sums;
  TelescopedSum out;
  double begin = 0.0;
  for (std::size_t i = 0; i < signals.samples(); ++i) {
    if (!states.ok[i]) continue;
    if (sums.empty() || signals.t[i] - begin >= block) {
      sums.push_back(0.0);
      begin = signals.t[i];
    }
    const Eigen::Index row = i;
    sums.back() += states.dx(row, form.rate) * states.x(row, form.rate);
    ++out.count;
  }
  for (double s : sums) out.value += s;
  const auto blocks = static_cast<double>(sums.size());
  double squares = 0.0;
  for (double s : sums) squares += (s - out.value / blocks) * (s - out.value / blocks);
  out.known = sums.size() > 1;
  if (out.known) out.sigma = std::sqrt(squares * blocks / (blocks - 1.0));
  return out;
}

/// One pass of the whole method with one interpretation of the stencils.
struct Pass {
  SlidBins bins;
  BinSolution all;
  TelescopedSum sum;
  DrivenTest test;
  bool driven = false;
  double damping_of_acceleration = 0.0;  ///< over all data, had nothing been known: `all` less what the known terms add
  double residual_rms = 0.0;
  std::size_t usable = 0;
};

/// Autocorrelation by lag for the sigmas: what is beyond `last_lag` is taken as 0.
std::vector<double> correlation_up_to(const std::vector<double>& residuals, int last_lag) {
  std::vector<double> rho = autocorrelation(residuals, last_lag);
  for (double& r : rho) {
    if (!std::isfinite(r)) r = 0.0;
  }
  return rho;
}

BinRegression acceleration_alone(const BinRegression& regression) {
  std::vector<BinEquation> equations = regression.equations();
  for (auto& e : equations) e.y += e.known;
  return BinRegression(std::move(equations));
}

double rms(const std::vector<double>& values) {
  double squares = 0.0, count = 0.0;
  for (double v : values) {
    if (std::isfinite(v)) squares += v * v, count += 1.0;
  }
  return count > 0.0 ? std::sqrt(squares / count) : 0.0;
}

/// Per sample, NaN where there is none: the measured acceleration, or what is left of it by the terms that are known.
std::vector<double> accelerations(const BinRegression& regression, std::size_t samples, bool less_known) {
  std::vector<double> out(samples, std::nan(""));
  for (const BinEquation& e : regression.equations()) out[e.sample] = less_known ? e.y : e.y + e.known;
  return out;
}

/// What noise as large as the measured one adds to the equations.
std::vector<double> of_noise(const BinForm& form, const Signals& signals, const SlidingBinOptions& options,
                             const BinRegression& regression) {
  const Signals noisier = with_more_noise(form.model.system->spec(), signals);
  const ReconstructedStates states = stencil_states(form, noisier, options.stencils, options.three_point_average);
  std::vector<double> out = accelerations(BinRegression(bin_equations(form, noisier, states)), signals.samples(), true);
  const std::vector<double> without = accelerations(regression, signals.samples(), true);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] -= without[i];
  return out;
}

Pass run(const BinForm& form, const Signals& signals, const SlidingBinOptions& options) {
  Pass pass;
  const ReconstructedStates states = stencil_states(form, signals, options.stencils, options.three_point_average);
  const BinRegression regression(bin_equations(form, signals, states));
  const BinLayout layout{options.width, options.step, options.minimum_samples};
  pass.usable = regression.equations().size();
  pass.bins = regression.slide(layout, {});
  if (pass.bins.bins.empty() || options.curves_only) return pass;
  const std::vector<double> residuals = regression.residuals(pass.bins.bins, options.width, signals.samples());
  const double frequency = motion_frequency(form.model, states);
  constexpr int beyond_stencil = 2 * kStencilReach + 1;
  const double half_period = frequency > 0.0 ? std::numbers::pi / frequency / usual_step(signals.t) : 0.0;
  pass.test = test_driven({signals.t, residuals, accelerations(regression, signals.samples(), false),
                           [&] { return of_noise(form, signals, options, regression); }, static_cast<int>(half_period), beyond_stencil});
  pass.residual_rms = rms(residuals);
  pass.driven = options.driven.value_or(pass.test.driven());
  const std::vector<double> rho = correlation_up_to(residuals, pass.driven ? pass.test.whiteness.last_lag : beyond_stencil - 1);
  pass.bins = regression.slide(layout, rho);
  pass.all = regression.all(rho);
  pass.damping_of_acceleration = acceleration_alone(regression).all({}).damping;
  pass.sum = telescoped_sum(form, signals, states, frequency);
  return pass;
}

/// One of the two curves that the bins give.
struct BinCurve {
  std::string name;
  double BinSolution::*value;
  double BinSolution::*sigma;
  std::vector<int> coefficients;  ///< parameters
};

BinCurve static_curve(const BinForm& form) {
  return {form.model.system->spec().static_curve, &BinSolution::value, &BinSolution::value_sigma, form.static_coefficients};
}

BinCurve damping_curve(const BinForm& form) {
  return {form.model.system->spec().damping_curve, &BinSolution::damping, &BinSolution::damping_sigma, form.damping_coefficients};
}

CurveEstimate curve(const BinForm& form, const std::vector<BinSolution>& bins, const BinCurve& which) {
  const Curve& lead = *form.model.find_curve(form.model.system->spec().static_curve);
  CurveEstimate out;
  out.name = which.name;
  out.of = lead.of;
  out.of_unit = lead.of_unit;
  out.unit = form.model.parameters[which.coefficients.front()].unit;
  for (const auto& bin : bins) {
    out.x.push_back(bin.level);
    out.value.push_back(bin.*which.value);
    out.sigma.push_back(bin.*which.sigma);
    out.count.push_back(bin.count);
  }
  return out;
}

std::string name_of(Stencils stencils) { return stencils == Stencils::fourth_order ? "fourth-order" : "second-order four-point"; }

/// The largest difference of the two passes, in the sigmas of `a`, at equal bins.
std::string largest_difference(const SlidBins& a, const SlidBins& b, const BinCurve& which) {
  double largest = 0.0, in_sigmas = 0.0;
  for (const auto& bin : a.bins) {
    const auto other = std::min_element(b.bins.begin(), b.bins.end(), [&](const auto& p, const auto& q) {
      return std::abs(p.level - bin.level) < std::abs(q.level - bin.level);
    });
    const double difference = std::abs(bin.*which.value - (*other).*which.value);
    if (difference <= largest) continue;
    largest = difference;
    in_sigmas = difference / (bin.*which.sigma);
  }
  return which.name + " by at most " + format_value(largest) + " (" + format_value(in_sigmas) + " sigma)";
}

Stencils other_stencils(Stencils stencils) {
  return stencils == Stencils::fourth_order ? Stencils::second_order_four_point : Stencils::fourth_order;
}

/// What the other stencils give.
std::string stencils_in_words(const BinForm& form, Stencils stencils, const SlidBins& bins, const SlidBins& by_others) {
  std::string text = name_of(stencils) + " stencils";
  if (by_others.bins.empty()) return text;
  const BinCurve lead = static_curve(form);
  text += "; with the " + name_of(other_stencils(stencils)) + " ones the results differ: " + largest_difference(bins, by_others, lead) +
          ", " + largest_difference(bins, by_others, damping_curve(form));
  const CurveEstimate other = curve(form, by_others.bins, lead);
  if (const auto trim = stable_zero(other)) text += ", trim " + in_display_unit(trim->value, other.of_unit, trim->sigma);
  return text;
}

void report_bins(const SlidingBinOptions& options, const Pass& pass, Fit& fit) {
  const std::string unit = fit.curves.front().of_unit;
  fit.facts["bins"] = std::to_string(pass.bins.bins.size()) + " bins of " + in_display_unit(options.width, unit) + " every " +
                      in_display_unit(options.step, unit) + " over " + std::to_string(pass.usable) +
                      " usable samples; left out: " + std::to_string(pass.bins.too_few) + " with fewer than " +
                      std::to_string(options.minimum_samples) + " samples, " + std::to_string(pass.bins.undetermined) +
                      " where level or rate do not vary";
  fit.facts["average"] = options.three_point_average ? "the channel was averaged over three samples"
                                                     : "the channel was taken as given, without a three-point average";
}

void report_damping(const BinForm& form, const Pass& pass, Fit& fit) {
  const auto& spec = form.model.system->spec();
  const std::string name = spec.damping_curve, level_unit = spec.states[form.level].unit;
  fit.facts["whiteness"] = "bins: " + in_words(pass.test);
  const std::string sum =
      "sum of acceleration times rate over " + std::to_string(pass.sum.count) + " samples: " + pass.sum.in_words(level_unit + "^2/s^3");
  fit.facts["telescoped_sum"] = sum;
  const double known = pass.all.damping - pass.damping_of_acceleration;
  fit.parameters[name + "_all_data"] = {pass.all.damping, pass.all.damping_sigma, fit.curves.back().unit};
  const std::string unit = fit.curves.back().unit;
  fit.facts["all_data"] = name + " = " + in_display_unit(pass.all.damping, unit, pass.all.damping_sigma) +
                          " by least squares over all data at once: " + in_display_unit(pass.damping_of_acceleration, unit) +
                          " from the acceleration and " + in_display_unit(known, unit) + " from the terms taken as known";
  if (fit.driven) {
    fit.warnings.push_back("the motion is driven by something this equation does not have (" + fit.facts["whiteness"] + ")");
  }
  if (!pass.sum.zero()) return;
  const std::string telescopes = sum + ". On stationary motion it telescopes to 0 by construction, whatever the truth: then the average " +
                                 name + " over all data says nothing of the damping";
  if (fit.driven) {
    mark_not_informative(form.model, name, "driven motion: the sum of acceleration times rate telescopes to zero", fit);
    fit.warnings.push_back(name + " of this method is not informative, the motion being driven: " + telescopes +
                           ", and by bins it is a third moment of the motion");
  } else if (pass.test.deterministic()) {
    fit.warnings.push_back("the bins are used, since the equation explains most of the acceleration (" + fit.facts["whiteness"] +
                           "): " + telescopes);
  } else {
    const bool tested = pass.test.tested();
    mark_not_informative(form.model, name,
                         tested ? "the equation leaves most of the acceleration unexplained"
                                : "it is not known whether the equation explains the acceleration",
                         fit);
    fit.warnings.push_back(
        name + " of this method is not informative: " + telescopes + ", and " +
        (tested ? "the equation does not explain the acceleration (" : "it is not known whether the equation explains the acceleration (") +
        fit.facts["whiteness"] + ")");
  }
}

Fit declined(const std::string& why) {
  Fit fit;
  fit.method = estimators::sliding_bin.name;
  fit.status = FitStatus::declined;
  fit.message = why;
  return fit;
}

std::string why_no_bins(const BinForm& form, const SlidingBinOptions& options, const Pass& pass) {
  const std::string channel = form.model.system->spec().outputs[form.output].name;
  if (pass.usable < options.minimum_samples) {
    return "only " + std::to_string(pass.usable) + " samples of " + channel +
           " have all the neighbours that its derivatives need; a bin needs " + std::to_string(options.minimum_samples);
  }
  if (pass.bins.too_many) {
    return channel + " runs over more than " + std::to_string(SlidBins::most) +
           " steps of the bins: an outlier in the data, or steps that are too small";
  }
  if (pass.bins.undetermined > 0) {
    return channel + " does not move enough: in no bin with " + std::to_string(options.minimum_samples) +
           " samples do its level and rate vary, or its equation has no static or damping term";
  }
  return "no bin holds " + std::to_string(options.minimum_samples) + " samples: " + channel + " has " + std::to_string(pass.usable) +
         " usable ones, spread too thinly; use wider bins";
}

}  // namespace

Fit sliding_bin(const Model& model, const Signals& signals, const SlidingBinOptions& options) {
  const Stopwatch clock;
  check(options);
  std::string why;
  const std::optional<BinForm> form = bin_form(model, signals, why);
  if (!form) return declined(why);
  const Pass pass = run(*form, signals, options);
  if (pass.bins.bins.empty()) return declined(why_no_bins(*form, options, pass));
  const auto& spec = model.system->spec();
  Fit fit;
  fit.method = estimators::sliding_bin.name;
  fit.status = FitStatus::converged;
  fit.curves = {curve(*form, pass.bins.bins, static_curve(*form)), curve(*form, pass.bins.bins, damping_curve(*form))};
  fit.curves.front().trimmed = true;
  fit.trim = stable_zero(fit.curves.front());
  fit.message = "linear regression solved in " + std::to_string(pass.bins.bins.size()) + " bins";
  if (options.curves_only) return fit;
  SlidingBinOptions with_others = options;
  with_others.stencils = other_stencils(options.stencils);
  const Pass other = run(*form, signals, with_others);
  fit.noise["equation_residual"] = {pass.residual_rms, 0.0, rate_unit(spec.states[form->rate].unit)};
  fit.driven = pass.driven;
  fit.driven_untested = !options.driven && !pass.test.tested();
  report_bins(options, pass, fit);
  fit.facts["stencils"] = stencils_in_words(*form, options.stencils, pass.bins, other.bins);
  report_damping(*form, pass, fit);
  if (!form->taken_as_known.empty()) {
    std::string names;
    for (const auto& name : form->taken_as_known) names += (names.empty() ? "" : ", ") + name;
    fit.warnings.push_back("taken as known at their present values: " + names);
  }
  fit.seconds = clock.seconds();
  return fit;
}

}  // namespace misfit
