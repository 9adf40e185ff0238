// The service ~load_scene: another scene in the place of the present one.
#pragma once

#include <functional>
#include <string>

#include <ros/node_handle.h>
#include <ros/service_server.h>

#include "model/scene.h"

namespace vibratory_alignment {

/// `put_on` is given the scene, loaded and checked, makes it the node's, and returns words about where it waits. It
/// throws SceneError when the scene has no start; then the present one goes on.
ros::ServiceServer advertise_load_scene(ros::NodeHandle private_handle,
                                        std::function<std::string(const Scene&)> put_on);

}  // namespace vibratory_alignment
