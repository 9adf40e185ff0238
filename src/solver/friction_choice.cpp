#include "solver/friction_choice.h"

#include <algorithm>
#include <cmath>

#include "solver/held_state.h"
#include "solver/series_noise.h"
#include "solver/step_size.h"

namespace vibratory_alignment {
namespace {

/// Order of the series that a choice is judged by.
constexpr int kOrder = MotionSeries::kHeldPowers;

/// The time over which coefficients are compared: the last terms of the series are this small.
constexpr double kProbeTolerance = 1e-3;

/// Factors on rounding. Of several choices that rounding allows, the one that needs the least of it is taken: what is
/// nearly the same now may grow apart. If it is larger than it was thought to be, no choice is consistent, and it is
/// asked again.
constexpr double kAllowances[] = {0.03, 1.0, 1e2, 1e4, 1e6};

/// Error of a friction force at an event, relative to the truncation error of a step, and its bounds.
constexpr double kLimitErrors = 1e4, kSmallestLimitError = 1e-9, kLargestLimitError = 1e-3;

/// Error of a T that holds a contact, beside that of its limit, up to which it may exceed the limit.
constexpr double kMostForceNoise = 1e5;

/// V' of contacts that count as the same, which nothing takes out when they stick, beside the V' with which they slide
/// against their direction: they stick where it is not this many times as large.
constexpr double kUnheld = 100.0;

/// V' smaller than this beside the accelerations that it is made of is looked at more closely.
constexpr double kDoubt = 1e-6;

Slip opposite(Slip slip) { return slip == Slip::plus ? Slip::minus : Slip::plus; }

struct LeadingTerm {
  int order = 0;      ///< its power; one more than the last power when all are rounding
  double size = 0.0;  ///< |g_k| h^k
  bool positive = true;
};

/// First term of g, from power `from` on, that is more than rounding.
LeadingTerm leading_term(const Series& g, int from, int to, double h, double noise) {
  double power = std::pow(h, from);
  for (int k = from; k <= to; ++k, power *= h) {
    const double term = g[static_cast<std::size_t>(k)] * power;
    if (std::abs(term) > noise) return {k, std::abs(term), term > 0.0};
  }
  return {to + 1, 0.0, true};
}

}  // namespace

FrictionChoice::FrictionChoice(const System& system, double tolerance)
    : system_(system),
      limit_tolerance_(std::clamp(kLimitErrors * tolerance, kSmallestLimitError, kLargestLimitError)),
      series_(system) {}

/// True when an event has just brought the contact's N or one of its limits to zero.
bool FrictionChoice::has_event(std::size_t site) const {
  return known_[site].normal > 0 || known_[site].hold_plus > 0 || known_[site].hold_minus > 0;
}

void FrictionChoice::Judgement::contradict(int at_order, double size) {
  if (at_order > order || (at_order == order && size <= excess)) return;
  order = at_order;
  excess = size;
}

/// V must grow in the direction of sliding. V of power k + 1 belongs to forces of power k.
void FrictionChoice::judge_sliding(int loaded, const SeriesNoise& noise, Judgement& judgement) const {
  const ContactSeries& contact = probe_.loaded[loaded];
  const auto site = static_cast<std::size_t>(contact.site);
  const double limit = noise.h * noise.slip_rate[loaded];
  // out of a stick that has just broken V' starts at zero, where it slides against the T at its limit; the other way
  // T jumps, and V' with it
  const SitePins& known = known_[site];
  const bool against_limit = probe_.contacts[site].slip == Slip::plus ? known.hold_minus > 0 : known.hold_plus > 0;
  const double friction = system_.friction * contact.normal_force[0];
  const double nearly = noise.state_slip_rate[loaded] + limit_error() * noise.mobility[loaded] * std::abs(friction);
  const bool broken = (known.normal > 0 || against_limit) && std::abs(contact.slip_velocity[1]) <= nearly;
  const LeadingTerm term = leading_term(contact.slip_velocity, broken ? 2 : 1, kOrder, noise.h, limit);
  const bool forward = term.positive == (probe_.contacts[site].slip == Slip::plus);
  if (term.order <= kOrder && !forward) {
    judgement.contradict(term.order - 1, term.size / limit);
    judgement.limits_kept = false;
  }
  SitePins& pins = judgement.mode.pins[site];
  pins.slip = term.order;
  pins.hold_plus = pins.hold_minus = 0;
}

/// f N - T and f N + T must not fall below zero.
void FrictionChoice::judge_sticking(int loaded, const SeriesNoise& noise, double allowance, double force_noise,
                                    Judgement& judgement) const {
  const ContactSeries& contact = probe_.loaded[loaded];
  const auto site = static_cast<std::size_t>(contact.site);
  SitePins& pins = judgement.mode.pins[site];
  // where T is not known, one that friction cannot give is none: what slides instead has a V that is rounding
  const double capped = std::min(1.0, kMostLimitAllowance / allowance);
  const double limit_noise = capped * system_.friction * noise.normal_force[loaded];
  const double limit = limit_noise + std::min(capped * force_noise, kMostForceNoise * limit_noise);
  const double nearly =
      system_.friction * (noise.state_normal_force[loaded] + limit_error() * std::abs(contact.normal_force[0]));
  for (const double sign : {1.0, -1.0}) {
    Series guard;
    for (std::size_t k = 0; k < kOrder; ++k)
      guard[k] = system_.friction * contact.normal_force[k] - sign * contact.tangential_force[k];
    // a limit that an event says has been reached, unless T is another one now
    const int known = sign > 0.0 ? known_[site].hold_plus : known_[site].hold_minus;
    const bool reached = (known > 0 || known_[site].normal > 0) && std::abs(guard[0]) <= nearly;
    const LeadingTerm term = leading_term(guard, reached ? std::max(1, known) : 0, kOrder - 1, noise.h, limit);
    if (!term.positive) {
      judgement.contradict(term.order, term.size / limit);
      judgement.limits_kept = false;
    }
    (sign > 0.0 ? pins.hold_plus : pins.hold_minus) = term.order;
  }
  pins.slip = 0;
}

void FrictionChoice::judge(const State& state, const DriveForms& drives, double allowance, Judgement& judgement) {
  judgement.order = Judgement::kNone;
  judgement.excess = 0.0;
  judgement.limits_kept = true;
  probe_.contacts = judgement.mode.contacts;
  series_.expand_contact(hold_sticking(system_, state, probe_.contacts), drives, kOrder, probe_);
  double h = std::min({1.0, series_step(system_, probe_, kProbeTolerance),
                       pair_step(series_.direction(probe_), kOrder, kProbeTolerance)});
  SeriesNoise noise = series_noise(system_, probe_, h, allowance);
  if (!(h > 0.0) || !noise.is_finite()) {
    judgement.contradict(-1, INFINITY);
    judgement.limits_kept = false;
    return;
  }
  judgement.mode.unheld_slip_rate = series_.not_held_within(h);
  // can those that stick hold together?
  double power = 1.0;
  const double slip_rate = noise.held_slip_rate;
  for (int k = 0; k < MotionSeries::kHeldPowers; ++k, power *= h)
    if (series_.not_held(k) * power > slip_rate) judgement.contradict(k, series_.not_held(k) * power / slip_rate);
  const std::array<double, kSiteCount> force_noise = series_.holding_force_noise(noise.slip_rate);
  for (int i = 0; i < probe_.loaded_count; ++i) {
    const auto index = static_cast<std::size_t>(i);
    const auto site = static_cast<std::size_t>(probe_.loaded[index].site);
    if (!decided_[site]) continue;
    if (probe_.contacts[site].slip == Slip::stick)
      judge_sticking(i, noise, allowance, force_noise[index], judgement);
    else
      judge_sliding(i, noise, judgement);
  }
}

/// The usual case, one contact: V' with friction against either way of sliding decides, where it is far from zero.
bool FrictionChoice::decide_alone(const State& state, const DriveForms& drives, std::size_t site, ContactMode& mode) {
  probe_.contacts = mode.contacts;
  probe_.contacts[site].slip = Slip::plus;
  series_.expand_contact(state, drives, 1, probe_);
  int i = 0;
  while (static_cast<std::size_t>(probe_.loaded[i].site) != site) ++i;
  const double normal_force = probe_.loaded[i].normal_force[0];
  // what a force of one along t adds to V'
  const ContactKinematics k = contact_kinematics(system_, state, static_cast<Site>(site), probe_.contacts[site].face);
  const double mobility = mobility_along(system_, k.tangent, cross(k.lever, k.tangent));
  const double plus = probe_.loaded[i].slip_velocity[1];
  const double minus = plus + 2.0 * system_.friction * normal_force * mobility;
  const double doubt = kDoubt * (series_.slip_rate_size(probe_) + std::abs(plus) + std::abs(minus));
  if (!(std::abs(plus) > doubt && std::abs(minus) > doubt)) return false;
  // N is below zero by its last digits: it slides either way, and what it would take to stick tells which
  if (plus > 0.0 && minus < 0.0) return false;
  mode.contacts[site].slip = plus > 0.0 ? Slip::plus : minus < 0.0 ? Slip::minus : Slip::stick;
  mode.unheld_slip_rate = 0.0;
  SitePins& pins = mode.pins[site];
  pins.slip = mode.contacts[site].slip == Slip::stick ? 0 : 1;
  pins.hold_plus = pins.hold_minus = 0;
  return true;
}

void FrictionChoice::decide(const State& state, const DriveForms& drives, const SiteFlags& at_rest, ContactMode& mode,
                            bool unmoved) {
  std::array<std::size_t, kSiteCount> sites{};
  int count = 0, choices = 1;
  known_ = mode.pins;
  unmoved_ = unmoved;
  for (std::size_t i = 0; i < kSiteCount; ++i) {
    decided_[i] = at_rest[i];
    if (!at_rest[i]) continue;
    sites[static_cast<std::size_t>(count++)] = i;
    choices *= 3;
  }
  if (count == 0) return;
  if (count == 1 && !has_event(sites[0]) && decide_alone(state, drives, sites[0], mode)) return;
  Judgement best, candidate, all_stick;
  best.order = -2;
  candidate.mode = mode;
  for (const double allowance : kAllowances) {
    // all stick first; what does so with too large a T most likely slides against it
    std::array<Slip, kSiteCount> likely;
    likely.fill(Slip::plus);
    for (int code = 0; code < choices; ++code) {
      int digits = code;
      for (int i = 0; i < count; ++i, digits /= 3) {
        const std::size_t site = sites[static_cast<std::size_t>(i)];
        ContactState& contact = candidate.mode.contacts[site];
        contact.slip = digits % 3 == 0 ? Slip::stick : digits % 3 == 1 ? likely[site] : opposite(likely[site]);
        candidate.mode.pins[site] = known_[site];
      }
      judge(state, drives, allowance, candidate);
      if (candidate.better_than(best)) best = candidate;
      if (best.consistent()) {
        mode = best.mode;
        return;
      }
      if (code > 0) continue;
      all_stick = candidate;
      for (int i = 0; i < probe_.loaded_count; ++i) {
        const ContactSeries& contact = probe_.loaded[static_cast<std::size_t>(i)];
        if (contact.tangential_force[0] > 0.0) likely[static_cast<std::size_t>(contact.site)] = Slip::minus;
      }
    }
  }
  // contacts that count as the same hold each other: each takes a T of its own that is not known, and their V' that
  // remains is what that T would take out
  const bool hold = all_stick.limits_kept && all_stick.order == best.order && all_stick.excess < kUnheld * best.excess;
  mode = hold ? all_stick.mode : best.mode;
}

}  // namespace vibratory_alignment
