#include "misfit/track/tracker.h"

#include <algorithm>
#include <cmath>

#include "misfit/math/statistics.h"

namespace misfit {
namespace {

constexpr double score_of_tracking = 0.45;  // of the correlation, before the fit
constexpr std::size_t candidates = 4;
constexpr double gate_sigmas = 5.0;
constexpr double min_gate = 5.0;                             // [px]
constexpr double first_acceleration = 3.0;                   // [px per field²] until seen
constexpr int max_missed_fields = 90, stride_when_lost = 3;  // lost for long: every third field is searched
constexpr double radius_about_start = 40.0;                  // [px]
constexpr std::size_t min_run = 3;                           // fields: shorter finds are not believed
constexpr double min_acceleration = 0.5;
constexpr double forgetting_factor = 0.99, contrast_forgetting = 0.9;

}  // namespace

Tracker::Tracker(TrackerOptions options)
    : options_(std::move(options)), acceleration_(first_acceleration), contrast_(options_.look.marker.levels[1]) {}

PixelPoint Tracker::expected() const { return {last_.column + since_ * velocity_.column, last_.row + since_ * velocity_.row}; }

/// The way covered in n fields is uncertain by n velocity_sigma and n (n + 1)/2 accelerations, as these last.
double Tracker::gate() const {
  const double n = since_;
  const double floor = std::max(min_gate, 0.5 * (options_.look.marker.reach_x() + options_.look.marker.reach_y()));
  return std::max(floor, gate_sigmas * (0.5 * n * (n + 1.0) * acceleration_ + n * velocity_sigma_));
}

void Tracker::begin(const Location& found, const Field& field) {
  const Marker& marker = options_.look.marker;
  const double travel = std::max(2.5 * (marker.reach_x() + marker.reach_y()), 0.08 * field.image.width);  // [px] farthest in one field
  last_ = found.at;
  velocity_ = {};
  velocity_sigma_ = travel / gate_sigmas;
  held_ = true;
}

void Tracker::correct(const Location& found) {
  const double n = since_;
  const PixelPoint before = expected();
  if (missed_ == 0 && velocity_sigma_ <= acceleration_) {  // the innovation is then the acceleration
    const double square = 0.5 * (std::pow(found.at.column - before.column, 2.0) + std::pow(found.at.row - before.row, 2.0));
    acceleration_ =
        std::max(min_acceleration, std::sqrt(forgetting_factor * acceleration_ * acceleration_ + (1.0 - forgetting_factor) * square));
  }
  velocity_ = {(found.at.column - last_.column) / n, (found.at.row - last_.row) / n};
  velocity_sigma_ = 0.5 * std::max(n - 1.0, 0.0) * acceleration_;
  last_ = found.at;
}

/// Two fields ago it was exactly here, though it should have moved: the file repeats a frame.
bool Tracker::stands_still_suspiciously(const PixelPoint& at) const {
  const std::size_t n = samples_.size();
  if (n < 2 || samples_[n - 2].loss != Loss::none) return false;
  const double speed = std::hypot(velocity_.column, velocity_.row);
  return speed > 1.5 && distance(samples_[n - 2].at, at) < std::min(0.5, 0.1 * speed);
}

std::optional<Location> Tracker::look(const Field& field, Loss& why) {
  Region region = options_.region.value_or(whole(field));
  const PixelPoint middle = expected();
  const double radius = gate();
  const bool everywhere = !held_ || radius > 0.35 * field.image.width;
  if (everywhere && missed_ > max_missed_fields && missed_ % stride_when_lost != 0) return std::nullopt;
  if (!everywhere)
    region = intersection(region, {middle.column - radius, middle.row - radius, middle.column + radius, middle.row + radius});
  if (samples_.empty() && options_.start) {
    const PixelPoint& s = *options_.start;
    region = intersection(
        region, {s.column - radius_about_start, s.row - radius_about_start, s.column + radius_about_start, s.row + radius_about_start});
  }
  std::optional<Location> best;
  double best_merit = -1.0;
  for (const Match& c : search(field, options_.look.marker, region, score_of_tracking, candidates)) {
    const Location found = locate(field, options_.look.marker, c.at);
    const Loss loss = judge(found, options_.look, contrast_);
    if (loss != Loss::none) {
      if (why == Loss::not_found) why = loss;
      continue;
    }
    const bool known =
        std::any_of(options_.still.begin(), options_.still.end(), [&](const PixelPoint& p) { return distance(p, found.at) < 3.0; });
    const double away = everywhere ? 0.0 : distance(found.at, middle) / radius;
    if (known || away > 1.0) continue;
    const double merit = found.explained - 0.3 * away * away;
    if (merit > best_merit) {
      best_merit = merit;
      best = found;
    }
  }
  return best;
}

const TrackedSample& Tracker::lose(Loss why) {
  ++missed_;
  samples_.push_back({why, {}, 0.0, 0.0});
  if (held_ && missed_ > max_missed_fields) held_ = false;
  return samples_.back();
}

const TrackedSample& Tracker::add_missing() {
  since_ += 1.0;
  steps_.push_back(1.0);
  return lose(Loss::no_frame);
}

const TrackedSample& Tracker::add(const Field& field, bool copy, double steps) {
  since_ += steps;
  steps_.push_back(steps);
  const bool moves = std::hypot(velocity_.column, velocity_.row) > 0.3;
  if (copy && (!held_ || moves)) return lose(Loss::copy);
  Loss why = Loss::not_found;
  const std::optional<Location> found = look(field, why);
  if (!found) {
    const double x = expected().column, y = expected().row, reach = options_.look.marker.reach_x();
    const bool beyond = held_ && (x < reach || y < reach || x > field.image.width - 1.0 - reach || y > field.frame_height() - 1.0 - reach);
    return lose(beyond ? Loss::outside : why);
  }
  row_step_ = field.row_step;
  if (held_ && stands_still_suspiciously(found->at)) return lose(Loss::copy);
  samples_.push_back({Loss::none, found->at, found->sigma, found->explained});
  if (!held_ || gate() > 0.35 * field.image.width) {
    begin(*found, field);
  } else {
    correct(*found);
  }
  missed_ = 0;
  since_ = 0.0;
  contrast_ = contrast_forgetting * contrast_ + (1.0 - contrast_forgetting) * found->levels[1];
  return samples_.back();
}

namespace {

/// Distance from the straight way between the neighbours on both sides; negative where one is lost.
double bend(const std::vector<TrackedSample>& s, const std::vector<double>& steps, std::size_t i) {
  if (i == 0 || i + 1 >= s.size() || s[i - 1].loss != Loss::none || s[i].loss != Loss::none || s[i + 1].loss != Loss::none) return -1.0;
  const double after = steps[i] / (steps[i] + steps[i + 1]), before = 1.0 - after;
  return std::hypot(s[i].at.column - before * s[i - 1].at.column - after * s[i + 1].at.column,
                    s[i].at.row - before * s[i - 1].at.row - after * s[i + 1].at.row);
}

void drop_bends(std::vector<TrackedSample>& samples, const std::vector<double>& steps) {
  std::vector<double> bends;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double b = bend(samples, steps, i);
    if (b >= 0.0) bends.push_back(b);
  }
  if (bends.size() < 20) return;
  const double limit = std::max(8.0 * median(bends), 3.0);
  std::vector<std::size_t> wild;
  for (std::size_t i = 1; i + 1 < samples.size(); ++i) {
    const double b = bend(samples, steps, i);
    if (b > limit && b >= bend(samples, steps, i - 1) && b >= bend(samples, steps, i + 1)) wild.push_back(i);
  }
  for (std::size_t i : wild) samples[i] = {Loss::implausible, {}, 0.0, 0.0};
}

void drop_short_runs(std::vector<TrackedSample>& samples) {
  if (samples.size() < 3 * min_run) return;
  for (std::size_t i = 0; i < samples.size();) {
    std::size_t j = i;
    while (j < samples.size() && samples[j].loss == Loss::none) ++j;
    if (j > i && j - i < min_run)
      for (std::size_t k = i; k < j; ++k) samples[k] = {Loss::implausible, {}, 0.0, 0.0};
    i = std::max(j, i + 1);
  }
}

void add_locking(std::vector<TrackedSample>& samples, int row_step) {
  std::vector<double> columns, rows;
  for (const TrackedSample& s : samples) {
    if (s.loss != Loss::none) continue;
    columns.push_back(s.at.column);
    rows.push_back(s.at.row);
  }
  const double x = pixel_locking(columns, 1.0), y = pixel_locking(rows, row_step);
  for (TrackedSample& s : samples) s.sigma = std::sqrt(s.sigma * s.sigma + 0.5 * (x * x + y * y));
}

}  // namespace

