#include "misfit/serve/api.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "misfit/core/base64.h"
#include "misfit/core/enum_name.h"
#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "misfit/core/text.h"
#include "misfit/data/estimators.h"
#include "misfit/data/study_reader.h"
#include "misfit/page/json_text.h"
#include "misfit/page/views.h"
#include "misfit/workflow/ladder.h"
#include "misfit/workflow/session/study_change.h"
#include "misfit/workflow/stages.h"

namespace misfit::serve {
namespace {

using nlohmann::json;
using page::json_list;
using page::json_number;
using page::json_string;
using page::Place;

constexpr std::size_t many = 10'000;  // experiments, quantities or candidates: more than any study has

Answer failure(int status, const std::string& why) { return {status, fmt::format(R"({{"error":{}}})", json_string(why))}; }

/// A number of a list of `size`; 0 where the request has none. InputError: anything else.
std::size_t number(const Ask& ask, const std::string& name, std::size_t size) {
  const auto found = ask.parameters.find(name);
  if (found == ask.parameters.end()) return 0;
  const std::string& text = found->second;
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value >= size)
    throw InputError(fmt::format("{}: a number below {} is expected", name, size));
  return value;
}

/// [s]. InputError: no number.
double time_of(const Ask& ask) {
  const auto found = ask.parameters.find("t");
  double t = 0.0;
  const std::string text = found == ask.parameters.end() ? "" : found->second;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), t);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(t)) throw InputError("t: a time [s] is expected");
  return t;
}

std::string strings(const std::vector<std::string>& texts) {
  std::vector<std::string> out;
  for (const std::string& text : texts) out.push_back(json_string(text));
  return json_list(out);
}

std::string json_of(const std::optional<TextFault>& fault) {
  if (!fault) return "null";
  return fmt::format(R"({{"message":{},"line":{}}})", json_string(fault->message), fault->line);
}

std::string json_of(const std::vector<TextFault>& faults) {
  std::vector<std::string> out;
  for (const TextFault& fault : faults) out.push_back(json_of(std::optional(fault)));
  return json_list(out);
}

std::string json_of(const CostTrace& trace) {
  std::vector<std::string> points;
  for (const auto& [iteration, value] : trace.points) points.push_back(fmt::format("[{},{}]", iteration, json_number(value)));
  return fmt::format(R"({{"work":{},"what":{},"points":{}}})", json_string(trace.work), json_string(trace.what), json_list(points));
}

std::string json_of(const JobReport& job) {
  constexpr std::array states = {"none", "running", "done", "failed", "stopped"};
  std::vector<std::string> costs;
  for (const CostTrace& trace : job.costs) costs.push_back(json_of(trace));
  const auto optional = [](const std::optional<double>& value) { return value ? json_number(*value) : "null"; };
  return fmt::format(
      R"({{"number":{},"command":{},"state":"{}","stopping":{},"status":{},"seconds":{},"work":{},"part":{},"left":{},"costs":{},)"
      R"("notes":{},"output":{}}})",
      job.number, json_string(job.command), enum_name(states, job.state), job.stopping, job.status, json_number(job.seconds),
      json_string(job.work), optional(job.part), optional(job.left), json_list(costs), strings(job.notes), json_string(job.output));
}

std::string films_of(const std::vector<std::pair<std::string, std::filesystem::path>>& films) {
  std::vector<std::string> experiments;
  for (const auto& [experiment, file] : films) experiments.push_back(experiment);
  return strings(experiments);
}

std::string text_in(const json& body, const char* name) {
  const auto found = body.find(name);
  if (found == body.end()) return "";
  if (!found->is_string()) throw InputError(std::string(name) + ": a text is expected");
  return found->get<std::string>();
}

std::vector<std::string> texts_in(const json& body, const char* name) {
  const auto found = body.find(name);
  if (found == body.end()) return {};
  const bool texts = found->is_array() && std::all_of(found->begin(), found->end(), [](const json& item) { return item.is_string(); });
  if (!texts) throw InputError(std::string(name) + ": a list of texts is expected");
  return found->get<std::vector<std::string>>();
}

