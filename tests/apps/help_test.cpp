// misfit help, and the keys of files: the reference names every key that the readers know, and they know every key that it names.

#include <set>
#include <tuple>

#include "misfit/core/keys.h"
#include "misfit/data/study_keys.h"
#include "misfit/model/declared_keys.h"
#include "tests/apps/program.h"
#include "tests/paths.h"

namespace {

using namespace program;
using misfit::TomlNode;
using misfit::TomlPath;
using misfit::config::Key;
using misfit::config::KeyGroup;
using misfit::config::KeyType;

TEST(Help, ListsVerbsAndTopics) {
  const Outcome outcome = run({"help"});
  EXPECT_EQ(outcome.status, 0);
  expect_parts(outcome.out,
               {"misfit help VERB", "\n  fit  ", "\n  effects  ", "misfit help TOPIC", "\n  study  ", "\n  system  ", "\n  words  "});
}

TEST(Help, OfAVerbIsWhatTheVerbSays) { EXPECT_EQ(run({"help", "fit"}).out, run({"fit", "--help"}).out); }

TEST(Help, NamesTheNearestTopic) {
  for (const auto& [typed, meant] : std::vector<std::pair<const char*, const char*>>{{"studdy", "study"}, {"diagnos", "diagnose"}}) {
    const Outcome outcome = run({"help", typed});
    EXPECT_EQ(outcome.status, 2);
    expect_parts(outcome.err, {"misfit help knows no"});
    EXPECT_NE(outcome.err.find("did you mean '" + std::string(meant) + "'?"), std::string::npos) << outcome.err;
  }
  EXPECT_EQ(run({"help", "fit", "study"}).status, 2);
}

TEST(Help, OfAVerbSaysWhatItReadsAndWritesWithAnExample) {
  const std::string all = run({"help"}).out;
  int verbs = 0;
  for (const char* verb : {"run", "track", "calibrate", "attitude", "fit", "diagnose", "discover", "add", "remove", "set", "compare",
                           "uncertainty", "report", "open", "simulate", "batch", "export", "init", "effects"}) {
    const Outcome outcome = run({verb, "--help"});
    EXPECT_EQ(outcome.status, 0) << verb;
    EXPECT_TRUE(outcome.out.starts_with(std::string("misfit ") + verb + ":")) << outcome.out;
    expect_parts(outcome.out, {"\n  reads ", "\n  writes ", "\n  example  misfit ", "\n  -h, --help "});
    std::istringstream lines(outcome.out);
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 102U) << verb << ": " << line;  // … is three bytes
    verbs += all.find(std::string("\n  ") + verb) != std::string::npos ? 1 : 0;
  }
  EXPECT_EQ(verbs, 19);
}

TEST(Help, ManualAndCompletionNameEveryOptionOfTheHelp) {
  const TemporaryFolder folder;
  ASSERT_EQ(run({"help", "--manual", folder.path().string()}).status, 0);
  const std::string completion = content(folder.path() / "bash-completion/misfit");
  int pages = 0;
  for (const auto& page : fs::directory_iterator(folder.path() / "man1")) {
    ++pages;
    const std::string name = page.path().stem().string(), text = content(page.path());
    EXPECT_TRUE(text.starts_with(".TH \"misfit")) << name;
    if (name == "misfit") continue;
    const std::string verb = name.substr(std::string("misfit-").size());
    std::istringstream lines(run({verb, "--help"}).out);
    for (std::string line; std::getline(lines, line);) {
      std::smatch option;
      if (!std::regex_search(line, option, std::regex("^  (--[a-z-]+)"))) continue;
      EXPECT_NE(text.find(std::regex_replace(option[1].str(), std::regex("-"), "\\-")), std::string::npos) << verb << option[1];
      EXPECT_NE(completion.find(option[1].str()), std::string::npos) << verb << option[1];
    }
  }
  EXPECT_EQ(pages, 20);
}

