#pragma once

namespace misfit {

[[nodiscard]] const char* version();  ///< "0.2.0"
[[nodiscard]] const char* commit();   ///< short commit of the build, "+" appended if the tree was changed; "unknown" outside git

}  // namespace misfit
