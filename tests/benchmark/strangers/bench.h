#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/benchmark/strangers/world.h"

namespace strangers {

struct Bench {
  std::filesystem::path program;  ///< misfit
  std::filesystem::path folder;   ///< of the worlds' folders
  int threads = 2;
  double limit = 60.0;           ///< of one process, wall time [s]
  double processor_limit = 0.0;  ///< of one process, all its threads [s]; 0: none. For a machine that is shared
  bool keep = false;             ///< worlds' folders
};

/// Writes DIR/study (the user's, by misfit init where the system has no text); false with `error` where init fails.
[[nodiscard]] bool write_study(const World& world, const Bench& bench, const std::filesystem::path& dir);
/// DIR/truth: the same with the hidden effects started at their values and the parameters at theirs. False where an effect has no such
/// text.
[[nodiscard]] bool write_truth(const World& world, const std::filesystem::path& dir);
/// DIR/twin: the user's study of the recording without anything hidden, started at the true parameters.
void write_twin(const World& world, const std::filesystem::path& dir);

/// How a process ended.
struct Ended {
  int status = 0;  ///< -1: killed at a limit
  double seconds = 0.0, processor_seconds = 0.0;
};
[[nodiscard]] Ended run(const std::vector<std::string>& words, const std::filesystem::path& output, const Bench& bench);

/// Runs the world and judges the answer: one row of the table. DIR is made, and removed unless kept.
[[nodiscard]] nlohmann::json answer(const World& world, const Bench& bench);

void print_table(const std::vector<nlohmann::json>& rows);

}  // namespace strangers
