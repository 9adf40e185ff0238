#include "rviz_panel/history_plot.h"

#include <algorithm>
#include <cmath>

#include <QPainter>
#include <QPainterPath>

#include "rviz_panel/ticks.h"

namespace vibratory_alignment {
namespace {

// Told apart also by those who see colours otherwise (Okabe and Ito), as in the plots of `align`.
const QColor kBlue(0x00, 0x72, 0xB2), kOrange(0xD5, 0x5E, 0x00), kGrid(0xE3, 0xE6, 0xE9), kAxis(0x5A, 0x62, 0x6A);
constexpr int kMargin = 6;        ///< around everything [pixels]
constexpr int kTickSpacing = 44;  ///< of pixels for a mark
constexpr double kHeadroom = 1.08;

/// A unit with a prefix such that the largest number of an axis has one to three digits before the point.
struct Unit {
  double factor = 1.0;
  QString name;
};

Unit unit_for(double largest, const char* base, bool has_scales) {
  if (!has_scales) return {1.0, QString()};
  for (const auto& [factor, prefix] : {std::pair<double, const char*>{1.0, ""}, {1e3, "m"}}) {
    if (largest * factor >= 0.9995 || largest == 0.0) return {factor, QString::fromUtf8(prefix) + base};
  }
  return {1e6, QString::fromUtf8("\u00B5") + base};
}

QString with_unit(const QString& title, const Unit& unit) {
  return unit.name.isEmpty() ? title : title + " [" + unit.name + "]";
}

/// One coordinate system: a frame on the widget, time along x, from 0 up to `top` along y.
class Frame {
 public:
  Frame(QPainter& painter, const QRectF& area, double end, double top)
      : painter_(painter), area_(area), end_(end > 0.0 ? end : 1.0), top_(top > 0.0 ? top * kHeadroom : 1.0) {}

  QPointF at(double time, double value) const {
    return {area_.left() + area_.width() * time / end_, area_.bottom() - area_.height() * value / top_};
  }

  void draw_axes(const QString& title, const Unit& unit, const Unit* time_unit) const {
    const QFontMetrics metrics = painter_.fontMetrics();
    painter_.fillRect(area_, Qt::white);
    const int rows = std::max(2, static_cast<int>(area_.height() / (1.6 * metrics.height())));
    for (const double mark : ticks(0.0, top_ * unit.factor, rows)) {
      const double y = at(0.0, mark / unit.factor).y();
      painter_.setPen(kGrid);
      painter_.drawLine(QPointF(area_.left(), y), QPointF(area_.right(), y));
      painter_.setPen(kAxis);
      painter_.drawText(QRectF(0.0, y - metrics.height(), area_.left() - 4.0, 2.0 * metrics.height()),
                        Qt::AlignRight | Qt::AlignVCenter, QString::number(mark, 'g', 4));
    }
    const double time_factor = time_unit ? time_unit->factor : 1.0;
    const int columns = std::max(2, static_cast<int>(area_.width()) / kTickSpacing);
    for (const double mark : ticks(0.0, end_ * time_factor, columns)) {
      const double x = at(mark / time_factor, 0.0).x();
      painter_.setPen(kGrid);
      painter_.drawLine(QPointF(x, area_.top()), QPointF(x, area_.bottom()));
      if (!time_unit) continue;
      painter_.setPen(kAxis);
      painter_.drawText(QRectF(x - kTickSpacing, area_.bottom() + 2.0, 2.0 * kTickSpacing, metrics.height()),
                        Qt::AlignHCenter | Qt::AlignTop, QString::number(mark, 'g', 4));
    }
    painter_.setPen(kAxis);
    painter_.drawRect(area_);
    painter_.drawText(QPointF(area_.left(), area_.top() - 4.0), with_unit(title, unit));
  }

  /// `value` gives a point's height. Filled: with the colour below the line.
  template <class Value>
  void draw_curve(const std::vector<HistoryPoint>& points, const QColor& color, bool filled, const Value& value) const {
    if (points.empty()) return;
    QPainterPath path(at(points.front().time, value(points.front())));
    for (const HistoryPoint& point : points) path.lineTo(at(point.time, value(point)));
    painter_.save();
    painter_.setClipRect(area_.adjusted(0.0, -1.0, 1.0, 1.0));
    if (filled) {
      QPainterPath body = path;
      body.lineTo(at(points.back().time, 0.0));
      body.lineTo(at(points.front().time, 0.0));
      QColor shade = color;
      shade.setAlpha(60);
      painter_.fillPath(body, shade);
    }
    painter_.setPen(QPen(color, 1.4));
    painter_.drawPath(path);
    painter_.restore();
  }

  /// Names of curves in their colours, to the right above the frame.
  void draw_legend(std::initializer_list<std::pair<const char*, QColor>> curves) const {
    double x = area_.right();
    for (const auto& [name, color] : curves) {
      const QString text = QString::fromUtf8(name);
      x -= painter_.fontMetrics().horizontalAdvance(text) + 12.0;
      painter_.setPen(color);
      painter_.drawText(QPointF(x + 12.0, area_.top() - 4.0), text);
    }
  }

 private:
  QPainter& painter_;
  QRectF area_;
  double end_, top_;
};

}  // namespace

HistoryPlot::HistoryPlot(QWidget* parent) : QWidget(parent) {
  setObjectName("plot");
  setToolTip(
      "Over simulated time: the misalignment, and the largest normal forces at the slot's edges a1 (right) and a2");
}

void HistoryPlot::add(const HistoryPoint& point) {
  history_.add(point);
  update();
}

void HistoryPlot::clear() {
  history_.clear();
  update();
}

void HistoryPlot::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  QFont small = font();
  small.setPointSizeF(std::max(6.0, 0.85 * small.pointSizeF()));
  painter.setFont(small);
  const QFontMetrics metrics = painter.fontMetrics();

  const std::vector<HistoryPoint>& points = history_.points();
  double misalignment = 0.0, force = 0.0;
  for (const HistoryPoint& point : points) {
    misalignment = std::max(misalignment, point.misalignment);
    force = std::max({force, point.force_a1, point.force_a2});
  }
  const double end = points.empty() ? 0.0 : points.back().time;
  const Unit length_unit = unit_for(misalignment, "m", has_scales_), force_unit = unit_for(force, "N", has_scales_),
             time_unit = unit_for(end, "s", has_scales_);

  const double left = kMargin + metrics.horizontalAdvance("-0.000"), width = this->width() - left - 2 * kMargin;
  const double line = metrics.height() + 4.0;
  const double height = 0.5 * (this->height() - 3.6 * line - kMargin);
  const Frame above(painter, {left, line, width, height}, end, misalignment);
  const Frame below(painter, {left, 2.0 * line + height + 2.0, width, height}, end, force);

  above.draw_axes("misalignment", length_unit, nullptr);
  above.draw_curve(points, kBlue, false, [](const HistoryPoint& point) { return point.misalignment; });
  below.draw_axes("reactions", force_unit, &time_unit);
  below.draw_legend({{"a2", kOrange}, {"a1", kBlue}});
  below.draw_curve(points, kBlue, true, [](const HistoryPoint& point) { return point.force_a1; });
  below.draw_curve(points, kOrange, true, [](const HistoryPoint& point) { return point.force_a2; });
  painter.setPen(kAxis);
  painter.drawText(QRectF(left, this->height() - line - 2.0, width, line), Qt::AlignHCenter | Qt::AlignBottom,
                   has_scales_ ? "simulated time [" + time_unit.name + "]" : QString("simulated time"));
}

}  // namespace vibratory_alignment
