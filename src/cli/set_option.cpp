#include "cli/set_option.h"

#include <cctype>

namespace vibratory_alignment {
namespace {

const std::string kSet = "--set";

/// A key path before an equals sign; a path to a file has a slash or a hyphen before it, if there is one.
bool is_setting(const std::string& word) {
  const std::size_t equals = word.find('=');
  if (equals == std::string::npos || equals == 0) return false;
  for (const char c : word.substr(0, equals))
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_' && c != '.') return false;
  return true;
}

}  // namespace

void add_set_option(CLI::App& app, std::vector<std::string>& settings, const std::string& description) {
  app.add_option(kSet, settings, description)->type_name("KEY.PATH=VALUE")->allow_extra_args(false);
}

std::vector<std::string> with_set_before_each(const std::vector<std::string>& words) {
  std::vector<std::string> expanded;
  bool is_value = false, follows_setting = false;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == "--" && !is_value) {
      expanded.insert(expanded.end(), words.begin() + static_cast<std::ptrdiff_t>(i), words.end());
      break;
    }
    if (follows_setting && is_setting(words[i]))
      expanded.push_back(kSet);
    else
      follows_setting = is_value || words[i].compare(0, kSet.size() + 1, kSet + "=") == 0;
    is_value = words[i] == kSet && !is_value;
    expanded.push_back(words[i]);
  }
  return expanded;
}

}  // namespace vibratory_alignment
