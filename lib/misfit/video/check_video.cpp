#include "misfit/video/check_video.h"

#include <fmt/format.h>

#include "misfit/core/error.h"
#include "misfit/video/canvas.h"
#include "misfit/video/module.h"
#include "misfit/video/video.h"

namespace misfit {
namespace {

constexpr std::size_t trail_length = 30;  // samples

class CheckVideo {
 public:
  CheckVideo(const std::filesystem::path& to, const VideoFacts& facts, const Track& track, int fields, double radius)
      : track_(track), radius_(radius), canvas_(facts.width, facts.height) {
    std::string why;
    sink_ = video_backend().create(to.string(), facts.width, facts.height, facts.rate * fields, why);
    if (!sink_) throw RunError(to.string() + ": " + why);
  }

  void add(const Field& field, std::size_t sample) {
    if (sample >= track_.t.size()) return;
    canvas_.paste(field, 0.0, 0.0, canvas_.width(), canvas_.height(), 0, 0, 1.0);
    std::vector<video_module::Mark> marks;
    for (std::size_t k = sample > trail_length ? sample - trail_length : 1; k <= sample && sample > 0; ++k) {
      if (track_.ok[k - 1] && track_.ok[k]) marks.push_back(line(column(k - 1), row(k - 1), column(k), row(k), trail_colour));
    }
    if (track_.ok[sample]) {
      marks.push_back(circle(column(sample), row(sample), radius_ + 3.0, found_colour));
      marks.push_back(cross(column(sample), row(sample), 3.0, found_colour));
      marks.push_back(text(8, 20, 12.0, fmt::format("{:.3f} s  sigma {:.2f} px", track_.t[sample], track_.sigma[sample]), found_colour));
    } else {
      marks.push_back(text(8, 20, 12.0, fmt::format("{:.3f} s  lost", track_.t[sample]), lost_colour));
    }
    canvas_.draw(marks);
    sink_->write(canvas_.data());
  }

 private:
  [[nodiscard]] double column(std::size_t k) const { return 0.5 * canvas_.width() - track_.P_y[k]; }
  [[nodiscard]] double row(std::size_t k) const { return 0.5 * canvas_.height() + track_.P_z[k]; }

  const Track& track_;
  double radius_;
  Canvas canvas_;
  std::unique_ptr<video_module::Sink> sink_;
};

}  // namespace

void write_check_video(const std::filesystem::path& from, const std::filesystem::path& to, const Track& track, int fields, int first_row,
                       double radius, const std::function<void(std::size_t, std::size_t)>& progress) {
  Video video(from);
  CheckVideo out(to, video.facts(), track, fields, radius);
  while (auto frame = video.next()) {
    const std::size_t sample = frame->number * fields;
    if (fields == 1) {
      out.add({std::move(frame->image), 0, 1}, sample);
    } else {
      out.add(field_of(frame->image, first_row), sample);
      out.add(field_of(frame->image, 1 - first_row), sample + 1);
    }
    if (progress) progress(sample, track.t.size());
  }
}

}  // namespace misfit
