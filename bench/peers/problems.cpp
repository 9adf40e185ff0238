// The problems, made from the reference cases (test/reference/reference_cases.h).
#include <cmath>
#include <cstddef>
#include <cstdio>

#include "../../test/reference/reference_cases.h"
#include "problem.h"

namespace vibratory_alignment::peers {
namespace {

namespace ref = vibratory_alignment::reference;

constexpr double usual_eps = 2.0e-3;

double number(ref::Real value) { return static_cast<double>(value); }

State state_of(const ref::ReferenceState& s) {
  return {number(s.x), number(s.y), number(s.phi), number(s.vx), number(s.vy), number(s.omega)};
}

void add_excitation(Parameters& p, Axis axis, const ref::Sine& sine) {
  if (sine.amplitude == 0.0L) return;
  p.excitations[static_cast<std::size_t>(p.excitation_count++)] = {axis, number(sine.amplitude), number(sine.frequency),
                                                                   number(sine.phase)};
}

Problem problem_of(const ref::ReferenceCase& c) {
  const ref::ReferenceParameters& r = c.parameters;
  Problem problem;
  problem.name = c.name;
  Parameters& p = problem.parameters;
  p.a = number(r.a);
  p.b = number(r.b);
  p.l = number(r.l);
  p.mu = number(r.mu);
  p.k_x = number(r.k_x);
  p.k_phi = number(r.k_phi);
  p.h_x = number(r.h_x);
  p.h_y = number(r.h_y);
  p.h_phi = number(r.h_phi);
  p.x_a = number(r.x_a);
  p.y_a = number(r.y_a);
  p.phi_a = number(r.phi_a);
  p.weight = number(r.weight);
  p.c1 = number(r.c1);
  p.c2 = number(r.c2);
  p.h1 = number(r.h1);
  p.h2 = number(r.h2);
  p.f = number(r.f);
  p.eps = number(r.eps);
  add_excitation(p, axis_x, r.excitation_x);
  add_excitation(p, axis_y, r.excitation_y);
  add_excitation(p, axis_phi, r.excitation_phi);
  problem.start = state_of(c.start);
  problem.end_time = number(c.end_time);
  problem.answer = state_of(c.end);
  problem.has_answer = true;
  return problem;
}

Problem with_eps(const ref::ReferenceCase& c, double eps) {
  Problem problem = problem_of(c);
  problem.parameters.eps = eps;
  problem.has_answer = false;
  return problem;
}

// R1 on another base and pressed otherwise, at rest in balance as R1 is. zeta = H / (2 sqrt(C)), for mass 1.
Problem pressed(const char* name, double f0, double stiffness, double zeta, double eps) {
  Problem problem = with_eps(ref::caseR1Regularised(), eps);
  problem.name = name;
  Parameters& p = problem.parameters;
  p.c1 = p.c2 = stiffness;
  p.h1 = p.h2 = 2.0 * zeta * std::sqrt(stiffness);
  const double x = problem.start[0], phi = f0 * (p.l - x) / p.k_phi;
  const double y = (p.b - f0 / stiffness - (p.l - x) * std::sin(phi)) / std::cos(phi);
  p.y_a = y - f0;
  problem.start = {x, y, phi, 0.0, 0.0, 0.0};
  return problem;
}

Problem answered(Problem problem, const State& answer) {
  problem.answer = answer;
  problem.has_answer = true;
  return problem;
}

// The base of `r1_stiff` is 1000 times stiffer at R1's damping ratio; `lasting` is never out of contact.
Problem r1_stiff(const char* name, double eps) { return pressed(name, 0.2, 2.5e6, 0.2, eps); }
Problem lasting(const char* name, double eps) { return pressed(name, 3.0, 2500.0, 0.2, eps); }
Problem lasting_overdamped(const char* name, double eps) { return pressed(name, 3.0, 2.5e6, 10.0, eps); }

Problem r1_with_eps(double eps) {
  Problem problem = with_eps(ref::caseR1Regularised(), eps);
  char name[32];
  std::snprintf(name, sizeof name, "r1_eps_%.0e", eps);
  problem.name = name;
  return problem;
}

}  // namespace

// The answers below were computed by the integrator of test/reference (long double, Gauss-Legendre of order 12), each
// with two step sizes, the smaller one given, that agree to 2e-12 (r1_stiff) or 1e-14 and better.

std::vector<Problem> regularised_problems() {
  std::vector<Problem> all;
  all.push_back(problem_of(ref::caseR1Regularised()));
  all.back().name = "r1";

  all.push_back(answered(r1_with_eps(5e-4), {0.119651176650237930, 0.904636259837035977, 1.18831310202258312e-4,
                                             -0.0175776728149560418, -0.0648488047505419823, -0.0823806094195594783}));
  all.push_back(answered(r1_with_eps(1e-4), {0.119214806850361517, 0.904634815960257159, 1.18764823869770860e-4,
                                             -0.0176797857882375828, -0.0648611810020971659, -0.0824068570627128534}));
  for (const double eps : {2e-5, 5e-6, 1e-6, 3e-7, 1e-7, 1e-8, 1e-9, 2e-10}) all.push_back(r1_with_eps(eps));

  all.push_back(answered(r1_stiff("r1_stiff", usual_eps),  // steps of 1e-5, 5e-6
                         {0.121855387336562375, 0.899144720516487963, 1.28093150869137895e-3, -0.0181517364246347847,
                          -0.0333629607881327105, 0.0499881270652383965}));
  all.push_back(answered(lasting("lasting", usual_eps),  // 1e-4, 5e-5
                         {0.189377601802683575, 0.881485104265725964, 0.0291130446180306647, -0.0173351100379447092,
                          -0.00766705540758013528, 0.0200500315607800089}));
  all.push_back(answered(lasting_overdamped("lasting_overdamped", usual_eps),  // 1e-5, 5e-6
                         {0.194356427959079053, 0.883218828933240056, 0.0287892481797273333, -0.0115722756576300346,
                          -0.00805905620193248408, 0.0135562305532153524}));
  all.push_back(answered(with_eps(ref::caseSlot(), usual_eps),  // 2e-5, 1e-5
                         {0.0255754118006210216, 0.656649507137274621, 0.00499042494416235428, -0.0449815835333060898,
                          -0.0888584083647205044, 0.0389737362453706004}));
  all.push_back(answered(with_eps(ref::caseTilt(), usual_eps),  // 1e-4, 5e-5
                         {-0.119226162876975673, 0.422177857682946779, 0.354763381248684908, 0.0136776133625782285,
                          -0.215150384361824067, 0.0416277688693917168}));
  all.push_back(answered(with_eps(ref::caseWedge(), usual_eps),  // 2e-5, 1e-5
                         {-0.176771149664780953, 0.586743613595836300, 0.306716049015000600, -0.0109878111185603325,
                          -0.0316233230980911067, 0.0462009049837674201}));
  return all;
}

std::vector<Problem> dry_problems() {
  return {problem_of(ref::caseR1Dry()),
          answered(r1_stiff("r1_stiff_dry", 0.0),  // 1e-4, 5e-5
                   {0.119782572970375682, 0.899119562259778029, 1.31456546217489481e-3, -0.0187484432751470583,
                    -0.0334357637567231273, 0.0499422281670782684}),
          answered(lasting("lasting_dry", 0.0),  // 2e-3, 1e-3
                   {0.193816315726302852, 0.881826662425896988, 0.0287437462407849285, -0.0157809836329574111,
                    -0.00622604201805097785, 0.0177536840510941390}),
          answered(lasting_overdamped("lasting_overdamped_dry", 0.0),  // 1e-5, 5e-6
                   {0.198525018373174648, 0.883588513512769670, 0.0283483697814387831, -0.00816024749375000923,
                    -0.00545821798975560764, 0.00923521394936556502})};
}

}  // namespace vibratory_alignment::peers
