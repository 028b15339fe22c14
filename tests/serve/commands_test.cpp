// What the page does: commands of the program, one at a time, recorded so that they can be done again.
#include <gmock/gmock.h>

#include "tests/apps/oscillator_study.h"
#include "tests/paths.h"
#include "tests/serve/page_server.h"

namespace {

using namespace program;
using testing::HasSubstr;
using testing::Not;

/// Results of a run folder, by file: without seconds, dates and hashes of them.
std::map<std::string, std::string> results_in(const fs::path& folder) {
  std::map<std::string, std::string> out;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (!entry.is_regular_file() || name.ends_with("run.json") || name == "report.html" || name == "session.sh") continue;
    out[entry.path().lexically_relative(folder).string()] =
        std::regex_replace(content(entry.path()), std::regex(R"("seconds": [-+.e\d]+)"), "");
  }
  return out;
}

TEST(CommandsOfThePage, AreWhatOneWouldTypeAndGiveTheSameBytesWhenDoneAgain) {
  const OscillatorStudy study;
  const std::string file = study.path("study.toml").string();
  PageServer server({file});
  EXPECT_EQ(server.state()["verdict"], nullptr);
  const json started = server.post("/api/job", {{"verb", "run"}}).parsed();
  EXPECT_EQ(started["command"], "misfit run " + file);
  EXPECT_EQ(server.post("/api/job", {{"verb", "fit"}}).status, 409) << "one at a time";
  json job = server.job();
  ASSERT_EQ(job["state"], "done") << job["notes"] << job["output"];
  EXPECT_FALSE(job["costs"].empty()) << "its searches are followed";
  EXPECT_LE(job["costs"].size(), 4U);
  std::size_t iterations = 0;
  std::set<std::pair<std::string, std::string>> searches;
  for (const json& trace : job["costs"]) {
    iterations += trace["points"].size();
    EXPECT_TRUE(searches.emplace(trace["work"], trace["what"]).second) << "one line for a search, though others run beside it";
  }
  EXPECT_GT(iterations, 2U);
  EXPECT_THAT(job["output"], HasSubstr("Verdict"));
  EXPECT_NE(server.state()["verdict"], nullptr);
  EXPECT_TRUE(server.state()["outdated"].empty());

  const json candidates = server.get("/api/candidates").parsed();
  ASSERT_FALSE(candidates["rows"].empty());
  EXPECT_EQ(candidates["rows"].size(),
            candidates["blocks"][1]["kind"] == "table" ? candidates["blocks"][1]["rows"].size() : candidates["rows"].size());
  const std::string effect = "coulomb_friction";
  const auto refused = [&](const std::string& of) {
    const json state = server.state();
    for (const json& one : state["effects"]) {
      if (one["effect"] == of) return one["refused"].get<std::string>();
    }
    return std::string("not in the list");
  };
  EXPECT_EQ(refused(effect), "");
  EXPECT_THAT(refused("strut_wake"), HasSubstr("does not suit this model")) << "an effect of parachutes";
  EXPECT_EQ(server.post("/api/job", {{"verb", "add"}, {"effect", effect}}).parsed()["command"], "misfit add " + file + " " + effect);
  ASSERT_EQ(server.job()["state"], "done");
  EXPECT_EQ(server.state()["models"].size(), 2U);
  EXPECT_THAT(refused(effect), HasSubstr("already in the model"));
  EXPECT_EQ(server.get("/api/ladder").parsed()["rungs"].size(), 2U);
  EXPECT_NE(server.get("/api/where?model=1").parsed()["maps"][0]["change"], nullptr);
  EXPECT_EQ(server.end().status, 0);

  fs::rename(study.path("out"), study.path("before"));
  const std::string path = paths::program().parent_path().string();
  ASSERT_EQ(std::system(("PATH='" + path + "':\"$PATH\" sh '" + study.path("before/session.sh").string() + "' > /dev/null 2>&1").c_str()),
            0);
  const auto before = results_in(study.path("before")), again = results_in(study.path("out"));
  EXPECT_GT(before.size(), 30U);
  for (const auto& [name, text] : before) {
    ASSERT_TRUE(again.contains(name)) << name;
    EXPECT_TRUE(again.at(name) == text) << name;
  }
  EXPECT_EQ(again.size(), before.size());
}

