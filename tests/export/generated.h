#pragma once

// Generated C and Python, compiled and run.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "misfit/export/exported.h"
#include "tests/core/temporary_folder.h"

namespace misfit::testing_export {

using Row = std::vector<double>;

/// What is asked of the generated code: rates, outputs and curves at each of the points (states, inputs, time).
struct Questions {
  int states = 0, inputs = 0, outputs = 0;
  std::vector<std::string> sample_times;  ///< functions of x, u, t
  std::vector<std::string> curves;        ///< functions of the first state
  std::vector<Row> points;
};

inline void write_file(const std::filesystem::path& path, const std::string& text) { std::ofstream(path) << text; }

/// Runs a command that prints a row of numbers per point.
inline std::vector<Row> rows_of(const TemporaryFolder& folder, const std::string& command) {
  const std::string in_folder = "cd '" + folder.path().string() + "' && { " + command + "; } > rows.txt 2> errors.txt";
  EXPECT_EQ(std::system(in_folder.c_str()), 0) << command;  // NOLINT(cert-env33-c): the compiler of the machine
  std::ifstream errors(folder.path() / "errors.txt");
  std::stringstream said;
  said << errors.rdbuf();
  EXPECT_EQ(said.str(), "") << command;
  std::ifstream file(folder.path() / "rows.txt");
  std::vector<Row> rows;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    Row row;
    for (std::string word; words >> word;) row.push_back(std::strtod(word.c_str(), nullptr));
    rows.push_back(row);
  }
  return rows;
}

inline void write_points(const TemporaryFolder& folder, const Questions& ask) {
  std::ostringstream text;
  text.precision(17);
  for (const Row& point : ask.points) {
    for (const double value : point) text << value << ' ';
    text << '\n';
  }
  write_file(folder.path() / "points.txt", text.str());
}

/// By the C compiler of the machine, with its warnings as errors.
inline std::vector<Row> run_c(const std::string& source, const Questions& ask) {
  const TemporaryFolder folder;
  write_file(folder.path() / "model.c", source);
  write_points(folder, ask);
  const int width = ask.states + ask.inputs + 1;
  std::ostringstream main;
  main << "#include \"model.c\"\n#include <stdio.h>\nint main(void) {\n  double p[" << width << "], r[64];\n  for (;;) {\n"
       << "    for (int i = 0; i < " << width << "; ++i) if (scanf(\"%lf\", p + i) != 1) return 0;\n"
       << "    const double *x = p, *u = p + " << ask.states << ";\n    const double t = p[" << width - 1
       << "];\n    (void)x, (void)u, (void)t;\n"
       << "    int n = 0;\n";
  if (ask.states > 0)
    main << "    rates(x, u, t, r);\n    n = " << ask.states << ";\n    outputs(x, u, t, r + n);\n    n += " << ask.outputs << ";\n";
  for (const std::string& name : ask.sample_times) main << "    r[n++] = " << name << "(x, u, t);\n";
  for (const std::string& curve : ask.curves) main << "    r[n++] = " << curve << "(p[0]);\n";
  main << "    for (int i = 0; i < n; ++i) printf(\"%.17g \", r[i]);\n    printf(\"\\n\");\n  }\n}\n";
  write_file(folder.path() / "main.c", main.str());
  return rows_of(folder, "cc -std=c99 -pedantic -Wall -Wextra -Werror -O1 main.c -o main -lm && ./main < points.txt");
}

inline std::vector<Row> run_python(const std::string& source, const Questions& ask) {
  const TemporaryFolder folder;
  write_file(folder.path() / "model.py", source);
  write_points(folder, ask);
  std::ostringstream main;
  main << "import model\nwith open('points.txt') as f:\n  lines = f.readlines()\nfor line in lines:\n  p = [float(w) for w in "
          "line.split()]\n"
       << "  x, u, t = p[:" << ask.states << "], p[" << ask.states << ":" << ask.states + ask.inputs << "], p[-1]\n  r = []\n";
  if (ask.states > 0) main << "  r += model.rates(x, u, t) + model.outputs(x, u, t)\n";
  for (const std::string& name : ask.sample_times) main << "  r += [model." << name << "(x, u, t)]\n";
  for (const std::string& curve : ask.curves) main << "  r += [model." << curve << "(p[0])]\n";
  main << "  print(*map(repr, r))\n";
  write_file(folder.path() / "main.py", main.str());
  return rows_of(folder, "python3 -W error main.py");
}

/// Per number, the largest finite size at any of the points.
inline Row largest_of(const std::vector<Row>& rows) {
  Row out;
  for (const Row& row : rows) {
    out.resize(std::max(out.size(), row.size()), 0.0);
    for (std::size_t j = 0; j < row.size(); ++j) {
      if (std::isfinite(row[j])) out[j] = std::max(out[j], std::abs(row[j]));
    }
  }
  return out;
}

/// Equal to 1e-12 of each value, or to a unit of rounding of the largest that this number takes: one that happens to be near 0 is a
/// difference of larger ones. Both not a number, or both the same infinity.
inline void expect_same(const std::vector<Row>& found, const std::vector<Row>& wanted, const std::string& what) {
  ASSERT_EQ(found.size(), wanted.size()) << what;
  const Row largest = largest_of(wanted);
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    ASSERT_EQ(found[i].size(), wanted[i].size()) << what;
    for (std::size_t j = 0; j < wanted[i].size(); ++j) {
      const double a = found[i][j], b = wanted[i][j];
      const bool same = a == b || (std::isnan(a) && std::isnan(b)) ||
                        std::abs(a - b) <= std::max(1e-12 * std::abs(b), std::numeric_limits<double>::epsilon() * largest[j]);
      EXPECT_TRUE(same) << what << ": point " << i << ", number " << j << ": " << a << " is not " << b;
    }
  }
}

inline void expect_both_give(const Exported& exported, const Questions& ask, const std::vector<Row>& wanted) {
  expect_same(run_c(c_source(exported), ask), wanted, "C");
  expect_same(run_python(python_source(exported), ask), wanted, "Python");
}

}  // namespace misfit::testing_export
