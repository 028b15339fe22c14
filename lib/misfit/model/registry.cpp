#include "misfit/model/registry.h"

#include <stdexcept>

namespace misfit {
namespace {

template <class Map>
std::vector<std::string> keys_of(const Map& map) {
  std::vector<std::string> keys;
  for (const auto& entry : map) keys.push_back(entry.first);
  return keys;
}

}  // namespace

void EffectSpec::set_texts(const std::array<const char*, 7>& texts) {
  const std::array<std::string*, 7> fields = {&key, &formula, &symbols, &valid, &size, &source, &excludes};
  for (std::size_t i = 0; i < texts.size(); ++i) *fields[i] = texts[i];
}

void Registry::add(std::unique_ptr<Effect> effect) {
  const std::string key = effect->spec().key;
  if (!effects_.emplace(key, std::move(effect)).second) throw std::logic_error("effect '" + key + "' registered twice");
}

void Registry::add(SystemType system) {
  const std::string key = system.key;
  if (!systems_.emplace(key, std::move(system)).second) throw std::logic_error("system '" + key + "' registered twice");
}

const Effect& Registry::effect(const std::string& key, const Source& where) const {
  const auto found = effects_.find(key);
  if (found == effects_.end()) throw InputError(where, "unknown effect '" + key + "'" + suggest(key, effect_keys()));
  return *found->second;
}

const SystemType& Registry::system(const std::string& key, const Source& where) const {
  const auto found = systems_.find(key);
  if (found == systems_.end()) throw InputError(where, "unknown system '" + key + "'" + suggest(key, system_keys()));
  return found->second;
}

std::vector<std::string> Registry::effect_keys() const { return keys_of(effects_); }
std::vector<std::string> Registry::system_keys() const { return keys_of(systems_); }

}  // namespace misfit
