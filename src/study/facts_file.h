// Reads a facts file (docs/studies.md "Facts").
#pragma once

#include <string>
#include <vector>

#include "study/facts.h"

namespace vibratory_alignment {

/// Throws SceneError with every fault at once: file, key path, value, what is allowed.
FactBook load_facts(const std::string& path);

/// What is wrong with the formulas and columns of the book, given the columns of each table that it asks for (tables
/// without rows); empty: nothing. One line a fault.
std::vector<std::string> faults_of_formulas(const FactBook& book, const Tables& empty_tables);

}  // namespace vibratory_alignment
