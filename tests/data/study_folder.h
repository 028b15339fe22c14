#pragma once

#include <gtest/gtest.h>

#include <string>

#include "misfit/data/study.h"
#include "tests/core/temporary_folder.h"

namespace misfit {

/// A study folder with every file that the studies below name.
class StudyFolder : public ::testing::Test {
 protected:
  StudyFolder() {
    for (const char* name : {"track.csv", "other.csv", "static_sweep.csv", "static_test.csv", "flight.mkv", "model.toml", "template.png"})
      folder_.write(name, "x\n");
  }
  Study read(const std::string& text) const { return read_study(folder_.write("study.toml", text)); }
  /// A study that is right but for `text`.
  Study read_with(const std::string& text) const { return read("[system]\nkind = \"parachute_planar\"\n" + text); }
  std::string error_of(const std::string& text) const {
    return message_of<InputError>([&] { (void)read(text); });
  }
  /// `text` begins on line 3.
  std::string error_with(const std::string& text) const {
    return message_of<InputError>([&] { (void)read_with(text); });
  }
  TemporaryFolder folder_;
};

}  // namespace misfit