/// As readline asks for it.
std::string completed(const fs::path& file, const std::string& words, int at) {
  const TemporaryFolder folder;
  const std::string command = "bash -c '. " + file.string() + "; COMP_WORDS=(" + words + "); COMP_CWORD=" + std::to_string(at) +
                              "; _misfit; echo \"${COMPREPLY[*]}\"' > " + (folder.path() / "said").string();
  EXPECT_EQ(std::system(command.c_str()), 0);  // NOLINT(cert-env33-c)
  return content(folder.path() / "said");
}

TEST(Help, CompletionKnowsVerbsOptionsAndValues) {
  const TemporaryFolder folder;
  ASSERT_EQ(run({"help", "--manual", folder.path().string()}).status, 0);
  const fs::path file = folder.path() / "bash-completion/misfit";
  EXPECT_EQ(completed(file, "misfit cal", 1), "calibrate\n");
  EXPECT_EQ(completed(file, "misfit fit --me", 2), "--method\n");
  EXPECT_EQ(completed(file, "misfit fit x --method filt", 4), "filter_error\n");
  EXPECT_EQ(completed(file, "misfit export --to ", 3), "json csv c python jsbsim\n");
  EXPECT_EQ(completed(file, "misfit help wor", 2), "words\n");
}

TEST(NoVerb, SaysWhatToDoNext) {
  const TemporaryFolder folder;
  const auto here = [&] {
    const Outcome outcome = run({}, [&] { std::ignore = ::chdir(folder.path().c_str()); });
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.out;
  };
  expect_parts(here(), {"No study and no CSV file in this folder", "misfit init DATA.csv", "misfit help"});
  folder.write("my motor.csv", "t,u,y\n");
  expect_parts(here(), {"misfit init 'my motor.csv'"});
  const std::string apostrophe = "the pendulum's recording of the thirteenth of November.csv";
  folder.write(apostrophe, "t,u,y\n");
  expect_parts(here(), {"misfit init 'the pendulum'\\''s recording of the thirteenth of November.csv'"});
  fs::remove(folder.path() / apostrophe);
  fs::create_directories(folder.path() / "flight");
  folder.write("flight/study.toml", "");
  expect_parts(here(), {"misfit run flight", "misfit init 'my motor.csv'"});
  folder.write("study.toml", "");
  expect_parts(here(), {"a study that has not been run", "misfit run ."});
  fs::create_directories(folder.path() / "out/fit");
  folder.write("out/run.json", "");
  folder.write("out/report.html", "");
  expect_parts(here(), {"misfit discover . --auto", "misfit export . --to json", "out/report.html"});
}

std::size_t characters(const std::string& line) {
  return std::count_if(line.begin(), line.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; });
}

TEST(Help, KeepsTo100Columns) {
  for (const char* topic : {"", "study", "system", "effects", "data", "words"}) {
    std::istringstream lines(run(*topic == '\0' ? std::vector<std::string>{"help"} : std::vector<std::string>{"help", topic}).out);
    for (std::string line; std::getline(lines, line);) EXPECT_LE(characters(line), 100U) << topic << ": " << line;
  }
}

TEST(Help, OfStudyHasSystemsWithTheirOptionsAndConstants) {
  const std::string text = run({"help", "study"}).out;
  expect_parts(text,
               {"\nparachute_planar\n", "options: induced_angle", "R_cp", "swivel to centre of pressure", "\ncascaded_tanks\n", "V^0.5/s"});
}

