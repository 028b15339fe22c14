#pragma once

#include <string>
#include <vector>

#include "misfit/export/model_formulas.h"

namespace misfit {

/// What differs between languages in the text of an expression.
struct Language {
  std::string (*choose)(const std::string& condition, const std::string& yes, const std::string& no);
  std::string (*divide)(const std::string& a, const std::string& b);
  const char *both, *either;    ///< " && "
  const char* function_prefix;  ///< before sqrt, sin, …
  const char* declare;          ///< before the name of an intermediate value: "const double "
  const char* end;              ///< of a statement: ";"
};

/// How leaves are called.
struct LeafNames {
  std::vector<std::string> leaves;  ///< by number, up to ModelFormulas::first_curve()
  std::vector<std::string> curves;  ///< function that evaluates each curve of the model as its formulas need it
};

/// Statements that compute `roots`, one line each and indented, the last ones being the assignments "TARGETS[i] = …": every operation of
/// the graph in its order, parentheses complete. What is used more than once becomes an intermediate value.
[[nodiscard]] std::string statements(const ModelFormulas& formulas, const std::vector<int>& roots, const std::vector<std::string>& targets,
                                     const LeafNames& names, const Language& language);

/// 17 significant digits: the same number when it is read.
[[nodiscard]] std::string number_text(double value);

}  // namespace misfit
