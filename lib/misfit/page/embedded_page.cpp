#include "misfit/page/embedded_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <unordered_map>

#include "misfit/core/files.h"
#include "misfit/page/assets.h"
#include "misfit/page/json_text.h"
#include "misfit/page/packed.h"
#include "misfit/page/views.h"

namespace misfit::page {
namespace {

/// What the page may ask, in the words of web/embedded.js, and the answer.
struct Answer {
  std::string question, json;
  bool needed = false;  ///< without it there is no page
};
using AllAnswers = std::vector<Answer>;  ///< the most wanted first

/// Those that find room. Long lists of numbers, which many answers share, stand once, in a list of lists: in their places {"$":k} names
/// one.
class ChosenAnswers {
 public:
  explicit ChosenAnswers(std::size_t most) : most_(most) {}

  /// False: there was no room.
  bool add(const Answer& answer) {
    const std::size_t lists_before = lists_.size();
    const std::string entry = fmt::format("{}:{}", json_string(answer.question), with_shared_lists(answer.json));
    std::size_t more = entry.size() + 2;
    for (std::size_t k = lists_before; k < lists_.size(); ++k) more += lists_[k].size() + 2;
    if (size_ + more > most_) {
      for (; lists_.size() > lists_before; lists_.pop_back()) known_.erase(lists_.back());
      return false;
    }
    size_ += more;
    entries_.push_back(entry);
    return true;
  }
  [[nodiscard]] std::string text() const {
    return fmt::format("{{\"lists\":[{}],\n\"answers\":{{{}}}}}", fmt::join(lists_, ",\n"), fmt::join(entries_, ",\n"));
  }

 private:
  std::string with_shared_lists(const std::string& json) {
    constexpr std::size_t long_enough = 100;
    std::string out;
    bool quoted = false;
    for (std::size_t at = 0; at < json.size(); ++at) {
      if (json[at] == '"') quoted = !quoted;
      if (json[at] == '\\') out += json[at++];
      const std::size_t end = quoted || json[at] != '[' ? at : json.find_first_of("[]{\"", at + 1);
      if (end != at && json[end] == ']' && end - at > long_enough) {
        const auto [known, fresh] = known_.emplace(json.substr(at, end + 1 - at), lists_.size());
        if (fresh) lists_.push_back(known->first);
        out += fmt::format("{{\"$\":{}}}", known->second);
        at = end;
      } else {
        out += json[at];
      }
    }
    return out;
  }

