#include "misfit/data/study_text.h"

#include <algorithm>

namespace misfit {
namespace {

bool begins_with(const TomlPath& path, const TomlPath& front) {
  return path.size() >= front.size() && std::equal(front.begin(), front.end(), path.begin());
}

bool is_below(const TomlNode& node, const TomlNode& above) {
  return node.path.size() > above.path.size() && begins_with(node.path, above.path);
}

}  // namespace

const TomlNode* StudyText::find(const TomlPath& path) const {
  const auto found = std::find_if(nodes_.begin(), nodes_.end(), [&](const TomlNode& n) { return n.path == path; });
  return found == nodes_.end() ? nullptr : &*found;
}

std::vector<const TomlNode*> StudyText::entries(const TomlNode& table) const {
  std::vector<const TomlNode*> out;
  for (const TomlNode& node : nodes_) {
    if (is_below(node, table) && node.path.size() == table.path.size() + 1) out.push_back(&node);
  }
  return out;
}

bool StudyText::has_header(const TomlNode& node) const {
  return node.kind == TomlNode::Kind::table && !node.inline_table && node.begin < text_.size() && text_[node.begin] == '[';
}

bool StudyText::has_own_header(const TomlNode& node) const {
  if (!has_header(node)) return false;
  const auto inside = entries(node);
  return std::none_of(inside.begin(), inside.end(), [&](const TomlNode* n) { return has_header(*n) && n->begin == node.begin; });
}

const TomlNode* StudyText::outermost_inline(const TomlNode& node) const {
  for (const TomlNode& other : nodes_) {  // parents before what they hold
    if (other.inline_table && is_below(node, other)) return &other;
  }
  return nullptr;
}

std::size_t StudyText::end_of(const TomlNode& node) const {
  std::size_t end = node.end;
  for (const TomlNode* entry : entries(node)) {
    if (!has_header(*entry)) end = std::max(end, end_of(*entry));
  }
  return end;
}

std::size_t StudyText::next_header(std::size_t at) const {
  std::size_t next = text_.size();
  for (const TomlNode& node : nodes_) {
    if (has_header(node) && node.begin > at) next = std::min(next, line_begin(node.begin));
  }
  return next;
}

std::size_t StudyText::line_begin(std::size_t at) const {
  const std::size_t before = at == 0 ? std::string::npos : text_.rfind('\n', at - 1);
  return before == std::string::npos ? 0 : before + 1;
}

std::size_t StudyText::line_end(std::size_t at) const {
  const std::size_t end = std::min(text_.find('\n', at), text_.size());
  return end > at && end < text_.size() && text_[end - 1] == '\r' ? end - 1 : end;
}

std::map<TomlPath, std::string> values_of(const StudyText& study, const TomlPath& without, const TomlPath& as) {
  std::map<TomlPath, std::string> out;
  for (const TomlNode& node : study.nodes()) {
    const bool holds = node.kind == TomlNode::Kind::table || node.kind == TomlNode::Kind::array;
    if (holds && (!study.entries(node).empty() || begins_with(without, node.path) || begins_with(as, node.path))) continue;
    TomlPath path = node.path;
    if (!without.empty() && begins_with(path, without)) {
      if (as.empty()) continue;
      path.erase(path.begin(), path.begin() + without.size());
      path.insert(path.begin(), as.begin(), as.end());
    }
    out[path] = std::to_string(static_cast<int>(node.kind)) + node.value;
  }
  return out;
}

}  // namespace misfit
