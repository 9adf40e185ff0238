// Looks at a motion from outside, segment by segment, and holds it against MODEL.md: equations of motion, base law,
// friction law, who is in contact with what. The mechanics are written once more here, from MODEL.md alone; from src
// come only the data (scene, resolved start, segments).
//
// What it cannot see is a root missed between its samples; the reference cases and the tests of the roots do that.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "mechanics/system.h"
#include "solver/segment.h"
#include "solver/solver.h"
#include "trial/simulation.h"

namespace vibratory_alignment::test {

class MotionCheck {
 public:
  explicit MotionCheck(const Scene& scene) : scene_(scene), system_(make_system(scene)), before_(system_.start) {
    l_ = scene.part.half_width + scene.slot.clearance;
    friction_ = scene.friction ? scene.friction->coefficient : 0.0;
    eps_ = scene.friction && scene.friction->regularization ? *scene.friction->regularization : 0.0;
    tolerance_ = std::max(1e-3 * scene.solver.tolerance, 1e-15);
    for (const Axis* axis : {&system_.x, &system_.y, &system_.phi})
      if (axis->moves)
        fastest_ = std::max({fastest_, std::sqrt(axis->stiffness / axis->inertia), axis->damping / axis->inertia});
    for (const Excitation& e : scene.excitations) fastest_ = std::max({fastest_, e.frequency, e.end_frequency});
  }

  /// Holds one segment against the model; false after the first fault, which is reported.
  bool check(const Segment& g) {
    g_ = &g;
    const double h = g.duration;
    expect(h >= 0.0, "a segment of negative length", h);
    const State start = g.begin;
    if (scene_.base.recovery && !begun_) begin_recovery();
    begun_ = true;
    // a closed form may lose three digits to cancelling terms
    expect(distance(start, state_at(g, 0.0)) <= 1e-13 * size(start), "the start is not that of the motion",
           distance(start, state_at(g, 0.0)));
    expect(std::abs(g.start - time_) <= 1e-15 * (1.0 + std::abs(g.start.value())), "a gap in time", g.start - time_);
    // what truncation left of V in a sticking contact is taken out between segments
    expect(distance(start, before_) <= (1e-13 + 1e2 * tolerance_) * size(start), "a jump of the state between segments",
           distance(start, before_));
    // inside the segment; not at the ends, where drives jump
    if (h > 1e-11)
      for (const double share : {0.003, 0.08, 0.21, 0.37, 0.5, 0.66, 0.83, 0.93, 0.997}) check_at(share * h);
    // a leap is long: nothing may be passed over
    if (g.flight != nullptr || g.layer_crossing != nullptr)
      for (int i = 1; i < 60; ++i) check_laws(h * i / 60.0);
    check_laws(h);
    // a closed form corrects the series of a flight, in which events are sought to a hundredth of a step's tolerance
    const double sought = g.loaded_count == 0 ? 1e-2 * tolerance_ : 0.0;
    expect(distance(g.end, state_at(g, h)) <= (1e-12 + sought) * size(g.end), "the end is not that of the series",
           distance(g.end, state_at(g, h)));
    check_events();
    follow_recovery(h);
    before_ = g.end;
    time_ = g.start + h;
    return faults_ == 0;
  }

  long touches() const { return touches_; }

 private:
  struct Point {  // a possible contact of one site with one face
    double depth, depth_rate, slip, nx, ny, rx, ry, stiffness, damping;
  };

  void expect(bool holds, const char* what, double value) {
    if (holds || faults_ > 0) return;
    ++faults_;
    ADD_FAILURE() << scene_.name << ": " << what << " (" << value << ") in the segment from " << g_->start.value()
                  << ", " << g_->duration << " long";
  }

