// Known answers of the hard cases that have no formula of one line: test/reference/hard_cases.yaml. The tests compute
// them anew.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

namespace vibratory_alignment::test {

inline YAML::Node known_answers(const std::string& scene) { return YAML::LoadFile(std::string(KNOWN_ANSWERS))[scene]; }

}  // namespace vibratory_alignment::test
