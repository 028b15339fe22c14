// Where the repository and the built misfit lie. Only paths.cpp is compiled with these paths, so that a compiler cache serves the objects
// of all other tests in any clone.
#pragma once

#include <filesystem>

namespace paths {

std::filesystem::path source();   ///< the repository
std::filesystem::path program();  ///< the built misfit

}  // namespace paths