TEST(CommandsOfThePage, AStudyWithAnErrorIsMendedInIt) {
  const OscillatorStudy study;
  const std::string good = content(study.path("study.toml"));
  const std::string bad = std::regex_replace(good, std::regex("seed = 1"), "seeds = 1");
  study.write("study.toml", bad);
  const PageServer server({study.path("study.toml").string()});
  const json fault = server.state()["study"]["fault"];
  EXPECT_EQ(fault["line"], 5);
  EXPECT_THAT(fault["message"], HasSubstr("seed"));
  const json shown = server.get("/api/study").parsed();
  EXPECT_EQ(shown["text"], bad);
  EXPECT_EQ(server.post("/api/check", {{"text", bad}}).parsed()["faults"][0]["line"], 5);
  EXPECT_EQ(server.post("/api/save", {{"text", bad}, {"hash", shown["hash"]}}).status, 422);
  EXPECT_EQ(content(study.path("study.toml")), bad) << "what is wrong is not written";
  EXPECT_EQ(server.post("/api/save", {{"text", good}, {"hash", "0123456789abcdef"}}).status, 400) << "changed meanwhile";
  EXPECT_EQ(content(study.path("study.toml")), bad);
  EXPECT_EQ(server.post("/api/check", {{"text", good}}).parsed()["faults"], json::array());
  ASSERT_EQ(server.post("/api/save", {{"text", good}, {"hash", shown["hash"]}}).status, 200);
  EXPECT_EQ(content(study.path("study.toml")), good);
  EXPECT_EQ(server.state()["study"]["fault"], nullptr);
  EXPECT_THAT(content(study.path("out/session.sh")), HasSubstr(good + "END_OF_STUDY\n"));
}

TEST(CommandsOfThePage, AreNotWrittenThroughLinks) {
  const OscillatorStudy study;
  fs::create_directories(study.path("out"));
  study.write("elsewhere", "mine\n");
  fs::create_symlink(study.path("elsewhere"), study.path("out/session.sh"));
  const PageServer server({study.path("study.toml").string()});
  const json shown = server.get("/api/study").parsed();
  const json more = {{"text", shown["text"].get<std::string>() + "# more\n"}, {"hash", shown["hash"]}};
  EXPECT_EQ(server.post("/api/save", more).status, 500);
  EXPECT_EQ(content(study.path("study.toml")), shown["text"].get<std::string>()) << "nothing is saved that cannot be recorded";
  EXPECT_EQ(server.post("/api/job", {{"verb", "fit"}}).status, 500);
  EXPECT_EQ(server.job()["state"], "none") << "nothing is done that cannot be recorded";
  fs::remove(study.path("out/session.sh"));
  fs::rename(study.path("study.toml"), study.path("real.toml"));
  fs::create_symlink(study.path("real.toml"), study.path("study.toml"));
  EXPECT_EQ(server.post("/api/save", more).status, 400);
  EXPECT_EQ(content(study.path("elsewhere")), "mine\n");
  EXPECT_EQ(content(study.path("real.toml")), shown["text"].get<std::string>());
}

/// Damaged, and missing.
void expect_that_a_rung_is_watched(const PageServer& server, const fs::path& rung) {
  const fs::path diagnosis = rung / "out/diagnosis.json", record = rung / "out/run.json";
  const std::string good = content(diagnosis), good_record = content(record);
  std::ofstream(diagnosis) << good << " ";
  std::ofstream(record) << good_record << " ";
  EXPECT_THAT(server.state()["outdated"].dump(), HasSubstr("the diagnosis of rung 1"));
  std::ofstream(diagnosis) << good;
  std::ofstream(record) << good_record;
  EXPECT_TRUE(server.state()["outdated"].empty());
  fs::rename(rung, rung.string() + "_away");
  const json state = server.state();
  EXPECT_EQ(state["study"]["fault"], nullptr) << "the study itself is well";
  EXPECT_THAT(state["outdated"].dump(), HasSubstr("Rung 1 of the ladder cannot be read: "));
  EXPECT_EQ(state["effects"], json::array());
  fs::rename(rung.string() + "_away", rung);
  EXPECT_TRUE(server.state()["outdated"].empty());
}

