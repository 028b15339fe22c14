#include "misfit/sim/planner.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <ranges>

#include "misfit/core/lists.h"
#include "misfit/core/text.h"

namespace misfit {
namespace {

constexpr std::size_t kMostExplicit = 100;  // parts of an interval before implicit ones are thought of
constexpr std::size_t kMostParts = 20000;   // of an interval at all
constexpr int kDeepest = 30;                // halvings of a part
constexpr int kDeepestLost = 12;            // the same where no step has a finite end

using State = std::array<double, kMaxStates>;

/// The largest error above the tolerance that is left.
struct Lack {
  double t = 0.0, error = 1.0;  ///< [s]; [tolerances]
  int state = 0;
};

/// Divides one interval, in halves and halves of these until the error of every part is below the tolerance.
class Division {
 public:
  Division(Stepper& stepper, const Interval& interval, const std::vector<double>& size, double tolerance)
      : stepper_(stepper), interval_(interval), size_(size), tolerance_(tolerance), length_(interval.t1 - interval.t0) {}

  /// Moves x to the end of the interval, unless its motion leaves the finite numbers.
  std::vector<StepPart> run(double* x) {
    const double pieces = std::ceil(interval_.rate * length_ / kLargestProduct);
    State start;
    std::copy_n(x, stepper_.states(), start.begin());
    if (!(pieces > static_cast<double>(kMostExplicit)) && divide_equally(std::max(pieces, 1.0), x)) return take();
    std::copy_n(start.begin(), stepper_.states(), x);
    stiff_ = true;
    most_ = kMostParts;
    static_cast<void>(divide_equally(pieces_asked_for(), x));
    return take();
  }
  [[nodiscard]] const Lack& lack() const { return lack_; }
  [[nodiscard]] double errors() const { return errors_; }  ///< sum over the parts [tolerances]

 private:
  /// A step over a part.
  struct Trial {
    State end;
    double error = 0.0;  ///< largest over the states [tolerances]
    int state = 0;
  };

  [[nodiscard]] std::vector<StepPart> take() {
    if (lost_) return {StepPart{}};
    return std::move(parts_);
  }

  /// As many as the study's own fastest_rate asks for, whatever the method.
  [[nodiscard]] double pieces_asked_for() const {
    constexpr double most = 1000.0;
    const SystemSpec& spec = stepper_.evaluator().model().system->spec();
    return spec.rate_given ? std::clamp(std::ceil(spec.fastest_rate * length_ / kLargestProduct), 1.0, most) : 1.0;
  }

  /// False if there are too many parts, or explicit steps do not end at all.
  [[nodiscard]] bool divide_equally(double pieces, double* x) {
    parts_.clear();
    lost_ = false;
    lack_ = {};
    errors_ = 0.0;
    for (double k = 0.0; k < pieces && !lost_; k += 1.0) divide(x, k / pieces, (k + 1.0) / pieces, 0);
    return !lost_ && (stiff_ || parts_.size() < most_);
  }

  Trial attempt(const double* x, double from, const StepPart& part) {
    constexpr double of_order_four = 15.0, rounding = 16.0 * std::numeric_limits<double>::epsilon();
    const int n = stepper_.states();
    Trial out;
    State halves;
    std::copy_n(x, n, out.end.begin());
    std::copy_n(x, n, halves.begin());
    const double middle = 0.5 * (from + part.to);
    if (!stepper_.advance(out.end.data(), interval_, from, part) ||
        !stepper_.advance(halves.data(), interval_, from, {middle, part.implicit}) ||
        !stepper_.advance(halves.data(), interval_, middle, part)) {
      out.error = std::numeric_limits<double>::infinity();
      return out;
    }
    for (int i = 0; i < n; ++i) {
      const double size = std::max(size_[i], std::abs(out.end[i] - x[i]));
      const double difference = std::abs(out.end[i] - halves[i]) / of_order_four;
      if (difference <= std::max(tolerance_ * size, rounding * std::abs(x[i])) * out.error) continue;
      out.error = difference / std::max(tolerance_ * size, rounding * std::abs(x[i]));
      out.state = i;
    }
    return out;
  }

