#pragma once

#include "misfit/data/study.h"

/// Sections of a study, one function each: the parts of read_study (study.h). All throw InputError with the place in the file.
namespace misfit::study_parts {

/// Every one of `names` (the value of `key`) is in `valid`, and none is given twice.
void check_names(const config::Section& section, std::string_view key, const std::vector<std::string>& names,
                 const std::vector<std::string>& valid);

/// The file that `key` names, taken from `folder`; it must exist, else the nearest name there is given. nullopt if the key is absent.
[[nodiscard]] std::optional<std::filesystem::path> existing_file(const config::Section& section, std::string_view key,
                                                                 const std::filesystem::path& folder);

/// "0.5 m" → 0.5 with unit "m" (value in SI, unit as written); "0.5" has an empty unit.
[[nodiscard]] config::Number number_as_written(const config::Section& section, std::string_view key);

void read_camera(const config::Section& root, Study& study);
void read_experiments(const config::Section& root, Study& study);
void read_video(const config::Section& root, Study& study);
/// sweep_images, sweep_marker and sweep_points of [camera]; the marker's default is that of [video], which is read before.
void read_sweep_images(const config::Section& camera, Study& study);
void read_initial(const config::Section& root, Study& study);
void read_effects(const config::Section& root, Study& study);
void read_parameters(const config::Section& root, Study& study);
void read_curves(const config::Section& root, Study& study);
void read_reference(const config::Section& root, Study& study);
void read_simulate(const config::Section& root, Study& study);
void read_uncertainty(const config::Section& root, Study& study);

}  // namespace misfit::study_parts
