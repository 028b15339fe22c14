#include "misfit/uncertainty/resample.h"

#include <algorithm>
#include <cmath>

#include "misfit/core/error.h"
#include "misfit/math/spectrum.h"

namespace misfit {
namespace {

constexpr std::size_t min_samples = 16;  // samples: fewer show no autocorrelation and cannot be resampled

bool counts(const Signals& s, std::size_t i) {
  if (i < s.exclude || s.held_out(i)) return false;
  return std::all_of(s.measured.begin(), s.measured.end(), [&](const Signal& channel) { return std::isfinite(channel.values[i]); });
}

const ChannelPrediction& prediction_of(const Fit& fit, const Signals& experiment, const Signal& channel) {
  for (const auto& p : fit.predictions) {
    if (p.experiment == experiment.name && p.channel == channel.name && p.t.size() == experiment.samples()) return p;
  }
  throw RunError("bootstrap: the fit of " + fit.method + " does not predict " + channel.name + " of experiment '" + experiment.name + "'");
}

/// Lag up to which series in a pool remember; `pool`: sample → value per channel.
int memory_in(const std::vector<std::vector<double>>& pool) {
  const std::ptrdiff_t n = std::ssize(pool), channels = std::ssize(pool.front());
  constexpr std::ptrdiff_t max_lag = 400;
  const std::ptrdiff_t lags = std::min(max_lag, n / 3);
  LagProducts products(lags + 1, Eigen::MatrixXd::Zero(channels, channels)), pairs = products;
  for (std::ptrdiff_t k = 0; k <= lags; ++k) {
    auto& sums = products[k];
    for (std::ptrdiff_t i = 0; i + k < n; ++i) {
      for (Eigen::Index a = 0; a < channels; ++a) {
        for (Eigen::Index b = 0; b < channels; ++b) sums(a, b) += pool[i][a] * pool[i + k][b];
      }
    }
    pairs[k].setConstant(static_cast<double>(n - k));
  }
  return correlation_length(products, pairs, 1);
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
  std::vector<double> mean(channels, 0.0);
  for (const auto& e : experiments_) {
    std::vector<const ChannelPrediction*> from;
    for (const auto& channel : e.measured) from.push_back(&prediction_of(fit, e, channel));
    auto& predicted = predicted_.emplace_back();
    for (const auto* p : from) predicted.push_back(p->predicted);
    for (std::size_t i = 0; i < e.samples(); ++i) {
      if (!counts(e, i)) continue;
      auto& here = pool_.emplace_back();
      for (std::size_t o = 0; o < channels; ++o) here.push_back(e.measured[o].values[i] - from[o]->predicted[i]);
      for (std::size_t o = 0; o < channels; ++o) mean[o] += here[o] / static_cast<double>(counted_);
    }
  }
  for (std::size_t o = 0; o < channels; ++o) {
    const auto noise = fit.noise.find(experiments_.front().measured[o].name), rms = fit.rms.find(experiments_.front().measured[o].name);
    const bool known = noise != fit.noise.end() && rms != fit.rms.end() && rms->second.value > 0.0;
    constexpr double max_factor = 1.5;
    const double factor = known ? std::clamp(noise->second.value / rms->second.value, 1.0, max_factor) : 1.0;
    for (auto& residual : pool_) residual[o] = factor * (residual[o] - mean[o]);
  }
}

void Resampler::collect_rows() {
  const std::size_t length = block_;
  for (std::size_t e = 0; e < experiments_.size(); ++e) {
    const Signals& s = experiments_[e];
    std::size_t free = 0, idle = 0;  // up to sample i: in a row not held out; since the last that counts
    for (std::size_t i = s.exclude; i < s.samples(); ++i) {
      free = s.held_out(i) ? 0 : free + 1;
      idle = counts(s, i) ? 0 : idle + 1;
      if (free >= length && idle < length) starts_.push_back({e, i + 1 - length});
    }
  }
  if (starts_.empty())
    throw RunError("bootstrap: no experiment has " + std::to_string(block_) + " samples in a row of which none is held out and any counts");
}

std::vector<Signals> Resampler::draw(std::mt19937_64& random) const {
  return what_ == Resampled::residuals ? draw_residuals(random) : draw_rows(random);
}

std::vector<Signals> Resampler::draw_residuals(std::mt19937_64& random) const {
  std::vector<Signals> out = experiments_;
  std::uniform_int_distribution<std::size_t> place(0, pool_.size() - 1);
  int left = 0;
  std::size_t at = 0;
  for (std::size_t e = 0; e < out.size(); ++e) {
    left = 0;  // blocks do not run on from one experiment into the next
    for (std::size_t i = 0; i < out[e].samples(); ++i) {
      if (left-- == 0) {
        at = place(random);
        left = block_ - 1;
      }
      for (std::size_t o = 0; o < out[e].measured.size(); ++o) {
        double& value = out[e].measured[o].values[i];
        if (std::isfinite(value) && !out[e].held_out(i)) value = predicted_[e][o][i] + pool_[at][o];
      }
      at = (at + 1) % pool_.size();
    }
  }
  return out;
}

Signals Resampler::part(const Signals& whole, std::size_t first, std::size_t last) const {
  const std::size_t from = first >= kReach ? first - kReach : 0, to = std::min(last + kReach, whole.samples());
  const auto cut = [&](const std::vector<double>& values) {
    if (values.empty()) return values;  // an input that the model does not need
    return std::vector<double>(values.begin() + static_cast<std::ptrdiff_t>(from), values.begin() + static_cast<std::ptrdiff_t>(to));
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
    for (; last < first + length && drawn < wanted; ++last) drawn += counts(whole, last) ? 1 : 0;
    left -= drawn;
    out.push_back(part(whole, first, last));
    out.back().name += " block " + std::to_string(out.size());
  }
  return out;
}

}  // namespace misfit
