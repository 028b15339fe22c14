#pragma once

#include <atomic>
#include <memory>
#include <mutex>

#include "misfit/serve/addable.h"
#include "misfit/serve/http.h"
#include "misfit/serve/job.h"
#include "misfit/serve/results.h"
#include "misfit/serve/session_script.h"
#include "misfit/serve/settable.h"
#include "misfit/video/frame_at.h"

namespace misfit::serve {

/// What is asked of POST /api/job.
struct JobRequest {
  std::string verb, effect, rung;
  std::string what, name, value;    ///< setting_of()
  std::vector<std::string> at;      ///< words of the effect's place; empty: the one that explains most
  std::vector<std::string> models;  ///< the effects that were added, as the page shows them; empty: whatever they are
};

/// What the page may ask for. Of a request only numbers of a list, keys of effects, and the text of the study itself are used; none becomes
/// a path or part of a command line.
///
/// GET  /api/state; /api/motion?model&method; /api/where?model; /api/samples?model&experiment&quantity; /api/candidates?model;
///      /api/added?model&experiment&candidate; /api/curves?model; /api/calibration; /api/ladder; /api/study?model; /api/session;
///      /api/frame?film&t (film: number in "films" of /api/state)
/// POST /api/job {"verb": "run"|"fit"|"discover"|"add"|"remove"|"set", "effect", "at", "models", "rung", "what", "name", "value"};
/// /api/stop; /api/check {"text"}; /api/save
/// {"text", "hash"}
class Api {
 public:
  Api(SessionOptions options, const Registry& registry, std::string program);

  [[nodiscard]] Answer answer(const Ask& ask);

 private:
  /// What must be computed to know it, kept until a file changes.
  struct Known {
    std::string version;
    std::string study;  ///< "study" of /api/state
    std::string verdict, models;
    std::vector<std::string> outdated;  ///< sentences
    std::vector<Reference> references;
    Settable settable;
    std::vector<Addable> effects;
    std::vector<std::pair<std::string, std::filesystem::path>> films;  ///< experiment, its video
  };

  struct Film {
    std::string stamp;  ///< of the file as it was opened
    FrameReader frames;
  };

  [[nodiscard]] Answer get(const Ask& ask);
  [[nodiscard]] Answer post(const Ask& ask);
  [[nodiscard]] std::string state();
  [[nodiscard]] std::shared_ptr<const Known> known();
  void open_study(Known& known) const;
  /// Of the last model of the ladder. None where it cannot be opened: `faults` then says why.
  [[nodiscard]] std::vector<Addable> effects(std::vector<std::string>& faults) const;
  [[nodiscard]] Answer study(const page::Place& place) const;
  [[nodiscard]] Answer start(const JobRequest& request);
  /// Behind the study, out of what is known here: nothing of a request becomes a word of a command. InputError: it is not.
  [[nodiscard]] std::vector<std::string> words_of(const JobRequest& request);
  /// Are these the effects that were added, in their order, "" first?
  [[nodiscard]] bool has_models(const std::vector<std::string>& added) const;
  [[nodiscard]] std::vector<std::string> words_of_add(const JobRequest& request) const;
  [[nodiscard]] std::vector<std::string> words_of_remove(const JobRequest& request) const;
  [[nodiscard]] Answer save(const std::string& text, const std::string& hash);
  [[nodiscard]] page::Place place(const Ask& ask) const;
  [[nodiscard]] std::string where(const Ask& ask) const;
  [[nodiscard]] std::string samples(const Ask& ask);
  [[nodiscard]] std::string added(const Ask& ask);
  [[nodiscard]] std::string curves(const Ask& ask);
  [[nodiscard]] std::string frame(const Ask& ask);

  SessionOptions options_;
  const Registry& registry_;
  Results results_;
  SessionScript script_;
  std::mutex mutex_;  ///< of known_, and of what is written
  std::shared_ptr<const Known> known_;
  Jobs jobs_;
  std::mutex frames_mutex_;  ///< of frames_
  std::map<std::filesystem::path, Film> frames_;
};

}  // namespace misfit::serve
