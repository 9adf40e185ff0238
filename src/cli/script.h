// Runs a script that comes with the program.
#pragma once

#include <string>
#include <vector>

namespace vibratory_alignment {

/// Runs the script `name` that is installed beside this program, and waits for it. `purpose` begins the messages.
/// Throws std::runtime_error when it is missing or fails.
void run_script(const std::string& name, const std::vector<std::string>& arguments, const std::string& purpose);

}  // namespace vibratory_alignment
