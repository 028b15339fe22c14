#include "misfit/page/thinned.h"

#include <vector>

#include "misfit/show/extreme_rows.h"

namespace misfit::page {
namespace {

using Values = std::vector<double>;

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
  const std::vector<std::size_t> places = extreme_rows({&c.measured, &c.predicted, &residual}, most);
  keep(places, c.t);
  keep(places, c.measured);
  keep(places, c.predicted);
  keep(places, c.sigma);
  keep(places, c.held_out);
  if (!c.ahead.empty()) keep(places, c.ahead);
}

std::vector<const Values*> pointers(const std::vector<Values>& lists) {
  std::vector<const Values*> out;
  for (const Values& list : lists) out.push_back(&list);
  return out;
}

void thin(MissingForce& m, std::size_t most) {
  if (m.t.size() <= most || m.force.empty()) return;
  const std::vector<std::size_t> places = extreme_rows(pointers(m.force), most);
  keep(places, m.t);
  for (std::vector<Values>* lists : {&m.force, &m.sigma, &m.values}) {
    for (Values& list : *lists) keep(places, list);
  }
}

void thin(AddedForce& added, std::size_t most) {
  if (added.t.size() <= most || added.force.empty()) return;
  const std::vector<std::size_t> places = extreme_rows(pointers(added.force), most);
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
