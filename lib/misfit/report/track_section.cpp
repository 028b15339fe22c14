#include <array>

#include "misfit/core/base64.h"
#include "misfit/report/figures.h"
#include "misfit/report/sections.h"
#include "misfit/show/results.h"

namespace misfit::report {
namespace {}  // namespace

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
