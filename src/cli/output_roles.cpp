#include "cli/output_roles.h"

#include <filesystem>
#include <system_error>

#include "cli/errors.h"

namespace vibratory_alignment {
namespace {

namespace fs = std::filesystem;

/// Whether both paths lead to one file, be it there or not yet.
bool same_file(const std::string& a, const std::string& b) {
  if (a.empty() || b.empty()) return false;
  std::error_code error;
  if (fs::equivalent(a, b, error)) return true;
  const auto place = [&error](const std::string& path) { return fs::weakly_canonical(fs::absolute(path), error); };
  return place(a) == place(b) && !error;
}

}  // namespace

void refuse_overwriting(const std::vector<NamedFile>& inputs, const std::vector<NamedFile>& outputs) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const NamedFile& output = outputs[i];
    for (const NamedFile& input : inputs)
      if (same_file(input.path, output.path))
        throw UsageError(output.role + ": " + output.path + ": is " + input.role + "; it is not overwritten");
    for (std::size_t j = 0; j < i; ++j)
      if (same_file(outputs[j].path, output.path))
        throw UsageError(output.path + ": " + outputs[j].role + " and " + output.role + " name the same file");
  }
}

}  // namespace vibratory_alignment
