#pragma once

#include <filesystem>
#include <memory>

#include "misfit/video/backend.h"

namespace misfit {

/// InputError: no such file, no file. RunError: an empty one.
void check_media_file(const std::filesystem::path& path);

/// A video to decode. Throws as check_media_file(); RunError: not a video (what cannot be decoded), pictures without a size, no frame rate.
[[nodiscard]] std::unique_ptr<video_module::VideoStream> opened_stream(const std::filesystem::path& path);

}  // namespace misfit
