#pragma once

#include <span>
#include <string_view>

namespace misfit::serve {

/// A file of the page, compiled into the program (embed.cmake).
struct Asset {
  std::string_view path;  ///< "/page.js"; "/" is the page
  std::string_view type;  ///< "text/javascript; charset=utf-8"
  std::string_view content;
};
[[nodiscard]] std::span<const Asset> assets();

}  // namespace misfit::serve
