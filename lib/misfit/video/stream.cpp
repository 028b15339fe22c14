#include "misfit/video/stream.h"

#include <fmt/format.h>

#include <string>
#include <system_error>

#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "misfit/video/module.h"

namespace misfit {

void check_media_file(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) static_cast<void>(read_file(path));  // says what is missing, with the nearest name
  if (!std::filesystem::is_regular_file(path, error)) throw InputError(path.string() + ": not a file");
  if (std::filesystem::file_size(path, error) == 0) throw RunError(path.string() + ": not a video: the file is empty");
}

std::unique_ptr<video_module::VideoStream> opened_stream(const std::filesystem::path& path) {
  check_media_file(path);
  std::string why;
  std::unique_ptr<video_module::VideoStream> stream = video_backend().open(path.string(), why);
  if (!stream) throw RunError(path.string() + ": not a video: " + why);
  if (stream->width <= 0 || stream->height <= 0) throw RunError(path.string() + ": not a video: its pictures have no size");
  if (!(stream->rate > 0.0) || stream->rate > 1e5)
    throw RunError(
        fmt::format("{}: the file declares {} frames per second: no time can be assigned to its frames", path.string(), stream->rate));
  return stream;
}

}  // namespace misfit
