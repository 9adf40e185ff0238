// Who touches what, from states alone: the faces that are crossed, how contacts end, what a base that recovers keeps.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "../support/scenes.h"
#include "mechanics/contact_frame.h"
#include "mechanics/system.h"
#include "solver/contact_book.h"

namespace vibratory_alignment {
namespace {

/// A part 1.4 wide, its bottom 0.9 below its centre; edges at +-0.8.
const std::string box = R"(
part: {half_width: 0.7, base_distance: 0.9, inertia: 0.2}
slot: {clearance: 0.1}
gripper: {stiffness: {x: 0.1, phi: 1.0}, anchor: {y: 0.5}}
base: {stiffness: {x: 500.0, y: 1000.0}, damping: {x: 5.0, y: 10.0}}
contacts: [edges, corners]
excitation: {amplitude: 0.0, frequency: 1.0}
initial: {x: 0.2, y: 3.0, phi: 0.0}
trial: {time_limit: 1.0}
)";

/// The book of a part that is led through states.
class Led {
 public:
  explicit Led(const State& start, const std::vector<std::string>& settings = {})
      : system_(make_system(test::scene_of(box, settings))),
        table_(system_),
        book_(open_book(system_, table_, start)) {}

  /// Events on the way to `state`.
  std::vector<Event> to(const State& state, double elapsed = 1e-3) {
    Segment segment;
    segment.begin = book_.placed.state;
    segment.end = state;
    segment.duration = elapsed;
    ContactBook after(state);
    follow(system_, table_, book_, segment, after);
    book_ = after;
    return {segment.events.begin(), segment.events.begin() + segment.event_count};
  }

  const ContactState& contact(Site site) const { return book_.contacts[static_cast<std::size_t>(site)]; }
  const Recovery& recovery(Site site) const { return book_.recoveries[static_cast<std::size_t>(site)]; }
  bool pushes(Site site) const { return may_push(system_, book_, site); }

 private:
  System system_;
  SiteTable table_;
  ContactBook book_;
};

std::vector<EventKind> kinds(const std::vector<Event>& events) {
  std::vector<EventKind> found;
  for (const Event& event : events) found.push_back(event.kind);
  return found;
}

using Kinds = std::vector<EventKind>;

TEST(ContactPoint, is_what_the_kinematics_of_a_contact_are) {
  const System system = make_system(test::scene_of(box, {"contacts=[edges, corners, walls]", "slot.depth=0.5"}));
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1.5, 1.5);
  const std::vector<std::pair<Site, Face>> pairs = {{Site::a1, Face::bottom},     {Site::a2, Face::left_side},
                                                    {Site::a1, Face::right_side}, {Site::b1, Face::top},
                                                    {Site::b2, Face::top},        {Site::b1, Face::right_wall},
                                                    {Site::b2, Face::left_wall},  {Site::b1_floor, Face::floor}};
  for (int i = 0; i < 100; ++i) {
    const State s{any(random), any(random), 3.0 * any(random), any(random), any(random), any(random)};
    const PlacedState placed(s);
    for (const auto& [site, face] : pairs) {
      const Vec2 point = site_point(system, placed, site);
      const ContactPoint p = contact_point(system, placed, site, face, point);
      const ContactKinematics k = contact_kinematics(system, s, site, face);
      EXPECT_NEAR(p.depth, k.depth, 1e-14);
      EXPECT_NEAR(p.depth_rate, k.depth_rate, 1e-14);
      EXPECT_NEAR(p.slip_velocity, k.slip_velocity, 1e-14);
      EXPECT_NEAR(p.normal.x, k.normal.x, 1e-15);
      EXPECT_NEAR(p.tangent.y, k.tangent.y, 1e-15);
      EXPECT_NEAR(p.normal_lever(), k.lever.x * k.normal.y - k.lever.y * k.normal.x, 1e-14);
      EXPECT_NEAR(p.stiffness, 1000.0 * k.normal.y * k.normal.y + 500.0 * k.normal.x * k.normal.x, 1e-10);
      EXPECT_NEAR(p.push(), p.stiffness * k.depth + 0.01 * p.stiffness * k.depth_rate, 1e-9);
    }
  }
}

