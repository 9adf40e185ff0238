// Scenes with a name, as parameters of tests.
#pragma once

#include <ostream>
#include <string>

namespace vibratory_alignment::test {

struct NamedScene {
  std::string name, text;
};

inline std::ostream& operator<<(std::ostream& out, const NamedScene& scene) { return out << scene.name; }

}  // namespace vibratory_alignment::test