JobRequest request_in(const json& body) {
  return {text_in(body, "verb"), text_in(body, "effect"), text_in(body, "rung"), text_in(body, "what"),
          text_in(body, "name"), text_in(body, "value"),  texts_in(body, "at"),  texts_in(body, "models")};
}

}  // namespace

Api::Api(SessionOptions options, const Registry& registry, std::string program)
    : options_(std::move(options)),
      registry_(registry),
      results_(options_),
      script_(results_.folder()),
      jobs_(std::move(program), [this](const JobReport& job) {
        if (job.state != JobState::done) script_.record_end(job.command, job.status, job.state == JobState::stopped);
      }) {
  (void)read_file(results_.study());  // InputError: there is none
}

Answer Api::answer(const Ask& ask) {
  try {
    return ask.method == "POST" ? post(ask) : get(ask);
  } catch (const InputError& error) {
    return failure(400, error.what());
  } catch (const json::exception&) {
    return failure(400, "the body is no JSON of the form that is expected");
  } catch (const RunError& error) {
    return failure(500, error.what());
  }
}

Place Api::place(const Ask& ask) const {
  const std::vector<Place> places = results_.places();
  return places[number(ask, "model", places.size())];
}

std::string Api::where(const Ask& ask) const {
  const std::vector<Place> places = results_.places();
  const std::size_t model = number(ask, "model", places.size());
  return page::where_view(places[model], model > 0 ? &places[model - 1] : nullptr);
}

std::string Api::samples(const Ask& ask) {
  const std::optional<Diagnosis> diagnosis = page::diagnosis_of(place(ask));
  return page::samples_view(diagnosis.value_or(Diagnosis{}), number(ask, "experiment", many), number(ask, "quantity", many));
}

std::string Api::added(const Ask& ask) {
  const Place shown = place(ask);
  const std::optional<Diagnosis> diagnosis = page::diagnosis_of(shown);
  const std::optional<Discovery> discovery = page::discovery_of(shown);
  return page::added_view(diagnosis.value_or(Diagnosis{}), discovery.value_or(Discovery{}), number(ask, "experiment", many),
                          number(ask, "candidate", many));
}

std::string Api::curves(const Ask& ask) {
  const std::vector<Place> places = results_.places();
  return page::curves_view(places, number(ask, "model", places.size()), known()->references);
}

std::string Api::frame(const Ask& ask) {
  const auto films = known()->films;
  if (films.empty()) throw InputError("film: the study has none");
  const std::filesystem::path film = films[number(ask, "film", films.size())].second;
  const double t = time_of(ask);
  const std::lock_guard lock(frames_mutex_);
  const std::string stamp = file_stamp(film);
  auto reader = frames_.find(film);
  if (reader != frames_.end() && reader->second.stamp != stamp) reader = (frames_.erase(reader), frames_.end());  // it was replaced
  if (reader == frames_.end()) reader = frames_.try_emplace(film, stamp, FrameReader(film)).first;
  const std::optional<FramePicture> picture = reader->second.frames.at(t);
  if (!picture) throw RunError(film.string() + ": its frames cannot be decoded any more");
  return fmt::format(R"({{"t":{},"width":{},"height":{},"jpeg":"{}"}})", json_number(picture->t), picture->width, picture->height,
                     base64(picture->jpeg));
}

Answer Api::get(const Ask& ask) {
  if (ask.path == "/api/state") return {200, state()};
  if (ask.path == "/api/motion") {
    const auto method = ask.parameters.find("method");
    if (method != ask.parameters.end() && find_estimator(method->second) == nullptr)
      throw InputError("method: one of " + join_words(estimator_names()) + " is expected");
    return {200, page::motion_view(place(ask), method == ask.parameters.end() ? "" : method->second)};
  }
  if (ask.path == "/api/where") return {200, where(ask)};
  if (ask.path == "/api/samples") return {200, samples(ask)};
  if (ask.path == "/api/added") return {200, added(ask)};
  if (ask.path == "/api/candidates") return {200, page::candidates_view(place(ask), registry_.effect_keys())};
  if (ask.path == "/api/frame") return {200, frame(ask)};
  if (ask.path == "/api/curves") return {200, curves(ask)};
  if (ask.path == "/api/calibration") return {200, page::calibration_view(results_.places().front())};
  if (ask.path == "/api/ladder") return {200, page::ladder_view(results_.places())};
  if (ask.path == "/api/study") return study(place(ask));
  if (ask.path == "/api/session") return {200, fmt::format(R"({{"text":{}}})", json_string(script_.text()))};
  return failure(404, "there is no such page");
}