double white_error(const std::vector<TrackedSample>& samples) {
  std::vector<double> x, y;
  for (std::size_t i = 4; i < samples.size(); ++i) {
    const TrackedSample* s = &samples[i - 4];
    if (std::any_of(s, s + 5, [](const TrackedSample& one) { return one.loss != Loss::none; })) continue;
    x.push_back(s[0].at.column - 4.0 * s[1].at.column + 6.0 * s[2].at.column - 4.0 * s[3].at.column + s[4].at.column);
    y.push_back(s[0].at.row - 4.0 * s[1].at.row + 6.0 * s[2].at.row - 4.0 * s[3].at.row + s[4].at.row);
  }
  constexpr std::size_t enough = 20;
  if (x.size() < enough) return 0.0;
  const double of_white_noise = 70.0;  // 1 + 16 + 36 + 16 + 1
  const double sx = mad_sigma(x), sy = mad_sigma(y);
  return std::sqrt(0.5 * (sx * sx + sy * sy) / of_white_noise);
}

double pixel_locking(const std::vector<double>& positions, double pitch) {
  constexpr double assumed_noise = 0.1, largest_noise = 0.3;
  const auto n = static_cast<double>(positions.size());
  if (positions.size() < 200 || !(mad_sigma(positions) > 10.0 * pitch)) return assumed_noise;
  std::vector<double> phase;
  for (double p : positions) phase.push_back(p / pitch - std::floor(p / pitch));
  std::sort(phase.begin(), phase.end());
  double sum = 0.0, squares = 0.0;
  for (std::size_t k = 0; k < phase.size(); ++k) {
    const double lack = phase[k] - (static_cast<double>(k) + 0.5) / n;
    sum += lack;
    squares += lack * lack;
  }
  const double variance = squares / n - sum * sum / (n * n) - 1.0 / (12.0 * n);
  return std::min(largest_noise, pitch * std::sqrt(2.0 * std::max(0.0, variance)));
}

std::vector<TrackedSample> Tracker::finish() {
  drop_bends(samples_, steps_);
  drop_short_runs(samples_);
  add_locking(samples_, row_step_);
  return std::move(samples_);
}

}  // namespace misfit
