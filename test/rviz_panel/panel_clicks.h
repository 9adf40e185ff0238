// What the tests of the panel share: an aligner_node that can be killed, and clicks and looks by the names of widgets.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>

#include <QApplication>
#include <QLabel>
#include <QProcess>
#include <QPushButton>
#include <QtTest/QTest>

namespace vibratory_alignment {

/// An aligner_node that waits for ~start; killed when this goes.
class NodeProcess {
 public:
  NodeProcess() { start(); }
  ~NodeProcess() { kill(); }

  void start() {
    process_.setProcessChannelMode(QProcess::ForwardedChannels);
    process_.start(ALIGNER_NODE, {"__name:=aligner", "_scene_file:=" SMALL_SCENE, "_autostart:=false",
                                  "_time_scale:=0.005", "_sample_interval:=0.01"});
    if (!process_.waitForStarted()) throw std::runtime_error(ALIGNER_NODE " does not start");
  }

  /// As kill -9: the master is not told.
  void kill() {
    process_.kill();
    process_.waitForFinished();
  }

  qint64 pid() const { return process_.processId(); }

 private:
  QProcess process_;
};

/// Lets Qt work until `condition` holds; false if it does not in time.
inline bool wait_until(const std::function<bool()>& condition, int milliseconds = 15000) {
  for (int waited = 0; waited < milliseconds; waited += 20) {
    if (condition()) return true;
    QTest::qWait(20);
  }
  return condition();
}

template <class Widget>
Widget& child(QWidget& window, const char* name) {
  auto* const widget = window.findChild<Widget*>(name);
  if (!widget) throw std::runtime_error(std::string("there is no widget ") + name);
  return *widget;
}

inline void click(QWidget& window, const char* button) {
  QTest::mouseClick(&child<QPushButton>(window, button), Qt::LeftButton);
}

inline bool says(QWidget& window, const char* label, const char* words) {
  return child<QLabel>(window, label).text().contains(words);
}

}  // namespace vibratory_alignment
