#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace misfit {

/// A name that a user chose, of an experiment, a channel, an effect, as part of a file name: letters, digits, '_' and '-' stay as they
/// are; where there is anything else, or more than a file name can hold, it becomes '_' or is cut, and '.' with a hash of the whole name
/// stands behind it. So different names have different files, on every run the same.
[[nodiscard]] std::string file_name_for(std::string_view name);

/// How files that there is one of per experiment (or other item) are distinguished, by what stands behind their stem: nothing for the
/// first,
/// "_NAME" (file_name_for()) for number 1, 2, ….
[[nodiscard]] std::string file_suffix(std::size_t number, std::string_view name);

}  // namespace misfit
