// What is wrong with a scene, a study or another file that a user has written.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace vibratory_alignment {

/// All faults of one scene; what() is the message for the user, one fault a line: "source: key.path: value: what is
/// allowed".
class SceneError : public std::runtime_error {
 public:
  SceneError(std::string source, std::vector<std::string> faults);
  /// The file, or what else is said in its place.
  const std::string& source() const { return source_; }
  const std::vector<std::string>& faults() const { return faults_; }

 private:
  std::string source_;
  std::vector<std::string> faults_;
};

}  // namespace vibratory_alignment