  std::size_t most_, size_ = 0;
  std::vector<std::string> entries_, lists_;
  std::unordered_map<std::string, std::size_t> known_;  ///< place in lists_
};

std::string state_of(const EmbeddedPage& page) {
  std::vector<std::string> warnings;
  for (const std::string& warning : page.warnings) warnings.push_back(json_string(warning));
  return fmt::format(
      R"({{"version":"","study":{{"name":{},"question":{},"fault":null}},"models":{},"outdated":{},"mostSamples":{},"verdict":{},"effects":[],"settable":null,"films":[],"camera":{},)"
      R"("job":{{"state":"none","number":0}}}})",
      json_string(page.study), json_words(page.question), models_view(page.places), json_list(warnings), page.places.front().most_samples,
      page.verdict != nullptr ? verdict_view(*page.verdict) : "null", calibration_of(page.places.front()).has_value());
}

std::string study_of(const Place& place) {
  return fmt::format(R"({{"text":{},"hash":"","file":{},"rung":{},"editable":false,"faults":[]}})", json_string(read_file(place.study)),
                     json_string(place.study.filename().string()), place.id);
}

/// By which any model is fitted: one that is chosen stays chosen in a model that it has not fitted.
std::set<std::string> methods_of(const std::vector<Place>& places) {
  std::set<std::string> out;
  for (const Place& place : places) {
    for (const Fit& fit : fits_of(place)) out.insert(fit.method);
  }
  return out;
}

/// Motion by every method and the missing force.
void add_first_views(const EmbeddedPage& page, std::size_t model, AllAnswers& out) {
  const std::string number = fmt::format("model={}", model);
  const bool needed = model + 1 == page.places.size();  // it is shown first
  out.push_back({"where?" + number, where_view(page.places[model], model > 0 ? &page.places[model - 1] : nullptr), needed});
  out.push_back({"motion?" + number, motion_view(page.places[model], ""), needed});
  for (const std::string& method : methods_of(page.places))
    out.push_back({fmt::format("motion?{}&method={}", number, method), motion_view(page.places[model], method), needed});
}

void add_other_views(const EmbeddedPage& page, std::size_t model, AllAnswers& out) {
  const Place& place = page.places[model];
  const std::string number = fmt::format("?model={}", model);
  out.push_back({"candidates" + number, candidates_view(place, {})});
  out.push_back({"curves" + number, curves_view(page.places, model, page.references)});
  out.push_back({"study" + number, study_of(place)});
}

void add_samples(const Diagnosis& diagnosis, std::size_t model, AllAnswers& out) {
  for (std::size_t e = 0; e < diagnosis.missing.size(); ++e) {
    for (std::size_t q = 0; q < diagnosis.missing[e].quantities.size(); ++q)
      out.push_back({fmt::format("samples?model={}&experiment={}&quantity={}", model, e, q), samples_view(diagnosis, e, q)});
  }
}

void add_added_forces(const Diagnosis& diagnosis, const Discovery& discovery, std::size_t model, AllAnswers& out) {
  for (std::size_t e = 0; e < diagnosis.missing.size(); ++e) {
    for (std::size_t c = 0; c < discovery.candidates.size(); ++c) {
      if (discovery.candidates[c].added.empty()) continue;
      out.push_back({fmt::format("added?model={}&experiment={}&candidate={}", model, e, c), added_view(diagnosis, discovery, e, c)});
    }
  }
}

/// What is seen where a candidate, or a cell, is pointed at: the forces of all models before the samples.
void add_pointed_at(const EmbeddedPage& page, AllAnswers& out) {
  AllAnswers samples;
  for (std::size_t model = page.places.size(); model-- > 0;) {
    const std::optional<Diagnosis> diagnosis = diagnosis_of(page.places[model]);
    if (!diagnosis) continue;
    if (const auto discovery = discovery_of(page.places[model])) add_added_forces(*diagnosis, *discovery, model, out);
    add_samples(*diagnosis, model, samples);
  }
  std::move(samples.begin(), samples.end(), std::back_inserter(out));
}

AllAnswers all_answers(const EmbeddedPage& page) {
  AllAnswers out;
  out.push_back({"state?", state_of(page), true});
  for (std::size_t model = page.places.size(); model-- > 0;) add_first_views(page, model, out);
  for (std::size_t model = page.places.size(); model-- > 0;) add_other_views(page, model, out);
  out.push_back({"ladder?", ladder_view(page.places)});
  out.push_back({"calibration?", calibration_view(page.places.front())});
  add_pointed_at(page, out);
  return out;
}

/// Answers that find room.
struct Chosen {
  std::string text;  ///< empty: one that is needed finds none
  bool all = true;   ///< none was left out
};

Chosen chosen(const AllAnswers& all, std::size_t most) {
  ChosenAnswers out(most);
  bool complete = true;
  for (const Answer& answer : all) {
    if (out.add(answer)) continue;
    if (answer.needed) return {"", false};
    complete = false;
  }
  return {out.text(), complete};
}

/// Samples of the longest recording that the page shows.
std::size_t longest_recording(const EmbeddedPage& page) {
  std::size_t out = 0;
  for (const Place& place : page.places) {
    for (const Fit& fit : fits_of(place)) {
      for (const ChannelPrediction& c : fit.predictions) out = std::max(out, c.t.size());
    }
    const std::optional<Diagnosis> diagnosis = diagnosis_of(place);
    for (const MissingForce& m : diagnosis ? diagnosis->missing : std::vector<MissingForce>{}) out = std::max(out, m.t.size());
  }
  return out;
}

EmbeddedPage thinned(EmbeddedPage page, std::size_t most_samples) {
  for (Place& place : page.places) place.most_samples = most_samples;
  return page;
}

/// `choose`: what of all answers finds room. Of recordings as they are; where something is left out of thinner ones, and where nothing can
/// be shown at all of still thinner ones.
template <class Choose>
std::string of_thinnest_needed(const EmbeddedPage& page, const Choose& choose) {
  Chosen best = choose(all_answers(page));
  const std::size_t longest = best.all ? 0 : longest_recording(page);
  for (const std::size_t most_samples : {24'000U, 8'000U, 3'000U, 1'000U}) {
    constexpr std::size_t enough = 8'000;  // for any screen
    if (most_samples >= longest) continue;
    if (most_samples >= enough ? best.all : !best.text.empty()) break;
    Chosen next = choose(all_answers(thinned(page, most_samples)));
    if (!next.text.empty()) best = std::move(next);
  }
  return best.text;
}

}  // namespace

std::string embedded_answers(const EmbeddedPage& page, std::size_t most) {
  return of_thinnest_needed(page, [&](const AllAnswers& all) { return chosen(all, most); });
}

std::string embedded_page(const EmbeddedPage& page, std::size_t most) {
  const EmbeddedAssets& assets = embedded_assets();
  const std::size_t fixed = assets.body.size() + assets.style.size() + assets.frame.size() + assets.script.size() + 1000;
  const auto in_room = [&](const AllAnswers& all) {
    for (double room = 2.6 * (static_cast<double>(most) - static_cast<double>(fixed)); room > 0.0; room *= 0.8) {
      Chosen answers = chosen(all, static_cast<std::size_t>(room));
      if (answers.text.empty()) break;
      answers.text = packed(answers.text);
      if (answers.text.size() + fixed <= most) return answers;
    }
    return Chosen{"", false};
  };
  const std::string answers = of_thinnest_needed(page, in_room);
  if (answers.empty()) return "";
  return fmt::format(
      "<template id=\"explore\">{}</template>\n<template id=\"explore-styles\"><style id=\"explore-style\" media=\"not all\">\n{}</style>\n"
      "<style>\n{}</style></template>\n<script type=\"text/plain\" id=\"answers\">{}</script>\n<script type=\"module\">\n{}</script>\n",
      assets.body, assets.style, assets.frame, answers, assets.script);
}

}  // namespace misfit::page
