#include "misfit/track/survey.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "misfit/math/statistics.h"

namespace misfit {
namespace {

constexpr double min_score = 0.5;  // of the correlation, before the fit
constexpr std::size_t candidates_per_scale = 5;
constexpr double start_radius = 40.0;  // [px] about a given start
constexpr double still_radius = 1.5;   // [px]
constexpr long min_frames = 30, max_frames = 60;
constexpr long max_empty_frames = 40, stride_after = 20;  // nothing found in the first ones: every twentieth frame from there on
constexpr std::size_t min_found = 12;                     // fields, before one size is believed

/// Fits every candidate; keeps the possible ones, each place once (the best explained).
std::vector<Location> fit_all(const Field& field, const Marker& marker, const std::vector<Match>& candidates) {
  std::vector<Location> out;
  for (const Match& c : candidates) {
    const Location found = locate(field, marker, c.at, true);
    if (possible(found, marker.kind)) out.push_back(found);
  }
  return out;
}

void merge(std::vector<Location>& all, const std::vector<Location>& more) {
  for (const Location& m : more) {
    const auto same =
        std::find_if(all.begin(), all.end(), [&](const Location& a) { return distance(a.at, m.at) < 0.7 * std::max(a.outer, 3.0); });
    if (same == all.end()) {
      all.push_back(m);
    } else if (m.explained > same->explained) {
      *same = m;
    }
  }
}

std::vector<Marker> scales(const Marker& marker) {
  if (marker.kind == MarkerKind::picture) return {marker};
  std::vector<Marker> out;
  for (double diameter : {8.0, 11.0, 15.0, 21.0, 29.0}) out.push_back(nominal_marker(marker.kind, diameter));
  return out;
}

double median_of(const std::vector<Location>& all, double (*value)(const Location&)) {
  std::vector<double> values;
  for (const Location& l : all) values.push_back(value(l));
  return median(values);
}

Appearance appearance_of(const std::vector<Location>& members, const Marker& marker) {
  Appearance look;
  look.marker = marker;
  if (marker.kind != MarkerKind::picture) {
    look.marker.outer = median_of(members, [](const Location& l) { return l.outer; });
    look.marker.inner = median_of(members, [](const Location& l) { return l.inner; });
    look.marker.edge = median_of(members, [](const Location& l) { return l.edge; });
  }
  look.marker.levels = {median_of(members, [](const Location& l) { return l.levels[0]; }),
                        median_of(members, [](const Location& l) { return l.levels[1]; }),
                        median_of(members, [](const Location& l) { return l.levels[2]; })};
  std::vector<double> explained;
  for (const Location& l : members) explained.push_back(l.explained);
  look.explained = median(explained);
  look.explained_spread = mad_sigma(explained);
  look.noise = median_of(members, [](const Location& l) { return l.noise; });
  return look;
}

}  // namespace

Survey::Survey(SurveyOptions options) : options_(std::move(options)) {}

std::vector<Marker> Survey::markers_to_try() const { return learnt_ ? std::vector<Marker>{learnt_->marker} : scales(options_.marker); }

void Survey::look(const Field& field, long number) {
  Region region = options_.region.value_or(whole(field));
  if (options_.start && number == 0) {
    const PixelPoint& s = *options_.start;
    region = intersection(region, {s.column - start_radius, s.row - start_radius, s.column + start_radius, s.row + start_radius});
  }
  std::vector<Location> all;
  for (const Marker& marker : markers_to_try())
    merge(all, fit_all(field, marker, search(field, marker, region, min_score, candidates_per_scale)));
  for (const Location& l : all) found_.push_back({l, number, field.first_row});
}

void Survey::add(const Image& frame, long number) {
  ++seen_;
  if (found_.empty() && seen_ > max_empty_frames && seen_ % stride_after != 0) return;
  ++searched_;
  for (int parity : {0, 1}) look(field_of(frame, parity), number);
  if (!learnt_) learn();
}

/// One size is believed once it was found often enough; from there on only it is searched for.
void Survey::learn() {
  const Group group = best_group();
  if (group.members.size() < min_found) return;
  std::vector<Location> members;
  for (std::size_t k : moving(group)) members.push_back(found_[k].location);
  if (members.size() >= min_found / 2) learnt_ = appearance_of(members, options_.marker);
}

bool Survey::similar(const Location& a, const Location& b) const {
  const double contrast = a.levels[1] / b.levels[1];
  constexpr double min_contrast_ratio = 0.6;
  const bool alike = contrast > min_contrast_ratio && contrast < 1.0 / min_contrast_ratio;
  if (!alike) return false;
  return options_.marker.kind == MarkerKind::picture || std::abs(a.outer - b.outer) < std::max(0.8, 0.15 * b.outer);
}

Survey::Group Survey::best_group() const {
  std::vector<Group> groups;
  for (std::size_t k = 0; k < found_.size(); ++k) {
    const auto fits = [&](const Group& g) { return similar(found_[k].location, found_[g.members.front()].location); };
    auto group = std::find_if(groups.begin(), groups.end(), fits);
    if (group == groups.end()) group = groups.insert(groups.end(), Group{});
    group->members.push_back(k);
  }
  for (Group& g : groups) {
    std::set<std::pair<long, int>> fields;
    std::vector<double> explained;
    bool at_start = false;
    for (std::size_t k : moving(g)) {
      fields.insert({found_[k].frame, found_[k].parity});
      explained.push_back(found_[k].location.explained);
      at_start = at_start || found_[k].frame == 0;
    }
    const PixelPoint first = found_[g.members.front()].location.at;
    const bool moves =
        std::any_of(g.members.begin(), g.members.end(), [&](std::size_t k) { return distance(found_[k].location.at, first) > 2.0; });
    if (explained.empty()) continue;
    g.score = static_cast<double>(fields.size()) * median(explained) * (moves ? 1.0 : 0.5);
    if (options_.start && !at_start) g.score = 0.0;
  }
  const auto best = std::max_element(groups.begin(), groups.end(), [](const Group& a, const Group& b) { return a.score < b.score; });
  return best == groups.end() ? Group{} : *best;
}

std::vector<PixelPoint> Survey::still_of(const Group& group) const {
  std::vector<PixelPoint> places;
  std::set<long> frames;
  for (std::size_t k : group.members) frames.insert(found_[k].frame);
  if (frames.size() < 4) return places;
  for (std::size_t k : group.members) {
    const PixelPoint& at = found_[k].location.at;
    if (std::any_of(places.begin(), places.end(), [&](const PixelPoint& p) { return distance(p, at) < 2.0 * still_radius; })) continue;
    std::set<long> here;
    for (std::size_t m : group.members) {
      if (distance(found_[m].location.at, at) < still_radius) here.insert(found_[m].frame);
    }
    if (2 * here.size() > frames.size()) places.push_back(at);
  }
  return places;
}

std::vector<std::size_t> Survey::moving(const Group& group) const {
  const std::vector<PixelPoint> places = still_of(group);
  std::vector<std::size_t> out;
  for (std::size_t k : group.members) {
    const PixelPoint& at = found_[k].location.at;
    if (std::none_of(places.begin(), places.end(), [&](const PixelPoint& p) { return distance(p, at) < 2.0 * still_radius; }))
      out.push_back(k);
  }
  // A few stray finds beside a thing that stands still are no marker that moves.
  return 3 * out.size() > group.members.size() ? out : group.members;
}

std::optional<Appearance> Survey::appearance() const {
  const Group group = best_group();
  if (group.members.empty() || !(group.score > 0.0)) return std::nullopt;
  std::vector<Location> members;
  for (std::size_t k : moving(group)) members.push_back(found_[k].location);
  return appearance_of(members, options_.marker);
}

std::vector<PixelPoint> Survey::still() const {
  const Group group = best_group();
  if (moving(group).size() == group.members.size()) return {};
  return still_of(group);
}

double Survey::doubled() const {
  std::map<std::pair<long, int>, int> count;
  for (std::size_t k : moving(best_group())) ++count[{found_[k].frame, found_[k].parity}];
  const auto twice = std::count_if(count.begin(), count.end(), [](const auto& c) { return c.second > 1; });
  return count.empty() ? 0.0 : static_cast<double>(twice) / static_cast<double>(count.size());
}

double Survey::share() const {
  std::set<long> frames;
  for (std::size_t k : moving(best_group())) frames.insert(found_[k].frame);
  return searched_ > 0 ? static_cast<double>(frames.size()) / static_cast<double>(searched_) : 0.0;
}

FieldEvidence Survey::evidence() const {
  std::vector<FieldPair> pairs;
  const Group group = best_group();
  std::vector<double> quality(2, 0.0);
  for (std::size_t k : moving(group)) {
    const Found& f = found_[k];
    if (pairs.empty() || pairs.back().frame != f.frame) {
      pairs.push_back({f.frame, std::nullopt, std::nullopt});
      quality = {0.0, 0.0};
    }
    const std::size_t parity = f.parity;
    if (f.location.explained <= quality[parity]) continue;
    quality[parity] = f.location.explained;
    (f.parity == 0 ? pairs.back().even : pairs.back().odd) = f.location.at;
  }
  return field_evidence(pairs);
}

bool Survey::enough() const {
  if (!learnt_ || searched_ < min_frames) return false;
  return searched_ >= max_frames || evidence().decisive;
}

std::vector<Location> find_markers(const Field& field, const Marker& marker, std::size_t most, const std::optional<Region>& region) {
  const Region where = region.value_or(whole(field));
  std::vector<Location> all;
  for (const Marker& m : scales(marker)) merge(all, fit_all(field, m, search(field, m, where, min_score, 2 * most + 4)));
  std::stable_sort(all.begin(), all.end(), [](const Location& a, const Location& b) { return a.explained > b.explained; });
  if (all.size() > most) all.resize(most);
  return all;
}

}  // namespace misfit
