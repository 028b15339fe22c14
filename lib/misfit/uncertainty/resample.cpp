#include "misfit/uncertainty/resample.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "misfit/core/error.h"
#include "misfit/math/spectrum.h"

namespace misfit {
namespace {

constexpr std::size_t min_samples = 16;  // samples: fewer show no autocorrelation and cannot be resampled

/// Any channel is measured there, and may be drawn anew.
bool measured(const Signals& s, std::size_t i) {
  if (s.held_out(i)) return false;
  return std::any_of(s.measured.begin(), s.measured.end(), [&](const Signal& channel) { return std::isfinite(channel.values[i]); });
}

bool counts(const Signals& s, std::size_t i) { return i >= s.exclude && measured(s, i); }

const ChannelPrediction& prediction_of(const Fit& fit, const Signals& experiment, const Signal& channel) {
  for (const auto& p : fit.predictions) {
    if (p.experiment == experiment.name && p.channel == channel.name && p.t.size() == experiment.samples()) return p;
  }
  throw RunError("bootstrap: the fit of " + fit.method + " does not predict " + channel.name + " of experiment '" + experiment.name + "'");
}

/// Lag up to which series in a pool remember; `pool`: sample → value per channel, NaN where it is not known.
int memory_in(const std::vector<std::vector<double>>& pool) {
  const std::ptrdiff_t n = std::ssize(pool), channels = std::ssize(pool.front());
  Eigen::MatrixXd values = Eigen::MatrixXd::Zero(n, channels), known = values;
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    for (Eigen::Index o = 0; o < channels; ++o) {
      if (!std::isfinite(pool[i][o])) continue;
      values(i, o) = pool[i][o];
      known(i, o) = 1.0;
    }
  }
  constexpr std::ptrdiff_t max_lag = 400;
  const std::ptrdiff_t lags = std::min(max_lag, n / 3);
  LagProducts products, pairs;
  for (std::ptrdiff_t k = 0; k <= lags; ++k) {
    products.emplace_back(values.topRows(n - k).transpose() * values.bottomRows(n - k));
    pairs.emplace_back(known.topRows(n - k).transpose() * known.bottomRows(n - k));
  }
  return correlation_length(products, pairs, 1);
}

/// Samples at which all of these channels are known.
std::vector<std::size_t> known_in(const std::vector<std::vector<double>>& pool, const std::vector<std::size_t>& channels) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < pool.size(); ++i) {
    if (std::all_of(channels.begin(), channels.end(), [&](std::size_t o) { return std::isfinite(pool[i][o]); })) out.push_back(i);
  }
  return out;
}

}  // namespace

Resampler::Resampler(Resampled what, const Fit& fit, const std::vector<Signals>& experiments, const BlockLength& length)
    : what_(what), experiments_(experiments) {
  if (length.samples < 0)
    throw InputError("bootstrap: a block of " + std::to_string(length.samples) + " samples; it must be at least 1, or 0 to be chosen");
  for (const auto& e : experiments) {
    for (std::size_t i = 0; i < e.samples(); ++i) counted_ += counts(e, i) ? 1 : 0;
  }
  if (counted_ < min_samples)
    throw RunError("bootstrap: only " + std::to_string(counted_) + " samples count; at least " + std::to_string(min_samples) +
                   " are needed");
  if (what_ == Resampled::residuals || !fit.predictions.empty()) {
    collect_residuals(fit);
  } else {
    collect_equations(length.equations);
  }
  choose_length(length);
  if (what_ == Resampled::rows) collect_rows();
}

void Resampler::choose_length(const BlockLength& length) {
  const auto root = static_cast<int>(std::ceil(std::cbrt(static_cast<double>(counted_))));
  int wanted = length.samples;
  if (wanted == 0) {
    constexpr int memories_per_block = 5, extra_for_rows = 50;
    wanted = std::max(pool_.size() < min_samples ? root : memories_per_block * memory_in(pool_), root);
    if (what_ == Resampled::rows) wanted += extra_for_rows;
  }
  block_ = std::min(wanted, std::max(1, static_cast<int>(counted_ / 8)));
  if (block_ == wanted) return;
  note_ = (length.samples > 0 ? "the study asks for blocks of " : "the residual autocorrelation asks for blocks of ") +
          std::to_string(wanted) + " samples; they are cut to " + std::to_string(block_) + ", an eighth of the " +
          std::to_string(counted_) + " that count: with longer ones too few differ" +
          (length.samples > 0 ? "" : ", and with these the scatter may come out too small");
}

void Resampler::collect_equations(const EquationResiduals& equations) {
  for (const auto& rows : equations) {
    for (std::size_t i = 0; !rows.empty() && i < rows.front().size(); ++i) {
      std::vector<double> here;
      for (const auto& row : rows) here.push_back(row[i]);
      if (std::all_of(here.begin(), here.end(), [](double v) { return std::isfinite(v); })) pool_.push_back(std::move(here));
    }
  }
}

