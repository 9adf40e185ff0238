#include "cli/output_path.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "cli/errors.h"

namespace vibratory_alignment {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& option, const std::string& path, const std::string& reason) {
  throw UsageError(option + ": " + path + ": cannot be written: " + reason);
}

/// True when the path names the file, device or pipe that the descriptor leads to.
bool leads_to(int descriptor, const std::string& path) {
  struct stat stream {
  }, file{};
  return fstat(descriptor, &stream) == 0 && stat(path.c_str(), &file) == 0 && stream.st_dev == file.st_dev &&
         stream.st_ino == file.st_ino;
}

/// What a path leads to through symbolic links, whether or not it is there. Throws std::system_error.
fs::path without_links(fs::path path) {
  constexpr int kMostLinks = 40;
  for (int links = 0; fs::is_symlink(fs::symlink_status(path)); ++links) {
    if (links == kMostLinks) throw std::system_error(ELOOP, std::generic_category(), path.string());
    path = path.parent_path() / fs::read_symlink(path);
  }
  return path;
}

/// "TARGET.part", made unless it is there. Throws std::system_error.
std::string kept_file(const std::string& target) {
  const std::string path = target + ".part";
  const fs::file_status status = fs::status(path);
  if (fs::exists(status) && !fs::is_regular_file(status))
    throw std::system_error(EEXIST, std::generic_category(), path + ": is not a regular file, and in the way");
  std::FILE* const file = std::fopen(path.c_str(), "ab");
  if (file == nullptr) throw std::system_error(errno, std::generic_category(), path);
  std::fclose(file);
  return path;
}

}  // namespace

bool is_stdout(const std::string& path) { return leads_to(STDOUT_FILENO, path); }

OutputPath::OutputPath(const std::string& option, const std::string& path, Unfinished unfinished)
    : path_(path), target_(path) {
  if (path.empty()) throw UsageError(option + ": the name of the file is empty");
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) refuse(option, path, std::strerror(EISDIR));
  const bool exists = fs::exists(status);
  if (exists && access(path.c_str(), W_OK) != 0) refuse(option, path, std::strerror(errno));
  if (exists && !fs::is_regular_file(status)) return;
  if (exists && (is_stdout(path) || leads_to(STDERR_FILENO, path)))
    refuse(option, path, "it is the file that the command's own output goes to");
  try {
    target_ = without_links(path).string();
    if (unfinished == Unfinished::kept)
      kept_ = kept_file(target_);
    else
      own_.emplace(target_);
    // the new file has the rights of the one whose place it takes
    if (exists) fs::permissions(temporary(), status.permissions());
  } catch (const std::system_error& failure) {
    refuse(option, path, failure.what());
  }
}

const std::string& OutputPath::temporary() const {
  if (own_) return own_->path();
  return is_direct() ? target_ : kept_;
}

void OutputPath::commit() {
  try {
    if (own_) own_->rename(target_);
  } catch (const std::system_error& failure) {
    throw OutputError(path_, failure.what());
  }
  if (!kept_.empty() && std::rename(kept_.c_str(), target_.c_str()) != 0)
    throw OutputError(path_, kept_ + ": " + std::strerror(errno));
}

}  // namespace vibratory_alignment