  static double distance(const State& a, const State& b) {
    return std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.phi - b.phi), std::abs(a.vx - b.vx),
                     std::abs(a.vy - b.vy), std::abs(a.omega - b.omega)});
  }

  static double size(const State& a) {
    return 1.0 + std::abs(a.x) + std::abs(a.y) + std::abs(a.phi) + std::abs(a.vx) + std::abs(a.vy) + std::abs(a.omega);
  }

  static bool is_edge_site(int site) { return site < 2; }
  static double side(int site) { return site % 2 == 0 ? 1.0 : -1.0; }

  Point point(const State& q, int site, Face face) const {
    const double c = std::cos(q.phi), s = std::sin(q.phi), a = scene_.part.half_width, b = scene_.part.base_distance;
    Point p{};
    if (is_edge_site(site)) {
      p.rx = side(site) * l_ - q.x;
      p.ry = -q.y;
      const double along = p.rx * c + p.ry * s, up = -p.rx * s + p.ry * c;
      if (face == Face::bottom) {
        p.depth = up + b;
        p.nx = -s;
        p.ny = c;
      } else {
        const double way = face == Face::right_side ? -1.0 : 1.0;
        p.depth = a + way * along;
        p.nx = way * c;
        p.ny = way * s;
      }
    } else {
      p.rx = side(site) * a * c + b * s;
      p.ry = side(site) * a * s - b * c;
      const double px = q.x + p.rx, py = q.y + p.ry;
      p.nx = face == Face::right_wall ? -1.0 : face == Face::left_wall ? 1.0 : 0.0;
      p.ny = p.nx == 0.0 ? 1.0 : 0.0;
      p.depth = face == Face::right_wall  ? px - l_
                : face == Face::left_wall ? -l_ - px
                : face == Face::floor     ? -*scene_.slot.depth - py
                                          : -py;
    }
    const double ux = q.vx - q.omega * p.ry, uy = q.vy + q.omega * p.rx;  // the material point
    p.depth_rate = -(ux * p.nx + uy * p.ny);
    p.slip = ux * p.ny - uy * p.nx;
    p.stiffness = scene_.base.stiffness_y * p.ny * p.ny + scene_.base.stiffness_x * p.nx * p.nx;
    p.damping = scene_.base.damping_y * p.ny * p.ny + scene_.base.damping_x * p.nx * p.nx;
    return p;
  }

  /// An excitation at global time t (MODEL.md; the phase need not be better than 1e-12 here).
  static double drive(const Excitation& e, double t) {
    const double pi = 3.14159265358979323846;
    double theta = e.frequency * t + e.phase;
    switch (e.waveform) {
      case Waveform::sine: return e.amplitude * std::sin(theta);
      case Waveform::square: return e.amplitude * (std::sin(theta) > 0.0 ? 1.0 : -1.0);
      case Waveform::triangle: {
        theta = std::fmod(theta, 2.0 * pi);
        if (theta < 0.0) theta += 2.0 * pi;
        return e.amplitude * 2.0 / pi * (theta < 0.5 * pi ? theta : theta < 1.5 * pi ? pi - theta : theta - 2.0 * pi);
      }
      case Waveform::chirp: {
        const double rate = (e.end_frequency - e.frequency) / e.sweep_time, s = std::min(t, e.sweep_time);
        return e.amplitude * std::sin(e.phase + e.frequency * s + 0.5 * rate * s * s + e.end_frequency * (t - s));
      }
    }
    return 0.0;
  }

  static double derivative(const Series& series, int order, double t) {
    double value = 0.0;
    for (int k = order; k >= 1; --k) value = value * t + k * series[static_cast<std::size_t>(k)];
    return value;
  }

  /// What is cut off of a velocity (tolerance_ of its leading terms), seen in its derivative. Of a crossing of the tanh
  /// layer: of its polynomials, whose degree is at most 56.
  double cut_off(const Series& v) const {
    if (g_->layer_crossing != nullptr) return 4.0 * 56.0 * tolerance_ * speed(g_->begin) / g_->duration;
    double lead = 0.0, power = 1.0;
    for (std::size_t k = 0; k < 4; ++k, power *= g_->duration) lead = std::max(lead, std::abs(v[k]) * power);
    return 4.0 * g_->order * tolerance_ * lead / g_->duration;
  }

  static double speed(const State& a) { return std::abs(a.vx) + std::abs(a.vy) + std::abs(a.omega); }

  /// Derivative of a velocity that is not a series in time, by differences of fourth order.
  double difference(double State::*rate, double t) const {
    const double h = g_->flight != nullptr ? 3e-3 / fastest_ : 1e-3 * g_->duration;
    const auto at = [&](double s) { return state_at(*g_, t + s).*rate; };
    return (8.0 * (at(h) - at(-h)) - (at(2.0 * h) - at(-2.0 * h))) / (12.0 * h);
  }

  /// Newton's law at t, with the forces that the model gives for the contacts that are loaded.
  void check_at(double t) {
    const Segment& g = *g_;
    const State q = state_at(g, t);
    const double now = g.start.value() + t;
    double fx = -system_.x.stiffness * (q.x - system_.x.anchor) - system_.x.damping * q.vx;
    double fy = -system_.y.stiffness * (q.y - system_.y.anchor) - system_.y.damping * q.vy - scene_.weight;
    double m = -system_.phi.stiffness * (q.phi - system_.phi.anchor) - system_.phi.damping * q.omega;
    for (const Excitation& e : scene_.excitations)
      (e.direction == Direction::x ? fx : e.direction == Direction::y ? fy : m) += drive(e, now);
    double forces = 1.0 + std::abs(fx) + std::abs(fy) + std::abs(m);
    double stiff = 1.0;
    for (int i = 0; i < g.loaded_count; ++i) {
      const Site site = g.loaded[static_cast<std::size_t>(i)].site;
      const ContactState& contact = g.contacts[static_cast<std::size_t>(site)];
      const ContactValues values = contact_at(g, i, t);
      const Point p = point(q, static_cast<int>(site), contact.face);
      const double n = p.stiffness * p.depth + p.damping * p.depth_rate;
      const double digits = 1e-14 * (p.stiffness + p.damping) * size(q) + 1e3 * tolerance_ * (1.0 + std::abs(n));
      expect(std::abs(values.normal_force - n) <= digits, "N is not k d + h d'", values.normal_force - n);
      expect(n >= -digits, "the base pulls", n);
      const double tangential = values.tangential_force;
      check_friction(contact.slip, n, tangential, p.slip, digits, size(q),
                     cut_off(g.vx) + cut_off(g.vy) + cut_off(g.omega));
      const double px = n * p.nx + tangential * p.ny, py = n * p.ny - tangential * p.nx;
      fx += px;
      fy += py;
      m += p.rx * py - p.ry * px;
      forces += std::abs(n) + std::abs(tangential);
      stiff += p.stiffness + p.damping;
    }
    const double digits = 1e-14 * stiff * size(q) + 1e-12 * forces;
    // forces of a contact carry what is cut off of one velocity to the others
    const double cut =
        g.loaded_count > 0 ? cut_off(g.vx) + cut_off(g.vy) + system_.phi.inertia * cut_off(g.omega) : 0.0;
    const auto axis = [&](const Axis& a, const Series& v, double State::*rate, double force, const char* what) {
      const bool is_series = g.flight == nullptr && g.layer_crossing == nullptr;
      const double acceleration = is_series ? derivative(v, g.order, t) : difference(rate, t);
      if (!a.moves) return expect(acceleration == 0.0, "a locked motion moves", acceleration);
      const double residual = acceleration - force / a.inertia;
      const double error = g.flight != nullptr ? 1e-8 * (fastest_ * size(q) + forces / a.inertia)
                                               : (digits + cut) / a.inertia + cut_off(v);
      expect(std::abs(residual) <= error, what, residual);
    };
    axis(system_.x, g.vx, &State::vx, fx, "x'' is not what the forces give");
    axis(system_.y, g.vy, &State::vy, fy, "y'' is not what the forces give");
    axis(system_.phi, g.omega, &State::omega, m, "phi'' is not what the moments give");
    check_laws(t);
  }

  void check_friction(Slip slip, double n, double t, double v, double digits, double speed, double cut) {
    if (eps_ > 0.0) {
      // the narrow layer shows what is cut off, and the last digits of V
      const double error = t + friction_ * n * std::tanh(v / eps_);
      return expect(std::abs(error) <= digits + cut + 1e-14 * speed / eps_ * (1.0 + std::abs(n)),
                    "T is not -f N tanh(V/eps)", error);
    }
    if (friction_ == 0.0) return expect(t == 0.0, "T without friction", t);
    const double still = 1e-13 * speed + 1e2 * tolerance_;
    switch (slip) {
      case Slip::stick:
        expect(std::abs(v) <= still, "it sticks, but V is not 0", v);
        expect(std::abs(t) <= friction_ * n + digits, "it sticks with more than f N", std::abs(t) - friction_ * n);
        break;
      case Slip::plus:
        expect(v >= -still, "it slips forward with V < 0", v);
        expect(std::abs(t + friction_ * n) <= digits, "T is not -f N", t);
        break;
      case Slip::minus:
        expect(v <= still, "it slips backward with V > 0", v);
        expect(std::abs(t - friction_ * n) <= digits, "T is not +f N", t);
        break;
      default: expect(false, "a loaded contact without law of friction", 0.0);
    }
  }

  bool called_for(Face face) const {
    switch (face) {
      case Face::bottom:
      case Face::right_side:
      case Face::left_side: return scene_.contacts.edges;
      case Face::top: return scene_.contacts.corners;
      case Face::floor: return scene_.contacts.walls && scene_.slot.depth;
      default: return scene_.contacts.walls;
    }
  }

  /// How deep the site's point is inside the other body, and through which face that is nearest; corners on one half.
  double inside(const State& q, int site, double half, Face& nearest) const {
    std::array<Face, 3> faces{Face::floor};
    int count = 1;
    if (is_edge_site(site)) {
      faces = {Face::bottom, Face::right_side, Face::left_side};
      count = 3;
    } else if (site < 4) {
      faces = {Face::top, half > 0.0 ? Face::right_wall : Face::left_wall};
      count = 2;
    }
    double least = INFINITY;
    for (int i = 0; i < count; ++i) {
      const Face face = faces[static_cast<std::size_t>(i)];
      const double depth = point(q, site, face).depth;
      if (depth < least) {
        least = depth;
        nearest = face;
      }
    }
    return least;
  }

  /// Who may be in which phase at t.
  void check_laws(double t) {
    const State q = state_at(*g_, t);
    const double tiny = (1e-13 + 1e2 * tolerance_) * size(q);
    for (int site = 0; site < kSiteCount; ++site) {
      const ContactState& contact = g_->contacts[static_cast<std::size_t>(site)];
      const bool used = site < 2   ? scene_.contacts.edges
                        : site < 4 ? scene_.contacts.corners || scene_.contacts.walls
                                   : called_for(Face::floor);
      if (!used) {
        expect(contact.phase == Phase::outside, "a contact that the scene does not call for", site);
        continue;
      }
      if (contact.phase == Phase::outside) {
        for (const double half : {1.0, -1.0}) {
          Face nearest = Face::none;
          double depth = inside(q, site, half, nearest);
          // a base that recovers is not where it was
          if (scene_.base.recovery && recovering_[static_cast<std::size_t>(site)].face == nearest)
            depth -= deformation(static_cast<std::size_t>(site), t);
          expect(depth <= tiny, "an unnoticed penetration", depth);
        }
        continue;
      }
      if (contact.phase == Phase::free) continue;
      expect(called_for(contact.face), "a face that the scene does not call for", static_cast<double>(contact.face));
      const Point p = point(q, site, contact.face);
      if (contact.phase == Phase::unloaded) {
        expect(p.depth >= -tiny, "an unloaded contact that is open", p.depth);
        const double push = p.stiffness * p.depth + p.damping * p.depth_rate;
        const double digits = 1e-13 * (p.stiffness + p.damping) * size(q) + 1e3 * tolerance_ * (1.0 + std::abs(push));
        if (!scene_.base.recovery)
          expect(push <= digits, "an unloaded contact that would push", push);
        else
          expect(p.depth <= deformation(static_cast<std::size_t>(site), t) + tiny, "deeper than the base", p.depth);
      }
      // the foot is on its face
      const double along = is_edge_site(site) ? p.rx * std::cos(q.phi) + p.ry * std::sin(q.phi) : q.x + p.rx;
      const double up = is_edge_site(site) ? -p.rx * std::sin(q.phi) + p.ry * std::cos(q.phi) : q.y + p.ry;
      double over = 0.0;
      if (contact.face == Face::bottom) over = std::abs(along) - scene_.part.half_width;
      if (contact.face == Face::right_side || contact.face == Face::left_side) over = -scene_.part.base_distance - up;
      if (contact.face == Face::top) over = l_ - std::abs(along);
      if (contact.face == Face::right_wall || contact.face == Face::left_wall) over = up;
      expect(over <= tiny, "a foot beyond the end of its face", over);
    }
  }

  /// What is zero where an event happens.
  void check_events() {
    const Segment& g = *g_;
    const double tiny = (1e-13 + 1e2 * tolerance_) * size(g.end);
    for (int i = 0; i < g.event_count; ++i) {
      const Event& event = g.events[static_cast<std::size_t>(i)];
      const int site = static_cast<int>(event.site);
      const ContactState& contact = g.contacts[static_cast<std::size_t>(event.site)];
      const Face face = event.kind == EventKind::touch || event.kind == EventKind::run_off ? event.face : contact.face;
      if (face == Face::none) continue;
      const Point p = point(g.end, site, face);
      const double push = p.stiffness * p.depth + p.damping * p.depth_rate;
      const double digits = 1e-13 * (p.stiffness + p.damping) * size(g.end) + 1e3 * tolerance_ * (1.0 + std::abs(push));
      switch (event.kind) {
        case EventKind::touch: {
          const bool recovering = scene_.base.recovery && recovering_[static_cast<std::size_t>(site)].face == face;
          const double surface = recovering ? deformation(static_cast<std::size_t>(site), g.duration) : 0.0;
          expect(std::abs(p.depth - surface) <= tiny, "a touch away from the surface", p.depth - surface);
          expect(p.depth_rate >= -tiny, "a touch that goes away", p.depth_rate);
          ++touches_;
          break;
        }
        case EventKind::close:
        case EventKind::run_off:
          expect(std::abs(p.depth) <= tiny, "an end of contact away from its place", p.depth);
          break;
        case EventKind::release: expect(std::abs(push) <= digits, "a release under load", push); break;
        case EventKind::reload:
          if (!scene_.base.recovery) expect(std::abs(push) <= digits, "a reload under load", push);
          break;
        case EventKind::stick:
        case EventKind::slip_reversal:
          if (eps_ == 0.0) expect(std::abs(p.slip) <= tiny, "V = 0 away from zero", p.slip);
          break;
        default: break;
      }
    }
  }

  /// The paper's massless base: after the release u' = -(k/h) u.
  struct Recovering {
    Face face = Face::none;
    double at_start = 0.0;  ///< u at the start of the present segment
  };

  /// u at t of the segment: k/h, along the normal of now, integrated by Simpson's rule.
  double deformation(std::size_t site, double t) const {
    const Recovering& base = recovering_[site];
    if (base.at_start == 0.0) return 0.0;
    constexpr int kPanels = 8;
    double mean_rate = 0.0;
    for (int i = 0; i <= kPanels; ++i) {
      const Point p = point(state_at(*g_, t * i / kPanels), static_cast<int>(site), base.face);
      const double weight = i == 0 || i == kPanels ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
      mean_rate += weight / (3.0 * kPanels) * (p.damping > 0.0 ? p.stiffness / p.damping : 1e300);
    }
    return base.at_start * std::exp(-mean_rate * t);
  }

  /// A trial may start inside a base that the part does not load.
  void begin_recovery() {
    for (std::size_t site = 0; site < kSiteCount; ++site) {
      const ContactState& contact = g_->contacts[site];
      if (contact.phase == Phase::unloaded)
        recovering_[site] = {contact.face, point(g_->begin, static_cast<int>(site), contact.face).depth};
    }
  }

  void follow_recovery(double h) {
    for (std::size_t site = 0; site < kSiteCount; ++site) {
      recovering_[site].at_start = deformation(site, h);
      for (int i = 0; i < g_->event_count; ++i) {
        const Event& event = g_->events[static_cast<std::size_t>(i)];
        if (static_cast<std::size_t>(event.site) != site) continue;
        if (event.kind == EventKind::release) {
          const Face face = g_->contacts[site].face;
          recovering_[site] = {face, point(g_->end, static_cast<int>(site), face).depth};
        } else if (event.kind == EventKind::touch || event.kind == EventKind::reload ||
                   event.kind == EventKind::run_off) {
          recovering_[site] = {};
        }
      }
    }
  }

  Scene scene_;
  System system_;
  const Segment* g_ = nullptr;
  double l_ = 0.0, friction_ = 0.0, eps_ = 0.0, tolerance_ = 0.0;
  double fastest_ = 1.0;  ///< rate of the free motion
  State before_;
  Instant time_;
  bool begun_ = false;
  std::array<Recovering, kSiteCount> recovering_;
  long touches_ = 0;
  int faults_ = 0;
};

/// Runs a scene to its end under the eyes of MotionCheck and returns the result.
inline TrialResult checked_run(const Scene& scene, const SimulationOptions& options = {}) {
  Simulation simulation(scene, options);
  MotionCheck check(scene);
  while (simulation.advance())
    if (!check.check(simulation.segment())) break;
  return simulation.result();
}

}  // namespace vibratory_alignment::test
