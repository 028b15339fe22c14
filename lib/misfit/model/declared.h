#pragma once

#include <memory>
#include <string>

#include "misfit/data/study.h"
#include "misfit/model/registry.h"

namespace misfit {

/// Few products of states, inputs and parameters are possible in a system of so many states. Among the many of a larger one there is one
/// that looks like whatever is missing (of the velocities of two masses, a square of their difference).
inline constexpr std::size_t states_of_a_small_system = 3;

/// A system declared as text (TOML); its keys: declared_keys.cpp, misfit help system. Formulas: misfit/formula; units are checked through
/// them, SI and radians. Every equation also has the dynamic port dSTATE/dt, whose conjugate is the state. Every input and quantity is a
/// quantity port as well; an input before such changes is the quantity NAME_given. So is every parameter that stands in
/// several equations and outputs, and in a system of up to three states each whose action depends on states or inputs.
/// An output that is a formula of an input or quantity sees what effects add to it. InputError with file, line and column.
/// `holds`: what its inputs are between their samples, in place of what the text says.
[[nodiscard]] SystemType declared_system(const std::string& text, const std::string& file, const std::string& key,
                                         const std::map<std::string, HoldStudy>& holds = {});

/// Adds a declared system that is part of the program: the list that misfit_add_effects generates calls it.
void register_declared(Registry& registry, const char* key, const char* text);

/// What the program knows and what this study declares: [system] file, and effects with a formula. `base` must outlive it.
[[nodiscard]] std::shared_ptr<const Registry> study_registry(const Study& study, const Registry& base);

}  // namespace misfit
