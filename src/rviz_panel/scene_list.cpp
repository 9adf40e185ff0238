#include "rviz_panel/scene_list.h"

#include <ros/package.h>

#include "model/package_files.h"

namespace vibratory_alignment {

QStringList shipped_scenes() {
  QStringList names;
  for (const std::string& name : yaml_names(ros::package::getPath("vibratory_alignment") + "/config/scenes"))
    names.push_back(QString::fromStdString(name));
  return names;
}

}  // namespace vibratory_alignment