Answer Api::post(const Ask& ask) {
  const json body = ask.body.empty() ? json::object() : json::parse(ask.body);
  if (!body.is_object()) throw InputError("a JSON object is expected");
  if (ask.path == "/api/stop") {
    jobs_.stop();
    return {200, json_of(jobs_.report())};
  }
  if (ask.path == "/api/check")
    return {200, fmt::format(R"({{"faults":{}}})", json_of(faults_of(results_.study(), text_in(body, "text"), registry_)))};
  if (ask.path == "/api/save") return save(text_in(body, "text"), text_in(body, "hash"));
  if (ask.path == "/api/job") return start(request_in(body));
  return failure(404, "there is no such page");
}

/// Tells what the study is, and what of the results is not its own any more.
void Api::open_study(Known& known) const {
  std::string name = results_.study().filename().string(), question;
  std::optional<TextFault> fault = fault_of(results_.study(), read_file(results_.study()), registry_);
  if (!fault) {
    try {
      const Session session(options_, registry_, RunFolder::Access::read);
      name = session.study.name;
      question = session.study.question;
      results_.know_ladder(known_ladder(session).has_value());
      for (const ExperimentStudy& experiment : session.study.experiments) {
        if (experiment.video) known.films.emplace_back(experiment.name, *experiment.video);
      }
      known.outdated = outdated(session, results_.places(), registry_);
      known.references = references(session);
      known.settable = settable_of(session);
      known.effects = effects(known.outdated);
    } catch (const std::exception& error) {
      fault = TextFault{error.what(), 0};
    }
  }
  known.study =
      fmt::format(R"({{"name":{},"question":{},"file":{},"folder":{},"fault":{}}})", json_string(name), page::json_words(question),
                  json_string(results_.study().string()), json_string(results_.folder().string()), json_of(fault));
}

std::vector<Addable> Api::effects(std::vector<std::string>& faults) const {
  const Place last = results_.places().back();
  const SessionOptions options = last.id == 0 ? options_ : options_for(options_, last.study);
  try {
    return addable_effects(Session(options, registry_, RunFolder::Access::read), page::discovery_of(last));
  } catch (const std::exception& error) {
    faults.push_back(std::string("No effect can be added: ") + error.what());
    return {};
  }
}

std::shared_ptr<const Api::Known> Api::known() {
  const std::string version = results_.version();
  const std::lock_guard lock(mutex_);
  if (known_ && known_->version == version) return known_;
  auto fresh = std::make_shared<Known>();
  fresh->version = version;
  open_study(*fresh);
  fresh->verdict = page::verdict_view(results_.places(), options_.study, options_.out);
  fresh->models = page::models_view(results_.places());
  known_ = fresh;
  return fresh;
}

std::string Api::state() {
  const auto all = known();
  return fmt::format(
      R"({{"version":"{}","study":{},"models":{},"outdated":{},"verdict":{},"effects":{},"settable":{},"films":{},"camera":{},"job":{}}})",
      all->version, all->study, all->models, strings(all->outdated), all->verdict, json_of(all->effects), json_of(all->settable),
      films_of(all->films), std::filesystem::exists(results_.folder() / "camera.json"), json_of(jobs_.report()));
}

Answer Api::study(const Place& place) const {
  const std::string text = read_file(place.study);
  return {200, fmt::format(R"({{"text":{},"hash":"{}","file":{},"rung":{},"editable":{},"faults":{}}})", json_string(text), hash_text(text),
                           json_string(place.study.string()), place.id, place.id == 0, json_of(faults_of(place.study, text, registry_)))};
}

