#include "cli/temporary_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <system_error>

namespace vibratory_alignment {
namespace {

/// So many files that killed processes left may be in the way.
constexpr int kMostAttempts = 1000;

/// Makes the file unless there is one; it gets the rights that the umask leaves. False if there is one.
bool make(const std::string& path) {
  const int descriptor = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor >= 0) close(descriptor);
  if (descriptor < 0 && errno != EEXIST) throw std::system_error(errno, std::generic_category(), path);
  return descriptor >= 0;
}

}  // namespace

TemporaryFile::TemporaryFile(const std::string& target) {
  for (int attempt = 0; attempt < kMostAttempts; ++attempt) {
    path_ = target + "." + std::to_string(getpid() + attempt) + ".part";
    if (make(path_)) return;
  }
  throw std::system_error(EEXIST, std::generic_category(), path_);
}

TemporaryFile::~TemporaryFile() {
  if (!renamed_) std::remove(path_.c_str());
}

void TemporaryFile::rename(const std::string& name) {
  if (std::rename(path_.c_str(), name.c_str()) != 0) throw std::system_error(errno, std::generic_category(), path_);
  renamed_ = true;
}

}  // namespace vibratory_alignment
