// The ledger of facts: as a table on the terminal, in markdown, as JSON.
#pragma once

#include <string>
#include <vector>

#include "study/facts.h"

namespace vibratory_alignment {

/// "met", "missed", and where that is not what the book expects, that it is not.
std::string verdict(const Fact& fact, const FactResult& result);

/// A line for each measure, the verdict of each fact, and how many are met. `results` belong to the facts of the book.
std::string ledger_text(const FactBook& book, const std::vector<FactResult>& results);
std::string ledger_markdown(const FactBook& book, const std::vector<FactResult>& results);
std::string ledger_json(const FactBook& book, const std::vector<FactResult>& results);

/// Facts that are expected to be met and are not.
std::vector<std::string> unexpected_misses(const FactBook& book, const std::vector<FactResult>& results);

}  // namespace vibratory_alignment