TEST(ContactBook, a_point_touches_the_face_that_it_crosses) {
  Led part({0.2, 0.91, 0.0, 0.0, -0.1, 0.0});
  EXPECT_EQ(part.contact(Site::a1).phase, Phase::outside);
  const std::vector<Event> events = part.to({0.2, 0.899, 0.0, 0.0, -0.1, 0.0});
  // flat: the edge a1 under the bottom and the corner b1 on the top
  ASSERT_EQ(kinds(events), (Kinds{EventKind::touch, EventKind::touch}));
  EXPECT_EQ(events[0].site, Site::a1);
  EXPECT_EQ(events[0].face, Face::bottom);
  EXPECT_EQ(events[1].site, Site::b1);
  EXPECT_EQ(events[1].face, Face::top);
  EXPECT_EQ(part.contact(Site::a1).phase, Phase::loaded);
}

// Of the faces crossed in one step the last one is touched, even if the other one is nearer at the end.
TEST(ContactBook, of_two_faces_the_one_crossed_last_is_touched) {
  // the edge a1 is beside the right side and below the bottom; at the end 0.002 deep behind the side, 0.001 above the
  // bottom; the bottom came first
  Led part({0.05, 0.9005, 0.0, 0.0, 0.0, 0.0});
  const std::vector<Event> side = part.to({0.102, 0.899, 0.0, 0.0, 0.0, 0.0});
  ASSERT_FALSE(side.empty());
  EXPECT_EQ(side[0].face, Face::right_side);
  // and the other way round
  Led other({0.09, 0.92, 0.0, 0.0, 0.0, 0.0});
  const std::vector<Event> bottom = other.to({0.14, 0.899, 0.0, 0.0, 0.0, 0.0});
  ASSERT_FALSE(bottom.empty());
  EXPECT_EQ(bottom[0].face, Face::bottom);
}

// What is passed between two states is not seen: in through one face, out through another.
// From exactly on a corner both faces are crossed at once: the point has come in through the one that it is least inside.
TEST(ContactBook, from_exactly_on_a_corner_the_nearest_face_is_touched) {
  const double x = 0.8 + 0.7;  // the left side of the part above the right edge
  Led down({x, 0.9, 0.0, 0, 0, 0}, {"contacts=[edges]"});
  const std::vector<Event> first = down.to({x - 1e-6, 0.9 - 1e-3, 0.0, 0, 0, 0});
  ASSERT_EQ(first.size(), 1u);
  EXPECT_EQ(first[0].face, Face::left_side);
  Led across({x, 0.9, 0.0, 0, 0, 0}, {"contacts=[edges]"});
  const std::vector<Event> second = across.to({x - 1e-3, 0.9 - 1e-6, 0.0, 0, 0, 0});
  ASSERT_EQ(second.size(), 1u);
  EXPECT_EQ(second[0].face, Face::bottom);
}

TEST(ContactBook, a_corner_clipped_within_a_step_is_missed) {
  Led part({0.09, 0.895, 0.0, 0.0, 0.0, 0.0}, {"contacts=[edges]"});
  EXPECT_TRUE(part.to({0.11, 0.905, 0.0, 0.0, 0.0, 0.0}).empty());
}

TEST(ContactBook, a_start_inside_touches_the_nearest_face) {
  Led low({0.2, 0.899, 0.0, 0.0, 0.0, 0.0});
  EXPECT_EQ(low.contact(Site::a1).face, Face::bottom);
  EXPECT_EQ(low.contact(Site::a1).phase, Phase::loaded);
  Led beside({0.101, 0.5, 0.0, 0.0, 0.0, 0.0});
  EXPECT_EQ(beside.contact(Site::a1).face, Face::right_side);
  // k d + h d' < 0: the part goes up faster than the base follows
  Led rising({0.2, 0.899, 0.0, 0.0, 0.2, 0.0});
  EXPECT_EQ(rising.contact(Site::a1).phase, Phase::unloaded);
}

