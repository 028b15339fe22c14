#include "misfit/workflow/measure/samples.h"

#include "misfit/core/missing.h"
#include "misfit/core/text.h"

namespace misfit {
std::vector<double> sample_times(const std::vector<std::optional<double>>& read, const VideoFacts& facts, std::size_t fields,
                                 std::vector<std::string>& warnings) {
  std::vector<double> out;
  if (!facts.variable) {
    for (std::size_t k = 0; k < read.size(); ++k) out.push_back(static_cast<double>(k) / (facts.rate * static_cast<double>(fields)));
    return out;
  }
  for (const auto& t : read) {
    if (!t) continue;
    const std::size_t last = out.size(), k = static_cast<std::size_t>(&t - read.data());
    const double from = last > 0 ? out.back() : *t;
    for (std::size_t i = last; i <= k; ++i)
      out.push_back(*t - (*t - from) * static_cast<double>(k - i) / static_cast<double>(k - last + 1));
  }
  if (out.size() < read.size())
    warnings.push_back(counted(read.size() - out.size(), "frame at the end has no time of its own and is left out",
                               "frames at the end have no time of their own and are left out"));
  return out;
}

Track track_of(const std::vector<TrackedSample>& samples, const VideoFacts& facts, const std::vector<double>& times) {
  Track track;
  for (std::size_t k = 0; k < times.size(); ++k) {
    const TrackedSample& s = samples[k];
    const bool ok = s.loss == Loss::none;
    track.t.push_back(times[k]);
    track.P_y.push_back(ok ? 0.5 * facts.width - s.at.column : kMissing);
    track.P_z.push_back(ok ? s.at.row - 0.5 * facts.height : kMissing);
    track.sigma.push_back(ok ? s.sigma : kMissing);
    track.ok.push_back(ok);
  }
  return track;
}

TrackFacts facts_of(const VideoFacts& video, const std::vector<TrackedSample>& samples) {
  TrackFacts f;
  f.video = video.file;
  f.width = video.width;
  f.height = video.height;
  f.rate = video.rate;
  f.variable = video.variable;
  f.declared = video.declared;
  f.decoded = video.decoded;
  f.missing = video.missing;
  f.repeated = video.repeated;
  f.samples = samples.size();
  for (const TrackedSample& s : samples) {
    if (s.loss == Loss::none) {
      ++f.ok;
    } else {
      ++f.lost[words(s.loss)];
    }
  }
  const auto notes = notes_of(video);
  f.warnings.insert(f.warnings.end(), notes.begin(), notes.end());
  return f;
}

}  // namespace misfit
