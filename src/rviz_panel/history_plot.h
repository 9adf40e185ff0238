// The live plot of a trial: above the misalignment, below the reactions at the slot's two edges, over simulated time.
#pragma once

#include <QWidget>

#include "rviz_panel/history.h"

namespace vibratory_alignment {

class HistoryPlot : public QWidget {
 public:
  explicit HistoryPlot(QWidget* parent = nullptr);

  /// The points are in these units: s, m, N, or without.
  void set_units(bool has_scales) { has_scales_ = has_scales; }

  void add(const HistoryPoint& point);
  void clear();
  const History& history() const { return history_; }

  QSize sizeHint() const override { return {320, 230}; }
  QSize minimumSizeHint() const override { return {220, 150}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  History history_;
  bool has_scales_ = true;
};

}  // namespace vibratory_alignment