  void divide(double* x, double from, double to, int depth) {
    if (lost_ || (!stiff_ && parts_.size() >= most_)) return;
    constexpr double implicit_pays = 3.0;  // from this product on: an implicit step costs as much as six explicit ones
    const double rate = stiff_ ? std::max(interval_.rate, stepper_.linearised_rate(x, interval_, from)) : 0.0;
    const double product = rate * (to - from) * length_;
    const bool last = depth >= kDeepest || parts_.size() >= most_;
    const bool implicit = product > implicit_pays;
    if (implicit || last || product <= kLargestProduct) {
      const Trial trial = attempt(x, from, {to, implicit});
      const bool finite = std::isfinite(trial.error);
      if (trial.error <= 1.0 || (last && finite)) {
        errors_ += trial.error;
        if (trial.error > lack_.error) lack_ = {interval_.t0 + from * length_, trial.error, trial.state};
        parts_.push_back({to, implicit});
        std::copy_n(trial.end.begin(), stepper_.states(), x);
        return;
      }
      lost_ = !finite && (last || (depth >= kDeepestLost && !implicit));
    }
    const double middle = 0.5 * (from + to);
    divide(x, from, middle, depth + 1);
    divide(x, middle, to, depth + 1);
  }

  Stepper& stepper_;
  Interval interval_;
  const std::vector<double>& size_;
  double tolerance_, length_;
  bool stiff_ = false, lost_ = false;
  std::size_t most_ = kMostExplicit;
  double errors_ = 0.0;
  std::vector<StepPart> parts_;
  Lack lack_;
};

/// Least size of every state that errors are measured by.
std::vector<double> least_sizes(const Model& model) {
  constexpr double share = 1e-6;
  std::vector<double> out(model.states(), share);
  for (std::size_t j = 0; j < model.state_specs.size(); ++j) out[j] = share * model.state_specs[j].scale;
  return out;
}

/// Goes from sample to sample.
class Planner {
 public:
  Planner(const Simulation& simulation, double tolerance)
      : stepper_(simulation.stepper),
        signals_(simulation.signals),
        inputs_(simulation.inputs),
        size_(least_sizes(stepper_.evaluator().model())) {
    plan_.tolerance = tolerance;
    plan_.rate.reserve(signals_.samples());
    plan_.parts.reserve(signals_.samples());
    plan_.first.reserve(signals_.samples());
    plan_.first.push_back(0);
  }

  std::vector<double>& size() { return size_; }

  void add(std::size_t i, double* x) {
    Interval interval{signals_.t[i], signals_.t[i + 1], inputs_.at(i), inputs_.at(i + 1)};
    interval.rate = stepper_.evaluator().fastest_rate(x, interval.u0, interval.t0);
    if (!std::isfinite(interval.rate)) interval.rate = 0.0;
    plan_.rate.push_back(interval.rate);
    Division division(stepper_, interval, size_, plan_.tolerance);
    const std::vector<StepPart> parts = division.run(x);
    plan_.parts.insert(plan_.parts.end(), parts.begin(), parts.end());
    plan_.first.push_back(plan_.parts.size());
    plan_.error += division.errors() * plan_.tolerance;
    if (division.lack().error > lack_.error) lack_ = division.lack();
  }

  IntegrationPlan take() {
    constexpr double worth_saying = 1e-6;  // of the range
    const double error = lack_.error * plan_.tolerance;
    if (lack_.error > 1.0 && error > worth_saying) plan_.lack = words_on(error);
    if (!plan_.parts.empty()) plan_.error /= static_cast<double>(plan_.parts.size());
    return std::move(plan_);
  }

 private:
  [[nodiscard]] std::string words_on(double error) const {
    const Model& model = stepper_.evaluator().model();
    const int own = int_size(model.state_specs);
    return "the integration is not accurate: at t = " + format_value(lack_.t) + " s the estimated error of state " +
           (lack_.state < own ? model.state_specs[lack_.state].name : model.own_state_names[lack_.state - own]) + " in one step is " +
           format_value(error) + " of its range, with " + std::to_string(kMostParts) + " steps within the sample interval";
  }

  Stepper& stepper_;
  const Signals& signals_;
  const InputTable& inputs_;
  std::vector<double> size_;
  IntegrationPlan plan_;
  Lack lack_;
};

/// Lengths of the parts of divided intervals, so that a long part beside them can be divided as well.
class Grading {
 public:
  explicit Grading(const Signals& signals) : signals_(signals) {}

