// The scenes that come with the package.
#pragma once

#include <QStringList>

namespace vibratory_alignment {

/// Names as `align trial` and ~load_scene take them (fig2, hard/chatter), sorted, those in folders last; none where the
/// package is not found.
QStringList shipped_scenes();

}  // namespace vibratory_alignment
