#include <array>

#include "misfit/report/figures.h"
#include "misfit/report/sections.h"
#include "misfit/show/results.h"

namespace misfit::report {
namespace {

std::string base64(const std::string& bytes) {
  static constexpr const char* letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    const std::size_t left = std::min<std::size_t>(3, bytes.size() - k);
    unsigned long bits = 0;
    for (std::size_t j = 0; j < 3; ++j) bits = bits << 8U | (j < left ? static_cast<unsigned char>(bytes[k + j]) : 0U);
    for (std::size_t j = 0; j < 4; ++j) out.push_back(j <= left ? letters[bits >> (18U - 6U * j) & 63U] : '=');
  }
  return out;
}

}  // namespace

void track_section(const ReportInput& input, Page& page, const Draw& draw) {
  bool headed = false;
  for (const ExperimentInput& experiment : input.experiments) {
    if (!experiment.track) continue;
    if (!headed) page.section("Track");
    headed = true;
    if (experiment.video) page.show(blocks_of(experiment.name, *experiment.video));
    if (!experiment.contact_sheet.empty()) {
      page.html(
          "<figure><img style=\"width:100%\" alt=\"contact sheet of the track\" src=\"data:image/png;base64," +
          base64(experiment.contact_sheet) +
          "\"><figcaption>Frames over the whole video, and where the marker was first lost: the track drawn on the picture (circle: the "
          "marker found; line: its path before), and the marker magnified.</figcaption></figure>\n");
    }
    draw(track_figure(experiment.name, *experiment.track));
  }
}

}  // namespace misfit::report
