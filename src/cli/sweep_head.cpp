#include "cli/sweep_head.h"

#include <regex>

namespace vibratory_alignment {
namespace {

/// A whole number of at most 15 digits.
std::optional<std::size_t> parse_count(const std::string& text) {
  if (!std::regex_match(text, std::regex("[0-9]{1,15}"))) return std::nullopt;
  return std::stoull(text);
}

}  // namespace

std::size_t shard_size(const Shard& shard, std::size_t trials) {
  return shard.number < trials ? (trials - shard.number - 1) / shard.count + 1 : 0;
}

std::string shard_text(const Shard& shard) {
  return std::to_string(shard.number + 1) + "/" + std::to_string(shard.count);
}

std::optional<Shard> parse_shard(const std::string& text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos) return std::nullopt;
  const std::optional<std::size_t> number = parse_count(text.substr(0, slash)),
                                   count = parse_count(text.substr(slash + 1));
  if (!number || !count || *number < 1 || *number > *count) return std::nullopt;
  return Shard{*number - 1, *count};
}

std::string head_text(const SweepHead& head) {
  return "# align sweep " + head.fingerprint + ": " + std::to_string(head.trials) + " trials" +
         (head.shard.count > 1 ? ", shard " + shard_text(head.shard) : "");
}

std::optional<SweepHead> parse_head(const std::string& line) {
  std::smatch parts;
  if (!std::regex_match(line, parts, std::regex("# align sweep ([0-9a-f-]+): ([0-9]+) trials(, shard ([0-9/]+))?")))
    return std::nullopt;
  const std::optional<std::size_t> trials = parse_count(parts[2]);
  const std::optional<Shard> shard = parts[3].matched ? parse_shard(parts[4]) : Shard();
  if (!trials || !shard) return std::nullopt;
  return SweepHead{parts[1], *trials, *shard};
}

}  // namespace vibratory_alignment
