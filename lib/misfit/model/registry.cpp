#include "misfit/model/registry.h"

#include <algorithm>
#include <stdexcept>

#include "misfit/core/lists.h"
#include "misfit/core/shown.h"

namespace misfit {
namespace {

template <class Map>
std::vector<std::string> keys_of(const Map& map) {
  std::vector<std::string> keys;
  for (const auto& entry : map) keys.push_back(entry.first);
  return keys;
}

}  // namespace

int EffectSpec::curve_role(const CoefficientSpec& coefficient) const {
  if (coefficient.shared || coefficient.curve_of[0] == '\0') return -1;
  return index_of(quantities, coefficient.curve_of);
}

bool EffectSpec::has_unknown_form() const {
  return std::any_of(coefficients.begin(), coefficients.end(), [this](const CoefficientSpec& c) { return curve_role(c) >= 0; });
}

void EffectSpec::set_texts(const std::array<const char*, 7>& texts) {
  const std::array<std::string*, 7> fields = {&key, &formula, &symbols, &valid, &size, &source, &excludes};
  for (std::size_t i = 0; i < texts.size(); ++i) *fields[i] = texts[i];
}

Registry Registry::over(const Registry& base) {
  Registry out;
  out.base_ = &base;
  return out;
}

void Registry::add(std::unique_ptr<Effect> effect) {
  const std::string key = effect->spec().key;
  if (!effects_.emplace(key, std::move(effect)).second)
    throw std::logic_error("effect '" + shown(key) + "' is registered twice: rename one of its files, whose stem is the key");
}

void Registry::add(SystemType system) {
  const std::string key = system.key;
  if (!systems_.emplace(key, std::move(system)).second)
    throw std::logic_error("system '" + shown(key) + "' is registered twice: rename one of its files, whose stem is the key");
}

const Effect& Registry::effect(const std::string& key, const Source& where) const {
  const auto found = effects_.find(key);
  if (found == effects_.end() && base_ != nullptr) return base_->effect(key, where);
  if (found == effects_.end()) throw InputError(where, "unknown effect '" + shown(key) + "'" + suggest(key, effect_keys()));
  return *found->second;
}

const SystemType& Registry::system(const std::string& key, const Source& where) const {
  const auto found = systems_.find(key);
  if (found == systems_.end() && base_ != nullptr) return base_->system(key, where);
  if (found == systems_.end()) throw InputError(where, "unknown system '" + shown(key) + "'" + suggest(key, system_keys()));
  return found->second;
}

std::vector<std::string> Registry::effect_keys() const { return base_ != nullptr ? base_->effect_keys() : keys_of(effects_); }

std::vector<std::string> Registry::system_keys() const {
  std::vector<std::string> keys = keys_of(systems_);
  if (base_ != nullptr) {
    for (const auto& key : base_->system_keys()) {
      if (!systems_.contains(key)) keys.push_back(key);
    }
    std::sort(keys.begin(), keys.end());
  }
  return keys;
}

}  // namespace misfit
