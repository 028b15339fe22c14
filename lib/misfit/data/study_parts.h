#pragma once

#include "misfit/data/study.h"
#include "misfit/data/study_keys.h"

/// Sections of a study, one function each: the parts of read_study (study.h). All throw InputError with the place in the file.
namespace misfit::study_parts {

/// The table KEY of a section by its description in study_keys(), under `path` (its own key if none is given); an empty one, with defaults
/// alone, where the section has no such table.
[[nodiscard]] config::DescribedSection described(const config::Section& section, std::string_view key, std::string_view path = "");

/// The file that `key` names, taken from `folder`; it must exist, else the nearest name there is given. nullopt if the key is absent.
[[nodiscard]] std::optional<std::filesystem::path> existing_file(const config::Section& section, std::string_view key,
                                                                 const std::filesystem::path& folder);

/// "0.5 m" → 0.5 with unit "m" (value in SI, unit as written); "0.5" and 0.5 have an empty unit.
[[nodiscard]] config::Number number_as_written(const config::Section& section, std::string_view key);

void read_camera(const config::Section& root, Study& study);
void read_experiments(const config::Section& root, Study& study);
void read_video(const config::Section& root, Study& study);
/// sweep_images, sweep_marker and sweep_points of [camera]; the marker's default is that of [video], which is read before.
void read_sweep_images(const config::DescribedSection& camera, Study& study);
void read_initial(const config::Section& root, Study& study);
void read_noise(const config::Section& root, Study& study);
void read_force(const config::Section& root, Study& study);
void read_effects(const config::Section& root, Study& study);
void read_parameters(const config::Section& root, Study& study);
void read_curves(const config::Section& root, Study& study);
void read_reference(const config::Section& root, Study& study);
void read_simulate(const config::Section& root, Study& study);
void read_uncertainty(const config::Section& root, Study& study);

}  // namespace misfit::study_parts