TEST(CommandsOfThePage, AddWhereTheListSaysAndRemoveWhatWasAdded) {
  const OscillatorStudy study;
  study.measure_twice();
  const std::string file = study.path("study.toml").string();
  const PageServer server({file});
  ASSERT_EQ(server.post("/api/job", {{"verb", "run"}}).status, 200);
  ASSERT_EQ(server.job()["state"], "done");
  const json rows = server.get("/api/candidates").parsed()["rows"];
  const auto several =
      std::find_if(rows.begin(), rows.end(), [](const json& row) { return !row["at"].empty() && row["at"][0] != "default"; });
  ASSERT_NE(several, rows.end());
  const std::string effect = (*several)["effect"];
  EXPECT_EQ(server.post("/api/job", {{"verb", "add"}, {"effect", effect}, {"at", {"rate=; rm -r /"}}}).status, 400);
  EXPECT_EQ(server.post("/api/job", {{"verb", "add"}, {"effect", effect}, {"at", "default"}}).status, 400) << "no list";
  for (const json& models : {json::array({"", "drag"}), json::array({"drag"})})
    EXPECT_EQ(server.post("/api/job", {{"verb", "add"}, {"effect", effect}, {"models", models}}).status, 409)
        << "on models that are not there";
  std::string command = "misfit add " + file + " " + effect;
  for (const std::string word : (*several)["at"]) command += " '--at=" + word + "'";
  EXPECT_EQ(server.post("/api/job", {{"verb", "add"}, {"effect", effect}, {"at", (*several)["at"]}, {"models", json::array({""})}})
                .parsed()["command"],
            command);
  ASSERT_EQ(server.job()["state"], "done");
  ASSERT_EQ(server.state()["models"].size(), 2U);
  const json motion = server.get("/api/motion?model=1&method=output_error").parsed();
  EXPECT_EQ(motion["methods"], json::array({"filter_error"})) << "a rung is fitted by it alone";
  EXPECT_FALSE(motion["channels"].empty());
  study.write("study.toml", content(study.path("study.toml")) + "# a comment\n");
  EXPECT_EQ(server.state()["models"].size(), 2U) << "a comment changes no model";
  EXPECT_TRUE(server.state()["outdated"].empty());
  expect_that_a_rung_is_watched(server, study.path("out/rungs/01_" + effect));

  for (const char* rung : {"0", "2", "1; ls", ""})
    EXPECT_EQ(server.post("/api/job", {{"verb", "remove"}, {"rung", rung}}).status, 400) << rung;
  EXPECT_EQ(server.post("/api/job", {{"verb", "remove"}, {"rung", "1"}}).parsed()["command"], "misfit remove " + file + " 1");
  ASSERT_EQ(server.job()["state"], "done");
  EXPECT_EQ(server.state()["models"].size(), 1U);
  EXPECT_THAT(content(study.path("out/session.sh")), HasSubstr("misfit remove " + file + " 1\n"));
}

void run_to_the_first_fit(PageServer& server, const OscillatorStudy& study) {
  ASSERT_EQ(server.post("/api/job", {{"verb", "run"}}).status, 200);
  for (int k = 0; k < 400 && !fs::exists(study.path("out/fit/output_error/fit.json")); ++k)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
}

TEST(CommandsOfThePage, AStoppedOneLeavesAFolderToGoOnWith) {
  const OscillatorStudy study;
  PageServer server({study.path("study.toml").string()});
  run_to_the_first_fit(server, study);
  EXPECT_EQ(server.post("/api/stop", json::object()).status, 200);
  const json job = server.job();
  EXPECT_EQ(job["state"], "stopped") << job;
  EXPECT_EQ(server.get("/api/motion").parsed()["methods"][0], "output_error") << "what was finished is there";
  ASSERT_EQ(server.post("/api/job", {{"verb", "fit"}}).status, 200);
  EXPECT_EQ(server.job()["state"], "done");
  EXPECT_EQ(server.get("/api/motion").parsed()["methods"].size(), 2U);
  const std::string file = study.path("study.toml").string();
  EXPECT_THAT(server.get("/api/session").parsed()["text"].get<std::string>(),
              HasSubstr("\n# stopped: misfit run " + file + "\nmisfit fit " + file + "\n"));
}

