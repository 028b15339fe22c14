#pragma once

#include <span>
#include <string_view>

namespace misfit::page {

/// A file of the page, compiled into the program (embed.cmake).
struct Asset {
  std::string_view path;  ///< "/page.js"; "/" is the page
  std::string_view type;  ///< "text/javascript; charset=utf-8"
  std::string_view content;
};
/// What a server sends.
[[nodiscard]] std::span<const Asset> assets();

/// The same page as parts of a document that no server sends: body, its style sheet, one that shows either the page or the document, and
/// one script without imports, which answers itself.
struct EmbeddedAssets {
  std::string_view body, style, frame, script;
};
[[nodiscard]] const EmbeddedAssets& embedded_assets();

}  // namespace misfit::page
