// The first line of a sweep's CSV file: which study it is of, and which part of it.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace vibratory_alignment {

/// Trials number, number + count, ... of a study. The first shard has number 0.
struct Shard {
  std::size_t number = 0, count = 1;
};

/// Trials that a shard has of `trials`.
std::size_t shard_size(const Shard& shard, std::size_t trials);

/// "2/4"; parse_shard() reads it, none if it is not such a text with 1 <= 2 <= 4.
std::string shard_text(const Shard& shard);
std::optional<Shard> parse_shard(const std::string& text);

struct SweepHead {
  std::string fingerprint;  ///< of the study and the version of this package
  std::size_t trials = 0;   ///< of the whole study
  Shard shard;
};

/// "# align sweep 83d02f1c-...: 720 trials, shard 2/4", without the shard for a whole study; parse_head() reads it,
/// none if it is not such a line.
std::string head_text(const SweepHead& head);
std::optional<SweepHead> parse_head(const std::string& line);

}  // namespace vibratory_alignment