TEST(ContactBook, release_reload_and_close) {
  Led part({0.2, 0.899, 0.0, 0.0, 0.0, 0.0}, {"contacts=[edges]"});
  EXPECT_EQ(kinds(part.to({0.2, 0.8995, 0.0, 0.0, 0.2, 0.0})), (Kinds{EventKind::release}));
  EXPECT_EQ(part.contact(Site::a1).phase, Phase::unloaded);
  EXPECT_TRUE(part.to({0.2, 0.8996, 0.0, 0.0, 0.2, 0.0}).empty());
  EXPECT_EQ(kinds(part.to({0.2, 0.8996, 0.0, 0.0, 0.0, 0.0})), (Kinds{EventKind::reload}));
  EXPECT_EQ(kinds(part.to({0.2, 0.9001, 0.0, 0.0, 0.1, 0.0})), (Kinds{EventKind::release, EventKind::close}));
  EXPECT_EQ(part.contact(Site::a1).phase, Phase::outside);
  EXPECT_EQ(kinds(part.to({0.2, 0.8999, 0.0, 0.0, 0.1, 0.0})), (Kinds{EventKind::touch}));
  EXPECT_EQ(part.contact(Site::a1).phase, Phase::unloaded);
  EXPECT_TRUE(part.to({0.2, 0.9, 0.0, 0.0, 0.1, 0.0}).empty());  // exactly on the face still
  EXPECT_EQ(kinds(part.to({0.2, 0.9 + 1e-12, 0.0, 0.0, 0.1, 0.0})), (Kinds{EventKind::close}));
}

TEST(ContactBook, without_base_damping_release_and_close_are_one) {
  Led part({0.2, 0.899, 0.0, 0.0, 0.0, 0.0}, {"contacts=[edges]", "base.damping=null"});
  EXPECT_TRUE(part.to({0.2, 0.8999, 0.0, 0.0, 5.0, 0.0}).empty());
  EXPECT_EQ(kinds(part.to({0.2, 0.9001, 0.0, 0.0, 0.1, 0.0})), (Kinds{EventKind::release}));
  EXPECT_EQ(part.contact(Site::a1).phase, Phase::outside);
}

TEST(ContactBook, a_foot_runs_off_the_end_of_its_face) {
  Led part({0.11, 0.899, 0.0, 0.0, 0.0, 0.0}, {"contacts=[edges]"});
  ASSERT_EQ(part.contact(Site::a1).face, Face::bottom);
  const std::vector<Event> events = part.to({0.099, 0.899, 0.0, 0.0, 0.0, 0.0});
  ASSERT_EQ(kinds(events), (Kinds{EventKind::run_off}));
  EXPECT_EQ(events[0].face, Face::right_side);
  // back again, it comes in through the side
  EXPECT_EQ(part.to({0.101, 0.899, 0.0, 0.0, 0.0, 0.0}).at(0).face, Face::right_side);
}

TEST(ContactBook, a_face_that_is_not_called_for_lets_points_in) {
  Led part({0.05, 0.8, 0.0, 0.0, 0.0, 0.0}, {"contacts=[corners]"});
  const std::vector<Event> in = part.to({0.11, 0.8, 0.0, 0.0, 0.0, 0.0});
  ASSERT_EQ(kinds(in), (Kinds{EventKind::enter}));
  EXPECT_EQ(in[0].site, Site::b1);
  EXPECT_EQ(part.contact(Site::b1).phase, Phase::free);
  EXPECT_FALSE(part.pushes(Site::b1));
  EXPECT_TRUE(part.to({0.12, 0.8, 0.0, 0.0, 0.0, 0.0}).empty());
  EXPECT_EQ(kinds(part.to({0.05, 0.8, 0.0, 0.0, 0.0, 0.0})), (Kinds{EventKind::leave}));
}

