// A subcommand of `align`. main.cpp holds the table of them; each lives in a file of its own.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace vibratory_alignment {

struct Command {
  const char* name;
  const char* summary;  ///< one line for `align --help`
  /// Adds the options to the subcommand `app`; the returned function runs it after parsing and gives the exit status.
  std::function<int()> (*set_up)(CLI::App& app);
};

}  // namespace vibratory_alignment
