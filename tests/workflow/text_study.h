#pragma once

// A study of a system given as text and one recording, in a folder of its own.

#include <misfit_models_registry.h>

#include <string>

#include "misfit/misfit.h"
#include "tests/core/temporary_folder.h"

namespace misfit::testing_text_study {

class TextStudy {
 public:
  TextStudy(const std::string& system, const std::string& recording) {
    misfit_models_register(registry_);
    folder_.write("m.toml", system);
    folder_.write("d.csv", recording);
  }

  /// With these lines under [effects].
  [[nodiscard]] Fit fit(const std::string& method, const std::string& effects) const { return identification(method, effects).fit(method); }

  /// And these under [[experiment]].
  [[nodiscard]] Identification identification(const std::string& method, const std::string& effects,
                                              const std::string& experiment = "") const {
    folder_.write("study.toml", "[study]\nname = \"text\"\nquestion = \"What is missing?\"\nmethods = [\"" + method +
                                    "\"]\nseed = 1\n[system]\nfile = \"m.toml\"\n[[experiment]]\nname = \"one\"\ndata = \"d.csv\"\n" +
                                    experiment + "[effects]\n" + effects + "\n");
    return {{.study = path("study.toml"), .out = path("out"), .methods = {method}}, registry_};
  }

 private:
  [[nodiscard]] std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

  TemporaryFolder folder_;
  Registry registry_;
};

}  // namespace misfit::testing_text_study
