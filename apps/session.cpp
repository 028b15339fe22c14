#include "apps/session.h"

#include <csignal>
#include <iostream>

#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "misfit/model/declared.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

std::atomic<bool> interrupt_flag{false};  // the one thing a signal handler may touch

extern "C" void on_interrupt(int) {
  interrupt_flag = true;
  std::signal(SIGINT, SIG_DFL);
}

Study open_study(const Options& options) {
  Study study = read_study(options.study);
  if (options.has_seed) study.seed = options.seed;
  return study;
}

fs::path folder_of(const Options& options, const Study& study) {
  return options.out.empty() ? study.folder / "out" : fs::path(options.out);
}

std::string hash_of_program() {
  std::error_code error;
  const fs::path self = fs::read_symlink("/proc/self/exe", error);
  return error ? "unknown" : hash_file(self);
}

}  // namespace

Session::Session(const Options& o, const Registry& r)
    : options(o),
      study(open_study(o)),
      declared(study_registry(study, r)),
      registry(*declared),
      model(read_model(study, registry)),
      folder(folder_of(o, study), o.command, study.seed),
      program(hash_of_program()) {}

std::map<std::string, std::string> Session::inputs(const std::string& settings, const std::vector<fs::path>& files) const {
  std::map<std::string, std::string> out{{"program", program}, {"settings", hash_text(settings)}};
  for (const auto& file : files) {
    const fs::path shown = file.lexically_relative(study.folder);
    out[shown.empty() ? file.filename().string() : shown.string()] = hash_file(file);
  }
  return out;
}

void Session::say(const std::string& line) const {
  if (!options.quiet) std::cerr << line << '\n';
}

const std::atomic<bool>& interrupted() { return interrupt_flag; }
void watch_interrupts() { std::signal(SIGINT, on_interrupt); }

void stop_if_interrupted() {
  if (interrupt_flag) throw RunError("interrupted; what was finished is in the run folder, and the same command goes on from there");
}

}  // namespace misfit
