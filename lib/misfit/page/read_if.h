#pragma once

#include <filesystem>
#include <optional>

#include "misfit/core/error.h"

namespace misfit::page {

/// What `read` makes of a file; nullopt where there is none, or none of the right form.
template <class Read>
auto read_if(const std::filesystem::path& file, const Read& read) -> std::optional<decltype(read())> {
  std::error_code none;
  if (!std::filesystem::is_regular_file(file, none)) return std::nullopt;
  try {
    return read();
  } catch (const InputError&) {
    return std::nullopt;
  } catch (const RunError&) {
    return std::nullopt;
  }
}

}  // namespace misfit::page