TEST(Effect, IsPrintedInFullByItsKey) {
  const Outcome outcome = run({"effects", "coulomb_friction"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  expect_parts(outcome.out,
               {"coulomb_friction\n  formula", "symbols", "parameter", "friction", "strength", "bounds", "adds to", "valid", "source",
                "[effects]\n    coulomb_friction = {}\n", "to act elsewhere: coulomb_friction = { rate = \"NAME\", port = \"NAME\" }"});
  EXPECT_EQ(json::parse(run({"effects", "coulomb_friction", "--json"}).out).size(), 1U);
}

TEST(Effect, OfAStudyIsPrintedInFullByItsName) {
  const StudyCopy study("validation");
  const Outcome outcome = run({"effects", study.path("").string(), "static_moment"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(outcome.out.starts_with("static_moment\n  formula")) << outcome.out;
  EXPECT_EQ(run({"effects", study.path("").string(), "static_momen"}).status, 2);
}

TEST(Effect, UnknownNamesTheNearest) {
  const Outcome outcome = run({"effects", "coulomb_fricton"});
  EXPECT_EQ(outcome.status, 2);
  expect_parts(outcome.err, {"unknown effect 'coulomb_fricton'", "did you mean 'coulomb_friction'?"});
}

/// The line that study_line proposes is one that a study takes.
TEST(Effect, LineCanBePasted) {
  const std::string text = run({"effects", "overflow"}).out;
  const std::string line = "\n    overflow = {}\n";
  ASSERT_NE(text.find(line), std::string::npos) << text;
  const StudyCopy study("cascaded_tanks");
  study.append("[effects]" + line);
  EXPECT_EQ(study.run("effects").status, 0);
}

void expect_complete(std::span<const KeyGroup> groups, const std::string& reference) {
  for (const KeyGroup& group : groups) {
    EXPECT_FALSE(group.meaning.empty()) << group.path;
    std::set<std::string> names;
    for (const Key& key : group.keys) {
      const std::string of = group.path + "." + key.name;
      EXPECT_TRUE(names.insert(key.name).second) << of << " stands there twice";
      EXPECT_FALSE(key.meaning.empty()) << of;
      EXPECT_NE(key.fallback.empty(), key.otherwise.empty()) << of << ": either a default, or what holds without one";
      const bool number = key.type == KeyType::number || key.type == KeyType::number_with_sigma || key.type == KeyType::numbers;
      EXPECT_TRUE(!number || !key.unit.empty()) << of << " needs a unit";
      EXPECT_TRUE(key.type != KeyType::choice || !key.choices.empty()) << of;
      EXPECT_NE(reference.find("\n  " + key.name + " "), std::string::npos) << of;
    }
  }
}

TEST(KeyReference, OfStudyIsComplete) { expect_complete(misfit::study_keys(), run({"help", "study"}).out); }
TEST(KeyReference, OfSystemIsComplete) { expect_complete(misfit::declared::system_keys(), run({"help", "system"}).out); }

/// Where a key is put, and what must stand around it that it is read.
struct Place {
  std::string before, beside, after = "\n";
};

Place study_place(const KeyGroup& group) {
  if (group.variant == "formula") return {"[effects.e]\n", "formula = \"x1\"\nport = \"dx1/dt\"\n"};
  static const std::map<std::string, Place> places = {
      {"camera", {"[camera]\n", "sweep = \"estimation.csv\"\n"}},
      {"experiment", {"[[experiment]]\n", "data = \"estimation.csv\"\n"}},
      {"effects.NAME", {"[effects.e]\n", "kind = \"bias\"\n"}},
      {"effects.NAME.parameters.NAME",
       {"[effects.e]\nformula = \"c*x1\"\nport = \"dx1/dt\"\n[effects.e.parameters.c]\n", "unit = \"1/s\"\n"}},
      {"parameters.NAME", {"[parameters.k1]\n", ""}},
      {"curves.NAME", {"[curves.k1]\n", "of = \"x1\"\n"}},
      {"initial.NAME", {"[initial.x1]\n", ""}},
      {"uncertainty", {"[uncertainty]\n", "perturb = { k1 = 0.1 }\n"}}};
  const auto found = places.find(group.path);
  return found == places.end() ? Place{"[" + group.path + "]\n", ""} : found->second;
}

/// `beside` without the line of this key.
std::string lines_but(const std::string& beside, const std::string& key) {
  std::istringstream lines(beside);
  std::string out;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(key + " =")) out += line + "\n";
  }
  return out;
}

constexpr const char* wrong = " = 1979-05-27\n";  // a date: no reader takes one

/// For its value, not as unknown.
void expect_refused(const Outcome& outcome, const std::string& table, const std::string& key) {
  EXPECT_EQ(outcome.status, 2) << table << "." << key;
  EXPECT_NE(outcome.err.find("." + key + " = 1979-05-27"), std::string::npos) << table << "." << key << ": " << outcome.err;
}

TEST(KeyReference, OfStudyNamesNoKeyThatTheReadersDoNotKnow) {
  const StudyCopy study("cascaded_tanks");
  for (const KeyGroup& group : misfit::study_keys()) {
    for (const Key& key : group.keys) {
      if (key.any) continue;
      const Place place = study_place(group);
      const std::string system = group.path == "system" ? "" : "[system]\nkind = \"cascaded_tanks\"\n";
      study.write("study.toml", system + place.before + lines_but(place.beside, key.name) + key.name + wrong + place.after);
      expect_refused(study.run("fit"), group.path, key.name);
    }
  }
}

TEST(KeyReference, OfSystemNamesNoKeyThatTheReaderDoesNotKnow) {
  const StudyCopy study("cascaded_tanks");
  study.write("study.toml", "[system]\nfile = \"s.toml\"\n");
  const std::string system = "[states.x]\nunit = \"-\"\n[equations]\nx = \"-x/t\"\n[outputs.x]\nunit = \"-\"\n";
  for (const KeyGroup& group : misfit::declared::system_keys()) {
    for (const Key& key : group.keys) {
      if (key.any) continue;
      const std::string table = std::regex_replace(group.path, std::regex("NAME"), "n");
      const bool initial = group.path == "states.NAME.initial";
      const bool with_unit = group.path.ends_with(".NAME") && key.name != "unit";
      study.write("s.toml", system + (initial ? "[states.n]\nunit = \"V\"\n" : "") + "[" + table + "]\n" +
                                (with_unit ? "unit = \"V\"\n" : "") + key.name + wrong);
      expect_refused(study.run("effects"), group.path, key.name);
    }
  }
}

/// Entries of a file that no key describes. What is inside a number's { value, sigma } needs no description.
std::vector<std::string> undescribed(std::span<const KeyGroup> groups, const fs::path& file) {
  std::vector<std::string> out;
  std::set<TomlPath> closed;  // arrays, and numbers with a sigma
  for (const TomlNode& node : misfit::toml_outline(content(file))) {
    const TomlPath above(node.path.begin(), node.path.end() - 1);
    const Key* key = misfit::config::find_key(groups, node.path);
    const bool values = node.kind == TomlNode::Kind::array && node.path.size() > 1;
    if (closed.contains(above) || values || (key != nullptr && key->type == KeyType::number_with_sigma)) closed.insert(node.path);
    if (node.kind == TomlNode::Kind::table || closed.contains(above) || key != nullptr) continue;
    if (node.kind == TomlNode::Kind::array && node.path.size() == 1) continue;
    std::string path;
    for (const std::string& part : node.path) path += "/" + part;
    out.push_back(file.string() + ": " + path);
  }
  return out;
}

TEST(KeyReference, HasEveryKeyOfTheShippedStudiesAndSystems) {
  std::size_t studies = 0, systems = 0;
  for (const char* folder : {"configs", "models"}) {
    for (const auto& entry : fs::recursive_directory_iterator(paths::source() / folder)) {
      if (entry.path().extension() != ".toml" || entry.path().string().find("/out/") != std::string::npos) continue;
      const bool system = content(entry.path()).find("\n[equations]") != std::string::npos;
      ++(system ? systems : studies);
      EXPECT_EQ(undescribed(system ? misfit::declared::system_keys() : misfit::study_keys(), entry.path()), std::vector<std::string>{});
    }
  }
  EXPECT_GE(studies, 8U);
  EXPECT_GE(systems, 3U);
}

}  // namespace
