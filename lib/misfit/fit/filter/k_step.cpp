#include "misfit/fit/filter/k_step.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "misfit/core/text.h"
#include "misfit/data/ladder.h"
#include "misfit/fit/filter/filter_run.h"
#include "misfit/fit/filter/settled.h"

namespace misfit {
namespace {

constexpr std::size_t lengths = std::size(kLadderSteps);

/// Squared errors per channel and length, and runs per length.
struct Errors {
  std::vector<std::vector<double>> squares, counts;
  std::vector<std::size_t> runs = std::vector<std::size_t>(lengths, 0), diverged = runs;
  ComparedSamples compared;
  Errors(std::size_t channels, ComparedSamples which)
      : squares(channels, std::vector<double>(lengths, 0.0)), counts(squares), compared(which) {}

  [[nodiscard]] bool has(SampleRole role) const {
    return (role == SampleRole::counted && compared != ComparedSamples::held_out) ||
           (role == SampleRole::validation && compared != ComparedSamples::counted);
  }
};

/// The run of the filter over one experiment with the covariances of its states; that of the estimate, without them, where it fails.
FilterTrace run_with_covariances(const FilterEstimate& estimate, std::size_t experiment) {
  FilterRunner runner(estimate.forced, false);
  runner.set_parameters(estimate.forced.model.values());
  FilterTrace trace;
  if (!runner.run(estimate.data[experiment], estimate.noise, trace, {.keep_P = true})) trace = estimate.traces[experiment];
  return trace;
}

/// Free runs of one experiment: from the filtered states as far as the longest length, where that state is settled (settled.h).
class FreeRuns {
 public:
  /// From every `stride`-th sample.
  FreeRuns(Stepper& stepper, const FilterEstimate& estimate, std::size_t experiment, std::size_t stride)
      : stride_(stride),
        stepper_(stepper),
        data_(estimate.data[experiment]),
        trace_(estimate.traces[experiment]),
        predictions_(trace_, data_),
        with_covariances_(run_with_covariances(estimate, experiment)),
        ahead_(with_covariances_, data_.first, stride),
        signals_(*data_.signals) {}

  /// `visit(length, k, y)`: the outputs at sample k, kLadderSteps[length] after the start, as the run has
  /// them, NaN of one that is not settled there; nullptr: it has diverged, or nothing can be read from its state.
  template <class Visit>
  void run(Visit&& visit) {
    prepare_at(along(), data_.first, data_.start.data());
    for (std::size_t k = data_.first; k + 1 < signals_.samples(); k += stride_) {
      if (predictions_.all_settled(k + 1)) run_from(k, visit);
    }
  }

 private:
  [[nodiscard]] Simulation along() { return Simulation{stepper_, signals_, data_.inputs}; }

  template <class Visit>
  void run_from(std::size_t k, Visit& visit) {
    Eigen::VectorXd x = trace_.filtered(k);
    std::array<double, kMaxSensorPorts> y{};
    std::size_t next = 0;
    bool finite = true;
    for (std::size_t j = 1; next < lengths && k + j < signals_.samples(); ++j) {
      finite = finite && stepper_.step(x.data(), interval_after(along(), k + j - 1));
      if (static_cast<int>(j) != kLadderSteps[next]) continue;
      finite = finite && predict_at(along(), k + j, x.data(), y.data());
      for (std::size_t o = 0; o < signals_.measured.size(); ++o) {
        if (!ahead_.settled(k, next, o)) y[o] = std::nan("");
      }
      visit(next++, k + j, finite ? y.data() : nullptr);
    }
  }

