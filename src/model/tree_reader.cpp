#include "model/tree_reader.h"

#include <locale.h>  // POSIX: newlocale
#include <stdlib.h>  // POSIX: strtod_l

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

#include "model/nearest_word.h"

namespace vibratory_alignment {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::size_t longest_echo = 60, longest_line = 100, longest_text = 1000;

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

/// Text from the file as it may stand in a message: short, on one line.
std::string echo(const std::string& text) {
  std::string shown = text.substr(0, longest_echo);
  std::replace_if(shown.begin(), shown.end(), is_control, '?');
  return text.size() > longest_echo ? shown + "..." : shown;
}

/// Never the whole tree: an alias may make it contain itself.
std::string echo(const YAML::Node& node) {
  if (!node.IsDefined() || node.IsNull()) return "(nothing)";
  if (node.IsMap()) return "(a map)";
  if (node.IsSequence()) return "(a list)";
  return node.Scalar().empty() ? "(empty text)" : echo(node.Scalar());
}

/// The node's text with single blanks between its words; none when it is empty, too long or holds other control
/// characters than those between words.
std::optional<std::string> text_of(const YAML::Node& node) {
  if (!node.IsScalar() || node.Scalar().size() > longest_text) return std::nullopt;
  std::string text;
  for (const char c : node.Scalar()) {
    const bool blank = c == ' ' || c == '\n' || c == '\t' || c == '\r';
    if (is_control(c) && !blank) return std::nullopt;
    if (!blank)
      text += c;
    else if (!text.empty() && text.back() != ' ')
      text += ' ';
  }
  if (!text.empty() && text.back() == ' ') text.pop_back();
  return text.empty() ? std::nullopt : std::optional(text);
}

std::string join(const std::vector<std::string>& words, const std::string& last_separator) {
  std::string joined;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) joined += i + 1 == words.size() ? last_separator : ", ";
    joined += words[i];
  }
  return joined;
}

std::optional<std::size_t> index_of(const std::string& word, const std::vector<std::string>& words) {
  const auto found = std::find(words.begin(), words.end(), word);
  if (found == words.end()) return std::nullopt;
  return static_cast<std::size_t>(found - words.begin());
}

bool is_number_text(const std::string& text) {
  auto at = text.begin();
  const auto skip_digits = [&] {
    const auto start = at;
    while (at != text.end() && *at >= '0' && *at <= '9') ++at;
    return at - start;
  };
  const auto skip_sign = [&] { at += at != text.end() && (*at == '+' || *at == '-') ? 1 : 0; };

  skip_sign();
  const auto first = at;
  const auto whole_digits = skip_digits();
  if (whole_digits > 1 && *first == '0') return false;
  std::ptrdiff_t fraction_digits = 0;
  if (at != text.end() && *at == '.') {
    ++at;
    fraction_digits = skip_digits();
  }
  if (whole_digits + fraction_digits == 0) return false;
  if (at != text.end() && (*at == 'e' || *at == 'E')) {
    ++at;
    skip_sign();
    if (skip_digits() == 0) return false;
  }
  return at == text.end();
}

}  // namespace

const NumberRule any_number = {"a number", -infinity, infinity, true, false};
const NumberRule positive_number = {"a number > 0", 0.0, infinity, false, false};
const NumberRule not_negative_number = {"a number >= 0", 0.0, infinity, true, false};
const NumberRule positive_whole_number = {"a whole number from 1 to 1e15", 1.0, 1e15, true, true};

std::optional<double> parse_number(const std::string& text) {
  if (!is_number_text(text)) return std::nullopt;
  static const locale_t classic = newlocale(LC_ALL_MASK, "C", nullptr);
  const double value = strtod_l(text.c_str(), nullptr, classic);
  // A size that rounds to 0 is not 0.
  const bool is_zero = text.find_first_of("123456789") >= text.find_first_of("eE");
  return value == 0.0 && !is_zero ? std::numeric_limits<double>::denorm_min() : value;
}

bool has_sane_size(double value) {
  const double size = std::abs(value);
  return size == 0.0 || (size >= 1e-100 && size <= 1e100);
}

bool NumberRule::allows(double value) const {
  if (whole && std::floor(value) != value) return false;
  return low_is_allowed ? value >= low && value <= high : value > low && value <= high;
}

std::string alternatives(const std::vector<std::string>& words) { return join(words, " or "); }

TreeReader::TreeReader(const YAML::Node& node, std::string path, Faults& faults)
    : path_(std::move(path)), faults_(&faults) {
  is_map_ = node.IsDefined() && node.IsMap();
  if (!is_map_) {
    faults_->push_back((path_.empty() ? "" : path_ + ": ") + echo(node) + ": must be a map (key: value)");
    return;
  }
  for (const auto& entry : node) {
    if (!entry.first.IsScalar())
      faults_->push_back(path_of(echo(entry.first)) + ": a key must be a name");
    else if (find(entry.first.Scalar()) != nullptr)
      fault(entry.first.Scalar(), "is given twice");
    else
      entries_.emplace_back(entry.first.Scalar(), entry.second);
  }
}

std::optional<double> TreeReader::number(const std::string& key, const NumberRule& rule, const std::string& unit) {
  const YAML::Node* node = value(key);
  if (!node) return std::nullopt;
  const std::optional<double> value = node->IsScalar() ? parse_number(node->Scalar()) : std::nullopt;
  if (!value || !rule.allows(*value)) {
    fault(key, std::string("must be ") + rule.text + (unit.empty() ? "" : " [" + unit + "]"));
    return std::nullopt;
  }
  if (!has_sane_size(*value)) {
    fault(key, "the size of a number must be 0 or from 1e-100 to 1e100");
    return std::nullopt;
  }
  return value;
}

