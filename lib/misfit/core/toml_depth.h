#pragma once

#include <string>
#include <string_view>

namespace misfit::config {

inline constexpr int deepest_nesting = 64;

/// Looks at the text alone, before it is parsed: InputError with line and column where tables, arrays or keys with points stand in one
/// another more than `deepest_nesting` deep (the parser and the tables that it makes need stack for each). What is no TOML passes.
void check_toml_depth(std::string_view text, const std::string& name);

}  // namespace misfit::config