  std::size_t stride_;
  Stepper& stepper_;
  const FilterData& data_;
  const FilterTrace& trace_;
  SettledPredictions predictions_;
  const FilterTrace with_covariances_;
  const SettledAhead ahead_;
  const Signals& signals_;
};

void add_errors(const FilterEstimate& estimate, std::size_t experiment, Stepper& stepper, Errors& errors) {
  constexpr std::size_t stride = 3;  // neighbours say the same
  const FilterData& data = estimate.data[experiment];
  FreeRuns(stepper, estimate, experiment, stride).run([&](std::size_t length, std::size_t k, const double* y) {
    ++errors.runs[length];
    errors.diverged[length] += y != nullptr ? 0U : 1U;
    if (y == nullptr) return;
    for (std::size_t o = 0; o < errors.squares.size(); ++o) {
      if (!errors.has(data.use[k * errors.squares.size() + o]) || std::isnan(y[o])) continue;
      errors.squares[o][length] += std::pow(data.signals->measured[o].values[k] - y[o], 2);
      errors.counts[o][length] += 1.0;
    }
  });
}

constexpr double most_lost = 0.03;  // share of the runs

bool too_few(const Errors& errors, std::size_t length) {
  return static_cast<double>(errors.diverged[length]) > most_lost * static_cast<double>(errors.runs[length]);
}

std::string words_on(const Errors& errors) {
  std::string out;
  for (std::size_t l = 0; l < lengths; ++l) {
    if (errors.diverged[l] == 0) continue;
    out += out.empty() ? "" : "; ";
    out += fmt::format("{} of {} predictions diverge within {}: ", errors.diverged[l], errors.runs[l],
                       counted(static_cast<std::size_t>(kLadderSteps[l]), "sample", "samples"));
    out += too_few(errors, l) ? "no error is given there" : "they are not in its error";
  }
  return out;
}

}  // namespace

KStepErrors k_step_errors(const FilterEstimate& estimate, ComparedSamples compared) {
  const auto& outputs = estimate.model.system->spec().outputs;
  const Model fixed = all_fixed(estimate.forced.model);
  Stepper stepper(fixed);
  Errors errors(outputs.size(), compared);
  for (std::size_t e = 0; e < estimate.data.size(); ++e) add_errors(estimate, e, stepper, errors);
  KStepErrors out;
  for (std::size_t o = 0; o < outputs.size(); ++o) {
    for (std::size_t l = 0; l < lengths; ++l) {
      const double count = errors.counts[o][l];
      const bool known = count > 0.0 && !too_few(errors, l);
      out.rms[outputs[o].name].push_back(known ? std::sqrt(errors.squares[o][l] / count) : std::nan(""));
    }
  }
  out.words = words_on(errors);
  out.runs = std::move(errors.runs);
  out.diverged = std::move(errors.diverged);
  return out;
}

std::vector<std::vector<double>> predictions_far_ahead(const FilterEstimate& estimate, std::size_t experiment) {
  constexpr std::size_t most_runs = 1000;  // for a picture: every fit makes them, those of a resampling too
  const FilterData& data = estimate.data[experiment];
  const Model fixed = all_fixed(estimate.forced.model);
  Stepper stepper(fixed);
  const std::size_t samples = data.signals->samples();
  std::vector<std::vector<double>> out(data.signals->measured.size(), std::vector<double>(samples, std::nan("")));
  FreeRuns(stepper, estimate, experiment, 1 + samples / most_runs).run([&](std::size_t length, std::size_t k, const double* y) {
    if (length + 1 < lengths || y == nullptr) return;
    for (std::size_t o = 0; o < out.size(); ++o) out[o][k] = y[o];
  });
  return out;
}

double growth_of_errors(const std::map<std::string, std::vector<double>>& before, const std::map<std::string, std::vector<double>>& after) {
  double squares = 0.0, channels = 0.0;
  for (const auto& [name, errors] : before) {
    const auto others = after.find(name);
    if (others == after.end() || others->second.size() != errors.size()) continue;
    const auto last = std::find_if(errors.rbegin(), errors.rend(), [](double e) { return e > 0.0 && std::isfinite(e); });
    if (last == errors.rend()) continue;
    const double there = others->second[static_cast<std::size_t>(errors.rend() - last) - 1];
    if (!std::isfinite(there)) return std::numeric_limits<double>::infinity();
    squares += std::pow(there / *last, 2);
    channels += 1.0;
  }
  return channels > 0.0 ? std::sqrt(squares / channels) : 1.0;
}

std::string growth_in_words(double growth) {
  constexpr double too_much_to_say = 10.0;
  const std::string much =
      growth > too_much_to_say ? "to more than ten times what they were" : fmt::format("by {:.0f} %", 100.0 * (growth - 1.0));
  return "predictions farther ahead get worse: their RMS errors grow " + much;
}

}  // namespace misfit
