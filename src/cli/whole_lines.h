// A file that another run may have left torn, read line by line: what has no line end is no line.
#pragma once

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string>

namespace vibratory_alignment {

class WholeLines {
 public:
  /// `name`: that of the file in messages, with the option that gave it. Throws UsageError that says why it cannot be
  /// read.
  WholeLines(const std::string& name, const std::string& path);

  /// The next line that is whole, without its end; false when there is none. Throws UsageError when reading fails: that
  /// is not taken for the end of the file.
  bool next(std::string& line);

  /// At most so many of the next bytes, whatever the lines; fewer at the end of the file. Throws as next() does.
  std::string take(std::size_t bytes);

  /// Of the whole lines read so far.
  std::uintmax_t bytes() const { return bytes_; }

 private:
  [[noreturn]] void refuse() const;

  std::string name_;
  std::ifstream file_;
  std::uintmax_t bytes_ = 0;
};

}  // namespace vibratory_alignment
