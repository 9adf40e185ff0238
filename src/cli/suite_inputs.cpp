#include "cli/suite_inputs.h"

namespace vibratory_alignment {

std::vector<NamedFile> suite_inputs(const FactSuite& suite) {
  std::vector<NamedFile> inputs = {{"the facts file", suite.book.source}};
  for (const auto& [name, study] : suite.studies) {
    inputs.push_back({"the study " + name, study.source});
    inputs.push_back({"the scene of the study " + name, study.scene_source});
  }
  return inputs;
}

}  // namespace vibratory_alignment
