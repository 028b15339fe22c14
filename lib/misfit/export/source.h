#pragma once

#include <string>
#include <vector>

#include "misfit/export/exported.h"
#include "misfit/export/expression.h"

namespace misfit {

/// What the files of all languages say: curves with the names of their functions, parameters, formulas.
struct SourceParts {
  std::vector<ExportedCurve> curves;
  std::vector<std::string> curve_names;  ///< "curve_C_m"
  std::vector<ExportedParameter> parameters;
  std::vector<std::string> parameter_names;  ///< unique identifiers
  ModelFormulas formulas;                    ///< `lack` where there is no right-hand side
};
[[nodiscard]] SourceParts source_parts(const Exported& exported);

/// Names of the leaves, given those of a state, an input, the time and a parameter: "x[{}]", "u[{}]", "t", and one per parameter.
[[nodiscard]] LeafNames leaf_names(const SourceParts& parts, const Model& model, const std::vector<std::string>& parameter_texts);

/// Lines that say what x, u and y are, with units, and what is not in the right-hand side.
[[nodiscard]] std::vector<std::string> signature_lines(const SourceParts& parts, const Model& model);
/// Instead of a right-hand side: why there is none, and the formulas in words.
[[nodiscard]] std::vector<std::string> formula_lines(const SourceParts& parts, const Exported& exported);

/// "{1.0, 2.0, …}" without the braces, broken into lines.
[[nodiscard]] std::string number_list(const std::vector<double>& values);

/// Lines as one text, each behind `before`.
[[nodiscard]] std::string lines_text(const std::vector<std::string>& lines, const std::string& before);

/// Sigma of a grid, for code: what is not known is 0.
[[nodiscard]] std::vector<double> known_sigmas(const CurveEstimate& grid);

}  // namespace misfit
