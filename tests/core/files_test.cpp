#include "misfit/core/files.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "misfit/core/error.h"
#include "misfit/core/mapped_file.h"
#include "misfit/core/new_file.h"
#include "tests/core/temporary_folder.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

TEST(ReadFile, GivesEveryByte) {
  const TemporaryFolder folder;
  const std::string content("a\0b\r\n", 5);
  EXPECT_EQ(read_file(folder.write("x", content)), content);
  EXPECT_EQ(read_file(folder.write("empty", "")), "");
}

TEST(ReadFile, MissingNamesTheNearestInItsFolder) {
  const TemporaryFolder folder;
  folder.write("track.csv", "t\n");
  expect_parts(message_of<InputError>([&] { (void)read_file(folder.path() / "trak.csv"); }), {"trak.csv: no such file", "'track.csv'"});
  expect_parts(message_of<InputError>([&] { (void)read_file(folder.path() / "none" / "x"); }), {"the folder", "does not exist"});
}

TEST(ReadFile, AFolderIsRefused) {
  const TemporaryFolder folder;
  expect_parts(message_of<InputError>([&] { (void)read_file(folder.path()); }), {"is a folder"});
}

TEST(WriteAtomically, ReplacesTheWholeFileAndLeavesNothingElse) {
  const TemporaryFolder folder;
  const fs::path file = folder.write("x", "a long old content");
  write_atomically(file, "new");
  EXPECT_EQ(read_file(file), "new");
  EXPECT_EQ(folder.entries(), 1U);
}

TEST(ANewFile, IsThereOnlyOncePublished) {
  const TemporaryFolder folder;
  const fs::path file = folder.write("x", "old");
  {
    NewFile given_up(file);
    given_up.add("half of ");
    EXPECT_EQ(read_file(file), "old");
  }
  EXPECT_EQ(read_file(file), "old");
  EXPECT_EQ(folder.entries(), 1U) << "the temporary is removed";
  NewFile whole(file);
  whole.add("in two ");
  whole.add("pieces");
  whole.publish();
  EXPECT_EQ(read_file(file), "in two pieces");
  EXPECT_EQ(folder.entries(), 1U);
}

/// Large files are mapped into memory, others read.
TEST(TheTextOfAFile, IsTheSameOfALargeOne) {
  const TemporaryFolder folder;
  EXPECT_EQ(FileText(folder.write("small", "t,y\n")).text(), "t,y\n");
  EXPECT_EQ(FileText(folder.write("empty", "")).text(), "");
  std::string large;
  large.resize(70'000'000, 'x');
  large += "end";
  const FileText text(folder.write("large", large));
  EXPECT_TRUE(text.text() == large);
  expect_parts(message_of<InputError>([&] { (void)FileText(folder.path() / "lage"); }), {"no such file", "'large'"});
}

TEST(WriteAtomically, BelowARegularFileNamesFileAndReason) {
  const TemporaryFolder folder;
  const fs::path file = folder.write("x", "");
  expect_parts(message_of<RunError>([&] { write_atomically(file / "y", "z"); }), {"x/y: cannot be written: Not a directory"});
}

TEST(WriteAtomically, OverAFolderIsRefused) {
  const TemporaryFolder folder;
  expect_parts(message_of<RunError>([&] { write_atomically(folder.path(), "z"); }), {"it is a folder"});
}

/// Runs `check` in a child process (its mounts and limits end with it) and returns its exit status.
template <class Check>
int in_child(Check check) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(check());
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

constexpr int ok = 0, wrong = 1, not_possible_here = 77;

/// Writes too much over "old": the words of the error, the old file and the removal of the temporary are checked.
int overfull(const fs::path& folder, const std::string& words) {
  const fs::path file = folder / "result.csv";
  write_atomically(file, "old");
  try {
    write_atomically(file, std::string(1 << 20, 'x'));
    return wrong;
  } catch (const RunError& error) {
    const std::string message = error.what();
    const auto entries = std::distance(fs::directory_iterator(folder), fs::directory_iterator());
    const bool expected = message.find(words) != std::string::npos && message.find("result.csv") != std::string::npos;
    return expected && read_file(file) == "old" && entries == 1 ? ok : wrong;
  }
}

