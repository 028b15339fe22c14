#pragma once

// Logs of records (ULog, DataFlash): a file of messages, each a record of one topic with the same fields.

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "misfit/data/log/bytes.h"
#include "misfit/data/log/log.h"

namespace misfit {

struct RecordField {
  std::string name, unit;
  std::size_t offset = 0;  ///< in the record [bytes]
  NumberType type;
  double divisor = 1.0;  ///< of the number as it stands
};

struct RecordTopic {
  std::string name;
  std::vector<RecordField> fields;
  std::size_t clock = 0;  ///< index of the field that is its time; fields.size(): none
  std::size_t records = 0;
  std::size_t first_channel = 0;
};

/// Two passes over the file: the first counts records, the second takes the values that are asked for. A value behind the end of a record
/// that is too short is missing.
class RecordReader : public LogReader {
 protected:
  using Take = std::function<void(std::size_t topic, std::span<const std::byte> record)>;

  explicit RecordReader(const Bytes& bytes) : bytes_(bytes) { log_.source = bytes.source(); }

  /// Calls `take` for every record, in the order of the file.
  virtual void each_record(const Take& take) = 0;
  /// Counts the records of `topics_` and lists channels of those that have any.
  void list_channels();
  void read_values(const std::vector<std::size_t>& channels) override;

  Bytes bytes_;
  std::vector<RecordTopic> topics_;
};

}  // namespace misfit
