#pragma once

#include <atomic>

namespace misfit {

/// True asks long work to stop: it finishes what it is at, writes, and ends. Whoever wants to stop it sets it: a signal handler may (it is
/// lock-free), as may another thread.
[[nodiscard]] std::atomic<bool>& interrupted();

/// RunError "interrupted; …" if interrupted() is true: called between stages, when everything done so far is on disk.
void stop_if_interrupted();

}  // namespace misfit
