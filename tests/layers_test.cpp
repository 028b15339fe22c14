// The layers, enforced: the LINKS of each misfit_layer(…) line in the root CMakeLists.txt are the only other layers its files may include.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/paths.h"

namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Headers (by how their names begin) that cost seconds per includer: one file each may have them.
const std::vector<std::string> costly = {"ceres/ceres.h", "CLI/", "gnuplot-iostream", "httplib.h", "toml++/"};

using Layers = std::map<std::string, std::set<std::string>>;  ///< layer → layers it may include

struct Include {
  std::string file;  ///< relative to the repository
  int line = 0;
  std::string target;

  [[nodiscard]] std::string text() const { return file + ":" + std::to_string(line) + ": includes " + target; }
};

std::string read(const fs::path& path) {
  std::ifstream in(path);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

Layers read_layers(const fs::path& root) {
  static const std::regex call(R"((?:^|\n)misfit_layer\(([\w/]+)([^)]*)\))");
  const std::string text = read(root / "CMakeLists.txt");
  Layers layers;
  for (std::sregex_iterator it(text.begin(), text.end(), call), end; it != end; ++it) {
    const std::string name = (*it)[1];
    std::set<std::string>& allowed = layers[name];
    allowed.insert(name);
    std::istringstream words((*it)[2]);
    for (std::string word; words >> word && word != "PRIVATE";) {
      if (layers.contains(word)) allowed.insert(word);
    }
  }
  return layers;
}

std::vector<Include> read_includes(const fs::path& root, const std::string& folder) {
  static const std::regex directive(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
  std::vector<Include> includes;
  if (!fs::exists(root / folder)) return includes;
  for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
    const auto extension = entry.path().extension();
    if (extension != ".h" && extension != ".cpp") continue;
    std::ifstream in(entry.path());
    std::string text;
    std::smatch match;
    for (int line = 1; std::getline(in, text); ++line) {
      if (std::regex_search(text, match, directive)) includes.push_back({fs::relative(entry.path(), root).string(), line, match[1]});
    }
  }
  return includes;
}

/// LAYER of "misfit/LAYER/x.h" or of "lib/misfit/LAYER/x.cpp" after `prefix`: the longest that is a layer, for a folder inside a folder may
/// be one of its own; the first folder if none is. Empty without that prefix.
std::string layer_of(const std::string& path, const std::string& prefix, const Layers& layers) {
  if (!path.starts_with(prefix)) return "";
  const std::string rest = path.substr(prefix.size());
  for (std::size_t end = rest.rfind('/'); end != std::string::npos && end > 0; end = rest.rfind('/', end - 1)) {
    if (layers.contains(rest.substr(0, end))) return rest.substr(0, end);
  }
  return rest.substr(0, rest.find('/'));
}

/// misfit/misfit.h, the header for users, stands above all layers: it may include each of them, and none of them includes it.
bool above_all_layers(const Include& include) { return fs::path(include.file).parent_path() == "lib/misfit"; }

void check_layer(const Include& include, const Layers& layers, std::vector<std::string>& faults) {
  if (above_all_layers(include)) return;
  const std::string from = layer_of(include.file, "lib/misfit/", layers);
  const auto layer = layers.find(from);
  if (layer == layers.end()) {
    faults.push_back(include.file + ": folder '" + from + "' has no misfit_layer line in CMakeLists.txt");
    return;
  }
  const std::string to = layer_of(include.target, "misfit/", layers);
  if (!to.empty() && !layer->second.contains(to)) faults.push_back(include.text() + "; the LINKS of " + from + " do not permit " + to);
  if (include.target.starts_with("models/") || include.target.starts_with("apps/")) {
    faults.push_back(include.text() + "; lib knows neither models nor apps");
  }
}

void check_models(const Include& include, const Layers& layers, std::vector<std::string>& faults) {
  static const std::set<std::string> allowed = {"core", "math", "data", "model"};
  const std::string to = layer_of(include.target, "misfit/", layers);
  if ((!to.empty() && !allowed.contains(to)) || include.target.starts_with("apps/")) {
    faults.push_back(include.text() + "; models may include core, math, data and model");
  }
}

void check_costly(const std::vector<Include>& includes, std::vector<std::string>& faults) {
  for (const std::string& header : costly) {
    std::map<std::string, Include> includers;  // by file
    for (const Include& include : includes) {
      if (include.target.starts_with(header)) includers.emplace(include.file, include);
    }
    for (const auto& [file, include] : includers) {
      const std::string& first = includers.begin()->first;
      if (file != first) faults.push_back(include.text() + ", as " + first + " does; one includer only");
    }
  }
}

/// Every include that breaks the rules, as "file:line: …", sorted.
std::vector<std::string> faults_of(const fs::path& root) {
  const Layers layers = read_layers(root);
  std::vector<Include> all = read_includes(root, "lib");
  std::vector<std::string> faults;
  for (const Include& include : all) check_layer(include, layers, faults);
  for (const Include& include : read_includes(root, "models")) {
    check_models(include, layers, faults);
    all.push_back(include);
  }
  for (const Include& include : read_includes(root, "apps")) all.push_back(include);
  check_costly(all, faults);
  std::sort(faults.begin(), faults.end());
  faults.erase(std::unique(faults.begin(), faults.end()), faults.end());
  return faults;
}

/// A small tree in which core < math < fit, written to a folder that is removed afterwards.
class MadeUpTree : public testing::Test {
 protected:
  MadeUpTree()
      : root_(fs::path(testing::TempDir()) / ("layers_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()))) {
    write("CMakeLists.txt",
          "misfit_layer(core LINKS fmt::fmt)\nmisfit_layer(math LINKS core PRIVATE Ceres::ceres)\n"
          "misfit_layer(model LINKS core)\nmisfit_layer(fit LINKS core\n  math)\n");
    write("lib/misfit/fit/fit.cpp", "#include <vector>\n#include \"misfit/fit/fit.h\"\n#include \"misfit/math/spline.h\"\n");
    write("models/drag.cpp", "#include \"misfit/model/effect.h\"\n");
  }
  ~MadeUpTree() override { fs::remove_all(root_); }

  void write(const std::string& file, const std::string& text) const {
    fs::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file) << text;
  }

  fs::path root_;
};

TEST(Layers, AreReadFromTheLinkLines) {
  const Layers layers = read_layers(paths::source());
  ASSERT_TRUE(layers.contains("core") && layers.contains("fit") && layers.contains("report"));
  EXPECT_THAT(layers.at("core"), ElementsAre("core"));
  EXPECT_TRUE(layers.at("fit").contains("sim"));
  EXPECT_FALSE(layers.at("sim").contains("fit"));
}

TEST(Layers, EveryIncludeIsPermitted) {
  ASSERT_GT(read_includes(paths::source(), "lib").size(), 100u) << "the sources were not found";
  EXPECT_THAT(faults_of(paths::source()), IsEmpty());
}

TEST_F(MadeUpTree, PermittedIncludesPass) { EXPECT_THAT(faults_of(root_), IsEmpty()); }

TEST_F(MadeUpTree, UpwardIncludeIsFoundWithFileAndLine) {
  write("lib/misfit/math/spline.h", "#pragma once\n\n#  include \"misfit/fit/fit.h\"\n");
  EXPECT_THAT(faults_of(root_), ElementsAre(HasSubstr("lib/misfit/math/spline.h:3: includes misfit/fit/fit.h; the LINKS of math")));
}

TEST_F(MadeUpTree, AFolderInsideAFolderIsALayerOfItsOwn) {
  write("CMakeLists.txt",
        "misfit_layer(core LINKS)\nmisfit_layer(math LINKS core)\nmisfit_layer(model LINKS core)\n"
        "misfit_layer(fit/filter LINKS core)\nmisfit_layer(fit LINKS core math fit/filter)\n");
  write("lib/misfit/fit/table.h", "#include \"misfit/fit/filter/run.h\"\n");
  EXPECT_THAT(faults_of(root_), IsEmpty());
  write("lib/misfit/fit/filter/run.h", "#include \"misfit/fit/table.h\"\n#include \"misfit/math/spline.h\"\n");
  EXPECT_THAT(faults_of(root_), ElementsAre(HasSubstr("fit/filter/run.h:1: includes misfit/fit/table.h"),
                                            HasSubstr("fit/filter/run.h:2: includes misfit/math/spline.h")));
}

TEST_F(MadeUpTree, PrivatePackageIsNoPermissionForALayer) {
  write("CMakeLists.txt", "misfit_layer(core LINKS)\nmisfit_layer(math LINKS core)\nmisfit_layer(model LINKS core PRIVATE math)\n");
  fs::remove_all(root_ / "lib");
  write("lib/misfit/model/model.h", "#include \"misfit/math/spline.h\"\n");
  EXPECT_THAT(faults_of(root_), ElementsAre(HasSubstr("model.h:1")));
}

TEST_F(MadeUpTree, LibraryThatKnowsModelsOrAppsIsFound) {
  write("lib/misfit/fit/a.cpp", "#include \"models/drag.h\"\n");
  write("lib/misfit/fit/b.cpp", "#include \"apps/verbs.h\"\n");
  EXPECT_THAT(faults_of(root_), ElementsAre(HasSubstr("fit/a.cpp:1"), HasSubstr("fit/b.cpp:1")));
}

TEST_F(MadeUpTree, ModelThatKnowsAStageIsFound) {
  write("models/group/lift.cpp", "#include \"misfit/model/effect.h\"\n#include \"misfit/fit/fit.h\"\n");
  EXPECT_THAT(faults_of(root_), ElementsAre(HasSubstr("models/group/lift.cpp:2")));
}

TEST_F(MadeUpTree, SecondIncluderOfACostlyHeaderIsFound) {
  write("lib/misfit/fit/solve.cpp", "#include <ceres/ceres.h>\n");
  EXPECT_THAT(faults_of(root_), IsEmpty());
  write("apps/main.cpp", "#include <ceres/ceres.h>\n");
  EXPECT_THAT(faults_of(root_), ElementsAre(HasSubstr("lib/misfit/fit/solve.cpp:1: includes ceres/ceres.h, as apps/main.cpp does")));
}

TEST_F(MadeUpTree, TheHeaderForUsersIncludesEveryLayerAndNoLayerIncludesIt) {
  write("lib/misfit/misfit.h", "#include \"misfit/fit/fit.h\"\n");
  EXPECT_THAT(faults_of(root_), IsEmpty());
  write("lib/misfit/fit/fit.h", "#include \"misfit/misfit.h\"\n");
  EXPECT_THAT(faults_of(root_), ElementsAre(HasSubstr("fit/fit.h:1: includes misfit/misfit.h")));
}

TEST_F(MadeUpTree, FolderWithoutALayerLineIsFound) {
  write("lib/misfit/extra/x.h", "#include <vector>\n");
  EXPECT_THAT(faults_of(root_), ElementsAre(HasSubstr("folder 'extra' has no misfit_layer line")));
}

/// Types that a file defines outside of unnamed namespaces, with the namespaces they are in.
std::set<std::string> types_of(const std::string& text) {
  static const std::regex opened(R"(^(?:inline )?namespace\s*([\w:]*)\s*\{)"), closed(R"(^\}\s*// namespace)"),
      type(R"(^(?:struct|class|enum class|enum)\s+(\w+)\s*(?:final\s*)?(?::[^:;{][^;{]*)?\{)");
  std::set<std::string> out;
  std::vector<std::string> inside;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || std::string("nisce}").find(line.front()) == std::string::npos) continue;
    std::smatch found;
    if (std::regex_search(line, found, opened)) inside.push_back(found[1]);
    if (std::regex_search(line, closed) && !inside.empty()) inside.pop_back();
    if (!std::regex_search(line, found, type) || std::find(inside.begin(), inside.end(), "") != inside.end()) continue;
    std::string name;
    for (const std::string& space : inside) name += space + "::";
    out.insert(name + found[1].str());
  }
  return out;
}

