#pragma once

#include <memory>
#include <string>

#include "misfit/data/study.h"
#include "misfit/model/registry.h"

namespace misfit {

/// A system declared as text (TOML). Keys:
///   [system]     doc, source, fastest_rate [1/s]  fastest_rate: steps of the integration are at most 0.5/fastest_rate long; without it
///                they are chosen from the equations and an estimate of their error (sim/planner.h)
///   [states]     NAME = { unit, initial, min, max, scale, rate_of }  initial: "free" (default), "shared" between experiments, a number
///   (fixed), or
///                { value, kind = "free" | "shared" | "fixed" }; no step leaves a state outside min … max, and formulas never see it there
///   [inputs]     NAME = { unit, hold = "zero_order" | "first_order" (default), delay [s], doc }  delay: a dead time that is
///                known; one to be estimated is the effect `delay`
///   [parameters] NAME = { unit, value, bounds, free = false, sigma, doc }
///   [quantities] NAME = { unit, formula, doc }
///   [ports]      NAME = { unit, rate, doc }: places for effects inside formulas; `rate`: quantity whose product with the port is power
///   [equations]  STATE = "formula": its time derivative
///   [outputs]    NAME = { unit, formula, noise }; the formula may be left out where NAME is a state
///   [roles]      rate, level, port, input, output = names; force_ports = [ports of the random force]
/// Formulas: misfit/formula; units are checked through them, SI and radians. Every equation also has the dynamic port dSTATE/dt, whose
/// conjugate is the state. Every input and quantity is a quantity port as well; an input before such changes is the quantity NAME_given.
/// Outputs do not see effects on quantity ports. InputError with file, line and column.
[[nodiscard]] SystemType declared_system(const std::string& text, const std::string& file, const std::string& key);

/// Adds a declared system that is part of the program: the list that misfit_add_effects generates calls it.
void register_declared(Registry& registry, const char* key, const char* text);

/// What the program knows and what this study declares: [system] file, and effects with a formula. `base` must outlive it.
[[nodiscard]] std::shared_ptr<const Registry> study_registry(const Study& study, const Registry& base);

}  // namespace misfit
