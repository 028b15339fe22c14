#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "misfit/core/error.h"
#include "misfit/model/effect.h"
#include "misfit/model/system.h"

namespace misfit {

/// The effects and systems a program knows: filled once at start by the lists that CMake generates (misfit_add_effects), then read only.
class Registry {
 public:
  Registry() = default;
  /// What `base` knows, and what is added: the systems and effects that a study declares. `base` must outlive it.
  [[nodiscard]] static Registry over(const Registry& base);

  void add(std::unique_ptr<Effect> effect);
  void add(SystemType system);

  /// InputError at `where` with the nearest name if there is none.
  [[nodiscard]] const Effect& effect(const std::string& key, const Source& where = {}) const;
  [[nodiscard]] const SystemType& system(const std::string& key, const Source& where = {}) const;
  [[nodiscard]] std::vector<std::string> effect_keys() const;  ///< sorted; those of the base alone where there is one: what may be proposed
  [[nodiscard]] std::vector<std::string> system_keys() const;  ///< sorted

 private:
  const Registry* base_ = nullptr;
  std::map<std::string, std::unique_ptr<Effect>> effects_;
  std::map<std::string, SystemType> systems_;
};

}  // namespace misfit
