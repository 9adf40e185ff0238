// A text file of results: under its name there is what was there before, or all of the new one.
#pragma once

#include <fstream>
#include <string>

#include "cli/output_path.h"

namespace vibratory_alignment {

/// All of the file has been written. Throws OutputError that gives it this name, for what went wrong before as well.
void close_written(std::ofstream& file, const std::string& name);

class WholeFile {
 public:
  /// Throws std::runtime_error that names `option`, the path and the reason when it cannot be written.
  WholeFile(const std::string& option, const std::string& path);

  std::ostream& text() { return file_; }

  /// All of it has been written. Throws OutputError, for what went wrong before as well.
  void finish();

 private:
  OutputPath path_;
  std::ofstream file_;
};

}  // namespace vibratory_alignment
