#include "cli/picture_format.h"

#include <array>
#include <filesystem>

#include "cli/errors.h"

namespace vibratory_alignment {
namespace {

constexpr std::array<const char*, 3> kFormats = {"png", "svg", "pdf"};

}  // namespace

std::string picture_format(const std::string& option, const std::string& path) {
  const std::string ending = std::filesystem::path(path).extension().string();
  std::string allowed;
  for (const char* format : kFormats) {
    if (ending == std::string(".") + format) return format;
    allowed += (allowed.empty() ? "." : ", .") + std::string(format);
  }
  throw UsageError(option + ": " + path + ": the name must end in one of " + allowed);
}

}  // namespace vibratory_alignment
