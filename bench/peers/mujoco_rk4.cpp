// MuJoCo with its fixed-step RK4 integrator; tanh friction.
//
// The part is a body on two slides and a hinge, whose springs and dampers are the gripper. MuJoCo's own contact is not
// a spring and a damper: its force also depends on the acceleration without contact, and friction is softened together
// with the normal force. So base and excitation are added as the manual has it for one's own force laws, in the
// callback mjcb_passive, from the problem's right-hand side; MuJoCo's contacts are switched off.
#include <mujoco/mujoco.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>

#include "progress.h"
#include "report.h"

namespace va = vibratory_alignment::peers;

namespace {

struct Deleter {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
  void operator()(mjData* data) const { mj_deleteData(data); }
};
using Model = std::unique_ptr<mjModel, Deleter>;
using Data = std::unique_ptr<mjData, Deleter>;

std::string joint(const char* type, const char* axis, double stiffness, double damping, double anchor) {
  char text[256];
  std::snprintf(text, sizeof text,
                "<joint type='%s' axis='%s' stiffness='%.17g' damping='%.17g' springref='%.17g' limited='false'/>",
                type, axis, stiffness, damping, anchor);
  return text;
}

Model make_model(const va::Parameters& p) {
  char inertia[256];
  std::snprintf(inertia, sizeof inertia, "<inertial pos='0 0 0' mass='1' diaginertia='%.17g %.17g %.17g'/>", p.mu, p.mu,
                p.mu);
  const std::string text =
      "<mujoco><compiler angle='radian'/>"
      "<option integrator='RK4' gravity='0 0 0'><flag contact='disable'/></option>"
      "<worldbody><body>" +
      joint("slide", "1 0 0", p.k_x, p.h_x, p.x_a) + joint("slide", "0 1 0", 1.0, p.h_y, p.y_a) +
      joint("hinge", "0 0 1", p.k_phi, p.h_phi, p.phi_a) + inertia + "</body></worldbody></mujoco>";
  // MuJoCo reads files only.
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("peer_mujoco_" + std::to_string(getpid()) + ".xml");
  std::ofstream(file) << text;
  char error[1000] = "";
  Model model(mj_loadXML(file.c_str(), nullptr, error, sizeof error));
  std::filesystem::remove(file);
  if (!model) throw std::runtime_error(error);
  return model;
}

const va::Problem* current_problem = nullptr;  // mjcb_passive is a global function
long evaluations = 0;

void add_base_and_excitation(const mjModel*, mjData* data) {
  ++evaluations;
  const va::Parameters& p = current_problem->parameters;
  const va::State s{data->qpos[0], data->qpos[1], data->qpos[2], data->qvel[0], data->qvel[1], data->qvel[2]};
  va::Load load = contact_load(p, va::mode_of_start(p, s.data()), s.data());
  add_excitations(p, data->time, load);
  data->qfrc_passive[0] += load.x;
  data->qfrc_passive[1] += load.y - p.weight;
  data->qfrc_passive[2] += load.moment;
}

va::Outcome integrate(const va::Problem& problem, const mjModel* model, mjData* data, long steps) {
  mj_resetData(model, data);
  std::copy_n(problem.start.data(), 3, data->qpos);
  std::copy_n(problem.start.data() + 3, 3, data->qvel);
  evaluations = 0;
  for (long i = 0; i < steps; ++i) mj_step(model, data);
  va::State end;
  std::copy_n(data->qpos, 3, end.data());
  std::copy_n(data->qvel, 3, end.data() + 3);
  return {end, evaluations, steps, 0};
}

}  // namespace

int main(int argc, char** argv) {
  mjcb_passive = add_base_and_excitation;
  for (const va::Problem& problem : va::chosen(va::regularised_problems(), argc, argv)) {
    current_problem = &problem;
    const Model model = make_model(problem.parameters);
    const Data data(mj_makeData(model.get()));
    for (const long steps : va::step_counts()) {
      model->opt.timestep = problem.end_time / static_cast<double>(steps);
      va::report("mujoco_rk4", problem.name, model->opt.timestep,
                 [&] { return integrate(problem, model.get(), data.get(), steps); });
    }
  }
}
