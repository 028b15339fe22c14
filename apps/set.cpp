#include <iostream>

#include "apps/verbs.h"
#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "misfit/core/shown.h"
#include "misfit/data/study_reader.h"
#include "misfit/workflow/session/study_change.h"

namespace misfit {

int set_verb(const Options& options, const Registry& registry) {
  const std::filesystem::path file = study_file(options.session.study);
  const Study study = read_study(file);
  std::vector<Setting> settings;
  for (const std::string& words : options.settings) settings.push_back(read_setting(words));
  const std::string text = with_settings(study, settings);
  if (const auto fault = save_text(file, text, hash_text(study.text), registry))
    throw InputError(fault->message + "\n(the study is as it was)");
  for (const Setting& setting : settings) std::cout << shown(setting.key) << " = " << shown(setting.value) << '\n';
  std::cout << "written to " << file.string() << "; misfit run makes the results anew\n";
  return 0;
}

}  // namespace misfit
