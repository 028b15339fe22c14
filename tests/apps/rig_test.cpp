// Every length of [geometry] that the reference names for a rig with a camera counts.
#include <regex>

#include "tests/apps/short_flight.h"

namespace {

using namespace program;

/// [geometry] of the flight with one entry a tenth longer: what the calibration or the attitude of the same pictures then is.
std::string angles_with(const std::string& longer) {
  const ShortFlight study("parachute_planar", 4.0);
  std::string text = content(study.path("study.toml"));
  if (!longer.empty()) {
    std::smatch entry;
    EXPECT_TRUE(std::regex_search(text, entry, std::regex("\n" + longer + " = \"([0-9.]+) ([a-z/]+)\""))) << longer;
    const std::string changed = "\n" + longer + " = \"" + std::to_string(1.1 * std::stod(entry[1].str())) + " " + entry[2].str() + "\"";
    text.replace(static_cast<std::size_t>(entry.position()), entry[0].length(), changed);
    study.write("study.toml", text);
  }
  const Outcome outcome = study.run("attitude");
  EXPECT_EQ(outcome.status, 0) << longer << ": " << outcome.err;
  return content(study.out("camera.json")) + content(study.out("attitude.csv"));
}

TEST(LengthsOfTheRig, EachChangesTheCalibrationOrTheAngles) {
  const std::string as_it_is = angles_with("");
  EXPECT_EQ(angles_with(""), as_it_is);
  for (const char* name : {"R", "R_cp", "V", "l_b", "l_s", "l_p", "R1", "R2", "R3"}) EXPECT_NE(angles_with(name), as_it_is) << name;
}

}  // namespace
