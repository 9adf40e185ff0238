// A file that appears under its name only when it is whole.
#pragma once

#include <optional>
#include <string>

#include "cli/temporary_file.h"

namespace vibratory_alignment {

/// True when the path names the file, device or pipe that stdout goes to, which then has to be free of anything else.
bool is_stdout(const std::string& path);

/// What becomes of a file that has not been committed.
enum class Unfinished { removed, kept };

/// The path of an output file. Until commit() the file is written to `temporary()` beside it: "PATH.part" if it is kept
/// when it remains unfinished, else a name of its own. Devices and pipes (/dev/stdout) are written directly.
class OutputPath {
 public:
  /// Creates the temporary file, so that a path that cannot be written is found out before anything runs; a kept one
  /// that is there stays as it is.
  /// Throws UsageError that names `option`, the path and the reason; also for the file that stdout or stderr go to.
  OutputPath(const std::string& option, const std::string& path, Unfinished unfinished = Unfinished::removed);

  /// Where to write now.
  const std::string& temporary() const;

  /// Without a temporary file: a device or pipe.
  bool is_direct() const { return !own_ && kept_.empty(); }

  /// As the user gave it, for messages.
  const std::string& path() const { return path_; }

  /// The file is whole and closed: gives it its name. Throws OutputError.
  void commit();

 private:
  std::string path_;
  std::string target_;                ///< path_ with symbolic links resolved
  std::optional<TemporaryFile> own_;  ///< that is removed
  std::string kept_;                  ///< temporary file that stays
};

}  // namespace vibratory_alignment
