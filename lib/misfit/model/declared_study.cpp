// What a study declares, added to what the program knows.

#include "misfit/core/files.h"
#include "misfit/model/declared.h"
#include "misfit/model/declared_effect.h"

namespace misfit {

std::shared_ptr<const Registry> study_registry(const Study& study, const Registry& base) {
  auto own = std::make_shared<Registry>(Registry::over(base));
  if (study.system_file) {
    const std::string key = study.system_file->stem().string();
    own->add(declared_system(read_file(*study.system_file), study.system_file->string(), key, study.system_hold));
  }
  std::unique_ptr<System> system;
  for (const auto& effect : study.effects) {
    if (!effect.declared) continue;
    if (!system) {
      const std::string key = study.system_file ? study.system_file->stem().string() : study.system_kind;
      const auto where = study.system_where.find(study.system_file ? "file" : "kind");
      system = own->system(key, where == study.system_where.end() ? Source{} : where->second).make({study.system_flags, {}});
    }
    own->add(declared_effect(effect, system->spec()));
  }
  return own;
}

}  // namespace misfit
