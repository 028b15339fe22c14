// The video module: OpenCV behind backend.h. Loaded by lib/misfit/video/module.cpp, linked by nothing.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <new>
#include <opencv2/core.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "misfit/video/backend.h"
#include "misfit/video/opencv/patterns.h"

namespace misfit::video_module {
namespace {

class OpencvStream : public VideoStream {
 public:
  explicit OpencvStream(const cv::VideoCapture& capture) : capture_(capture) {
    width = static_cast<int>(capture_.get(cv::CAP_PROP_FRAME_WIDTH));
    height = static_cast<int>(capture_.get(cv::CAP_PROP_FRAME_HEIGHT));
    rate = capture_.get(cv::CAP_PROP_FPS);
    const double count = capture_.get(cv::CAP_PROP_FRAME_COUNT);
    declared = std::isfinite(count) && count > 0.0 && count < 1e9 ? std::lround(count) : 0;
  }
  bool next(std::uint8_t* grey, std::uint8_t* bgr) override {
    try {
      if (!capture_.read(frame_) || frame_.cols != width || frame_.rows != height) return false;
      cv::Mat into(height, width, CV_8UC1, grey);
      if (frame_.channels() == 1) {
        frame_.copyTo(into);
      } else {
        cv::cvtColor(frame_, into, frame_.channels() == 4 ? cv::COLOR_BGRA2GRAY : cv::COLOR_BGR2GRAY);
      }
      if (bgr != nullptr) in_colour(cv::Mat(height, width, CV_8UC3, bgr));
      timestamp = capture_.get(cv::CAP_PROP_POS_MSEC) / 1000.0;
      return true;
    } catch (const cv::Exception& error) {
      if (error.code == cv::Error::StsNoMem) throw std::bad_alloc();  // no end of the video
      return false;
    }
  }
  bool seek(double seconds) override {
    try {
      return capture_.set(cv::CAP_PROP_POS_MSEC, 1000.0 * seconds);
    } catch (const cv::Exception&) {
      return false;
    }
  }

 private:
  void in_colour(cv::Mat into) const {
    switch (frame_.channels()) {
      case 1:
        cv::cvtColor(frame_, into, cv::COLOR_GRAY2BGR);
        break;
      case 4:
        cv::cvtColor(frame_, into, cv::COLOR_BGRA2BGR);
        break;
      default:
        frame_.copyTo(into);
    }
  }

  cv::VideoCapture capture_;
  cv::Mat frame_;
};

/// Of the first frames, by a capture of its own: what decides how time runs must be known before the first frame is given.
std::vector<double> first_timestamps_of(const std::string& path) {
  constexpr std::size_t enough = 100;
  std::vector<double> times;
  cv::VideoCapture capture(path, cv::CAP_FFMPEG);
  while (times.size() < enough && capture.grab()) times.push_back(capture.get(cv::CAP_PROP_POS_MSEC) / 1000.0);
  return times;
}

class OpencvSink : public Sink {
 public:
  OpencvSink(const cv::VideoWriter& writer, int width, int height) : writer_(writer), width_(width), height_(height) {}
  void write(const std::uint8_t* bgr) override {
    writer_.write(
        cv::Mat(height_, width_, CV_8UC3, const_cast<std::uint8_t*>(bgr)));  // NOLINT: cv::Mat knows no const data; it is only read
  }