TEST(ContactBook, corners_reach_the_floor_in_the_slot_only) {
  const std::vector<std::string> settings = {"contacts=[walls]", "slot.depth=0.5"};
  Led inside({0.0, 0.405, 0.0, 0.0, -1.0, 0.0}, settings);
  EXPECT_EQ(kinds(inside.to({0.0, 0.399, 0.0, 0.0, -1.0, 0.0})), (Kinds{EventKind::touch, EventKind::touch}));
  EXPECT_EQ(inside.contact(Site::b2_floor).face, Face::floor);
  // through the top surface, which is not called for, the corner comes into the base beside the slot
  Led beside({0.2, 0.91, 0.0, 0.0, -1.0, 0.0}, settings);
  EXPECT_EQ(kinds(beside.to({0.2, 0.405, 0.0, 0.0, -1.0, 0.0})), (Kinds{EventKind::enter}));
  const std::vector<Event> deeper = beside.to({0.2, 0.399, 0.0, 0.0, -1.0, 0.0});
  ASSERT_EQ(kinds(deeper), (Kinds{EventKind::enter, EventKind::touch}));
  EXPECT_EQ(deeper[0].site, Site::b1_floor);
  EXPECT_EQ(deeper[1].site, Site::b2_floor);
}

// Down beside a wall, from within the slot: at the end of the step the corner is beyond the wall's line and below the
// floor, and has come to both.
TEST(ContactBook, a_corner_comes_to_wall_and_floor_in_one_step) {
  Led part({0.09, 0.405, 0.0, 1.0, -1.0, 0.0}, {"contacts=[walls]", "slot.depth=0.5"});
  part.to({0.101, 0.399, 0.0, 1.0, -1.0, 0.0});
  EXPECT_EQ(part.contact(Site::b1).face, Face::right_wall);
  EXPECT_EQ(part.contact(Site::b1_floor).face, Face::floor);
  EXPECT_EQ(part.contact(Site::b2_floor).face, Face::floor);
}

// u = d at the release, then exp(-(k/h) t): here k/h = 100. The part is met where the base is.
TEST(ContactBook, a_base_that_recovers_is_met_where_it_is) {
  const std::vector<std::string> settings = {"contacts=[edges]", "base.recovery=true"};
  Led part({0.2, 0.899, 0.0, 0.0, 0.0, 0.0}, settings);
  EXPECT_EQ(kinds(part.to({0.2, 0.8992, 0.0, 0.0, 0.2, 0.0})), (Kinds{EventKind::release}));
  EXPECT_NEAR(part.recovery(Site::a1).deformation, 8e-4, 1e-15);
  EXPECT_FALSE(part.pushes(Site::a1));
  // k d + h d' > 0 alone does not load it: the base is 8e-4 exp(-0.5) = 4.85e-4 deep
  EXPECT_TRUE(part.to({0.2, 0.8996, 0.0, 0.0, 0.0, 0.0}, 5e-3).empty());
  EXPECT_NEAR(part.recovery(Site::a1).deformation, 8e-4 * std::exp(-0.5), 1e-15);
  EXPECT_EQ(kinds(part.to({0.2, 0.8996, 0.0, 0.0, 0.0, 0.0}, 5e-3)), (Kinds{EventKind::reload}));
  EXPECT_TRUE(part.pushes(Site::a1));
  EXPECT_EQ(part.recovery(Site::a1).deformation, 0.0);
}

TEST(ContactBook, a_base_that_recovers_is_touched_below_its_surface) {
  Led part({0.2, 0.899, 0.0, 0.0, 0.0, 0.0}, {"contacts=[edges]", "base.recovery=true"});
  part.to({0.2, 0.8992, 0.0, 0.0, 0.2, 0.0});
  EXPECT_EQ(kinds(part.to({0.2, 0.9001, 0.0, 0.0, 0.2, 0.0}, 1e-3)), (Kinds{EventKind::close}));
  // inside, but not as deep as the base still is
  EXPECT_TRUE(part.to({0.2, 0.8999, 0.0, 0.0, -0.2, 0.0}, 1e-3).empty());
  EXPECT_EQ(kinds(part.to({0.2, 0.8992, 0.0, 0.0, -0.2, 0.0}, 1e-3)), (Kinds{EventKind::touch}));
}

}  // namespace
}  // namespace vibratory_alignment
