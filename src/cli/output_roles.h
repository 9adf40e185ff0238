// Files of one call that must differ: none that is written may be one that is read, or another one that is written.
#pragma once

#include <string>
#include <vector>

namespace vibratory_alignment {

struct NamedFile {
  std::string role;  ///< of an input "the scene"; of an output the option, "--csv"
  std::string path;  ///< empty: it is not asked for
};

/// Throws UsageError that names the path and what it is twice.
void refuse_overwriting(const std::vector<NamedFile>& inputs, const std::vector<NamedFile>& outputs);

}  // namespace vibratory_alignment
