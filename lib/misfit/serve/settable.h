#pragma once

#include <string>
#include <vector>

#include "misfit/workflow/session/session.h"

namespace misfit::serve {

/// What the page can set in a study.
struct Settable {
  struct Parameter {
    std::string name, unit;
    bool free = false;
    std::string value;  ///< where it is fixed: "1.2 m"; empty: of a curve
  };
  struct Curve {
    std::string name, in_study;  ///< in the model; what [curves] of the study calls it
    std::string unit;            ///< of its roughness: quantity^3/curve^2
    std::string roughness;       ///< "auto", or a number
  };
  std::vector<Parameter> parameters;  ///< a curve as a whole is one, too
  std::vector<Curve> curves;
  std::vector<std::string> experiments;  ///< of which a part can be held out: those that hold no file out as a whole
};
[[nodiscard]] Settable settable_of(const Session& session);
[[nodiscard]] std::string json_of(const Settable& settable);

/// KEY=VALUE for `misfit set`. `what`: "free" of a parameter: "true" or "false"; "roughness" of a curve: "auto" or a number of at least 0;
/// "validation" of an experiment: two numbers, "12.5 20" [s]. Nothing of the request becomes part of it but numbers, and names that
/// `settable` has. InputError: it is something else.
[[nodiscard]] std::string setting_of(const Settable& settable, const std::string& what, const std::string& name, const std::string& value);

}  // namespace misfit::serve
