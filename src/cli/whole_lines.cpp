#include "cli/whole_lines.h"

#include <cerrno>
#include <cstring>

#include "cli/errors.h"

namespace vibratory_alignment {

WholeLines::WholeLines(const std::string& name, const std::string& path) : name_(name), file_(path, std::ios::binary) {
  if (!file_) refuse();
}

bool WholeLines::next(std::string& line) {
  const bool whole = std::getline(file_, line) && !file_.eof();
  if (file_.bad()) refuse();
  if (whole) bytes_ += line.size() + 1;
  return whole;
}

std::string WholeLines::take(std::size_t bytes) {
  std::string text(bytes, '\0');
  file_.read(text.data(), static_cast<std::streamsize>(bytes));
  if (file_.bad()) refuse();
  text.resize(static_cast<std::size_t>(file_.gcount()));
  return text;
}

void WholeLines::refuse() const { throw UsageError(name_ + ": cannot be read: " + std::strerror(errno)); }

}  // namespace vibratory_alignment
