#include "misfit/workflow/init/init.h"

#include <fmt/format.h>

#include <iostream>
#include <nlohmann/json.hpp>

#include "apps/verbs.h"
#include "misfit/core/shell_word.h"
#include "misfit/core/text.h"

namespace misfit {
namespace {

const char* word_of(ColumnUse use) {
  constexpr const char* words[] = {"time", "input", "output", "rate", "segment", "constant", "text", "unused"};
  return words[static_cast<std::size_t>(use)];
}

std::string survey_text(const RecordingSurvey& survey) {
  std::string out = fmt::format("{}: {}, {} rows\n", survey.source, survey.format, survey.rows);
  out += fmt::format("  one sample every {:g} s ({:.6g} Hz){}\n\n", survey.step, 1.0 / survey.step,
                     survey.jitter > 1e-3 * survey.step ? fmt::format(", uneven by {:.2g} s", survey.jitter) : "");
  std::vector<std::vector<std::string>> rows = {{"column", "read as", "unit", "from", "to", "steps of", "missing", "because"}};
  for (const auto& c : survey.columns) {
    const bool numbers = c.use != ColumnUse::text && c.missing < survey.rows;
    rows.push_back({c.header, std::string(word_of(c.use)) + (c.use == ColumnUse::input || c.use == ColumnUse::output ? " " + c.name : ""),
                    c.unit, numbers ? format_value(c.low) : "", numbers ? format_value(c.high) : "",
                    c.resolution > 0.0 ? format_value(c.resolution) : "", c.missing > 0 ? std::to_string(c.missing) : "", c.why});
  }
  out += align_columns(rows) + "\n";
  for (const auto& remark : survey.remarks) out += wrap_text("note: " + remark, 110, "  ") + "\n";
  return out;
}

nlohmann::ordered_json as_json(const RecordingSurvey& survey) {
  nlohmann::ordered_json json = {{"source", survey.source}, {"format", survey.format}, {"rows", survey.rows},
                                 {"step", survey.step},     {"jitter", survey.jitter}, {"parts", survey.parts.size()}};
  json["columns"] = nlohmann::ordered_json::array();
  for (const auto& c : survey.columns) {
    json["columns"].push_back({{"header", c.header},
                               {"name", c.name},
                               {"unit", c.unit},
                               {"use", word_of(c.use)},
                               {"why", c.why},
                               {"missing", c.missing},
                               {"from", c.low},
                               {"to", c.high},
                               {"resolution", c.resolution},
                               {"rate_of", c.rate_of}});
  }
  json["gaps"] = nlohmann::ordered_json::array();
  for (const auto& gap : survey.gaps) json["gaps"].push_back({gap.from, gap.to});
  json["remarks"] = survey.remarks;
  return json;
}

FirstStudy first_study(const Options& options) {
  try {
    return init_study(options.session.study, options.recording, options.session.out, options.session.force);
  } catch (const ChannelsUndecided& undecided) {
    if (!options.json) std::cout << undecided.channels() << '\n';
    throw;
  }
}

}  // namespace

int init_verb(const Options& options, const Registry& /*registry*/) {
  const FirstStudy made = first_study(options);
  if (options.json) {
    std::cout << as_json(made.survey).dump(1) << '\n';
    return 0;
  }
  std::cout << survey_text(made.survey) << '\n';
  for (const auto& o : made.model.outputs) std::cout << wrap_text("model of " + o.name + ": " + o.guess.why, 110, "  ") << '\n';
  std::cout << fmt::format(
      "\nwritten: {0}, model.toml, the data as {1}.csv{2}, figures/\nnext: misfit run {3} --auto   (fit, where it fails, which effect is "
      "missing, verdict; a column read wrongly: --input, --output)\n",
      made.study.string(), made.parts.front(), made.parts.size() > 1 ? " …" : "", shell_word(made.study.parent_path().string()));
  return 0;
}

}  // namespace misfit
