// Runs a script that comes with the program.
#pragma once

#include <string>
#include <vector>

#include "cli/interrupt.h"

namespace vibratory_alignment {

/// A path as a word that no script takes for an option.
std::string path_word(const std::string& path);

/// Runs the script `name` that is installed beside this program, waits for it, and returns its exit status: 0 it did
/// what it is for; otherwise it has said on stderr why not. Ended by a signal: 128 + its number. A signal that has come
/// to `interrupt` is passed on to it; what it returns means nothing then.
/// Throws std::runtime_error that begins with `purpose` when it is missing or cannot be run.
int run_script(const std::string& name, const std::vector<std::string>& arguments, const std::string& purpose,
               const InterruptGuard& interrupt);

/// The same for a script that has no reason to fail but an interrupt. Throws std::runtime_error when it does.
void require_script(const std::string& name, const std::vector<std::string>& arguments, const std::string& purpose,
                    const InterruptGuard& interrupt);

}  // namespace vibratory_alignment
