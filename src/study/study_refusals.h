// Studies that would run in vain: no trial has a scene, or what is asked for reaches none.
#pragma once

#include <string>
#include <vector>

#include "study/study.h"

namespace vibratory_alignment {

/// Throws SceneError if load_scene refuses every trial; of a study of more than a thousand trials, if it refuses a
/// thousand all over it for a reason that they have in common: a key path or the scene itself is wrong then.
void refuse_without_scenes(const Study& study);

/// Throws SceneError for a setting, "key.path=value", that no trial would have: the study varies what stands there.
/// (An offset is added to what is set.)
void refuse_settings_of_varied_keys(const Study& study, const std::vector<std::string>& settings);

}  // namespace vibratory_alignment
