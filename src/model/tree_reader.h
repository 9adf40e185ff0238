// Checked access to one map of a YAML tree.
//
// Every read names its key and what is allowed there. What is wrong becomes a fault, "key.path: value: what is
// allowed", in a list that all readers of a tree share, so that the user sees every fault at once. A faulty or absent
// value reads as std::nullopt (0 if it was required): go on reading, and use nothing when there are faults.
// It is the text of a value that decides, not its YAML type: PyYAML takes `1.0e4` for a string and yaml-cpp has no
// types.
#pragma once

#include <yaml-cpp/yaml.h>

#include <list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace vibratory_alignment {

/// Decimal number without regard to the locale: "12", "-.5", "1.0e4". Not a number: "", " 1", "0x10", "1e4m", "nan",
/// "inf", "1_000", and "010", which YAML 1.1 takes for 8. Too large a number reads as infinity,
/// too small a one as the smallest there is.
std::optional<double> parse_number(const std::string& text);

/// True for 0 and for sizes from 1e-100 to 1e100: products of a few such quantities stay finite.
bool has_sane_size(double value);

/// The numbers that are allowed at a key, as far as they have a sane size.
struct NumberRule {
  const char* text;  ///< "a number > 0"
  double low, high;  ///< high itself is allowed
  bool low_is_allowed;
  bool whole;

  bool allows(double value) const;
};

extern const NumberRule any_number, positive_number, not_negative_number, positive_whole_number;

/// "a, b or c"
std::string alternatives(const std::vector<std::string>& words);

class TreeReader {
 public:
  using Faults = std::vector<std::string>;

  /// `path` is empty for the root. Anything but a map is a fault; no further ones come from reading it.
  TreeReader(const YAML::Node& node, std::string path, Faults& faults);

  bool has(const std::string& key) { return value(key) != nullptr; }

  /// What stands at the key, unread; null if nothing does.
  const YAML::Node* value(const std::string& key);

  /// The keys of a map whose keys are not known beforehand, in the order of the file.
  std::vector<std::string> keys();

  /// `unit` is for the message: "must be a number > 0 [kg]".
  std::optional<double> number(const std::string& key, const NumberRule& rule, const std::string& unit = "");
  double required_number(const std::string& key, const NumberRule& rule, const std::string& unit = "");

  /// true or false, or the other words of YAML 1.1 (yes, no, on, off), which roslaunch turns into booleans.
  std::optional<bool> flag(const std::string& key);

  /// One printable line of at most 100 bytes.
  std::optional<std::string> line(const std::string& key);

  /// Printable text of at most 1000 bytes; what YAML folds or breaks into lines comes as one, with single blanks.
  std::optional<std::string> text(const std::string& key);

  /// A list of texts, or one text alone; absent: none.
  std::vector<std::string> texts(const std::string& key);

  /// One of the words: its index.
  std::optional<std::size_t> choice(const std::string& key, const std::vector<std::string>& words);

  /// A list of some of the words, each at most once: their indices. Required.
  std::vector<std::size_t> choices(const std::string& key, const std::vector<std::string>& words);

  /// A map below this one; an absent one reads as an empty map.
  TreeReader section(const std::string& key);

  /// One map, or a list of at least one; an absent one reads as one empty map.
  std::vector<TreeReader> sections(const std::string& key);

  /// The key means something only elsewhere: given here it is a fault, with this reason.
  void refuse(const std::string& key, const std::string& reason);

  /// The key is neither read nor unknown.
  void ignore(const std::string& key);

  /// A fault that the caller found at the key (given or not).
  void fault(const std::string& key, const std::string& what);

  /// To be called last: a key that no call above has named is a fault.
  void refuse_unknown_keys();

 private:
  using Entry = std::pair<std::string, YAML::Node>;

  const Entry* find(const std::string& key) const;
  std::string path_of(const std::string& key) const;

  std::string path_;
  Faults* faults_;
  bool is_map_ = true;
  std::list<Entry> entries_;  ///< no vector: a YAML::Node that is moved up by assignment changes the tree
  std::vector<std::string> known_;
};

}  // namespace vibratory_alignment
