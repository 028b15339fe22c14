#pragma once

#include <span>

#include "misfit/core/keys.h"

namespace misfit::declared {

/// Every key of a declared system (TOML), in the order of the reference (misfit help system).
[[nodiscard]] std::span<const config::KeyGroup> system_keys();

/// The table KEY of a section by its description under `path`; an empty one, with defaults alone, where the section has no such table.
[[nodiscard]] config::DescribedSection described(const config::Section& section, std::string_view key, std::string_view path);

}  // namespace misfit::declared
