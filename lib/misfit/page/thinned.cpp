#include "misfit/page/thinned.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace misfit::page {
namespace {

using Values = std::vector<double>;

/// Least and largest of each stretch, of each of the drawn lists; in order, each once.
std::vector<std::size_t> kept(std::size_t samples, const std::vector<const Values*>& drawn, std::size_t most) {
  const std::size_t stretches = std::max<std::size_t>(most / (2 * drawn.size()), 1);
  std::vector<std::size_t> out;
  for (std::size_t s = 0; s < stretches; ++s) {
    const std::size_t from = s * samples / stretches, to = (s + 1) * samples / stretches;
    for (const Values* values : drawn) {
      std::size_t least = to, largest = to;
      for (std::size_t k = from; k < to; ++k) {
        const double v = (*values)[k];
        if (!std::isfinite(v)) continue;
        if (least == to || v < (*values)[least]) least = k;
        if (largest == to || v > (*values)[largest]) largest = k;
      }
      if (least != to) out.insert(out.end(), {least, largest});
    }
    if (out.empty() || out.back() < from) out.push_back(from);  // a gap stays one
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

template <class List>
void keep(const std::vector<std::size_t>& places, List& list) {
  List out;
  out.reserve(places.size());
  for (const std::size_t k : places) out.push_back(list[k]);
  list = std::move(out);
}

void thin(ChannelPrediction& c, std::size_t most) {
  if (c.t.size() <= most) return;
  Values residual(c.t.size());
  for (std::size_t k = 0; k < residual.size(); ++k) residual[k] = c.measured[k] - c.predicted[k];
  const std::vector<std::size_t> places = kept(c.t.size(), {&c.measured, &c.predicted, &residual}, most);
  keep(places, c.t);
  keep(places, c.measured);
  keep(places, c.predicted);
  keep(places, c.sigma);
  keep(places, c.held_out);
}

std::vector<const Values*> pointers(const std::vector<Values>& lists) {
  std::vector<const Values*> out;
  for (const Values& list : lists) out.push_back(&list);
  return out;
}

void thin(MissingForce& m, std::size_t most) {
  if (m.t.size() <= most || m.force.empty()) return;
  const std::vector<std::size_t> places = kept(m.t.size(), pointers(m.force), most);
  keep(places, m.t);
  for (std::vector<Values>* lists : {&m.force, &m.sigma, &m.values}) {
    for (Values& list : *lists) keep(places, list);
  }
}

void thin(AddedForce& added, std::size_t most) {
  if (added.t.size() <= most || added.force.empty()) return;
  const std::vector<std::size_t> places = kept(added.t.size(), pointers(added.force), most);
  keep(places, added.t);
  for (Values& list : added.force) keep(places, list);
}

}  // namespace

void thin(Fit& fit, std::size_t most) {
  for (ChannelPrediction& c : fit.predictions) thin(c, most);
}

void thin(Diagnosis& diagnosis, std::size_t most) {
  for (MissingForce& m : diagnosis.missing) thin(m, most);
}

void thin(Discovery& discovery, std::size_t most) {
  for (Candidate& c : discovery.candidates) {
    for (AddedForce& added : c.added) thin(added, most);
  }
}

}  // namespace misfit::page
