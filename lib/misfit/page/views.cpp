#include "misfit/page/views.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>

#include "misfit/core/display.h"
#include "misfit/core/error.h"
#include "misfit/core/units.h"
#include "misfit/data/curve_coefficient.h"
#include "misfit/data/estimators.h"
#include "misfit/page/held_out.h"
#include "misfit/page/json_text.h"
#include "misfit/report/figures.h"
#include "misfit/report/figures_discovery.h"
#include "misfit/show/results.h"
#include "misfit/show/rows.h"
#include "misfit/show/verdict.h"

namespace misfit::page {
namespace {

template <class Items, class Make>
std::string list_of(const Items& items, const Make& make) {
  std::vector<std::string> out;
  for (const auto& item : items) out.push_back(make(item));
  return json_list(out);
}

std::string quantities_of(const MissingForce& missing) {
  std::vector<std::string> out;
  for (std::size_t q = 0; q < missing.quantities.size(); ++q) {
    out.push_back(fmt::format(R"({{"name":{},"label":{},"unit":{}}})", json_string(missing.quantities[q]),
                              json_words(missing.quantities[q]), json_words(display_level_unit(missing.quantity_units[q]))));
  }
  return json_list(out);
}

std::string force_of(const MissingForce& missing) {
  return fmt::format(R"({{"experiment":{},"figure":{},"quantities":{}}})", json_string(missing.experiment),
                     json_of(report::missing_force_figure(missing, std::nullopt)), quantities_of(missing));
}

/// What is beside the maps of a model: those of the model below it, and which samples are held out.
struct BesideMaps {
  const Diagnosis* here;
  const Diagnosis* below;  ///< nullptr: there is none
  std::string added;       ///< to the model below
  std::map<std::string, Times> held_out;
};

/// "change": with that of the model below; null: it has no such map.
std::string map_of(const ForceMap& map, const BesideMaps& beside) {
  const std::vector<double> shares = held_out_shares(map, *beside.here, beside.held_out);
  const ForceMap* before = beside.below != nullptr ? find_map(*beside.below, map.port, map.quantity) : nullptr;
  report::Figure figure = report::map_figure(map);
  tell_held_out(map, shares, figure);
  std::string change = "null";
  if (before != nullptr) {
    report::Figure both = report::map_change_figure(*before, map, beside.added);
    if (before->x == map.x) tell_held_out(*before, shares, both);
    change = json_of(both);
  }
  return fmt::format(R"({{"port":{},"quantity":{},"label":{},"portLabel":{},"p":{},"pBefore":{},"figure":{},"change":{}}})",
                     json_string(map.port), json_string(map.quantity), json_words(map.quantity), json_words(map.port),
                     json_number(map.p_corrected), before != nullptr ? json_number(before->p_corrected) : "null", json_of(figure), change);
}

/// "before": of the model below; null: it has no such map.
std::string pair_of(const PairMap& map, const Diagnosis* below) {
  const PairMap* before = nullptr;
  for (std::size_t k = 0; below != nullptr && k < below->pairs.size(); ++k) {
    const PairMap& one = below->pairs[k];
    if (std::tie(one.port, one.quantity_x, one.quantity_y) == std::tie(map.port, map.quantity_x, map.quantity_y)) before = &one;
  }
  return fmt::format(R"({{"port":{},"portLabel":{},"x":{},"y":{},"xLabel":{},"yLabel":{},"p":{},"pBefore":{},"figure":{},"before":{}}})",
                     json_string(map.port), json_words(map.port), json_string(map.quantity_x), json_string(map.quantity_y),
                     json_words(map.quantity_x), json_words(map.quantity_y), json_number(map.p_corrected),
                     before != nullptr ? json_number(before->p_corrected) : "null", json_of(report::pair_figure(map)),
                     before != nullptr ? json_of(report::pair_figure(*before)) : "null");
}

std::string times_json(const Times& times) {
  return list_of(times, [](const auto& part) { return fmt::format("[{},{}]", json_number(part[0]), json_number(part[1])); });
}

/// Of a method: what another roughness would make of its curves. `drawn`: the curves of the figures.
std::string roughness_of(const Fit& fit, const RoughnessPath& path, const std::vector<std::pair<std::string, std::string>>& drawn) {
  const auto curve = [&](const CurvesByRoughness& c) {
    const auto figure = std::find(drawn.begin(), drawn.end(), std::pair(c.name, c.of));
    return fmt::format(R"({{"figure":{},"x":{},"values":{}}})", figure - drawn.begin(), json_numbers(display_values(c.x, c.of_unit)),
                       list_of(c.values, [&](const std::vector<double>& values) { return json_numbers(display_values(values, c.unit)); }));
  };
  const auto freedom = fit.facts.find(freedom_fact(path.curve));
  return fmt::format(
      R"({{"curve":{},"label":{},"method":{},"unit":{},"used":{},"chosen":{},"roughness":{},"support":{},"freedom":{},"curves":{}}})",
      json_string(path.curve), json_words(path.curve), json_string(fit.method), json_words(path.unit), json_number(path.used), path.chosen,
      json_numbers(path.roughness), json_numbers(path.log_likelihood, 4), json_string(freedom == fit.facts.end() ? "" : freedom->second),
      list_of(path.curves, curve));
}

/// Places of candidates, what is most significant first: the accepted one, then by p, then by the drop.
std::vector<std::size_t> by_significance(const std::vector<Candidate>& all) {
  std::vector<std::size_t> out(all.size());
  std::iota(out.begin(), out.end(), 0U);
  const auto key = [&](std::size_t k) {
    const Candidate& c = all[k];
    return std::tuple(!c.accepted, std::isfinite(c.p_value) ? c.p_value : 1.0, -c.actual_drop.value_or(c.predicted_drop));
  };
  std::stable_sort(out.begin(), out.end(), [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
  return out;
}

/// Why a candidate was not accepted; empty where the column of its p says it.
std::string reason_beside_p(const Candidate& c) { return is_only_not_significant(c) ? "" : c.why; }

/// What the table of blocks_of(Discovery) has no column for. In its order. `at`: the words of its place, where the effect has several;
/// `place`: in the discovery.
std::string row_of(const Candidate& c, std::size_t place, const std::vector<Candidate>& all, const std::vector<std::string>& known) {
  const bool addable = std::find(known.begin(), known.end(), c.effect) != known.end();
  const auto places = std::count_if(all.begin(), all.end(), [&](const Candidate& other) { return other.effect == c.effect; });
  const std::vector<std::string> at = addable && places > 1 ? words_of_place(c) : std::vector<std::string>{};
  return fmt::format(R"({{"effect":{},"name":{},"why":{},"accepted":{},"addable":{},"at":{},"force":{},"candidate":{}}})",
                     json_string(c.effect), json_string(effect_at(c.effect, c.roles)), json_words(reason_beside_p(c)), c.accepted, addable,
                     list_of(at, json_string), !c.added.empty(), place);
}

/// What the last method that has a result makes of each number: {"method", "values": {name: "1.2 ± 0.1 m"}}; null: there is none.
std::string estimates_of(const std::vector<Fit>& fits) {
  const auto last = std::find_if(fits.rbegin(), fits.rend(), [](const Fit& fit) { return fit.usable(); });
  if (last == fits.rend()) return "null";
  std::vector<std::string> values;
  for (const auto& [name, estimate] : last->parameters)
    values.push_back(fmt::format("{}:{}", json_string(name), json_words(shown(estimate))));
  return fmt::format(R"({{"method":{},"values":{{{}}}}})", json_string(last->method), fmt::join(values, ","));
}

/// The curve as a model without the effects of the last rungs has it.
void add_curve_below(int model, const std::string& colour, const std::vector<Fit>& fits, const std::pair<std::string, std::string>& curve,
                     report::Panel& panel) {
  const CurveEstimate* found = nullptr;
  std::string method;
  for (const Fit& fit : fits) {
    for (const CurveEstimate& c : fit.curves) {
      if (std::pair(c.name, c.of) == curve && fit.usable() && c.informative) found = &c, method = fit.method;
    }
  }
  if (found == nullptr) return;
  report::Series series{fmt::format("model_{}", model),
                        fmt::format("model {}, {}", model, method),
                        report::Style::dotted,
                        colour,
                        display_values(found->x, found->of_unit),
                        display_values(found->value, found->unit),
                        {},
                        {}};
  for (std::size_t i = 0; i < series.y.size(); ++i) {
    if (!(found->count[i] > 0.0)) series.y[i] = std::numeric_limits<double>::quiet_NaN();
    if (panel.y_range && std::isfinite(series.y[i]))
      panel.y_range = {std::min((*panel.y_range)[0], series.y[i]), std::max((*panel.y_range)[1], series.y[i])};
  }
  panel.series.push_back(std::move(series));
}

/// What is predicted far ahead by the model below and by this one, where the maps of that one show nothing; "null": they do, or there is
/// none.
std::string change_ahead(const Diagnosis* below, const Place& place, const Place* before) {
  if (below == nullptr || !report::maps_show_nothing(*below)) return "null";
  const auto whole_fit = [](Place of) {
    of.most_samples = 0;
    return fit_of(of, random_force_estimator().name);
  };
  const std::optional<Fit> without = whole_fit(*before), with = whole_fit(place);
  if (!without || !with) return "null";
  const auto figure = report::change_ahead_figure(*without, *with, place.added);
  return figure ? json_of(*figure) : "null";
}

}  // namespace

std::string motion_view(const Place& place, const std::string& method) {
  std::vector<std::string> methods = fitted_methods(place);
  auto asked = methods.end();
  std::optional<Fit> fit;
  while (!fit && !methods.empty()) {
    asked = std::find(methods.begin(), methods.end(), method);
    if (asked == methods.end()) --asked;
    fit = fit_of(place, *asked);
    if (!fit) methods.erase(asked);  // it cannot be read
  }
  if (!fit) return R"({"methods":[],"method":0,"channels":[],"blocks":[]})";
  std::vector<std::string> channels;
  for (const ChannelPrediction& c : fit->predictions) {
    channels.push_back(fmt::format(R"({{"experiment":{},"name":{},"channel":{},"heldOut":{},"figure":{}}})", json_string(c.experiment),
                                   json_string(c.channel), json_words(c.channel), times_json(held_out_times(c)),
                                   json_of(report::motion_figure(fit->method, c, std::nullopt))));
  }
  return fmt::format(R"({{"methods":{},"method":{},"channels":{},"blocks":{}}})", list_of(methods, json_string), asked - methods.begin(),
                     json_list(channels), json_of(status_blocks({*fit})));
}

std::string where_view(const Place& place, const Place* before) {
  const std::optional<Diagnosis> d = diagnosis_of(place), below = before != nullptr ? diagnosis_of(*before) : std::nullopt;
  if (!d) return "null";
  const std::vector<std::string> methods = fitted_methods(place);
  const std::optional<Fit> fit = methods.empty() ? std::nullopt : fit_of(place, methods.back());
  const BesideMaps beside{&*d, below ? &*below : nullptr, place.added, fit ? held_out_times(*fit) : std::map<std::string, Times>{}};
  const auto map = [&](const ForceMap& m) { return map_of(m, beside); };
  const auto pair = [&](const PairMap& m) { return pair_of(m, beside.below); };
  return fmt::format(R"({{"blocks":{},"ahead":{},"force":{},"maps":{},"pairs":{},"whiteness":[{},{}]}})", json_of(blocks_of(*d)),
                     change_ahead(beside.below, place, before), list_of(d->missing, force_of), list_of(d->maps, map),
                     list_of(d->pairs, pair), json_of(report::innovation_figure(d->whiteness)),
                     json_of(report::periodogram_figure(d->whiteness)));
}

std::string samples_view(const Diagnosis& diagnosis, std::size_t experiment, std::size_t quantity) {
  if (experiment >= diagnosis.missing.size()) throw InputError("there is no such experiment");
  const MissingForce& missing = diagnosis.missing[experiment];
  if (quantity >= missing.quantities.size()) throw InputError("there is no such quantity");
  return fmt::format(R"({{"t":{},"values":{},"figure":{}}})", json_places(missing.t),
                     json_numbers(display_levels(missing.values[quantity], missing.quantity_units[quantity])),
                     json_of(report::missing_force_by_figure(missing, missing.quantities[quantity])));
}

std::string candidates_view(const Place& place, const std::vector<std::string>& effects) {
  const std::optional<Discovery> d = discovery_of(place);
  if (!d) return "null";
  Discovery sorted = *d;
  std::vector<std::string> rows;
  sorted.candidates.clear();
  for (const std::size_t k : by_significance(d->candidates)) {
    sorted.candidates.push_back(d->candidates[k]);
    rows.push_back(row_of(d->candidates[k], k, d->candidates, effects));
  }
  const std::string figure = rows.empty() ? "null" : json_of(report::candidates_figure(sorted.candidates));
  const std::string unknown = list_of(d->unexplained_effects, [](const EffectPlace& e) {
    return fmt::format(R"({{"effect":{},"name":{},"at":{}}})", json_string(e.effect), json_string(effect_at(e.effect, e.roles)),
                       list_of(words_of_place(e.roles), json_string));
  });
  return fmt::format(R"({{"blocks":{},"rows":{},"unknown":{},"figure":{}}})", json_of(blocks_of(sorted)), json_list(rows), unknown, figure);
}

std::string added_view(const Diagnosis& diagnosis, const Discovery& discovery, std::size_t experiment, std::size_t candidate) {
  if (experiment >= diagnosis.missing.size()) throw InputError("there is no such experiment");
  if (candidate >= discovery.candidates.size()) throw InputError("there is no such candidate");
  return json_of(report::added_force_figure(diagnosis.missing[experiment], discovery.candidates[candidate], std::nullopt));
}

std::string curves_view(const std::vector<Place>& places, std::size_t model, const std::vector<Reference>& references) {
  const std::vector<Fit> fits = fits_of(places[model]);
  std::vector<std::vector<Fit>> below;
  for (std::size_t k = 0; k < model; ++k) below.push_back(fits_of(places[k]));
  std::vector<std::string> figures, roughness;
  const auto names = report::curve_names(fits, references);
  for (const auto& curve : names) {
    report::Figure figure = report::curve_figure(curve.first, curve.second, fits, references);
    for (std::size_t k = 0; k < model; ++k) {
      const std::string colour = k + 1 == model ? report::grey : report::palette(fits.size() + k);  // the last one before in grey
      add_curve_below(places[k].id, colour, below[k], curve, figure.panels.front());
    }
    figures.push_back(json_of(figure));
  }
  for (const Fit& fit : fits) {
    for (const RoughnessPath& path : fit.roughness) roughness.push_back(roughness_of(fit, path, names));
  }
  return fmt::format(R"({{"figures":{},"roughness":{},"estimates":{},"blocks":{}}})", json_list(figures), json_list(roughness),
                     estimates_of(fits), json_of(blocks_of(fits)));
}

std::string calibration_view(const Place& place) {
  const std::optional<Calibration> c = calibration_of(place);
  if (!c) return "null";
  return fmt::format(R"({{"blocks":{},"figures":[{},{}]}})", json_of(blocks_of(*c)), json_of(report::calibration_figure(*c)),
                     json_of(report::calibration_residual_figure(*c)));
}

namespace {

/// That of these models; nullopt where it is of the study as it was.
std::optional<Ladder> ladder_of(const std::vector<Place>& places) {
  std::optional<Ladder> ladder = ladder_in(places.front().folder);
  if (ladder && ladder->rungs.size() > 1 && places.size() == 1) return std::nullopt;
  return ladder;
}

}  // namespace

std::string ladder_view(const std::vector<Place>& places) {
  const std::optional<Ladder> ladder = ladder_of(places);
  if (!ladder || ladder->rungs.empty()) return "null";
  const auto rung = [&](const Rung& r) {
    return fmt::format(R"({{"id":{},"added":{},"system":{},"blocks":{}}})", r.id, json_string(r.added), json_string(r.system),
                       json_of(rung_blocks(*ladder, r)));
  };
  return fmt::format(R"({{"blocks":{},"figure":{},"rungs":{}}})", json_of(blocks_of(*ladder)), json_of(report::ladder_figure(*ladder)),
                     list_of(ladder->rungs, rung));
}

std::string models_view(const std::vector<Place>& places) {
  return list_of(places, [](const Place& p) { return fmt::format(R"({{"id":{},"added":{}}})", p.id, json_string(p.added)); });
}

std::string verdict_view(const Verdict& verdict) {
  const bool of_the_camera = verdict.kind == VerdictKind::calibration;
  return fmt::format(R"({{"opens":"{}","blocks":{}}})", of_the_camera ? "calibration" : "where", json_of(blocks_of(verdict)));
}

std::string verdict_view(const std::vector<Place>& places, const std::string& study, const std::string& out) {
  const std::vector<Fit> fits = fits_of(places.front());
  if (fits.empty()) return "null";
  const std::optional<Ladder> ladder = ladder_of(places);
  const bool effects_added = places.size() > 1;
  const std::optional<Calibration> calibration = calibration_of(places.front());
  const std::optional<Comparison> comparison = comparison_of(places.front());
  const std::optional<Diagnosis> diagnosis = diagnosis_of(places.front()),
                                 above = effects_added ? diagnosis_of(places.back()) : std::nullopt;
  const std::optional<Discovery> discovery = discovery_of(places.back());
  const auto pointer = [](const auto& result) { return result ? &*result : nullptr; };
  return verdict_view(verdict_of(VerdictInput{study, out, &fits, pointer(calibration), pointer(comparison), pointer(diagnosis),
                                              pointer(above), pointer(discovery), pointer(ladder)}));
}

}  // namespace misfit::page