Answer Api::save(const std::string& text, const std::string& hash) {
  const std::string whole = text.ends_with('\n') ? text : text + "\n";
  const std::lock_guard lock(mutex_);  // no command begins meanwhile
  if (jobs_.report().state == JobState::running)
    return failure(409, "a command is at work: wait for its end, or stop it, before the study is changed");
  const auto refused = [&](const TextFault& fault) -> Answer {
    return {422, fmt::format(R"({{"error":{},"faults":{}}})", json_string(fault.message),
                             json_of(faults_of(results_.study(), whole, registry_)))};
  };
  if (const auto fault = fault_of(results_.study(), whole, registry_)) return refused(*fault);
  const SessionScript::Opened opened = script_.open();  // first: nothing is done that cannot be recorded
  if (const auto fault = save_text(results_.study(), whole, hash, registry_)) return refused(*fault);
  script_.record_text(opened, results_.study().string(), whole);
  return {200, fmt::format(R"({{"hash":"{}"}})", hash_text(whole))};
}

std::vector<std::string> Api::words_of_add(const JobRequest& request) const {
  const std::vector<std::string> effects = registry_.effect_keys();
  const auto effect = std::find(effects.begin(), effects.end(), request.effect);
  if (effect == effects.end()) throw InputError("effect: a key of `misfit effects` is expected");
  std::vector<std::string> words{*effect};
  if (request.at.empty()) return words;
  const std::optional<Discovery> discovery = page::discovery_of(results_.places().back());
  for (const Candidate& candidate : discovery ? discovery->candidates : std::vector<Candidate>{}) {
    if (candidate.effect != *effect || words_of_place(candidate) != request.at) continue;
    for (const std::string& word : words_of_place(candidate)) words.push_back("--at=" + word);
    return words;
  }
  for (const EffectPlace& place : discovery ? discovery->unexplained_effects : std::vector<EffectPlace>{}) {
    if (place.effect != *effect || words_of_place(place.roles) != request.at) continue;
    for (const std::string& word : words_of_place(place.roles)) words.push_back("--at=" + word);
    return words;
  }
  throw InputError("at: a place of the effect in the list of candidates is expected");
}

std::vector<std::string> Api::words_of_remove(const JobRequest& request) const {
  const Ladder ladder = page::ladder_in(results_.folder()).value_or(Ladder{});
  for (const Rung& rung : ladder.rungs) {
    if (rung.parent >= 0 && request.rung == std::to_string(rung.id)) return {std::to_string(rung.id)};
  }
  throw InputError("rung: the number of a rung that was added is expected");
}

bool Api::has_models(const std::vector<std::string>& added) const {
  const std::vector<Place> places = results_.places();
  return std::equal(places.begin(), places.end(), added.begin(), added.end(),
                    [](const Place& place, const std::string& effect) { return place.added == effect; });
}

std::vector<std::string> Api::words_of(const JobRequest& request) {
  if (request.verb == "add") return words_of_add(request);
  if (request.verb == "remove") return words_of_remove(request);
  if (request.verb == "set") return {setting_of(known()->settable, request.what, request.name, request.value)};
  return {};
}

Answer Api::start(const JobRequest& request) {
  constexpr std::array verbs = {"run", "fit", "discover", "add", "remove", "set"};
  const auto verb = std::find(verbs.begin(), verbs.end(), request.verb);
  if (verb == verbs.end()) throw InputError("verb: run, fit, discover, add, remove or set is expected");
  std::vector<std::string> words{*verb, options_.study};
  if (!request.models.empty() && !has_models(request.models))
    return failure(409, "the models have changed since they were shown here: look again at what is to be done");
  const std::vector<std::string> more = words_of(request);
  words.insert(words.end(), more.begin(), more.end());
  if (!options_.out.empty() && request.verb != "set") words.insert(words.end(), {"--out", options_.out});
  const std::string command = command_of(words);
  const std::lock_guard lock(mutex_);
  if (jobs_.report().state == JobState::running) return failure(409, "a command is at work already: wait for its end, or stop it");
  script_.record(command);  // first: nothing is done that is not recorded
  if (!jobs_.start(words, command)) return failure(503, "misfit is about to end");
  return {200, json_of(jobs_.report())};
}

}  // namespace misfit::serve
