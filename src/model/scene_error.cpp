#include "model/scene_error.h"

#include <utility>

namespace vibratory_alignment {
namespace {

std::string message(const std::string& source, const std::vector<std::string>& faults) {
  std::string lines;
  for (const std::string& fault : faults) lines += (lines.empty() ? "" : "\n") + source + ": " + fault;
  return lines;
}

}  // namespace

SceneError::SceneError(std::string source, std::vector<std::string> faults)
    : std::runtime_error(message(source, faults)), source_(std::move(source)), faults_(std::move(faults)) {}

}  // namespace vibratory_alignment
