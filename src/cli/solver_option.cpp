#include "cli/solver_option.h"

#include "model/solver_names.h"

namespace vibratory_alignment {

std::string solver_list() {
  std::string list;
  for (const SolverName& solver : solver_names) list += (list.empty() ? "" : ", ") + std::string(solver.name);
  return list;
}

std::string check_solver(const std::string& name) {
  return find_solver(name) ? std::string() : name + " is not a solver; the solvers are " + solver_list();
}

}  // namespace vibratory_alignment
