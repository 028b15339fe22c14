#include "misfit/discover/operating_range.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

#include "misfit/core/lists.h"
#include "misfit/math/statistics.h"
#include "misfit/model/evaluator.h"

namespace misfit {
namespace {

std::optional<OperatingRange::Range> range_of(std::vector<double> values) {
  std::erase_if(values, [](double v) { return !std::isfinite(v); });
  if (values.size() < 2) return std::nullopt;
  std::sort(values.begin(), values.end());
  const std::size_t cut = values.size() / 200;
  const OperatingRange::Range range{values[cut], values[values.size() - 1 - cut]};
  if (!(range.high > range.low)) return std::nullopt;
  return range;
}

/// What ScanSpec::over says: of which role, and what of it.
struct ScannedSize {
  enum class Kind { range, largest, half_range, nearest_zero, per_step } kind = Kind::range;
  std::string_view role;
};
ScannedSize scanned_size(const ScanSpec& scan) {
  const std::string_view over = scan.over;
  constexpr std::string_view per_step = "|/step";
  if (over.starts_with('|') && over.ends_with(per_step))
    return {ScannedSize::Kind::per_step, over.substr(1, over.size() - 1 - per_step.size())};
  if (over.size() > 2 && over.starts_with('|') && over.ends_with('|')) return {ScannedSize::Kind::largest, over.substr(1, over.size() - 2)};
  if (over.starts_with("+-")) return {ScannedSize::Kind::half_range, over.substr(2)};
  if (over.starts_with("0 ")) return {ScannedSize::Kind::nearest_zero, over.substr(2)};
  return {ScannedSize::Kind::range, over};
}

/// Index of the quantity that ScanSpec::over names, −1 if it names none.
int scanned_quantity(const BoundEffect& effect, const ScanSpec& scan) {
  const std::string_view role = scanned_size(scan).role;
  const auto& quantities = effect.effect->spec().quantities;
  const auto found = std::find_if(quantities.begin(), quantities.end(), [&](const Role& r) { return role == r.name; });
  return found == quantities.end() ? -1 : effect.quantities[found - quantities.begin()];
}

/// What the numbers of a scan are shares of.
double unit_of_scan(const ScannedSize& size, const OperatingRange::Range& range, double step) {
  const double width = range.high - range.low, largest = std::max(std::abs(range.low), std::abs(range.high));
  if (size.kind == ScannedSize::Kind::per_step) return step > 0.0 ? largest / step : largest;
  if (size.kind == ScannedSize::Kind::nearest_zero) return std::clamp(0.0, range.low, range.high);
  if (size.kind == ScannedSize::Kind::half_range) return 0.5 * width;
  return size.kind == ScannedSize::Kind::largest ? largest : width;
}

/// Samples per second where none is missing. Of many samples: times printed with few digits have no exact interval.
double sampling_rate(const std::vector<double>& steps, double usual) {
  constexpr double missing = 1.5;  // usual steps
  double time = 0.0, count = 0.0;
  for (const double h : steps) {
    if (h > missing * usual) continue;
    time += h;
    count += 1.0;
  }
  return count / time;
}

/// Usual sigma of each quantity one step ahead: of g x, x the predicted state with its covariance P and g the quantity's slope.
std::vector<double> sigmas_of_quantities(const FilterEstimate& estimate) {
  constexpr std::size_t samples = 100;  // of each experiment
  const System& system = *estimate.model.system;
  const std::size_t count = system.spec().quantities.size();
  const Eigen::Index states = estimate.model.system_states();
  const std::vector<double> parameters = estimate.forced.model.values(), no_ports(system.spec().quantity_ports.size() + 1, 0.0);
  FilterRunner runner(estimate.forced, false);
  runner.set_parameters(parameters);
  std::vector<std::vector<double>> sigmas(count);
  std::vector<double> q(count);
  RowMatrix slope(static_cast<Eigen::Index>(count), states);
  for (const FilterData& data : estimate.data) {
    FilterTrace trace;
    if (!runner.run(data, estimate.noise, trace, {.keep_P = true})) continue;
    const Eigen::Index n = trace.n, columns = n + 2 * Eigen::Index{trace.ny};
    const std::size_t stride = std::max<std::size_t>((trace.samples - data.first) / samples, 1);
    for (std::size_t k = data.first; k < trace.samples; k += stride) {
      const Point at{trace.predicted_at(k).data(), data.inputs.at(k).values, data.signals->t[k], parameters.data(), no_ports.data()};
      system.linearise_quantities(at, ~std::uint64_t{0}, q.data(), {slope.data(), nullptr, nullptr});
      const Eigen::Map<const RowMatrix> P(trace.P.data() + k * n * columns, n, columns);
      const Eigen::VectorXd variance = (slope * P.topLeftCorner(states, states) * slope.transpose()).diagonal();
      for (std::size_t j = 0; j < count; ++j) sigmas[j].push_back(std::sqrt(std::max(variance[j], 0.0)));
    }
  }
  std::vector<double> out;
  for (auto& list : sigmas) out.push_back(list.empty() ? 0.0 : median(list));
  return out;
}

}  // namespace

bool is_hardly_seen_between_samples(const CoefficientSpec& c) { return c.fixed && std::string_view(c.scan.over) == "step"; }

bool is_of_a_rate(const ScanSpec& scan) { return scanned_size(scan).kind == ScannedSize::Kind::per_step; }

OperatingRange::Digits OperatingRange::digits_of(const std::vector<double>& measured) {
  const double step = resolution_of(measured);
  if (!(step > 0.0)) return {};
  constexpr double printed = 1e-3;  // of a step: what is lost of a level where values are printed with few digits
  const double level = std::remainder(measured.front(), step);
  return {step, std::abs(level) < printed * step ? 0.0 : level};
}

OperatingRange::OperatingRange(const FilterEstimate& estimate) : estimate_(estimate) {
  const SystemSpec& system = estimate.model.system->spec();
  Evaluator evaluator(estimate.forced.model);
  const std::size_t count = system.quantities.size();
  std::vector<std::vector<double>> values(count + system.outputs.size());
  std::vector<double> q(count), steps;
  for (std::size_t e = 0; e < estimate.traces.size(); ++e) {
    const FilterTrace& trace = estimate.traces[e];
    const FilterData& data = estimate.data[e];
    for (std::size_t k = data.first; k < trace.samples; ++k) {
      evaluator.quantities(trace.filtered(k).data(), data.inputs.at(k), data.signals->t[k], q.data());
      for (std::size_t i = 0; i < count; ++i) values[i].push_back(q[i]);
      if (k > data.first) steps.push_back(data.signals->t[k] - data.signals->t[k - 1]);
    }
    for (std::size_t o = 0; o < system.outputs.size(); ++o) {
      for (const Signal& channel : data.signals->measured) {
        if (channel.name == system.outputs[o].name)
          values[count + o].insert(values[count + o].end(), channel.values.begin(), channel.values.end());
      }
    }
  }
  for (std::size_t o = count; o < values.size(); ++o) {
    std::erase_if(values[o], [](double v) { return !std::isfinite(v); });
    digits_.push_back(digits_of(values[o]));
  }
  for (auto& list : values) ranges_.push_back(range_of(std::move(list)));
  if (steps.empty()) return;
  const auto middle = steps.begin() + steps.size() / 2;
  std::nth_element(steps.begin(), middle, steps.end());
  step_ = *middle;
  rate_ = sampling_rate(steps, step_);
}

std::optional<OperatingRange::Range> OperatingRange::range(int quantity) const {
  const std::size_t i = quantity;
  return quantity < 0 || i >= ranges_.size() ? std::nullopt : ranges_[i];
}

double OperatingRange::narrowest(int quantity) const {
  if (sigmas_.empty()) sigmas_ = sigmas_of_quantities(estimate_);
  const std::size_t i = quantity;
  return quantity < 0 || i >= sigmas_.size() || !std::isfinite(sigmas_[i]) ? 0.0 : std::sqrt(0.5 * std::numbers::pi) * sigmas_[i];
}

std::optional<OperatingRange::Range> OperatingRange::range_of_edge(const BoundEffect& effect, std::size_t coefficient) const {
  const CoefficientSpec& c = effect.effect->spec().coefficients[coefficient];
  if (c.fixed && c.scan.count == 1) return std::nullopt;  // from where something is counted: the effect goes on beyond it
  const ScanSpec& scan = c.scan;
  return scanned_size(scan).kind == ScannedSize::Kind::range && !scan.is_frequency() ? range(scanned_quantity(effect, scan)) : std::nullopt;
}

std::optional<OperatingRange::Range> OperatingRange::range_of_wave(const BoundEffect& effect, std::size_t coefficient) const {
  const ScanSpec& scan = effect.effect->spec().coefficients[coefficient].scan;
  return scan.is_frequency() ? range(scanned_quantity(effect, scan)) : std::nullopt;
}

namespace {

/// Of the shortest such time that is looked for. Shorter ones look alike, and take ever more steps of integration.
constexpr double share_of_shortest = 0.2;

}  // namespace

double OperatingRange::lower_bound(const BoundEffect& effect, std::size_t coefficient) const {
  const EffectSpec& spec = effect.effect->spec();
  const CoefficientSpec& c = spec.coefficients[coefficient];
  if (is_hardly_seen_between_samples(c)) return std::clamp(share_of_shortest * c.scan.from * step_, c.lower, c.upper);
  if (!c.scan.smooths) return c.lower;
  const int quantity = scanned_quantity(effect, c.scan);
  return std::clamp(narrowest(quantity), c.lower, c.upper);
}

std::optional<double> OperatingRange::of_measurements(const BoundEffect& effect, OfMeasurements what) const {
  if (what == OfMeasurements::none || effect.kind != PortKind::sensor) return std::nullopt;
  const std::size_t output = effect.ports.front();
  if (output >= digits_.size() || !(digits_[output].step > 0.0)) return std::nullopt;
  return what == OfMeasurements::step ? digits_[output].step : digits_[output].level;
}

std::vector<double> OperatingRange::grid(const BoundEffect& effect, std::size_t coefficient) const {
  const EffectSpec& spec = effect.effect->spec();
  const CoefficientSpec& c = spec.coefficients[coefficient];
  if (const auto measured = of_measurements(effect, c.measured_as)) return {std::clamp(*measured, c.lower, c.upper)};
  const std::string_view over = c.scan.over;
  const bool of_samples = over == "step" || over == "1/step", size = scanned_size(c.scan).kind != ScannedSize::Kind::range;
  double origin = 0.0, unit = 1.0;
  if (of_samples) {
    unit = over == "step" ? step_ : rate_;
  } else if (!over.empty()) {
    const auto range = this->range(scanned_quantity(effect, c.scan));
    if (!range) return {c.value};
    origin = size ? 0.0 : range->low;
    unit = unit_of_scan(scanned_size(c.scan), *range, step_);
  }
  const bool large = c.scan.most_states > 0 && int_size(estimate_.model.system->spec().states) > c.scan.most_states;
  const int count = large ? 1 : c.scan.count;
  std::vector<double> out;
  for (int i = 0; i < count; ++i) {
    const int steps = std::max(c.scan.count - 1, 1);
    const double share = size || of_samples ? c.scan.from * std::pow(c.scan.to / c.scan.from, static_cast<double>(i) / steps)
                                            : c.scan.from + (c.scan.to - c.scan.from) * i / steps;
    out.push_back(std::clamp(origin + unit * share, lower_bound(effect, coefficient), c.upper));
  }
  return out;
}

}  // namespace misfit