 private:
  cv::VideoWriter writer_;
  int width_, height_;
};

void draw_mark(cv::Mat& picture, const Mark& mark) {
  constexpr int shift = 4;  // positions in sixteenths of a pixel
  const auto fixed = [](double v) { return cvRound(v * (1 << shift)); };
  const cv::Scalar colour(mark.blue, mark.green, mark.red);
  const cv::Point at(fixed(mark.x), fixed(mark.y));
  switch (mark.shape) {
    case Mark::Shape::circle:
      cv::circle(picture, at, fixed(mark.size), colour, 1, cv::LINE_AA, shift);
      break;
    case Mark::Shape::cross:
      cv::line(picture, at - cv::Point(fixed(mark.size), 0), at + cv::Point(fixed(mark.size), 0), colour, 1, cv::LINE_AA, shift);
      cv::line(picture, at - cv::Point(0, fixed(mark.size)), at + cv::Point(0, fixed(mark.size)), colour, 1, cv::LINE_AA, shift);
      break;
    case Mark::Shape::line:
      cv::line(picture, at, {fixed(mark.x_end), fixed(mark.y_end)}, colour, 1, cv::LINE_AA, shift);
      break;
    case Mark::Shape::box:
      cv::rectangle(picture, at, {fixed(mark.x_end), fixed(mark.y_end)}, colour, cv::FILLED, cv::LINE_8, shift);
      break;
    case Mark::Shape::text:
      cv::putText(picture, mark.text, {cvRound(mark.x), cvRound(mark.y)}, cv::FONT_HERSHEY_SIMPLEX, mark.size / 22.0, colour, 1,
                  cv::LINE_AA);
      break;
  }
}

cv::Mat grey_picture(const std::uint8_t* grey, int width, int height) {
  return {height, width, CV_8UC1, const_cast<std::uint8_t*>(grey)};  // NOLINT: only read
}

class OpencvBackend : public Backend {
 public:
  OpencvBackend() {
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
    ::setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", 0);  // quiet: what is wrong with a file is said by misfit
  }
  std::unique_ptr<VideoStream> open(const std::string& path, std::string& why) override {
    try {
      cv::VideoCapture capture(path, cv::CAP_FFMPEG);
      if (capture.isOpened()) {
        auto stream = std::make_unique<OpencvStream>(capture);
        stream->first_timestamps = first_timestamps_of(path);
        return stream;
      }
      why = "no video that FFmpeg can decode is in it";
    } catch (const cv::Exception& error) {
      why = error.err;
    }
    return nullptr;
  }
  std::unique_ptr<Sink> create(const std::string& path, int width, int height, double rate, std::string& why) override {
    const int codec = path.ends_with(".avi")   ? cv::VideoWriter::fourcc('M', 'J', 'P', 'G')
                      : path.ends_with(".mkv") ? cv::VideoWriter::fourcc('F', 'F', 'V', '1')
                                               : cv::VideoWriter::fourcc('m', 'p', '4', 'v');
    try {
      cv::VideoWriter writer(path, cv::CAP_FFMPEG, codec, rate, {width, height});
      if (writer.isOpened()) return std::make_unique<OpencvSink>(writer, width, height);
      why =
          "FFmpeg cannot write such a file: .avi (Motion JPEG), .mp4 (MPEG-4) and .mkv (FFV1, without loss) are possible, in a folder that "
          "can be written";
    } catch (const cv::Exception& error) {
      why = error.err;
    }
    return nullptr;
  }
  std::vector<std::uint8_t> read_image(const std::string& path, int& width, int& height, std::string& why) override {
    try {
      const cv::Mat image = cv::imread(path, cv::IMREAD_GRAYSCALE);
      if (image.empty()) {
        why = "it is no image that can be read (PNG, JPEG, TIFF, BMP, PGM can)";
        return {};
      }
      width = image.cols;
      height = image.rows;
      std::vector<std::uint8_t> pixels(image.total());
      image.copyTo(cv::Mat(height, width, CV_8UC1, pixels.data()));
      return pixels;
    } catch (const cv::Exception& error) {
      why = error.err;
      return {};
    }
  }
  std::vector<std::uint8_t> encoded(const std::uint8_t* bgr, int width, int height, PictureFormat format, std::string& why) override {
    std::vector<std::uint8_t> bytes;
    try {
      const cv::Mat picture(height, width, CV_8UC3, const_cast<std::uint8_t*>(bgr));  // NOLINT: only read
      if (!cv::imencode(format == PictureFormat::png ? ".png" : ".jpg", picture, bytes)) why = "the picture could not be encoded";
    } catch (const cv::Exception& error) {
      why = error.err;
    }
    return bytes;
  }
  Chessboard chessboard(const std::uint8_t* grey, int width, int height, int columns, int rows) override {
    return chessboard_in(grey_picture(grey, width, height), columns, rows);
  }
  std::vector<std::array<Place, 4>> dark_quadrilaterals(const std::uint8_t* grey, int width, int height, double least_side) override {
    return dark_quadrilaterals_in(grey_picture(grey, width, height), least_side);
  }
  void draw(std::uint8_t* bgr, int width, int height, const std::vector<Mark>& marks) override {
    cv::Mat picture(height, width, CV_8UC3, bgr);
    for (const Mark& mark : marks) draw_mark(picture, mark);
  }
};

Backend* make() {
  static OpencvBackend backend;
  return &backend;
}

}  // namespace
}  // namespace misfit::video_module

extern "C" __attribute__((visibility("default")))
const misfit::video_module::Entry misfit_video_module = {misfit::video_module::interface_version, misfit::video_module::make};