/// "misfit::Column: a.h, b.h" for every type that two files define: one program must not hold both (the linker joins their functions).
std::vector<std::string> types_defined_twice(const fs::path& root) {
  std::map<std::string, std::vector<std::string>> files;
  for (const std::string folder : {"lib", "apps", "models"}) {
    if (!fs::exists(root / folder)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      if (entry.path().extension() != ".h" && entry.path().extension() != ".cpp") continue;
      for (const std::string& type : types_of(read(entry.path()))) files[type].push_back(fs::relative(entry.path(), root).string());
    }
  }
  std::vector<std::string> out;
  for (auto& [type, in] : files) {
    if (in.size() < 2) continue;
    std::sort(in.begin(), in.end());
    std::string line = type + ":";
    for (const std::string& file : in) line += " " + file;
    out.push_back(line);
  }
  return out;
}

TEST(Types, AreDefinedOnce) {
  EXPECT_THAT(types_of(read(paths::source() / "lib/misfit/core/table.h")), testing::Contains("misfit::Column"));
  EXPECT_THAT(types_defined_twice(paths::source()), IsEmpty());
}

TEST_F(MadeUpTree, ATypeDefinedTwiceIsFound) {
  write("lib/misfit/fit/a.h", "namespace misfit {\nstruct Row {\n};\n}  // namespace misfit\n");
  write("apps/b.h", "namespace misfit {\nenum class Row { one };\nclass Line : Row {\n};\n}  // namespace misfit\n");
  write("lib/misfit/fit/c.cpp",
        "namespace misfit {\nnamespace {\nstruct Row {\n};\n}  // namespace\nstruct Row::Part {\n};\n}  // namespace misfit\n");
  EXPECT_THAT(types_defined_twice(root_), ElementsAre("misfit::Row: apps/b.h lib/misfit/fit/a.h"));
}

}  // namespace