double TreeReader::required_number(const std::string& key, const NumberRule& rule, const std::string& unit) {
  if (!has(key)) fault(key, std::string("must be ") + rule.text + (unit.empty() ? "" : " [" + unit + "]"));
  return number(key, rule, unit).value_or(0.0);
}

std::optional<bool> TreeReader::flag(const std::string& key) {
  const YAML::Node* node = value(key);
  if (!node) return std::nullopt;
  std::string word = node->IsScalar() ? node->Scalar() : "";
  std::transform(word.begin(), word.end(), word.begin(),
                 [](char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); });
  if (index_of(word, {"true", "yes", "on"})) return true;
  if (index_of(word, {"false", "no", "off"})) return false;
  fault(key, "must be true or false");
  return std::nullopt;
}

std::optional<std::string> TreeReader::line(const std::string& key) {
  const YAML::Node* node = value(key);
  if (!node) return std::nullopt;
  const std::string text = node->IsScalar() ? node->Scalar() : "";
  if (!text.empty() && text.size() <= longest_line && std::none_of(text.begin(), text.end(), is_control)) return text;
  fault(key, "must be text on one line, of 1 to " + std::to_string(longest_line) + " bytes");
  return std::nullopt;
}

std::optional<std::string> TreeReader::text(const std::string& key) {
  const YAML::Node* node = value(key);
  if (!node) return std::nullopt;
  const std::optional<std::string> text = text_of(*node);
  if (!text) fault(key, "must be text, of 1 to " + std::to_string(longest_text) + " bytes");
  return text;
}

std::vector<std::string> TreeReader::texts(const std::string& key) {
  const YAML::Node* node = value(key);
  std::vector<std::string> texts;
  if (!node) return texts;
  const std::size_t count = node->IsSequence() ? node->size() : 1;
  for (std::size_t i = 0; i < count; ++i) {
    const std::optional<std::string> text = text_of(node->IsSequence() ? (*node)[i] : *node);
    if (text)
      texts.push_back(*text);
    else
      fault(key, "must be text or a list of texts, of 1 to " + std::to_string(longest_text) + " bytes each");
  }
  return texts;
}

std::optional<std::size_t> TreeReader::choice(const std::string& key, const std::vector<std::string>& words) {
  const YAML::Node* node = value(key);
  if (!node) return std::nullopt;
  const std::optional<std::size_t> index = node->IsScalar() ? index_of(node->Scalar(), words) : std::nullopt;
  if (!index) fault(key, "must be " + alternatives(words));
  return index;
}

std::vector<std::size_t> TreeReader::choices(const std::string& key, const std::vector<std::string>& words) {
  const YAML::Node* list = value(key);
  if (!list || !list->IsSequence() || list->size() == 0) {
    fault(key, "must be a list of at least one of " + alternatives(words));
    return {};
  }
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < list->size(); ++i) {
    const YAML::Node word = (*list)[i];
    const std::string place = path_of(key) + "." + std::to_string(i) + ": " + echo(word) + ": ";
    const std::optional<std::size_t> index = word.IsScalar() ? index_of(word.Scalar(), words) : std::nullopt;
    if (!index)
      faults_->push_back(place + "must be " + alternatives(words));
    else if (std::find(indices.begin(), indices.end(), *index) != indices.end())
      faults_->push_back(place + "is given twice");
    else
      indices.push_back(*index);
  }
  return indices;
}

TreeReader TreeReader::section(const std::string& key) {
  const YAML::Node* node = value(key);
  TreeReader below(node ? *node : YAML::Node(YAML::NodeType::Map), path_of(key), *faults_);
  below.is_map_ = below.is_map_ && is_map_;
  return below;
}

std::vector<TreeReader> TreeReader::sections(const std::string& key) {
  const YAML::Node* node = value(key);
  if (!node || !node->IsSequence()) return {section(key)};
  if (node->size() == 0) fault(key, "must be a map or a list of at least one map");
  std::vector<TreeReader> below;
  for (std::size_t i = 0; i < node->size(); ++i)
    below.emplace_back((*node)[i], path_of(key) + "." + std::to_string(i), *faults_);
  return below;
}

void TreeReader::refuse(const std::string& key, const std::string& reason) {
  if (find(key) != nullptr) fault(key, reason);
  ignore(key);
}

void TreeReader::fault(const std::string& key, const std::string& what) {
  // What is wrong with something that is no map has been said.
  if (!is_map_) return;
  const Entry* entry = find(key);
  const std::string value = entry == nullptr ? "missing" : echo(entry->second);
  faults_->push_back(path_of(key) + ": " + value + ": " + what);
}

void TreeReader::refuse_unknown_keys() {
  for (const auto& [key, node] : entries_) {
    if (index_of(key, known_)) continue;
    fault(key, "unknown key" + did_you_mean(key, known_) + "; known here: " + join(known_, ", "));
  }
}

const YAML::Node* TreeReader::value(const std::string& key) {
  if (!index_of(key, known_)) known_.push_back(key);
  const Entry* entry = find(key);
  return entry == nullptr ? nullptr : &entry->second;
}

std::vector<std::string> TreeReader::keys() {
  for (const Entry& entry : entries_) known_.push_back(entry.first);
  return known_;
}

void TreeReader::ignore(const std::string& key) {
  entries_.remove_if([&](const Entry& entry) { return entry.first == key; });
}

const TreeReader::Entry* TreeReader::find(const std::string& key) const {
  for (const Entry& entry : entries_)
    if (entry.first == key) return &entry;
  return nullptr;
}

std::string TreeReader::path_of(const std::string& key) const {
  return path_.empty() ? echo(key) : path_ + "." + echo(key);
}

}  // namespace vibratory_alignment
