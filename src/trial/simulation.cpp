#include "trial/simulation.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <exception>
#include <new>
#include <string>

#include "mechanics/statics.h"
#include "mechanics/system.h"
#include "model/scaling.h"
#include "solver/contact_point.h"
#include "trial/contact_watch.h"
#include "trial/energy.h"
#include "trial/make_solver.h"
#include "trial/settling.h"

namespace vibratory_alignment {
namespace {

double cpu_now() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

class Simulation::Impl {
 public:
  Impl(const Scene& scene, const SimulationOptions& options)
      : scene_(scene),
        options_(options),
        system_(make_system(scene)),
        solver_(make_solver(system_, scene.excitations, scene.solver)),
        excitations_(scene.excitations),
        limit_(options.until.value_or(scene.trial.time_limit)),
        contacts_(system_, slowest_period(scene.excitations)),
        energy_(system_),
        settling_(scene.excitations, limit_),
        state_(system_.start),
        cpu_start_(cpu_now()) {}

  bool advance() {
    if (ended_) return false;
    guarded([&] {
      if (has_segment_) book();
      if (ended_) return;
      solver_->advance(limit_);
      has_segment_ = true;
      is_changed_ = false;
      end_where_it_settles();
    });
    return !ended_;
  }

  const Segment& segment() const { return solver_->segment(); }
  Mode mode() const { return ended_ ? contacts_.mode() : contacts_.mode_in(segment()); }

  void cut(double t) {
    if (!has_segment_ || !std::isfinite(t)) return;
    // an instant has more digits than t: where t is the start but for these, nothing has passed yet
    double duration = t - segment().start;
    if (std::abs(duration) <= 2.3e-16 * std::abs(t)) duration = 0.0;
    if (!(duration >= 0.0 && duration < segment().duration)) return;
    guarded([&] { solver_->cut(duration); });
    if (is_changed_) {
      settling_.restart(excitations_, segment().end_time());
    } else {
      settling_.take_back();
      settling_.book(segment());
    }
  }

  void set_excitations(const std::vector<Excitation>& excitations) {
    std::copy_n(excitations.begin(), std::min(excitations.size(), excitations_.size()), excitations_.begin());
    guarded([&] { solver_->set_excitations(excitations); });
    contacts_.set_period(slowest_period(excitations_));
    go_on_changed();
  }

  void set_pressing_force(double pressing_force) {
    const std::optional<double> touch = touch_height(system_, system_.start.x, system_.start.phi);
    if (!touch) throw std::invalid_argument("this scene has no touching height, so no pressing force can be set");
    system_.y.anchor = *touch - pressing_force;
    guarded([&] { solver_->set_anchor_y(system_.y.anchor); });
    if (options_.energy && has_segment_)
      pending_anchor_ = system_.y.anchor;
    else
      energy_.move_anchor_y(system_.y.anchor, system_.start);
    go_on_changed();
  }

  TrialResult result() const {
    TrialResult r;
    r.scene = scene_.name;
    r.outcome = outcome_;
    r.failure = failure_;
    r.mode = contacts_.mode();
    r.mode_changes = contacts_.mode_changes();
    r.aligned_time = aligned_time_;
    r.final_time = time_;
    r.final_state = state_;
    for (int i = 0; i < kSpotCount; ++i) {
      const auto spot = static_cast<Spot>(i);
      r.impacts[static_cast<std::size_t>(i)] = contacts_.impacts(spot);
      r.impact_times[static_cast<std::size_t>(i)] = contacts_.impact_times(spot);
      r.peak_force[static_cast<std::size_t>(i)] = contacts_.peak_force(spot);
      if (scene_.trial.force_limit && contacts_.peak_force(spot) > *scene_.trial.force_limit)
        r.force_limit_exceeded = true;
    }
    r.first_contact = contacts_.first_contact();
    if (options_.energy) r.energy = energy_.ledger();
    r.solver_name = scene_.solver.name;
    if (scene_.solver.step)
      r.solver_step = *scene_.solver.step;
    else
      r.solver_tolerance = scene_.solver.tolerance;
    r.solver_accuracy = scene_.solver.accuracy.value_or(0.0);
    r.counts = solver_->counts();
    r.cpu_seconds = ended_ ? cpu_seconds_ : cpu_now() - cpu_start_;
    return r;
  }

  Scene scene_;
  SimulationOptions options_;
  System system_;
  std::unique_ptr<Solver> solver_;
  std::vector<Excitation> excitations_;
  double limit_;
  ContactWatch contacts_;
  EnergyAccount energy_;
  SettlingWatch settling_;

  double time_ = 0.0;
  State state_;
  bool has_segment_ = false, ended_ = false, reached_end_ = false;
  bool is_changed_ = false;  ///< from the segment's end on
  Outcome outcome_ = Outcome::running;
  std::string failure_;
  std::optional<double> aligned_time_;
  std::optional<double> pending_anchor_;
  double cpu_start_, cpu_seconds_ = 0.0;

