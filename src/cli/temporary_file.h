// A file that grows beside the one that it is to become.
#pragma once

#include <string>

namespace vibratory_alignment {

/// An empty file "TARGET.N.part", N such that no other file has this name. It goes with the object, unless it was given
/// another name.
class TemporaryFile {
 public:
  /// Throws std::system_error that names the file.
  explicit TemporaryFile(const std::string& target);
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::string& path() const { return path_; }

  /// Takes the place of `name` in one go. Throws std::system_error.
  void rename(const std::string& name);

 private:
  std::string path_;
  bool renamed_ = false;
};

}  // namespace vibratory_alignment
