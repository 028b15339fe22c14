#pragma once

#include "misfit/model/registry.h"

// What MISFIT_EFFECT makes of these effects, for a registry that knows no others.
void misfit_register_coulomb_friction(misfit::Registry& registry);
void misfit_register_load_friction(misfit::Registry& registry);
