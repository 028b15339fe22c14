#pragma once

// What discovery says of a recording beside a system given as text.

#include <memory>
#include <string>
#include <vector>

#include "misfit/discover/discover.h"
#include "tests/model/declared_texts.h"

namespace misfit::testing_models {

/// The system of `text` fitted to a recording.
struct Found {
  std::vector<Signals> signals;  ///< the estimate points to it
  std::shared_ptr<Registry> systems;
  ModelRequest request = request_of("text");
  FilterEstimate estimate;

  Found(const Signals& recording, const std::string& text)
      : signals{recording}, systems(registry_with(text)), estimate(estimate_filter(assemble(request, *systems), {}, signals)) {}
  Found(const Found&) = delete;
  Found& operator=(const Found&) = delete;
  Found(Found&&) = delete;
  Found& operator=(Found&&) = delete;
  ~Found() = default;

  [[nodiscard]] Discovery discover_missing(const DiscoverOptions& options = {}) const {
    return discover({estimate, request, *systems, signals}, options);
  }
};

}  // namespace misfit::testing_models
