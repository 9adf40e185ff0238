// Keeps what rviz shows in proportion to the slot, which ranges from micrometres to metres: where another scene brings
// a slot of another size, the view that looks at it comes nearer or goes away.
#pragma once

#include <string>

namespace rviz {
class VisualizationManager;
}

namespace vibratory_alignment {

class ViewFit {
 public:
  /// Looks at the slot of this frame, from now and then to at each refresh. A view whose Target Frame is another one is
  /// somebody's own, and stays as it is; so does one that is no Orbit.
  void follow(rviz::VisualizationManager& manager, const std::string& slot);

 private:
  std::string slot_;
  double half_width_ = 0.0;  ///< of the slot that is in view; 0: not known
};

}  // namespace vibratory_alignment
