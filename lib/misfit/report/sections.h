#pragma once

#include <string>
#include <vector>

#include "misfit/report/figure.h"
#include "misfit/report/input.h"
#include "misfit/report/page.h"

namespace misfit::report {

/// Puts a figure onto the page, under a name that no other one has there.
class Draw {
 public:
  explicit Draw(Page& page) : page_(page) {}
  void operator()(Figure figure) const;
  /// The same, on the first screen: when its section comes to it, it is not there again.
  void first(const Figure& figure);

 private:
  Page& page_;
  std::string first_;
};

/// The model that a section is about.
struct Subject {
  std::string note;    ///< for headings: ": rung 2, strut_wake added"
  std::string prefix;  ///< of the names of its figures
};
Subject of_rung(int id, const std::string& added);
Subject of_study(const ReportInput& input);  ///< named only where there is a choice

/// What was estimated of one model; `input` outlives it.
struct ModelResults {
  Subject subject;
  const std::vector<Fit>* fits = nullptr;
  const Comparison* comparison = nullptr;  ///< nullptr: none
};
/// The last rung's first, then the study's own model.
std::vector<ModelResults> models_of(const ReportInput& input);

// The sections of the page in their order; each is left out when there is nothing to show.
void verdict_section(const ReportInput& input, Page& page, Draw& draw);
void summary_section(const ReportInput& input, const ModelResults& model, Page& page);
void ladder_section(const ReportInput& input, Page& page, const Draw& draw);
void diagnosis_section(const ReportInput& input, Page& page, const Draw& draw);
void discovery_section(const ReportInput& input, Page& page, const Draw& draw);
void curves_section(const ModelResults& model, const std::vector<Reference>& references, Page& page, const Draw& draw);
void track_section(const ReportInput& input, Page& page, const Draw& draw);
void measured_section(const ReportInput& input, Page& page, const Draw& draw);
void uncertainty_section(const ReportInput& input, Page& page, const Draw& draw);
void resampling_section(const ReportInput& input, Page& page, const Draw& draw);
void prediction_section(const ModelResults& model, Page& page, const Draw& draw);
void simulated_section(const ReportInput& input, Page& page, const Draw& draw);
void parameters_section(const ModelResults& model, Page& page);
void calibration_section(const ReportInput& input, Page& page, const Draw& draw);
void notes_section(const ReportInput& input, Page& page);
void words_section(Page& page);  ///< the glossary
void provenance_section(const ReportInput& input, Page& page);

}  // namespace misfit::report
