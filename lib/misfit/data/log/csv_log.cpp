#include "misfit/data/log/csv_log.h"

#include "misfit/core/column_header.h"
#include "misfit/core/loose_csv.h"
#include "misfit/data/log/arrays.h"

namespace misfit {
namespace {

class CsvLog : public LogReader {
 public:
  explicit CsvLog(const std::filesystem::path& path) {
    LooseTable table = read_loose_csv(path);
    log_.source = table.source;
    log_.format = "CSV";
    for (LooseColumn& column : table.columns) {
      if (column.text > 0) continue;
      const NameAndUnit header = read_header(column.header);
      log_.channels.push_back({header.name, "", header.unit, column.values.size(), std::nullopt, {}});
      values_.push_back(std::move(column.values));
    }
    find_clocks(log_);
  }

 protected:
  void read_values(const std::vector<std::size_t>& channels) override {
    for (const std::size_t c : channels) log_.channels[c].values = values_[c];
  }

 private:
  std::vector<std::vector<double>> values_;
};

}  // namespace

std::unique_ptr<LogReader> read_csv_log(const std::filesystem::path& path) { return std::make_unique<CsvLog>(path); }

}  // namespace misfit
