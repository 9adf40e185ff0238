// How `align` ends: its exit status and the exceptions that lead to it. Exit status 2 also follows from a SceneError.
#pragma once

#include <stdexcept>
#include <string>

namespace vibratory_alignment {

/// Ended by a signal: 128 + its number, as shells report it.
enum ExitStatus : int {
  kExitRan = 0,     ///< it ran, whatever the outcome of the trial
  kExitFailed = 1,  ///< it failed while running
  kExitUsage = 2    ///< bad usage or bad scene; nothing was run
};

/// The call cannot be carried out as it was given. what() is the message for the user.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A file or stdout could not be written. what() names it and the reason.
class OutputError : public std::runtime_error {
 public:
  OutputError(const std::string& path, const std::string& reason)
      : std::runtime_error(path + ": cannot be written: " + reason) {}
};

}  // namespace vibratory_alignment
