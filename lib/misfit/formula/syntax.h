#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "misfit/core/error.h"

// Formulas as text, up to the syntax tree. Grammar, loosest first (^ binds to the right, and tighter than a sign on its left: -x^2 =
// -(x^2)):
//   or | and | not | < <= > >= == != | + - | * / | - + (sign) | ^ | number, name, name(…), (…)

namespace misfit::formula {

inline constexpr int kMaxDepth = 200;            ///< of parentheses, calls, signs and powers inside each other
inline constexpr std::size_t kMaxLength = 4096;  ///< characters of one formula

/// One node of the syntax tree.
struct Expression {
  enum class Kind { number, name, operation, call };
  Kind kind = Kind::number;
  double value = 0.0;          ///< number
  std::string text;            ///< name; operator ("neg" for a sign); function
  std::vector<int> arguments;  ///< nodes, all of them before this one
  int begin = 0, end = 0;      ///< characters of the text, end exclusive
};

/// A formula as written, and where.
struct Text {
  std::string text;
  std::string of;  ///< what it is the formula of: "equation x1"
  Source where;    ///< of the first character of `text`

  /// InputError naming the place of a part of the formula and the part itself.
  [[noreturn]] void fail(int begin, int end, const std::string& message) const;
};

/// The syntax tree, children before parents, root last.
struct Syntax {
  Text source;
  std::vector<Expression> nodes;
};

/// InputError with place and what was expected: syntax, depth, length, unknown function, number of arguments.
[[nodiscard]] Syntax parse(Text source);

/// Names that nothing else may have: functions, pi, t, and, or, not.
[[nodiscard]] const std::vector<std::string>& reserved_names();

/// Letters, digits and underscores, not beginning with a digit, and not reserved.
[[nodiscard]] bool is_name(std::string_view text);

}  // namespace misfit::formula
