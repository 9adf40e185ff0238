// The files that facts are read from, for messages about outputs that would overwrite them.
#pragma once

#include <vector>

#include "cli/output_roles.h"
#include "study/fact_suite.h"

namespace vibratory_alignment {

/// The facts file, its studies and their scenes.
std::vector<NamedFile> suite_inputs(const FactSuite& suite);

}  // namespace vibratory_alignment
