#include "misfit/page/held_out.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "misfit/core/display.h"

namespace misfit::page {
namespace {

bool is_held_out(const Times& times, double t) {
  return std::any_of(times.begin(), times.end(), [&](const auto& part) { return t >= part[0] && t <= part[1]; });
}

/// Samples under each hat, and those of them that are held out.
struct Counts {
  std::vector<double> all, held_out;
};

/// A sample counts under the two hats between which it lies, by its distance from them.
void add_sample(double value, bool held_out, const std::vector<double>& places, Counts& counts) {
  if (value < places.front() || value > places.back()) return;  // beyond the map
  const auto above = std::upper_bound(places.begin(), places.end(), value);
  const auto right = std::clamp(above - places.begin(), std::ptrdiff_t{1}, std::ssize(places) - 1), left = right - 1;
  const double share = std::clamp((value - places[left]) / (places[right] - places[left]), 0.0, 1.0);
  for (const auto& [place, part] : {std::pair{left, 1.0 - share}, {right, share}}) {
    counts.all[place] += part;
    if (held_out) counts.held_out[place] += part;
  }
}

/// Over which samples the map is; nullptr: the experiment does not have the quantity.
const std::vector<double>* values_of(const MissingForce& missing, const std::string& quantity) {
  const auto found = std::find(missing.quantities.begin(), missing.quantities.end(), quantity);
  if (found != missing.quantities.end()) return &missing.values[found - missing.quantities.begin()];
  return quantity == "time" ? &missing.t : nullptr;
}

/// The part of a band that stands at the given of its places, three rows each.
report::Series part_of(const report::Series& band, const std::vector<std::size_t>& places) {
  report::Series out = band;
  out.x.clear(), out.lo.clear(), out.hi.clear();
  for (const std::size_t k : places) {
    for (std::size_t row = 3 * k; row < 3 * k + 3 && row < band.x.size(); ++row) {
      out.x.push_back(band.x[row]);
      out.lo.push_back(band.lo[row]);
      out.hi.push_back(band.hi[row]);
    }
  }
  return out;
}

constexpr double half = 0.5;

/// The band of the places without an estimate as two bands, each with its reason.
void split_gaps(const ForceMap& map, const std::vector<double>& shares, report::Panel& panel) {
  const auto found = std::find_if(panel.series.begin(), panel.series.end(), [](const auto& s) { return s.key == "no_estimate"; });
  if (found == panel.series.end()) return;
  std::vector<std::size_t> held_out, few;
  for (std::size_t k = 0, gap = 0; k < map.x.size(); ++k) {
    if (map.sigma[k] > 0.0) continue;
    (shares[k] > half ? held_out : few).push_back(gap++);
  }
  const report::Series band = *found;
  std::vector<report::Series> parts;
  for (const auto& [places, key, why] :
       {std::tuple{&held_out, "no_estimate_held_out", "no estimate: held out"}, {&few, "no_estimate", "no estimate: too few samples"}}) {
    if (places->empty()) continue;
    parts.push_back(part_of(band, *places));
    parts.back().key = key;
    parts.back().legend = why;
  }
  const auto at = panel.series.erase(found);
  panel.series.insert(at, parts.begin(), parts.end());
}

/// Over the boxes of all samples those of the held out ones.
void add_held_out_counts(const std::vector<double>& shares, report::Panel& counts) {
  if (counts.series.empty() || std::none_of(shares.begin(), shares.end(), [](double share) { return share > 0.0; })) return;
  report::Series held_out = counts.series.front();
  if (held_out.y.size() != shares.size()) return;
  for (std::size_t k = 0; k < shares.size(); ++k) held_out.y[k] *= shares[k];
  counts.series.front().legend = "all";
  held_out.key = "held_out";
  held_out.legend = "of these held out";
  held_out.colour = report::palette(1);
  counts.series.push_back(std::move(held_out));
}

}  // namespace

Times held_out_times(const ChannelPrediction& c) {
  Times out;
  const auto border = [&](std::size_t k) { return k == 0 ? c.t.front() : k == c.t.size() ? c.t.back() : half * (c.t[k - 1] + c.t[k]); };
  for (std::size_t k = 0; k < c.t.size(); ++k) {
    if (!c.held_out[k]) continue;
    if (k > 0 && c.held_out[k - 1]) {
      out.back()[1] = border(k + 1);
    } else {
      out.push_back({border(k), border(k + 1)});
    }
  }
  return out;
}

std::map<std::string, Times> held_out_times(const Fit& fit) {
  std::map<std::string, Times> out;
  for (const ChannelPrediction& c : fit.predictions) out.try_emplace(c.experiment, held_out_times(c));
  return out;
}

std::vector<double> held_out_shares(const ForceMap& map, const Diagnosis& diagnosis, const std::map<std::string, Times>& held_out) {
  if (map.x.size() < 2) return {};
  Counts counts{std::vector<double>(map.x.size(), 0.0), std::vector<double>(map.x.size(), 0.0)};
  bool any = false;
  for (const MissingForce& missing : diagnosis.missing) {
    const std::vector<double>* values = values_of(missing, map.quantity);
    const auto times = held_out.find(missing.experiment);
    if (values == nullptr || times == held_out.end()) return {};
    any = true;
    for (std::size_t i = 0; i < missing.t.size(); ++i) {
      if (std::isfinite((*values)[i])) add_sample((*values)[i], is_held_out(times->second, missing.t[i]), map.x, counts);
    }
  }
  if (!any) return {};
  for (std::size_t k = 0; k < map.x.size(); ++k) counts.held_out[k] = counts.all[k] > 0.0 ? counts.held_out[k] / counts.all[k] : 0.0;
  return counts.held_out;
}

void tell_held_out(const ForceMap& map, const std::vector<double>& shares, report::Figure& figure) {
  if (shares.empty() || figure.panels.size() < 2) return;
  split_gaps(map, shares, figure.panels[0]);
  add_held_out_counts(shares, figure.panels[1]);
}

}  // namespace misfit::page