void Resampler::collect_residuals(const Fit& fit) {
  const std::size_t channels = experiments_.front().measured.size();
  std::vector<double> sum(channels, 0.0), known(channels, 0.0);
  for (const auto& e : experiments_) {
    std::vector<const ChannelPrediction*> from;
    for (const auto& channel : e.measured) from.push_back(&prediction_of(fit, e, channel));
    auto& predicted = predicted_.emplace_back();
    for (const auto* p : from) predicted.push_back(p->predicted);
    for (std::size_t i = 0; i < e.samples(); ++i) {
      if (!counts(e, i)) continue;
      auto& here = pool_.emplace_back();
      for (std::size_t o = 0; o < channels; ++o) {
        here.push_back(e.measured[o].values[i] - from[o]->predicted[i]);
        if (std::isfinite(here[o])) sum[o] += here[o], known[o] += 1.0;
      }
    }
  }
  for (std::size_t o = 0; o < channels; ++o) {
    const auto noise = fit.noise.find(experiments_.front().measured[o].name), rms = fit.rms.find(experiments_.front().measured[o].name);
    const bool known_sizes = noise != fit.noise.end() && rms != fit.rms.end() && rms->second.value > 0.0;
    constexpr double max_factor = 1.5;
    const double factor = known_sizes ? std::clamp(noise->second.value / rms->second.value, 1.0, max_factor) : 1.0;
    for (auto& residual : pool_) residual[o] = factor * (residual[o] - sum[o] / known[o]);
  }
  group_channels(channels);
}

void Resampler::group_channels(std::size_t channels) {
  std::vector<std::size_t> all(channels);
  std::iota(all.begin(), all.end(), std::size_t{0});
  std::vector<std::size_t> known = known_in(pool_, all);
  constexpr double together = 0.9;  // of the samples: else blocks of those would be of other lengths in time than in a channel
  if (static_cast<double>(known.size()) >= together * static_cast<double>(pool_.size())) {
    groups_.push_back({std::move(all), std::move(known)});
    return;
  }
  for (const std::size_t o : all) {
    known = known_in(pool_, {o});
    if (!known.empty()) groups_.push_back({{o}, known});
  }
}

void Resampler::collect_rows() {
  const std::size_t length = block_;
  for (std::size_t e = 0; e < experiments_.size(); ++e) {
    const Signals& s = experiments_[e];
    std::vector<std::size_t> counted;  // since the last row that is held out
    for (std::size_t i = s.exclude; i < s.samples(); ++i) {
      if (s.held_out(i)) counted.clear();
      if (!counts(s, i)) continue;
      counted.push_back(i);
      if (counted.size() >= length) starts_.push_back({e, counted[counted.size() - length]});
    }
  }
  if (starts_.empty())
    throw RunError("bootstrap: no experiment has " + std::to_string(block_) + " samples that count without one between that is held out");
}

std::vector<Signals> Resampler::draw(std::mt19937_64& random) const {
  return what_ == Resampled::residuals ? draw_residuals(random) : draw_rows(random);
}

std::vector<Signals> Resampler::draw_residuals(std::mt19937_64& random) const {
  std::vector<Signals> out = experiments_;
  std::uniform_int_distribution<std::size_t> place(0, pool_.size() - 1);
  for (std::size_t e = 0; e < out.size(); ++e) {
    int left = 0;  // blocks do not run on from one experiment into the next
    std::vector<std::size_t> at(groups_.size(), 0);
    for (std::size_t i = 0; i < out[e].samples(); ++i) {
      if (!measured(out[e], i)) continue;
      if (left-- == 0) {
        const std::size_t start = place(random);
        for (std::size_t g = 0; g < at.size(); ++g) at[g] = groups_[g].first_from(start);
        left = block_ - 1;
      }
      for (std::size_t g = 0; g < at.size(); ++g) at[g] = draw_group(groups_[g], at[g], {e, i}, out[e]);
    }
  }
  return out;
}

std::size_t Resampler::draw_group(const Group& group, std::size_t at, const Place& place, Signals& out) const {
  const auto& residuals = pool_[group.known[at]];
  bool drawn = false;
  for (const std::size_t o : group.channels) {
    double& value = out.measured[o].values[place.sample];
    if (!std::isfinite(value)) continue;
    value = predicted_[place.experiment][o][place.sample] + residuals[o];
    drawn = true;
  }
  return drawn ? (at + 1) % group.known.size() : at;
}

std::size_t Resampler::Group::first_from(std::size_t sample) const {
  const auto found = std::lower_bound(known.begin(), known.end(), sample);
  return found == known.end() ? 0 : found - known.begin();
}

Signals Resampler::part(const Signals& whole, std::size_t first, std::size_t last) const {
  const std::size_t from = first >= kReach ? first - kReach : 0, to = std::min(last + kReach, whole.samples());
  const auto cut = [&](const std::vector<double>& values) {
    if (values.empty()) return values;  // an input that the model does not need
    return std::vector<double>(values.begin() + from, values.begin() + to);
  };
  Signals out;
  out.name = whole.name;
  out.t = cut(whole.t);
  for (const auto& s : whole.measured) out.measured.push_back({s.name, s.unit, cut(s.values), s.sigma});
  for (const auto& s : whole.inputs) out.inputs.push_back({s.name, s.unit, cut(s.values), s.sigma});
  out.exclude = first - from;
  if (last < to) out.validation_from = whole.t[last];
  return out;
}

std::vector<Signals> Resampler::draw_rows(std::mt19937_64& random) const {
  std::vector<Signals> out;
  std::uniform_int_distribution<std::size_t> place(0, starts_.size() - 1);
  const std::size_t length = block_;
  for (std::size_t left = counted_; left > 0;) {
    const std::size_t wanted = left >= 2 * length ? length : left > length ? (left + 1) / 2 : left;
    const auto [experiment, first] = starts_[place(random)];
    const Signals& whole = experiments_[experiment];
    std::size_t last = first, drawn = 0;
    for (; drawn < wanted; ++last) drawn += counts(whole, last) ? 1 : 0;
    left -= drawn;
    out.push_back(part(whole, first, last));
    out.back().name += " block " + std::to_string(out.size());
  }
  return out;
}

}  // namespace misfit
