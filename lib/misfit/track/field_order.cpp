#include "misfit/track/field_order.h"

#include <fmt/format.h>

#include <cmath>

#include "misfit/track/search.h"

namespace misfit {
namespace {

constexpr double min_motion = 1.0;  // [px per frame]
constexpr std::size_t min_pairs = 6;

FieldOrder order_of(const FieldEvidence& e) {
  if (e.motion < min_motion) return FieldOrder::unknown;
  if (e.asymmetry > 0.25) return FieldOrder::top_first;
  if (e.asymmetry < -0.25) return FieldOrder::bottom_first;
  if (e.combing < 0.25) return FieldOrder::progressive;
  return FieldOrder::unknown;
}

}  // namespace

std::string words(FieldOrder order) {
  switch (order) {
    case FieldOrder::progressive:
      return "progressive";
    case FieldOrder::top_first:
      return "top_first";
    case FieldOrder::bottom_first:
      return "bottom_first";
    case FieldOrder::unknown:
      break;
  }
  return "unknown";
}

FieldEvidence field_evidence(const std::vector<FieldPair>& pairs) {
  FieldEvidence out;
  double within = 0.0, even_next = 0.0, odd_next = 0.0;
  for (std::size_t i = 0; i + 1 < pairs.size(); ++i) {
    const FieldPair &a = pairs[i], &b = pairs[i + 1];
    if (b.frame != a.frame + 1 || !a.even || !a.odd || !b.even || !b.odd) continue;
    ++out.pairs;
    within += distance(*a.even, *a.odd);
    even_next += distance(*a.odd, *b.even);
    odd_next += distance(*a.even, *b.odd);
  }
  if (out.pairs == 0) return out;
  const double n = static_cast<double>(out.pairs), sum = even_next + odd_next;
  out.motion = 0.5 * sum / n;
  out.combing = sum > 0.0 ? within / (0.5 * sum) : 0.0;
  out.asymmetry = sum > 0.0 ? (odd_next - even_next) / sum : 0.0;
  out.order = order_of(out);
  const bool clear =
      out.order == FieldOrder::progressive ? out.combing < 0.15 && std::abs(out.asymmetry) < 0.15 : std::abs(out.asymmetry) > 0.33;
  out.decisive = out.order != FieldOrder::unknown && clear && out.pairs >= min_pairs;
  return out;
}

std::string FieldEvidence::text() const {
  if (pairs == 0) return "the marker was not found in both fields of two successive frames";
  if (order == FieldOrder::unknown && motion < min_motion)
    return fmt::format("the marker hardly moves ({:.2f} px per frame): the order of fields cannot be seen and does not matter", motion);
  return fmt::format(
      "in {} pairs of frames the marker moves {:.1f} px per frame; between the fields of a frame it moves {:.2f} of that "
      "(0 progressive, 0.5 interlaced), and the asymmetry is {:+.2f} (+0.5 top first, -0.5 bottom first)",
      pairs, motion, combing, asymmetry);
}

}  // namespace misfit
