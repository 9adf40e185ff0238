// A subcommand of `align`. main.cpp holds the table of them; each lives in a file of its own.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

namespace vibratory_alignment {

struct Command {
  const char* name;
  const char* summary;  ///< one line for `align --help`
  /// Adds the options to the subcommand `app`; the returned function runs it after parsing and gives the exit status.
  std::function<int()> (*set_up)(CLI::App& app);
};

/// Accepts any name of a file but the empty one, which a shell makes of a variable that is not set.
inline CLI::Validator file_name() {
  return {[](std::string& name) { return name.empty() ? std::string("the name of the file is empty") : std::string(); },
          ""};
}

}  // namespace vibratory_alignment
