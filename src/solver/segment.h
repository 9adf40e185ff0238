// A segment: one smooth piece of the motion, as power series in the time since its start or, in flight, in closed form,
// or, across the tanh layer, as polynomials in a map of the sliding velocity.
// Every solver produces segments; everything that looks at a motion (samples, peaks, energy, outcomes) reads them.
#pragma once

#include <array>
#include <cstdint>

#include "mechanics/contact.h"
#include "mechanics/drive.h"
#include "mechanics/instant.h"
#include "mechanics/state.h"
#include "solver/contact_mode.h"
#include "solver/series.h"

namespace vibratory_alignment {

enum class EventKind : std::uint8_t {
  touch,          ///< a contact starts out of flight (an impact)
  reload,         ///< N rises from zero while the depth is still > 0
  release,        ///< N falls to zero
  close,          ///< the depth returns to zero
  run_off,        ///< the foot leaves the end of the face
  slip_reversal,  ///< V = 0, slips on in the other direction; tanh law: V enters the layer
  stick,          ///< V = 0 and friction holds
  slip,           ///< friction no longer holds; tanh law: V leaves the layer
  enter,          ///< a point enters the other body through a face without contact
  leave,          ///< ... and leaves it
  drive_kink,     ///< jump or kink of an excitation
  aligned,        ///< both lower corners in the slot, below the asked depth
  inserted        ///< the asked depth is reached
};

struct Event {
  EventKind kind = EventKind::touch;
  Site site = Site::a1;
  Face face = Face::none;  ///< touched or entered (touch, enter), or through which a point leaves (run_off, leave)
};

constexpr int kMaxEvents = 16;

/// Force series of one loaded contact during a segment.
struct ContactSeries {
  Site site = Site::a1;
  Series depth{};             ///< d
  Series normal_force{};      ///< N
  Series tangential_force{};  ///< T, along t (MODEL.md "Contact")
  Series slip_velocity{};     ///< V
};

class Flight;
class LayerCrossing;

struct Segment {
  Instant start;
  State begin;  ///< the state at its start
  double duration = 0.0;
  int order = 0;          ///< highest power that the series hold
  bool coarse = false;    ///< made by an implicit step, which does not follow what is faster than it
  double friction = 0.0;  ///< its coefficient, of a coarse segment, which keeps T in the tanh layer within its limit
  const Flight* flight = nullptr;  ///< set: a leap in flight, in closed form instead of series (x ... drive_phi unused)
  double flight_time = 0.0;        ///< time from the start of the flight to the start of the segment
  /// Set: a crossing of the tanh layer by the only loaded contact, loaded[0], instead of series (all unused).
  const LayerCrossing* layer_crossing = nullptr;
  Series x{}, y{}, phi{};      ///< positions
  Series vx{}, vy{}, omega{};  ///< velocities
  Series cos_phi{}, sin_phi{};
  Series drive_x{}, drive_y{}, drive_phi{};  ///< excitation forces and moment
  ContactStates contacts;                    ///< state of every site during the segment
  Recoveries recoveries;                     ///< bases that recover (Base::recovery), at its start
  int loaded_count = 0;
  std::array<ContactSeries, kSiteCount> loaded;  ///< the first loaded_count are valid
  State end;                                     ///< the state at its end (closed form in flight)
  int event_count = 0;
  std::array<Event, kMaxEvents> events;  ///< what happens at its end

  double end_time() const { return (start + duration).value(); }
};

/// The law of friction that a loaded contact follows during the segment.
inline Slip slip_of(const Segment& segment, const ContactSeries& contact) {
  return segment.contacts[static_cast<std::size_t>(contact.site)].slip;
}

/// State at `t` after the start, 0 <= t <= duration.
State state_at(const Segment& segment, double t);

/// Forces of the excitations then.
Load3 drive_at(const Segment& segment, double t);

/// What a loaded contact does at an instant, as ContactSeries.
struct ContactValues {
  double depth, normal_force, tangential_force, slip_velocity;
};

/// Of loaded[i] at `t` after the start.
ContactValues contact_at(const Segment& segment, int i, double t);

/// Largest N of loaded[i] between two times after the start; not a number where it is near overflow.
double largest_normal_force(const Segment& segment, int i, double from, double to);

}  // namespace vibratory_alignment
