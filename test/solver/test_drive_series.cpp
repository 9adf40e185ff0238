// Power series of the excitations against their forces in closed form, however many goes they are made in.
#include "solver/drive_series.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace vibratory_alignment {
namespace {

constexpr int kOrder = 30;
constexpr double kReach = 0.4;  // 5 rad of the fastest drive

const DriveForm kSine{0.3, 0.0, 1.2, 11.0, 0.0, 0.6, 0.8}, kOther{0.0, 0.0, 0.7, 5.0, 0.0, -0.8, 0.6},
    kChirp{0.0, 0.0, 0.9, 4.0, 6.0, 0.0, 1.0}, kRamp{0.5, -2.0, 0.0, 0.0, 0.0, 0.0, 1.0};

DriveForms forms_of(const std::vector<std::pair<Direction, DriveForm>>& drives) {
  DriveForms forms;
  for (const auto& [direction, form] : drives) {
    forms.direction[static_cast<std::size_t>(forms.count)] = direction;
    forms.form[static_cast<std::size_t>(forms.count)] = form;
    ++forms.count;
  }
  return forms;
}

std::unique_ptr<Segment> made_in(const DriveForms& forms, const std::vector<int>& orders) {
  auto segment = std::make_unique<Segment>();
  DriveSeries series;
  series.begin(forms);
  for (const int order : orders) series.extend(order, *segment);
  return segment;
}

const DriveForms kAll = forms_of({{Direction::x, kSine},
                                  {Direction::y, kChirp},
                                  {Direction::x, kOther},
                                  {Direction::y, kRamp},
                                  {Direction::x, kRamp}});

TEST(DriveSeries, sums_to_the_forces) {
  const auto segment = made_in(kAll, {kOrder});
  for (double t = 0.0; t <= kReach; t += 0.05) {
    EXPECT_NEAR(value_at(segment->drive_x, kOrder, t), kSine.at(t) + kOther.at(t) + kRamp.at(t), 1e-13) << t;
    EXPECT_NEAR(value_at(segment->drive_y, kOrder, t), kChirp.at(t) + kRamp.at(t), 1e-13) << t;
    EXPECT_EQ(value_at(segment->drive_phi, kOrder, t), 0.0);
  }
}

TEST(DriveSeries, is_the_same_in_one_go_and_in_several) {
  const auto whole = made_in(kAll, {kOrder});
  for (const std::vector<int>& orders :
       {std::vector<int>{0, kOrder}, {1, 2, kOrder}, {14, 16, 18, kOrder}, {kOrder, kOrder}}) {
    const auto parts = made_in(kAll, orders);
    for (std::size_t k = 0; k <= kOrder; ++k) {
      EXPECT_EQ(parts->drive_x[k], whole->drive_x[k]) << k;
      EXPECT_EQ(parts->drive_y[k], whole->drive_y[k]) << k;
      EXPECT_EQ(parts->drive_phi[k], 0.0) << k;
    }
  }
}

// A drive of another frequency, a chirp that has ended or one that begins: nothing is left of what was there before.
TEST(DriveSeries, knows_nothing_of_the_segment_before) {
  const DriveForms another = forms_of({{Direction::x, kChirp}, {Direction::y, kSine}, {Direction::phi, kSine}});
  const auto fresh = made_in(another, {kOrder}), fresh_all = made_in(kAll, {kOrder});
  DriveSeries series;
  Segment segment;
  for (int i = 0; i < 2; ++i) {
    series.begin(kAll);
    series.extend(kOrder, segment);
    for (std::size_t k = 0; k <= kOrder; ++k) {
      EXPECT_EQ(segment.drive_x[k], fresh_all->drive_x[k]) << k;
      EXPECT_EQ(segment.drive_y[k], fresh_all->drive_y[k]) << k;
    }
    series.begin(another);
    series.extend(kOrder, segment);
    for (std::size_t k = 0; k <= kOrder; ++k) {
      EXPECT_EQ(segment.drive_x[k], fresh->drive_x[k]) << k;
      EXPECT_EQ(segment.drive_y[k], fresh->drive_y[k]) << k;
      EXPECT_EQ(segment.drive_phi[k], fresh->drive_phi[k]) << k;
    }
  }
}

// Of a segment that has been used before nothing is left.
TEST(DriveSeries, an_axis_without_a_drive_is_without_force) {
  const DriveForms along_y = forms_of({{Direction::y, kSine}});
  auto segment = made_in(kAll, {kOrder});
  DriveSeries series;
  series.begin(along_y);
  series.extend(kOrder, *segment);
  for (std::size_t k = 0; k <= kOrder; ++k) {
    EXPECT_EQ(segment->drive_x[k], 0.0) << k;
    EXPECT_EQ(segment->drive_phi[k], 0.0) << k;
  }
}

}  // namespace
}  // namespace vibratory_alignment
