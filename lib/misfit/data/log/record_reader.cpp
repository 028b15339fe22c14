#include "misfit/data/log/record_reader.h"

#include <cmath>

namespace misfit {

void RecordReader::list_channels() {
  each_record([&](std::size_t topic, std::span<const std::byte>) { ++topics_[topic].records; });
  for (RecordTopic& topic : topics_) {
    topic.first_channel = log_.channels.size();
    if (topic.records == 0) continue;
    const std::size_t clock = topic.first_channel + topic.clock;
    for (const RecordField& f : topic.fields) {
      LogChannel channel{topic.name + "." + f.name, topic.name, f.unit, topic.records, std::nullopt, {}};
      if (topic.clock < topic.fields.size()) channel.clock = clock;
      log_.channels.push_back(std::move(channel));
    }
  }
}

void RecordReader::read_values(const std::vector<std::size_t>& channels) {
  struct Wanted {
    const RecordField* field = nullptr;
    std::vector<double>* values = nullptr;
  };
  std::vector<std::vector<Wanted>> wanted(topics_.size());
  for (const std::size_t c : channels) {
    std::size_t topic = 0;
    while (topics_[topic].records == 0 || c >= topics_[topic].first_channel + topics_[topic].fields.size()) ++topic;
    log_.channels[c].values.reserve(topics_[topic].records);
    wanted[topic].push_back({&topics_[topic].fields[c - topics_[topic].first_channel], &log_.channels[c].values});
  }
  each_record([&](std::size_t topic, std::span<const std::byte> record) {
    for (const Wanted& w : wanted[topic]) {
      const bool there = w.field->offset + w.field->type.size <= record.size();
      const double value = there ? decode_number(record.data() + w.field->offset, w.field->type) : std::nan("");
      w.values->push_back(w.field->divisor == 1.0 ? value : value / w.field->divisor);
    }
  });
}

}  // namespace misfit
