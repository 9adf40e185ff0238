#include "rviz_panel/scene_list.h"

#include <algorithm>

#include <QDir>
#include <QDirIterator>
#include <ros/package.h>

namespace vibratory_alignment {

QStringList shipped_scenes() {
  const QDir folder(QString::fromStdString(ros::package::getPath("vibratory_alignment")) + "/config/scenes");
  QStringList names;
  for (QDirIterator files(folder.path(), {"*.yaml"}, QDir::Files, QDirIterator::Subdirectories); files.hasNext();) {
    names.push_back(folder.relativeFilePath(files.next()).chopped(5));
  }
  std::sort(names.begin(), names.end(), [](const QString& a, const QString& b) {
    return std::make_pair(a.count('/'), a) < std::make_pair(b.count('/'), b);
  });
  return names;
}

}  // namespace vibratory_alignment
