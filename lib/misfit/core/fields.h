#pragma once

#include <type_traits>

namespace misfit {

/// A struct's fields are described once, by a function template beside it that archives call for writing (const) and for reading:
///   template <class Archive> void fields(Archive& archive, MaybeConst<Point> auto& point) { … }
/// core/bytes.h and data/json_fields.h have the archives.
template <class Data, class Type>
concept MaybeConst = std::is_same_v<std::remove_const_t<Data>, Type>;

}  // namespace misfit
