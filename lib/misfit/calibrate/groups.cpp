#include "misfit/calibrate/groups.h"

#include <algorithm>
#include <array>

#include "misfit/calibrate/calibrate.h"
#include "misfit/core/error.h"
#include "misfit/core/shown.h"

namespace misfit {
namespace {

struct GroupEntry {
  const char* name;
  std::vector<const char*> parameters, of_z_alone;
};

const std::vector<GroupEntry>& group_table() {
  static const std::vector<GroupEntry> table = {{"camera_roll", {"camera_roll"}, {}},
                                                {"image_centre", {"centre_y", "centre_z"}, {"centre_z"}},
                                                {"pixel_aspect", {"pixel_aspect"}, {}},
                                                {"lens_k1", {"lens_k1"}, {"lens_k1"}},
                                                {"camera_distance", {"camera_distance"}, {"camera_distance"}}};
  return table;
}

}  // namespace

const std::vector<std::string>& optional_camera_parameters() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const GroupEntry& entry : group_table()) all.emplace_back(entry.name);
    return all;
  }();
  return names;
}

std::size_t camera_parameter(const std::string& name) {
  const auto found = std::find(camera_parameter_names.begin(), camera_parameter_names.end(), name);
  if (found != camera_parameter_names.end()) return found - camera_parameter_names.begin();
  throw InputError("'" + shown(name) + "' is not a camera parameter" +
                   suggest(name, {camera_parameter_names.begin(), camera_parameter_names.end()}));
}

CameraGroup camera_group(const std::string& name, bool with_y) {
  for (const GroupEntry& entry : group_table()) {
    if (name != entry.name) continue;
    CameraGroup group{name, {}};
    for (const char* parameter : with_y ? entry.parameters : entry.of_z_alone) group.parameters.push_back(camera_parameter(parameter));
    return group;
  }
  throw InputError("'" + shown(name) + "' is not an optional camera parameter" + suggest(name, optional_camera_parameters()));
}

}  // namespace misfit