 private:
  /// Nothing new would come until the segment's end, which may be that of the trial.
  void end_where_it_settles() {
    const std::optional<double> when = settling_.book(segment());
    if (when && *when < segment().duration && outcome_ == Outcome::running && !options_.until) solver_->cut(*when);
  }

  /// What has settled may move again.
  void go_on_changed() {
    is_changed_ = true;
    if (!ended_ && (outcome_ == Outcome::stalled || outcome_ == Outcome::jammed)) outcome_ = Outcome::running;
    settling_.restart(excitations_, has_segment_ ? segment().end_time() : 0.0);
  }

  /// Accounts for the segment that has been passed and decides whether the trial ends with it.
  void book() {
    const Segment& segment = solver_->segment();
    contacts_.book(segment);
    if (options_.energy) {
      energy_.book(segment);
      if (pending_anchor_) energy_.move_anchor_y(*pending_anchor_, segment.end);
      pending_anchor_.reset();
    }
    time_ = segment.end_time();
    state_ = segment.end;
    if (outcome_ == Outcome::running) decide(segment);
    const bool at_limit = time_ >= limit_;
    if (at_limit && outcome_ == Outcome::running) outcome_ = Outcome::time_limit;
    if (at_limit || (outcome_ != Outcome::running && !options_.until)) end();
  }

  /// In a slot with an end the trial goes on after the alignment until the part is inserted or jammed.
  void decide(const Segment& segment) {
    const bool has_end = system_.has_floor || system_.has_inserted_depth;
    for (int i = 0; i < segment.event_count; ++i) {
      const Event& event = segment.events[static_cast<std::size_t>(i)];
      if (event.kind == EventKind::aligned && !aligned_time_) {
        aligned_time_ = time_;
        if (!has_end) outcome_ = Outcome::aligned;
      }
      const bool on_floor =
          event.kind == EventKind::touch && (event.site == Site::b1_floor || event.site == Site::b2_floor);
      if (on_floor || event.kind == EventKind::inserted) reached_end_ = true;
    }
    // it may have stood there from the start
    for (const Site site : {Site::b1_floor, Site::b2_floor})
      if (segment.contacts[static_cast<std::size_t>(site)].touching()) reached_end_ = true;
    if (aligned_time_ && reached_end_) outcome_ = Outcome::inserted;
    if (outcome_ != Outcome::running || !settling_.settled()) return;
    const bool is_in_slot = is_below(system_, PlacedState(segment.end), segment.contacts, 0.0, true);
    outcome_ = aligned_time_ && is_in_slot ? Outcome::jammed : Outcome::stalled;
  }

  /// Does a part of the trial. Whatever it throws ends the trial as failed, but for a lack of memory, which is none of
  /// its results.
  template <class Part>
  void guarded(const Part& part) {
    try {
      part();
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& error) {
      fail(error.what());
    }
  }

  /// The trial ends where the last segment that was passed does.
  void fail(const std::string& reason) {
    failure_ = reason + " at time " + own_unit_text(scene_, Quantity::time, time_) +
               (scene_.units == Units::si ? "" : " (dimensionless)") +
               ", x = " + own_unit_text(scene_, Quantity::length, state_.x) +
               ", y = " + own_unit_text(scene_, Quantity::length, state_.y) +
               ", phi = " + own_unit_text(scene_, Quantity::angle, state_.phi);
    outcome_ = Outcome::failed;
    end();
  }

  void end() {
    ended_ = true;
    cpu_seconds_ = cpu_now() - cpu_start_;
  }
};

Simulation::Simulation(const Scene& scene, const SimulationOptions& options)
    : impl_(std::make_unique<Impl>(scene, options)) {}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

bool Simulation::advance() { return impl_->advance(); }
const Segment& Simulation::segment() const { return impl_->segment(); }
void Simulation::cut(double t) { impl_->cut(t); }
void Simulation::set_excitations(const std::vector<Excitation>& excitations) { impl_->set_excitations(excitations); }
void Simulation::set_pressing_force(double pressing_force) { impl_->set_pressing_force(pressing_force); }
const Scene& Simulation::scene() const { return impl_->scene_; }
const System& Simulation::system() const { return impl_->system_; }
double Simulation::time() const { return impl_->time_; }
State Simulation::state() const { return impl_->state_; }
bool Simulation::ended() const { return impl_->ended_; }
Mode Simulation::mode() const { return impl_->mode(); }
long Simulation::impacts(Spot spot) const { return impl_->contacts_.impacts(spot); }
TrialResult Simulation::result() const { return impl_->result(); }

}  // namespace vibratory_alignment
