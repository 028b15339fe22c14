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
  CheckVideo(const CheckVideoInput& input, const VideoFacts& facts, const std::filesystem::path& to)
      : track_(input.track), radius_(input.radius), canvas_(facts.width, facts.height) {
    std::string why;
    sink_ = video_backend().create(to.string(), facts.width, facts.height, facts.rate * input.fields.count, why);
    if (!sink_) throw RunError(to.string() + ": " + why);
  }

  void add(const Field& field, std::size_t sample) {
    if (sample >= track_.t.size()) return;
    canvas_.paste(field, {0.0, 0.0, 1.0 * canvas_.width(), 1.0 * canvas_.height()}, {});
    std::vector<video_module::Mark> marks;
    for (std::size_t k = sample > trail_length ? sample - trail_length : 1; k <= sample && sample > 0; ++k) {
      if (track_.ok[k - 1] && track_.ok[k]) marks.push_back(line(place(k - 1), place(k), trail_colour));
    }
    if (track_.ok[sample]) {
      marks.push_back(circle(place(sample), radius_ + 3.0, found_colour));
      marks.push_back(cross(place(sample), 3.0, found_colour));
      marks.push_back(text({8, 20}, 12.0, fmt::format("{:.3f} s  sigma {:.2f} px", track_.t[sample], track_.sigma[sample]), found_colour));
    } else {
      marks.push_back(text({8, 20}, 12.0, fmt::format("{:.3f} s  lost", track_.t[sample]), lost_colour));
    }
    canvas_.draw(marks);
    sink_->write(canvas_.data());
  }

 private:
  [[nodiscard]] PixelPoint place(std::size_t k) const {
    return {0.5 * canvas_.width() - track_.P_y[k], 0.5 * canvas_.height() + track_.P_z[k]};
  }

  const Track& track_;
  double radius_;
  Canvas canvas_;
  std::unique_ptr<video_module::Sink> sink_;
};

}  // namespace

void write_check_video(const CheckVideoInput& input, const std::filesystem::path& to,
                       const std::function<void(std::size_t, std::size_t)>& progress) {
  const auto& [fields, first_row] = input.fields;
  Video video(input.from);
  CheckVideo out(input, video.facts(), to);
  while (auto frame = video.next()) {
    const std::size_t sample = frame->number * fields;
    if (fields == 1) {
      out.add({std::move(frame->image), 0, 1}, sample);
    } else {
      out.add(field_of(frame->image, first_row), sample);
      out.add(field_of(frame->image, 1 - first_row), sample + 1);
    }
    if (progress) progress(sample, input.track.t.size());
  }
}

}  // namespace misfit
