#pragma once

#include <optional>
#include <vector>

#include "misfit/track/appearance.h"
#include "misfit/track/field_order.h"
#include "misfit/track/search.h"

namespace misfit {

struct SurveyOptions {
  Marker marker;                    ///< kind, and the picture where there is one
  std::optional<PixelPoint> start;  ///< about where the marker is in the first frame
  std::optional<Region> region;     ///< where it is to be looked for
};

/// Learns from the first frames of a video how the marker looks, and how frames are made of fields. Each field is searched on its own:
/// nothing is assumed about order or motion. Candidates of many sizes are fitted with free shape and grouped by size and contrast; the
/// marker is the group that is found most, best and, where things of its kind also stand still, moving.
class Survey {
 public:
  explicit Survey(SurveyOptions options);

  void add(const Image& frame, long number);
  /// Nothing more is to be learnt: look and field order are clear (or order cannot be seen in 60 frames).
  [[nodiscard]] bool enough() const;

  [[nodiscard]] std::optional<Appearance> appearance() const;  ///< nullopt: no marker found
  [[nodiscard]] FieldEvidence evidence() const;
  /// Places where something of the same look stands still while the marker moves.
  [[nodiscard]] std::vector<PixelPoint> still() const;
  /// Share of the fields with the marker in which it is found at two places that both move: frames blended of two fields, or two markers.
  [[nodiscard]] double doubled() const;
  [[nodiscard]] long frames() const { return seen_; }
  /// Share of the frames searched in which it is found.
  [[nodiscard]] double share() const;

 private:
  struct Found {
    Location location;
    long frame = 0;
    int parity = 0;
  };
  struct Group {
    std::vector<std::size_t> members;  ///< of found_
    double score = 0.0;
  };
  void look(const Field& field, long number);
  void keep(const Field& field, const Marker& marker, const std::vector<Match>& candidates, long number);
  [[nodiscard]] std::vector<Marker> markers_to_try() const;
  [[nodiscard]] Group best_group() const;
  [[nodiscard]] bool similar(const Location& a, const Location& b) const;
  [[nodiscard]] std::vector<PixelPoint> still_of(const Group& group) const;
  [[nodiscard]] std::vector<std::size_t> moving(const Group& group) const;
  void learn();

  SurveyOptions options_;
  std::vector<Found> found_;
  std::optional<Appearance> learnt_;
  long seen_ = 0, searched_ = 0;
};

/// All markers of one picture, best first: for calibration images. Candidates that share a size and contrast with the best.
[[nodiscard]] std::vector<Location> find_markers(const Field& field, const Marker& marker, std::size_t most,
                                                 const std::optional<Region>& region = {});

}  // namespace misfit