  /// Every part at most twice as long as the one before it, if that is of a divided interval.
  [[nodiscard]] IntegrationPlan forwards(const IntegrationPlan& plan) {
    IntegrationPlan out = plan;
    out.parts.clear();
    out.first.assign(1, 0);
    before_ = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < plan.first.size(); ++i) {
      const double h = signals_.t[i + 1] - signals_.t[i];
      double from = 0.0;
      for (const StepPart& part : plan.of(i)) {
        divide(h, from, part, out.parts);
        from = part.to;
      }
      if (out.parts.size() - out.first.back() == 1) before_ = std::numeric_limits<double>::infinity();
      out.first.push_back(out.parts.size());
    }
    return out;
  }

 private:
  void divide(double h, double from, const StepPart& part, std::vector<StepPart>& parts) {
    constexpr double at_most = 2.0 * (1.0 + 1e-9);
    if (h * (part.to - from) > at_most * before_) {
      const double middle = 0.5 * (from + part.to);
      divide(h, from, {middle, part.implicit}, parts);
      divide(h, middle, part, parts);
      return;
    }
    before_ = h * (part.to - from);
    parts.push_back(part);
  }

  const Signals& signals_;
  double before_ = 0.0;
};

/// The same record run through from its end.
Signals times_reversed(const Signals& signals) {
  Signals out;
  for (const double t : signals.t | std::views::reverse) out.t.push_back(-t);
  return out;
}

IntegrationPlan reversed(const IntegrationPlan& plan) {
  IntegrationPlan out = plan;
  out.parts.clear();
  out.first.assign(1, 0);
  for (std::size_t i = plan.first.size() - 1; i-- > 0;) {
    const std::span<const StepPart> parts = plan.of(i);
    for (std::size_t k = parts.size(); k-- > 0;) out.parts.push_back({k > 0 ? 1.0 - parts[k - 1].to : 1.0, parts[k].implicit});
    out.first.push_back(out.parts.size());
  }
  return out;
}

IntegrationPlan graded(const Signals& signals, const IntegrationPlan& plan) {
  if (plan.parts.size() + 1 == plan.first.size()) return plan;  // nothing is divided
  const Signals backwards = times_reversed(signals);
  return reversed(Grading(backwards).forwards(reversed(Grading(signals).forwards(plan))));
}

}  // namespace

IntegrationPlan plan_along(const Simulation& simulation, const RowMatrix& states, double tolerance) {
  const auto& [stepper, signals, inputs] = simulation;
  Planner planner(simulation, tolerance);
  for (Eigen::Index j = 0; j < states.cols(); ++j) {
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const double value : states.col(j)) {
      if (!std::isfinite(value)) continue;
      least = std::min(least, value);
      most = std::max(most, value);
    }
    double& size = planner.size()[j];
    size = std::max(size, most - least);
  }
  State x{};
  for (std::size_t i = 0; i + 1 < signals.samples(); ++i) {
    const auto row = states.row(std::min<Eigen::Index>(i, states.rows() - 1));
    if (row.allFinite()) std::copy_n(row.data(), stepper.states(), x.begin());
    planner.add(i, x.data());
  }
  return graded(signals, planner.take());
}

IntegrationPlan plan_run(const Simulation& simulation, const double* x0, double tolerance) {
  const auto& [stepper, signals, inputs] = simulation;
  Planner planner(simulation, tolerance);
  State x{};
  std::copy_n(x0, stepper.states(), x.begin());
  for (std::size_t i = 0; i + 1 < signals.samples(); ++i) {
    for (std::size_t j = 0; j < planner.size().size(); ++j) planner.size()[j] = std::max(planner.size()[j], std::abs(x[j]));
    planner.add(i, x.data());
  }
  return planner.take();
}

std::vector<StepPart> plan_interval(Stepper& stepper, const Interval& interval, const double* x, double tolerance) {
  std::vector<double> size = least_sizes(stepper.evaluator().model());
  for (std::size_t j = 0; j < size.size(); ++j) size[j] = std::max(size[j], std::abs(x[j]));
  State end{};
  std::copy_n(x, stepper.states(), end.begin());
  return Division(stepper, interval, size, tolerance).run(end.data());
}

}  // namespace misfit
