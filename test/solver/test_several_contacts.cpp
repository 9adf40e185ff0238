// Friction at several contacts at once, at rest, and where forces begin at zero: scenes that are decided by more than
// one contact or by more than the first power of the motion. Each obeys the model in every segment, closes its ledger,
// and neither the side nor the tolerance matters.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "../support/mirror.h"
#include "../support/motion_check.h"
#include "../support/named_scene.h"
#include "../support/runs.h"
#include "../support/scenes.h"

namespace vibratory_alignment {
namespace {

const std::vector<test::NamedScene>& cases() {
  static const std::vector<test::NamedScene> all = {
      {"side_against_edge_and_wall_at_once", R"(
part: {half_width: 0.5, base_distance: 0.5}
slot: {clearance: 0.01, depth: 1}
gripper: {stiffness: {x: 1}, anchor: {x: 0, y: 1}}
base: {stiffness: {y: 1.0e+4}}
contacts: [edges, walls]
friction: {coefficient: 1}
excitation: {amplitude: 0, frequency: 1}
initial: {x: 0, y: 0, phi: 0, vx: -1, vy: -1}
trial: {time_limit: 0.04}
)"},
      {"flat_start_on_edge_and_corner_pushed_sideways", R"(
part: {half_width: 0.5, base_distance: 1.294529180896747}
slot: {clearance: 0.01}
gripper: {stiffness: {x: 0}, anchor: {x: 0, y: 0}}
base: {stiffness: {x: 1.0e+4, y: 2.0e+4}}
contacts: [edges, corners]
friction: {coefficient: 1}
excitation:
- {amplitude: 1, frequency: 10}
- {amplitude: 1, frequency: 10, phase: -3, direction: x}
initial: {x: 0.6, y: 1.29, phi: 0, vy: -1}
trial: {time_limit: 0.04, aligned_depth: 0.03}
)"},
      {"touch_at_the_start_with_x_locked", R"(
part: {half_width: 0.5, base_distance: 0.1, inertia: 0.1}
slot: {clearance: 0.01}
gripper: {stiffness: {phi: 1}, anchor: {x: 0, phi: 0, y: 0}}
base: {stiffness: {y: 1.0e+4}}
contacts: [edges]
friction: {coefficient: 1}
excitation: {amplitude: 0, frequency: 1}
initial: {x: -0.1, y: 0.1, phi: 0, vy: -1}
trial: {time_limit: 0.04}
)"},
      {"turning_back_on_the_floor_with_x_locked", R"(
part: {half_width: 1.117656997578504, base_distance: 0.32036146512933533, inertia: 0.09114250212993957}
slot: {clearance: 0.15012424635964683, depth: 0.5902615539915915}
gripper:
  stiffness: {phi: 1}
  damping: {y: 2, phi: 0.08}
  anchor: {x: 0, phi: 0.1548240854862581, y: -0.34338992581179084}
base: {stiffness: {x: 1.0e+4, y: 100}, damping: {x: 0, y: 6}}
contacts: [walls]
friction: {coefficient: 0.838977787628104}
excitation: {amplitude: 0, frequency: 1}
initial: {x: 0.37052714749911364, y: 0.3666885363191436, phi: -0.04171158017441712}
trial: {time_limit: 2.154943201453273, aligned_depth: 0.006407229302586707}
weight: 1
)"},
      {"flat_start_on_edge_and_corner", R"(
part: {half_width: 0.5, base_distance: 1.6875486864216407, inertia: 0.1}
slot: {clearance: 0.01}
gripper: {stiffness: {x: 1, phi: 1}, anchor: {x: 0, phi: 0, y: 1}}
base: {stiffness: {y: 1.0e+4}}
contacts: [edges, corners]
friction: {coefficient: 1}
excitation: {amplitude: 0, frequency: 1}
initial: {x: -0.2, y: 1.6875440371716643, phi: 0, vy: -1}
trial: {time_limit: 0.04, aligned_depth: 0.1}
)"},
      {"flat_landing_of_edge_and_corner", R"(
part: {half_width: 0.5, base_distance: 0.5, inertia: 0.1}
slot: {clearance: 0.006}
gripper: {stiffness: {x: 1, phi: 1}, anchor: {x: -0.007170234364181197, phi: 0, y: 1}}
base: {stiffness: {y: 1.0e+4}}
contacts: [edges, corners]
friction: {coefficient: 1}
excitation: {amplitude: 0, frequency: 1}
initial: {x: -0.007170234364181197, y: 1, phi: 0, vy: -1}
trial: {time_limit: 0.8}
)"},
      {"flat_landing_on_a_base_damped_one_way", R"(
part: {half_width: 1, base_distance: 0.1, inertia: 0.1}
slot: {clearance: 0.01}
gripper: {stiffness: {x: 1, phi: 1}, anchor: {x: -0.286828747355734, phi: 0, y: 1}}
base: {stiffness: {x: 1.0e+4, y: 100}, damping: {x: 0, y: 40}}
contacts: [edges, corners]
friction: {coefficient: 1}
excitation: {amplitude: 0, frequency: 1}
initial: {x: -0.286828747355734, y: 0.2, phi: 0, vy: -1}
trial: {time_limit: 0.4}
)"},
      {"flat_touch_at_the_start", R"(
part: {half_width: 2, base_distance: 1.2, inertia: 0.1}
slot: {clearance: 0.01}
gripper: {stiffness: {x: 1, phi: 1}, anchor: {x: -0.6096316477305698, phi: 0, y: 1}}
base: {stiffness: {y: 1.0e+4}}
contacts: [edges, corners]
friction: {coefficient: 1}
excitation: {amplitude: 0, frequency: 1}
initial: {x: -0.6096316477305698, y: 1.2, phi: 0, vy: -1}
trial: {time_limit: 1}
)"},
      {"flat_on_the_floor_shaken_sideways", R"(
part: {half_width: 0.5, base_distance: 0.29, inertia: 0.1}
slot: {clearance: 0.01, depth: 0.176}
gripper: {stiffness: {x: 1, phi: 1}, anchor: {x: 0, phi: 0, y: 1}}
base: {stiffness: {y: 1.0e+4}}
contacts: [walls]
friction: {coefficient: 1}
excitation: {amplitude: 1, frequency: 30, direction: x}
initial: {x: 0, y: 0.11379, phi: 0}
trial: {time_limit: 0.04}
)"},
      {"thrown_from_deep_in_the_floor", R"(
part: {half_width: 0.5, base_distance: 2, inertia: 0.1}
slot: {clearance: 0.01, depth: 1}
gripper: {stiffness: {x: 1, phi: 1}, anchor: {x: 0, phi: 0, y: 1}}
base: {stiffness: {y: 1.0e+4}}
contacts: [walls]
friction: {coefficient: 1}
excitation: {amplitude: 0, frequency: 1}
initial: {x: 0, y: 0, phi: 0, vx: -1, vy: -1, omega: -1}
trial: {time_limit: 1}
)"},
      {"landing_on_one_edge_with_x_locked", R"(
part: {half_width: 0.5, base_distance: 0.4, inertia: 0.003}
slot: {clearance: 0.01}
gripper: {stiffness: {phi: 50}, damping: {phi: 0.39}, anchor: {x: 0, phi: 0, y: -0.22}}
base: {stiffness: {y: 1.0e+4}}
contacts: [edges]
friction: {coefficient: 1}
excitation: {amplitude: 0, frequency: 1}
initial: {x: -0.03, y: 1, phi: 0, omega: 1}
trial: {time_limit: 1.6}
)"},
      {"bouncing_on_one_corner_with_x_locked", R"(
part: {half_width: 0.5, base_distance: 0.3, inertia: 0.1}
slot: {clearance: 0.01, depth: 0.2}
gripper: {stiffness: {phi: 1}, anchor: {x: 0, phi: 0, y: 0}}
base: {stiffness: {x: 1.0e+4, y: 1.0e+4}, damping: {x: 0, y: 200}}
contacts: [corners, walls]
friction: {coefficient: 0.2}
excitation: {amplitude: 0, frequency: 1}
initial: {x: -0.5, y: 0.3, phi: 0, vy: -1, omega: -1}
trial: {time_limit: 0.8}
weight: 1
)"},
      {"held_at_rest_while_the_excitation_changes", R"(
part: {half_width: 0.5, base_distance: 0.5}
slot: {clearance: 0.01}
gripper: {stiffness: {}, anchor: {y: 1}}
base: {stiffness: {x: 1.0e+4, y: 100}}
contacts: [walls]
friction: {coefficient: 1}
excitation: {amplitude: 1, frequency: 10}
initial: {x: 0, y: 0.3, phi: 0.05, vy: -1}
trial: {time_limit: 1, inserted_depth: 0.198}
)"},
      {"two_edges_on_parallel_sides_tilt_locked", R"(
part: {half_width: 0.5, base_distance: 0.5}
slot: {clearance: 0.0008}
gripper: {stiffness: {x: 1}, anchor: {x: 0, phi: 0, y: 1}}
base: {stiffness: {y: 1.0e+4}}
contacts: [edges]
friction: {coefficient: 0.2}
excitation: {amplitude: 0, frequency: 1}
initial: {x: 0, y: 0, phi: -0.07, vx: -1, vy: -1}
trial: {time_limit: 0.1}
)"},
      {"lying_on_its_side", R"(
part: {half_width: 0.379529059766848, base_distance: 1.02, inertia: 0.017}
slot: {clearance: 0.01}
gripper: {stiffness: {x: 0, phi: 0.11688}, anchor: {x: 0, phi: 0, y: -0.69}}
base: {stiffness: {y: 5.03e+4}, damping: {x: 25, y: 25}}
contacts: [edges, corners]
friction: {coefficient: 1}
excitation: {amplitude: 0, frequency: 1}
initial: {x: 0.29386, y: 0.3795220448397265, phi: 1.570796049177312}
trial: {time_limit: 0.1}
)"},
      {"two_corners_almost_level", R"(
part: {half_width: 0.5, base_distance: 1.8437544150035234, inertia: 0.1}
slot: {clearance: 0.01}
gripper:
  stiffness: {x: 0, phi: 1}
  anchor: {x: 0, phi: 0, y: -5}
base: {stiffness: {x: 1.0e+4, y: 9.0e+5}, damping: {x: 0, y: 0}}
contacts: [corners]
friction: {coefficient: 1}
excitation:
- {amplitude: 1, frequency: 1.0e+1, phase: 0, direction: phi}
initial: {x: -2, y: 1.8437510146131557, phi: 0, vx: 0, vy: 0, omega: 0}
trial: {time_limit: 1, aligned_depth: 0}
)"},
      {"slipping_back_before_the_release", R"(
part: {half_width: 0.1540724388452403, base_distance: 0.7094990132746818, inertia: 0.029234513552899282}
slot: {clearance: 0.030689861730200593}
gripper:
  stiffness: {x: 0.05671365291834603, phi: 0.2501720812969886}
  damping: {x: 0.1380110418364483, y: 0.014680743504242118, phi: 0.05394561129441805}
  anchor: {x: 0.03589991003757824, phi: 0, y: 1.2008276510621125}
base: {stiffness: {x: 2.0e+4, y: 2.0e+4}, damping: {x: 2.0e+2, y: 36.4676611655084}}
contacts: [edges, corners]
friction: {coefficient: 0.24284187453379366}
excitation:
- {amplitude: 1, frequency: 3.0813867412751086, phase: -0.32490427286960255}
initial:
  {x: 0.03589991003757824, y: 0.711411578188784, phi: 0.01278493415811588,
   vx: 0.25462096521612543, vy: -0.5025604511906866, omega: 3.917676598027207}
trial: {time_limit: 0.4041625728740279, aligned_depth: 1.0e+2}
)"},
      {"sticking_at_once_on_a_corner", R"(
part: {half_width: 0.10339120786883067, base_distance: 0.4172312740397013, inertia: 0.001548686251791566}
slot: {clearance: 0.0001154038626254222}
gripper:
  stiffness: {x: 0.010145589465097572, phi: 3.198019295884046}
  damping: {x: 0.0011527785039116682, y: 0.0051931619101145765, phi: 0.10215060777971073}
  anchor: {x: -0.08035531939507232, phi: 0.1881800691410626}
  pressing_force: 0
base: {stiffness: {x: 2.0e+4, y: 2.0e+4}, damping: {x: 35.82950510400382, y: 29.46634084847075}}
contacts: [corners]
friction: {coefficient: 0.44037087297366173}
excitation:
- {amplitude: 0, frequency: 1}
initial:
  {x: -0.08035531939507232, y: 0.42866213951693266, phi: 0.1881800691410626,
   vx: 0.002059570378360489, vy: -0.0026973821711226867, omega: 0.0260511261757539}
trial: {time_limit: 0.5387211924274887, aligned_depth: 1.0e+2}
)"},
      {"corner_behind_the_wall_below_the_floor", R"(
part: {half_width: 0.3, base_distance: 0.4}
slot: {clearance: 0.01, depth: 0.1}
gripper:
  stiffness: {phi: 1}
  anchor: {x: 0, phi: 0, y: -3}
base: {stiffness: {x: 12, y: 12}, damping: {x: 0, y: 0}}
contacts: [corners, walls]
excitation:
- {amplitude: -2.4, frequency: 1.0e+1, phase: 7.4}
initial: {x: -0.7, y: 0, phi: 0, vx: -1, vy: 0, omega: -1}
trial: {time_limit: 1, aligned_depth: 0}
)"},
      {"light_tilt_on_a_stiff_base", R"(
part: {half_width: 1.1058513254509192, base_distance: 0.17578889554881597, inertia: 1.0023950880952103e-07}
slot: {clearance: 0.004991392394498006}
gripper:
  stiffness: {x: 0.7689526893746621, phi: 0.9676544229590428}
  damping: {x: 4.217430487444417, y: 0.005247371602590393, phi: 0}
  anchor: {x: 0, phi: 0}
  pressing_force: 0.04977061911937411
base: {stiffness: {x: 42802361.09143694, y: 29257027.1216412}, damping: {x: 2677.2219491146766, y: 0}}
contacts: [corners, walls]
friction: {coefficient: 0.3904348008140699}
excitation:
- {amplitude: 1, frequency: 1, phase: 0}
- {amplitude: -2.158305784089548, frequency: 14.537487066770547, phase: 4.3166332816780955, direction: x}
initial: {x: 0.006488487205224397, y: 0.17578889554881597, phi: 0, vx: 0, vy: 0, omega: 0}
trial: {time_limit: 1.0e-6, aligned_depth: 0.0035157779109763194}
)"},
      {"load_that_falls_on_edge_and_corner_alike", R"(
part: {half_width: 0.8069480981459578, base_distance: 1.0586082916904742}
slot: {clearance: 0.012933878774816924, depth: 0.2044453149408007}
gripper:
  stiffness: {x: 1.6133204901066898}
  damping: {x: 0.35649319816067432, y: 0.019211232249104256, phi: 0.0055610031033145116}
  anchor: {x: 0, phi: 0, y: 0.65323244076197362}
base: {stiffness: {x: 22145.674940431993, y: 22145.674940431993}, damping: {x: 46.123269101901073, y: 46.123269101901073}, recovery: true}
contacts: [edges, corners, walls]
friction: {coefficient: 0.49101468789274944}
excitation:
- {amplitude: 1, frequency: 3.4736765362814062, phase: 3.8567177969353725, direction: y, waveform: triangle}
initial: {x: 0.48765112375640501, y: 1.181449712695172, phi: 0, vx: -0.26411840111027413, vy: -0.46020981699954633, omega: 0}
trial: {time_limit: 3, aligned_depth: 0.10222265747040035}
)"},
      {"side_and_corner_reaching_the_wall_together", R"(
part: {half_width: 0.69786645992807206, base_distance: 0.67049983079118058, inertia: 0.16558677673563171}
slot: {clearance: 0.11658761141671874, depth: 0.27235950233421397}
gripper:
  stiffness: {x: 1.3428019326214733, phi: 7.9157171767869619}
  damping: {x: 0.23173503787188557, y: 0.052324603627812084, phi: 0.017563619860660285}
  anchor: {x: 0, phi: 0, y: -0.047896865747873052}
base: {stiffness: {x: 2186.8755983355245, y: 1484.0735702072543}, damping: {x: 83.733820302378987, y: 56.824059739761388}, recovery: false}
contacts: [edges, corners, walls]
friction: {coefficient: 0.26531649824486325}
excitation:
- {amplitude: 1, frequency: 0.3155862079899982, phase: 1.8621596404396159, direction: y, waveform: chirp, end_frequency: 5.3871560734038457, sweep_time: 6.279508001203685}
initial: {x: 0.50760944536392749, y: 0.81644861391102364, phi: 0, vx: 0, vy: 0, omega: 0}
trial: {time_limit: 2, aligned_depth: 0.13617975116710698}
)"},
      {"released_together_by_a_base_that_recovers", R"(
part: {half_width: 0.54761516894282236, base_distance: 0.67551862970179544}
slot: {clearance: 0.023075870775027086, depth: 0.19230127413889381}
gripper:
  stiffness: {x: 0.048815836662411537}
  damping: {x: 0.00383244058107775, y: 0.075666105692706417, phi: 0.89300526246554801}
  anchor: {x: 0.33644313331111442, phi: 0, y: -0.045231218534698026}
base: {stiffness: {x: 2583.3246554905209, y: 7311.6668927435076}, damping: {x: 2.2969455163082038, y: 6.5011188006632485}, recovery: true}
contacts: [edges, corners, walls]
friction: {coefficient: 0.38744344991183949}
weight: 0.056280641189146427
excitation:
- {amplitude: 1, frequency: 13.21649218641762, phase: 2.1120894915188173, direction: y, waveform: sine}
initial: {x: 0.33644313331111442, y: 0.87593714385746457, phi: 0, vx: -0.054158110200216769, vy: -0.42706495036497466, omega: 0}
trial: {time_limit: 2, aligned_depth: 0.096150637069446904}
)"},
      // level on the floor, both corners stick; as soon as it tilts they have to part
      {"level_on_the_floor", R"(
part: {half_width: 1, base_distance: 2, inertia: 0.003}
slot: {clearance: 1, depth: 1}
gripper: {stiffness: {x: 0.05}, damping: {x: 0, y: 0, phi: 0}, anchor: {x: 0.04, phi: 0}, pressing_force: 1}
base: {stiffness: {x: 1, y: 1}, damping: {x: 0, y: 0}}
contacts: [walls]
friction: {coefficient: 1}
excitation: {amplitude: 0, frequency: 1}
initial: {x: 0, vx: 0, vy: 0, omega: 0}
trial: {time_limit: 0.04, aligned_depth: 0}
)"},
      {"stands_level", R"(
part: {half_width: 1, base_distance: 1, inertia: 1}
slot: {clearance: 1, depth: 1}
gripper: {stiffness: {x: 0, phi: 0.01}, anchor: {x: 0, phi: 0.002}, pressing_force: 1}
base: {stiffness: {y: 9.0e+4}}
contacts: [walls]
friction: {coefficient: 1}
excitation: {amplitude: 0, frequency: 1}
initial: {x: 0}
trial: {time_limit: 0.04}
)"},
      {"stands_level_while_it_settles", R"(
part: {half_width: 2, base_distance: 1, inertia: 1}
slot: {clearance: 1, depth: 1}
gripper: {stiffness: {x: 0, phi: 0.01}, anchor: {x: 0, phi: 0.03}, pressing_force: 1}
base: {stiffness: {x: 1, y: 2.0e+3}, damping: {x: 0, y: 20}}
contacts: [walls]
friction: {coefficient: 1}
excitation: {amplitude: 0, frequency: 1}
initial: {x: 0, phi: 0}
trial: {time_limit: 4}
)"},
      {"side_across_both_edges", R"(
part: {half_width: 0.7, base_distance: 1, inertia: 1}
slot: {clearance: 0.001}
gripper: {stiffness: {x: 0}, anchor: {x: 0, phi: 0.1}, pressing_force: 1}
base: {stiffness: {y: 2.0e+4}}
contacts: [edges]
friction: {coefficient: 0.7}
excitation: {amplitude: 0, frequency: 1}
initial: {x: -0.0017}
trial: {time_limit: 0.04}
)"},
      {"level_corners_of_a_light_part", R"(
part: {half_width: 1.4247388816874602, base_distance: 2.532092890261706, inertia: 0.0008317810275255694}
slot: {clearance: 3.4278114633248386e-07}
gripper:
  stiffness: {x: 0.13628815042134146, phi: 0.018763498859793348}
  damping: {phi: 4.801140470024677e-05}
  anchor: {x: -0.3226543036829289, phi: 0}
  pressing_force: 47.68382422902029
base: {stiffness: {y: 3498025.6999600865}, damping: {y: 4216.054070300954}}
contacts: [edges, corners]
friction: {coefficient: 0.8423486241443098}
excitation: {amplitude: 0, frequency: 1}
initial: {x: -3.5328012240698428, y: 2.5313053121048026, phi: 1.1379725905784362e-08}
trial: {time_limit: 0.9994335408556435, aligned_depth: 0.05064185780523412}
)"},
  };
  return all;
}

class SeveralContacts : public testing::TestWithParam<test::NamedScene> {
 protected:
  Scene scene(double tolerance) const {
    Scene scene = test::scene_of(GetParam().text);
    scene.name = GetParam().name;
    scene.solver.tolerance = tolerance;
    scene.solver.step_limit = 20000;
    return scene;
  }
};
INSTANTIATE_TEST_SUITE_P(scene, SeveralContacts, testing::ValuesIn(cases()),
                         [](const auto& info) { return info.param.name; });

/// The depth is a difference of lengths of order one, and the base turns its last digit into a force.
double rounding_force(const Scene& scene, const State& state) {
  const double length = 1.0 + std::abs(state.x) + std::abs(state.y);
  return 2.2e-16 * length * std::max(scene.base.stiffness_x, scene.base.stiffness_y);
}

/// What rounding may do to a velocity: that force acts on the lightest motion for as long as the trial lasts.
double rounding(const Scene& scene, const State& state) {
  const double length = 1.0 + std::abs(state.x) + std::abs(state.y);
  const double force = rounding_force(scene, state);
  const double reach = scene.part.half_width + scene.part.base_distance;
  const double mobility = 1.0 + (scene.gripper.phi.moves ? reach / scene.gripper.phi.inertia : 0.0);
  return 1e-15 * length + force * mobility * scene.trial.time_limit;
}

TEST_P(SeveralContacts, obey_the_laws) {
  const TrialResult result = test::checked_run(scene(1e-8));
  EXPECT_NE(result.outcome, Outcome::failed) << result.failure;
  ASSERT_TRUE(result.energy);
  EXPECT_GE(result.energy->friction_loss, -1e-12 * result.energy->exchanged);
  EXPECT_LT(result.energy->residual, 1e-9);
}

TEST_P(SeveralContacts, are_mirrored_in_the_mirrored_scene) {
  const Scene right = scene(1e-8);
  const TrialResult one = test::run(right), other = test::run(test::mirrored(right));
  EXPECT_EQ(one.outcome, other.outcome);
  // sums are taken in another order
  const State image = test::mirrored(other.final_state);
  EXPECT_LE(test::distance(one.final_state, image), rounding(right, one.final_state));
  EXPECT_EQ(one.impacts[0], other.impacts[1]);
  EXPECT_EQ(one.impacts[1], other.impacts[0]);
  EXPECT_EQ(one.impacts[2], other.impacts[3]);
  EXPECT_EQ(one.impacts[3], other.impacts[2]);
}

TEST_P(SeveralContacts, do_not_depend_on_the_tolerance) {
  const Scene loose = scene(1e-8), tight = scene(1e-12);
  const TrialResult one = test::run(loose), other = test::run(tight);
  EXPECT_EQ(one.outcome, other.outcome);
  // touches that press no harder than rounding come and go with it
  const double peak = *std::max_element(one.peak_force.begin(), one.peak_force.end());
  if (peak > 10.0 * rounding_force(loose, one.final_state)) {
    EXPECT_EQ(one.impacts, other.impacts);
  }
  EXPECT_LE(test::distance(one.final_state, other.final_state), 1e-8 + rounding(loose, one.final_state));
}

}  // namespace
}  // namespace vibratory_alignment
