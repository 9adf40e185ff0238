#include "cli/whole_file.h"

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "cli/errors.h"

namespace vibratory_alignment {
namespace {

/// By now something has run.
OutputPath output_path(const std::string& option, const std::string& path) {
  try {
    return OutputPath(option, path);
  } catch (const UsageError& refusal) {
    throw std::runtime_error(refusal.what());
  }
}

}  // namespace

WholeFile::WholeFile(const std::string& option, const std::string& path)
    : path_(output_path(option, path)), file_(path_.temporary(), std::ios::binary) {}

void close_written(std::ofstream& file, const std::string& name) {
  errno = 0;
  file.close();
  if (!file) throw OutputError(name, errno != 0 ? std::strerror(errno) : "not all of it was written");
}

void WholeFile::finish() {
  close_written(file_, path_.path());
  path_.commit();
}

}  // namespace vibratory_alignment
