// The ledger of facts: as a table on the terminal, in markdown, as JSON.
#pragma once

#include <string>
#include <vector>

#include "study/facts.h"

namespace vibratory_alignment {

/// A line for each measure, the verdict of each fact, and how many are met. `results` belong to the facts of the book.
std::string ledger_text(const FactBook& book, const std::vector<FactResult>& results);
std::string ledger_markdown(const FactBook& book, const std::vector<FactResult>& results);
std::string ledger_json(const FactBook& book, const std::vector<FactResult>& results);

/// Names of the facts that are missed and expected to be met.
std::vector<std::string> missed_unexpectedly(const FactBook& book, const std::vector<FactResult>& results);

}  // namespace vibratory_alignment