TEST(WriteAtomically, OnAFullDiskKeepsTheOldFileAndSaysSo) {
  const TemporaryFolder folder;
  const int status = in_child([&] {
    if (::unshare(CLONE_NEWNS) != 0 && ::unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) return not_possible_here;
    (void)::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr);
    if (::mount("tmpfs", folder.path().c_str(), "tmpfs", 0, "size=64k") != 0) return not_possible_here;
    return overfull(folder.path(), "No space left on device");
  });
  if (status == not_possible_here) GTEST_SKIP() << "no small file system can be mounted here; the next test writes against a limit instead";
  EXPECT_EQ(status, ok);
}

TEST(WriteAtomically, AgainstTheFileSizeLimitKeepsTheOldFileAndSaysSo) {
  const TemporaryFolder folder;
  const int status = in_child([&] {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{65536, 65536};
    if (::setrlimit(RLIMIT_FSIZE, &limit) != 0) return wrong;
    return overfull(folder.path(), "File too large");
  });
  EXPECT_EQ(status, ok);
}

/// Not a word of the request is wrong when no more files may be opened: what is thrown must not be taken for a result.
TEST(WhatTheMachineRefuses, IsToldFromAWrongRequest) {
  const TemporaryFolder folder;
  const fs::path file = folder.write("x", "content");
  const int status = in_child([&] {
    const int next = ::dup(0);
    const rlimit limit{static_cast<rlim_t>(next), static_cast<rlim_t>(next)};
    ::close(next);
    if (::setrlimit(RLIMIT_NOFILE, &limit) != 0) return wrong;
    int expected = 0;
    try {
      (void)read_file(file);
    } catch (const MachineError& error) {
      expected += std::string(error.what()).find("x: cannot be read: Too many open files") != std::string::npos ? 1 : 0;
    }
    try {
      make_writable_folder(folder.path());
    } catch (const WriteError& error) {
      expected += std::string(error.what()).find("cannot be written to: Too many open files") != std::string::npos ? 1 : 0;
    }
    return expected == 2 ? ok : wrong;
  });
  EXPECT_EQ(status, ok);
}

TEST(MakeWritableFolder, MakesParentsAndLeavesItEmpty) {
  const TemporaryFolder folder;
  const fs::path deep = folder.path() / "a" / "b";
  make_writable_folder(deep);
  EXPECT_TRUE(fs::is_empty(deep));
  EXPECT_NO_THROW(make_writable_folder(deep));
}

TEST(MakeWritableFolder, RefusesAFileAndWhatIsBelowOne) {
  const TemporaryFolder folder;
  const fs::path file = folder.write("x", "");
  expect_parts(message_of<InputError>([&] { make_writable_folder(file); }), {"x"});
  expect_parts(message_of<InputError>([&] { make_writable_folder(file / "y"); }), {"x/y", "Not a directory"});
}

TEST(MakeWritableFolder, RefusesAFolderThatTakesNoFiles) {
  expect_parts(message_of<InputError>([] { make_writable_folder("/proc/self"); }), {"/proc/self: the folder cannot be written to"});
}

TEST(HashText, IsTheFnvOfTheReference) {
  EXPECT_EQ(hash_text(""), "cbf29ce484222325");  // offset basis, draft-eastlake-fnv
  EXPECT_EQ(hash_text("a"), "af63dc4c8601ec8c");
  EXPECT_EQ(hash_text("foobar"), "85944171f73967e8");
}

TEST(HashFile, ChangesWithTheContentOnly) {
  const TemporaryFolder folder;
  EXPECT_EQ(hash_file(folder.write("x", "foobar")), hash_file(folder.write("y", "foobar")));
  EXPECT_NE(hash_file(folder.write("x", "foobas")), hash_file(folder.path() / "y"));
}

}  // namespace
}  // namespace misfit
