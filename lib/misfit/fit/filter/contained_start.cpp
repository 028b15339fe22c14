#include "misfit/fit/filter/contained_start.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "misfit/fit/filter/filter_start.h"
#include "misfit/fit/filter/runnable_start.h"

namespace misfit {
namespace {

constexpr std::array letters = {std::pair(SampleRole::none, '-'), std::pair(SampleRole::update, 'u'), std::pair(SampleRole::counted, 'c'),
                                std::pair(SampleRole::validation, 'v')};

char letter_of(SampleRole role) {
  return std::find_if(letters.begin(), letters.end(), [&](const auto& pair) { return pair.first == role; })->second;
}

/// What no role has as its letter is left out.
SampleRole role_of(char letter) {
  const auto* found = std::find_if(letters.begin(), letters.end(), [&](const auto& pair) { return pair.second == letter; });
  return found == letters.end() ? SampleRole::none : found->first;
}

/// Of parameters or curves: one of the two may have an effect's name before it.
bool same_name(const std::string& a, const std::string& b) { return a == b || a.ends_with("." + b) || b.ends_with("." + a); }

}  // namespace

bool contains(const Model& model, const ContainedFit& contained) {
  const bool room = contained.values.size() <= model.parameters.size() && contained.roughness.size() <= model.curves.size();
  return room && contained.noise.size() == place_of_force(with_random_force(model).force_groups(), model.system->spec()) &&
         std::equal(contained.names.begin(), contained.names.end(), model.parameters.begin(),
                    [](const std::string& name, const Parameter& p) { return same_name(name, p.name); });
}

ContainedFit contained_fit(const FilterEstimate& estimate) {
  ContainedFit out;
  for (const Parameter& p : estimate.model.parameters) out.names.push_back(p.name);
  out.values = estimate.model.values();
  out.roughness.assign(estimate.model.curves.size(), 0.0);
  for (const Penalty& p : estimate.penalties) out.roughness[p.curve] = p.lambda;
  for (const FilterData& data : estimate.data) {
    out.use.emplace_back();
    for (SampleRole role : data.use) out.use.back() += letter_of(role);
  }
  const SystemSpec& spec = estimate.model.system->spec();
  out.noise = pack(estimate.noise, spec, estimate.reference).value;
  out.usual_noise = pack(estimate.reference, spec, estimate.reference).value;
  return out;
}

std::vector<FilterStart> starts_from(const ContainedFit& contained, const Model& model) {
  if (!contains(model, contained)) return {};
  const std::vector<double>& noise = contained.noise;
  const auto start_at = [&](std::vector<double> values, const std::vector<double>& log_noise) {
    FilterStart start{model, {}, unpack(log_noise, model.system->spec())};
    for (std::size_t i = 0; i < values.size(); ++i) {
      Parameter& p = start.model.parameters[i];
      if (p.free) p.value = std::clamp(values[i], p.lower, p.upper);
    }
    start.penalties = curve_penalties(start.model);
    for (Penalty& p : start.penalties) {
      const std::size_t curve = p.curve;
      if (p.chosen && curve < contained.roughness.size() && contained.roughness[curve] > 0.0) p.lambda = contained.roughness[curve];
    }
    return start;
  };
  std::vector<double> off = with_strengths_off(model).model.values();
  std::copy(contained.values.begin(), contained.values.end(), off.begin());
  const FilterStart without = start_at(off, noise), as_given = start_at(contained.values, noise);
  std::vector<FilterStart> out = {without};
  if (contained.refit_values.size() == off.size() && contained.refit_log_noise.size() == noise.size())
    out.push_back(start_at(contained.refit_values, contained.refit_log_noise));
  if (out.size() == 1 && as_given.model.values() != without.model.values()) out.push_back(as_given);
  return out;
}

std::vector<Penalty> with_weights_of(const FilterEstimate& estimate, const Model& model, std::vector<Penalty> penalties) {
  for (Penalty& own : penalties) {
    const std::string& name = model.curves[own.curve].name;
    for (const Penalty& known : estimate.penalties) {
      const std::string& there = estimate.model.curves[known.curve].name;
      if (name == there || (own.curve == known.curve && same_name(name, there))) own.lambda = known.lambda;
    }
  }
  return penalties;
}

FilterNoise usual_noise_of(const ContainedFit& contained, const Model& model) {
  FilterNoise out = unpack(contained.usual_noise, model.system->spec());
  mark_known(with_random_force(model), out);
  return out;
}

std::optional<std::vector<std::vector<SampleRole>>> same_use(const ContainedFit& contained, const std::vector<Signals>& experiments) {
  if (contained.use.size() != experiments.size()) return std::nullopt;
  std::vector<std::vector<SampleRole>> out;
  for (std::size_t e = 0; e < experiments.size(); ++e) {
    const std::vector<Signal>& channels = experiments[e].measured;
    const std::string& use = contained.use[e];
    if (use.size() != experiments[e].samples() * channels.size()) return std::nullopt;
    out.emplace_back();
    for (std::size_t i = 0; i < use.size(); ++i) {
      const bool measured = std::isfinite(channels[i % channels.size()].values[i / channels.size()]);
      out.back().push_back(measured ? role_of(use[i]) : SampleRole::none);
    }
  }
  return out;
}

}  // namespace misfit
