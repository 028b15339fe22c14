#pragma once

#include "misfit/core/error.h"

namespace misfit {

/// An effect has no place in this system: a port, a quantity, a constant or another effect that it needs is not there, or has another unit.
/// Asked for by a study it is a mistake as any other; a search, which tries every effect everywhere, passes over it. All else that
/// assemble() refuses is wrong wherever the effect stands.
class DoesNotSuit : public InputError {
 public:
  using InputError::InputError;
};

}  // namespace misfit