TEST(CommandsOfThePage, EndWithTheServerThatIsKilledAndAreGoneOnWithByTheNext) {
  const OscillatorStudy study;
  PageServer server({study.path("study.toml").string()});
  run_to_the_first_fit(server, study);
  server.kill();
  PageServer next({study.path("study.toml").string()});
  EXPECT_EQ(next.get("/api/motion").parsed()["methods"][0], "output_error");
  json job;
  for (int k = 0; k < 100; ++k) {  // until the command of the killed server has let go of the folder
    ASSERT_EQ(next.post("/api/job", {{"verb", "run"}}).status, 200);
    job = next.job();
    if (job["state"] == "done") break;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  EXPECT_EQ(job["state"], "done") << job["notes"];
  EXPECT_THAT(content(study.path("out/session.sh")), HasSubstr("misfit run"));
}

TEST(CommandsOfThePage, AServerThatIsAskedToEndStopsItsCommand) {
  const OscillatorStudy study;
  PageServer server({study.path("study.toml").string()});
  ASSERT_EQ(server.post("/api/job", {{"verb", "run"}}).status, 200);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_EQ(server.end().status, 0);
  EXPECT_EQ(run({"fit", study.path("study.toml").string(), "--quiet"}).status, 0) << "the folder is free";
}

TEST(CommandsOfThePage, GoToTheFolderThatWasAskedFor) {
  const OscillatorStudy study;
  const std::string file = study.path("study.toml").string(), out = study.path("my results").string();
  const PageServer server({file, "--out", out});
  EXPECT_EQ(server.post("/api/job", {{"verb", "fit"}}).parsed()["command"], "misfit fit " + file + " --out '" + out + "'");
  EXPECT_EQ(server.job()["state"], "done");
  EXPECT_TRUE(fs::exists(fs::path(out) / "fit/output_error/fit.json"));
  EXPECT_FALSE(fs::exists(study.path("out")));
}

TEST(OpeningAPage, SaysWhatIsWrong) {
  const OscillatorStudy study;
  const Outcome none = run({"open", study.path("nothing.toml").string()});
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.err, HasSubstr("nothing.toml"));
  const PageServer server({study.path("study.toml").string()});
  const Outcome taken = run({"open", study.path("study.toml").string(), "--port", std::to_string(server.port())});
  EXPECT_EQ(taken.status, 1);
  EXPECT_THAT(taken.err, HasSubstr("port " + std::to_string(server.port())));
  EXPECT_EQ(run({"open", study.path("study.toml").string(), "--port", "70000"}).status, 2);
}

TEST(OpeningAPage, SeesThatAFileOfTheStudyHasChangedAndThatALimitOfTimeChangesNothing) {
  const OscillatorStudy study;
  ASSERT_EQ(run({"fit", study.path("study.toml").string(), "--time-limit", "600", "--quiet"}).status, 0);
  const PageServer server({study.path("study.toml").string()});
  const json before = server.state();
  EXPECT_TRUE(before["outdated"].empty()) << before["outdated"];
  study.write("d.csv", content(study.path("d.csv")) + "30.000,1.0,0.1\n");
  const json after = server.state();
  EXPECT_NE(after["version"], before["version"]);
  EXPECT_THAT(after["outdated"].dump(), HasSubstr("the fit by output_error"));
}

TEST(OpeningAPage, HoldsAPartOutOnlyWhereNoFileIsHeldOut) {
  const OscillatorStudy study;
  study.write("e.csv", content(study.path("d.csv")));
  study.write("study.toml", std::regex_replace(content(study.path("study.toml")), std::regex("validation = \"last 25 %\""),
                                               "validation = \"e.csv\"\n[[experiment]]\nname = \"more\"\ndata = \"d.csv\""));
  const PageServer server({study.path("study.toml").string()});
  EXPECT_EQ(server.state()["settable"]["experiments"], json::array({"more"}));
  const auto held_out = [&](const char* name, const char* value) {
    return server.post("/api/job", {{"verb", "set"}, {"what", "validation"}, {"name", name}, {"value", value}});
  };
  EXPECT_EQ(held_out("steps validation", "1 2").status, 400);
  EXPECT_THAT(held_out("more", "1764204705.25 1764204706").parsed()["command"].get<std::string>(),
              HasSubstr("experiment.more.validation=[1764204705.25, 1764204706]"));
}

TEST(OpeningAPage, NamesWhatCanBeSetWithItsUnit) {
  const StudyCopy swivel("swivel_friction");
  ASSERT_EQ(swivel.run("calibrate", {"--quiet"}).status, 0);
  const PageServer server({swivel.path("study.toml").string()});
  const json state = server.state();
  EXPECT_EQ(state["study"]["fault"], nullptr);
  ASSERT_EQ(state["settable"]["curves"].size(), 2U);
  EXPECT_EQ(state["settable"]["curves"][0]["unit"], json::parse(R"([["rad",0],["3",1]])")) << "of C_m, which has no unit, over alpha_T";
  EXPECT_EQ(state["settable"]["curves"][0]["roughness"], "auto");
  const auto& parameters = state["settable"]["parameters"];
  const auto camera = std::find_if(parameters.begin(), parameters.end(), [](const json& p) { return p["name"] == "h_c"; });
  ASSERT_NE(camera, parameters.end());
  EXPECT_EQ((*camera)["free"], true) << "as the calibration gives it";
}

TEST(OpeningAPage, DoesNoWork) {
  const OscillatorStudy study;
  PageServer server({study.path("study.toml").string()});
  for (const char* question : {"state", "motion", "where", "candidates", "curves", "calibration", "ladder", "study", "session"})
    EXPECT_EQ(server.get(std::string("/api/") + question).status, 200) << question;
  EXPECT_EQ(server.end().status, 0);
  EXPECT_FALSE(fs::exists(study.path("out")));
}

}  // namespace
