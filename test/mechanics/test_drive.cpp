// Excitations against their definitions, the phase in 113 bits: theta = nu (t - t0) + phase, over up to 1e6 periods.
#include "mechanics/drive.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "../support/numbers.h"
#include "../support/quad.h"

namespace vibratory_alignment {
namespace {

using test::Float128;
using test::kPi;
using test::two_pi;
using test::wrapped;

Excitation excitation_of(Waveform waveform, double amplitude, double frequency, double phase) {
  Excitation e;
  e.waveform = waveform;
  e.amplitude = amplitude;
  e.frequency = frequency;
  e.phase = phase;
  return e;
}

Float128 time_of(const Instant& t) { return Float128(t.high) + Float128(t.low); }

/// Distance of two angles around the circle.
double angle_between(double a, Float128 b) {
  Float128 difference = wrapped(Float128(a) - b);
  if (difference > two_pi() / 2) difference -= two_pi();
  return std::abs(static_cast<double>(difference));
}

/// What a form gives at time dt after its start.
double value_of(const DriveForm& form, double dt) {
  const double angle = form.frequency * dt + 0.5 * form.rate * dt * dt;
  return form.constant + form.slope * dt +
         form.amplitude * (form.sin_phase * std::cos(angle) + form.cos_phase * std::sin(angle));
}

/// Goes to `t`, passing the kinks on the way.
Instant go_to(Drive& drive, Instant now, double t) {
  for (;;) {
    const double left = t - now, to_kink = drive.time_to_kink(now);
    if (to_kink > left) return now + left;
    now = now + to_kink;
    drive.pass_kink();
  }
}

// Limits of trials and times of outputs are met to the last bit, from wherever a step starts.
TEST(Instant, goes_to_a_time_to_the_last_bit) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  for (int i = 0; i < 200'000; ++i) {
    const Instant now = (Instant{} + u(random)) + 1e-3 * u(random);
    const double end = now.value() + u(random) * std::pow(10.0, -12.0 * u(random));
    ASSERT_EQ((now + time_to(end, now)).value(), end) << i;
  }
  EXPECT_EQ(time_to(1.0, Instant{} + 2.0), 0.0);
}

TEST(Instant, adds_up_without_loss) {
  Instant t;
  Float128 exact = 0;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> step(0.0, 0.3);
  for (int i = 0; i < 300000; ++i) {
    const double dt = step(random);
    t = t + dt;
    exact += Float128(dt);
  }
  EXPECT_LT(std::abs(static_cast<double>(time_of(t) - exact)), 1e-22);
  EXPECT_LE(std::abs(t.low), 0.5 * (std::nextafter(t.high, 1e300) - t.high));
}

TEST(Instant, difference_keeps_the_small_digits) {
  const Instant a = Instant{1e6, 0.0} + 1e-20;
  const Instant b = a + 3e-13;
  EXPECT_NEAR(b - a, 3e-13, 1e-28);
  EXPECT_NEAR(1e6 - a, -1e-20, 1e-35);
}

TEST(Drive, sine_has_the_phase_of_the_definition) {
  for (const double phase : {0.0, 0.7, -2.0, 40.0}) {
    const Drive drive(excitation_of(Waveform::sine, 1.3, 20.0, phase), {});
    for (const double t : {0.0, 1e-7, 0.4, 3.1}) {
      const Instant now{t, 0.0};
      EXPECT_LT(angle_between(drive.phase_at(now), Float128(20.0) * Float128(t) + Float128(phase)), 4e-15);
      EXPECT_NEAR(value_of(drive.form_at(now), 0.02), 1.3 * std::sin(20.0 * (t + 0.02) + phase), 1e-13);
      EXPECT_EQ(drive.time_to_kink(now), std::numeric_limits<double>::infinity());
    }
  }
}

// A force that begins at its peak has no slope, one that begins at zero no value, though the double next to pi/2 or pi is
// not these; what is more than the last digit of the phase counts.
TEST(Drive, a_quarter_turn_is_one) {
  for (int quarters = 1; quarters <= 3; ++quarters) {
    const double phase = quarters * (0.5 * kPi);
    const auto small_part = [&](double off) {
      const DriveForm form = Drive(excitation_of(Waveform::sine, 1.3, 20.0, phase + off), {}).form_at({});
      return quarters == 2 ? form.sin_phase : form.cos_phase;
    };
    EXPECT_EQ(small_part(0.0), 0.0) << quarters;
    EXPECT_NEAR(std::abs(small_part(4e-15)), 4e-15, 1e-15) << quarters;
  }
}

// In doubles the phase would be off by 1e-9 by then.
TEST(Drive, phase_does_not_drift_in_a_million_periods) {
  for (const double frequency : {20.0, 7.3, 0.1, 1.0 / 3.0, 1234.5678})
    for (const double periods : {1e3, 123456.78, 1e6}) {
      const Drive drive(excitation_of(Waveform::sine, 1.0, frequency, 0.4), {});
      const Instant now = Instant{periods * 2.0 * kPi / frequency, 0.0} + 1.2345e-12;
      EXPECT_LT(angle_between(drive.phase_at(now), Float128(frequency) * time_of(now) + Float128(0.4)), 4e-15)
          << frequency;
    }
}

TEST(Drive, phase_counts_from_the_start_of_the_drive) {
  const Instant start = Instant{7777.7, 0.0} + 1e-15;
  const Drive drive(excitation_of(Waveform::sine, 1.0, 20.0, 0.4), start);
  const Instant now = start + 1.7;
  EXPECT_LT(angle_between(drive.phase_at(now), Float128(20.0) * (time_of(now) - time_of(start)) + Float128(0.4)),
            4e-15);
}

/// Walks through `periods` periods and compares value and slope with the definition at places between the kinks.
void expect_waveform(const Excitation& e, double (*definition)(double theta), double periods) {
  Drive drive(e, {});
  Instant now;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> step(0.0, 2.0);
  while (now.value() * e.frequency < periods * 2.0 * kPi) {
    now = go_to(drive, now, now.value() + step(random) / e.frequency);
    const double theta = static_cast<double>(wrapped(Float128(e.frequency) * time_of(now) + Float128(e.phase)));
    const DriveForm form = drive.form_at(now);
    ASSERT_NEAR(value_of(form, 0.0), e.amplitude * definition(theta), 1e-13) << "theta = " << theta;
    // it goes on as it is until the next kink
    const double on = std::min(0.1, 0.5 * drive.time_to_kink(now) * e.frequency);
    ASSERT_NEAR(value_of(form, on / e.frequency), e.amplitude * definition(theta + on), 1e-13) << "theta = " << theta;
  }
}

TEST(Drive, square_is_the_sign_of_the_sine) {
  const auto square = [](double theta) { return std::sin(theta) > 0.0 ? 1.0 : -1.0; };
  expect_waveform(excitation_of(Waveform::square, 1.3, 20.0, 0.0), square, 2000);
  expect_waveform(excitation_of(Waveform::square, -0.4, 0.37, 2.9), square, 50);
}

TEST(Drive, triangle_is_the_arc_sine_of_the_sine) {
  const auto triangle = [](double theta) { return 2.0 / kPi * std::asin(std::sin(theta)); };
  // asin loses half the digits at its ends; the walk stays off them by its random steps
  const auto definition = [](double theta) {
    const double turn = std::fmod(theta, 2.0 * kPi);
    return turn < 0.5 * kPi ? 2.0 / kPi * turn : turn < 1.5 * kPi ? 2.0 - 2.0 / kPi * turn : 2.0 / kPi * turn - 4.0;
  };
  for (const double theta : {0.1, 1.2, 2.0, 4.0, 5.5}) ASSERT_NEAR(definition(theta), triangle(theta), 1e-14);
  expect_waveform(excitation_of(Waveform::triangle, 1.3, 20.0, 0.0), definition, 2000);
  expect_waveform(excitation_of(Waveform::triangle, 0.7, 3.7, -1.9), definition, 50);
}

// Kink n of the square wave is where theta = n pi, of the triangle where theta = (n - 1/2) pi: to the last digit,
// however many came before it.
TEST(Drive, kinks_lie_where_the_definition_has_them) {
  for (const Waveform waveform : {Waveform::square, Waveform::triangle}) {
    const double frequency = 7.3, phase = 0.4;
    Drive drive(excitation_of(waveform, 1.0, frequency, phase), {});
    Instant now;
    for (int n = 1; n <= 200000; ++n) {
      now = now + drive.time_to_kink(now);
      drive.pass_kink();
      if (n % 997 != 1) continue;
      const Float128 angle =
          (Float128(n) - (waveform == Waveform::triangle ? Float128(0.5) : Float128(0))) * two_pi() / 2;
      const double error = static_cast<double>(time_of(now) - (angle - Float128(phase)) / Float128(frequency));
      ASSERT_LT(std::abs(error), 2e-15 / frequency * 2.0) << "kink " << n;
    }
  }
}

TEST(Drive, a_kink_that_is_passed_is_not_found_again) {
  for (const double phase : {0.0, 0.5 * kPi, kPi, 1.5 * kPi, 1e-16, -1e-16})
    for (const Waveform waveform : {Waveform::square, Waveform::triangle}) {
      Drive drive(excitation_of(waveform, 1.0, 20.0, phase), {});
      Instant now = Instant{} + drive.time_to_kink({});
      drive.pass_kink();
      for (int i = 0; i < 20; ++i) {
        const double to_kink = drive.time_to_kink(now);
        EXPECT_NEAR(to_kink * 20.0, kPi, 1e-14) << phase;
        now = now + to_kink;
        drive.pass_kink();
      }
    }
}

TEST(Drive, without_amplitude_there_are_no_kinks) {
  const Drive drive(excitation_of(Waveform::square, 0.0, 20.0, 0.0), {});
  EXPECT_EQ(drive.time_to_kink({}), std::numeric_limits<double>::infinity());
}

Excitation chirp_of(double frequency, double end_frequency, double sweep_time, double phase) {
  Excitation e = excitation_of(Waveform::chirp, 1.0, frequency, phase);
  e.end_frequency = end_frequency;
  e.sweep_time = sweep_time;
  return e;
}

Float128 chirp_phase(const Excitation& e, Float128 t) {
  const Float128 nu = e.frequency, end = e.end_frequency, sweep = e.sweep_time;
  if (t < sweep) return Float128(e.phase) + nu * t + (end - nu) / sweep * t * t / 2;
  return Float128(e.phase) + (nu + end) / 2 * sweep + end * (t - sweep);
}

TEST(Drive, chirp_is_the_integral_of_its_frequency) {
  for (const Excitation& e : {chirp_of(5.0, 40.0, 16.0, 0.3), chirp_of(40.0, 5.0, 3.0, -1.0)}) {
    // the rate of the sweep is a rounded quotient: that much of the angle swept is in question
    for (const double share : {0.0, 1e-3, 0.3, 0.99, 1.0, 1.5, 30.0}) {
      const double t = share * e.sweep_time;
      Drive drive(e, {});
      const Instant now = go_to(drive, {}, t);
      const double swept = std::abs(static_cast<double>(chirp_phase(e, Float128(std::min(t, e.sweep_time)))));
      EXPECT_LT(angle_between(drive.phase_at(now), chirp_phase(e, time_of(now))), 4e-15 + 3e-16 * swept) << "t = " << t;
      const double frequency =
          t < e.sweep_time ? e.frequency + (e.end_frequency - e.frequency) * t / e.sweep_time : e.end_frequency;
      EXPECT_NEAR(drive.form_at(now).frequency, frequency, 1e-13);
      const double on = std::min(0.01, 0.5 * drive.time_to_kink(now));
      EXPECT_NEAR(value_of(drive.form_at(now), on),
                  std::sin(static_cast<double>(wrapped(chirp_phase(e, time_of(now) + Float128(on))))), 1e-12);
    }
  }
}

// Another amplitude, or one of zero for a while, leaves the sweep as it is; another frequency begins a new one.
TEST(Drive, sweep_goes_on_when_the_amplitude_changes) {
  const Excitation e = chirp_of(5.0, 40.0, 16.0, 0.3);
  Excitation louder = e, silent = e;
  louder.amplitude = 2.0;
  louder.phase += 0.5;
  silent.amplitude = 0.0;
  const Drive undisturbed(e, Instant{});
  const auto at = [](double t) { return Instant{} + t; };
  Drive drive(e, Instant{});
  drive.change(louder, at(4.0));
  EXPECT_NEAR(angle_between(drive.phase_at(at(7.0)), Float128(undisturbed.phase_at(at(7.0)) + 0.5)), 0.0, 1e-13);
  EXPECT_EQ(drive.form_at(at(7.0)).frequency, undisturbed.form_at(at(7.0)).frequency);
  EXPECT_EQ(drive.form_at(at(7.0)).amplitude, 2.0);
  EXPECT_EQ(drive.time_to_kink(at(7.0)), 9.0);
  // the end of the sweep is not asked for while nothing shakes
  drive.change(silent, at(8.0));
  drive.change(e, at(20.0));
  EXPECT_EQ(drive.form_at(at(20.0)).frequency, 40.0);
  EXPECT_EQ(drive.time_to_kink(at(20.0)), std::numeric_limits<double>::infinity());
  Excitation faster = e;
  faster.frequency = 8.0;
  drive.change(faster, at(21.0));
  EXPECT_EQ(drive.form_at(at(21.0)).frequency, 8.0);
  EXPECT_EQ(drive.time_to_kink(at(21.0)), 16.0);
}

TEST(Drive, chirp_goes_on_from_its_end_without_a_jump) {
  const Excitation e = chirp_of(5.0, 40.0, 16.0, 0.3);
  Drive drive(e, {});
  const Instant end = Instant{} + drive.time_to_kink({});
  EXPECT_EQ(end.value(), 16.0);
  const double before = drive.phase_at(end);
  drive.pass_kink();
  EXPECT_LT(angle_between(drive.phase_at(end), Float128(before)), 1e-13);
  EXPECT_EQ(drive.time_to_kink(end), std::numeric_limits<double>::infinity());
}

// What has swept from 20 to 20 is a sine; and a sweep of half a million periods ends where its end frequency begins.
TEST(Drive, a_long_chirp_does_not_lose_the_phase) {
  Drive swept(chirp_of(20.0, 20.0, 0.1, 0.4), {});
  swept.pass_kink();
  for (const double t : {10.0, 1234.5, 3.14e5}) {
    const Instant now = Instant{t, 0.0} + 1.2345e-12;
    EXPECT_LT(angle_between(swept.phase_at(now), Float128(20.0) * time_of(now) + Float128(0.4)), 4e-15) << t;
  }
  for (const double sweep_time : {1.1e6, 1234567.8, 1.7e6 / 3.0}) {
    Drive drive(chirp_of(1.3, 3.1, sweep_time, 0.4), {});
    const Instant end = Instant{} + sweep_time;
    const double before = drive.phase_at(end);
    drive.pass_kink();
    EXPECT_LT(angle_between(drive.phase_at(end), Float128(before)), 4e-15) << sweep_time;
  }
}

TEST(Drive, change_keeps_the_phase) {
  for (const Waveform waveform : {Waveform::sine, Waveform::square, Waveform::triangle}) {
    Drive drive(excitation_of(waveform, 1.0, 20.0, 0.4), {});
    const Instant now = go_to(drive, {}, 3.33);
    const double before = drive.phase_at(now);
    drive.change(excitation_of(waveform, 0.5, 31.0, 0.4), now);
    EXPECT_LT(angle_between(drive.phase_at(now), Float128(before)), 2e-15);
    // from here on with the new frequency
    const Instant later = now + 0.01;
    EXPECT_LT(angle_between(drive.phase_at(later), Float128(before) + Float128(31.0) * (time_of(later) - time_of(now))),
              2e-15);
  }
}

// The phase of a kink is one of two neighbours of the target, so that asked anew the law of before it could hold again.
TEST(Drive, settings_that_are_given_at_a_kink_do_not_repeat_it) {
  for (const Waveform waveform : {Waveform::square, Waveform::triangle})
    for (const double frequency : {1.3, 17.0, 20.7}) {
      Drive drive(excitation_of(waveform, 1.0, frequency, 0.0), {});
      Instant now = Instant{} + drive.time_to_kink({});
      drive.pass_kink();
      for (int i = 0; i < 1000; ++i) {
        drive.change(excitation_of(waveform, i % 2 == 0 ? 0.5 : 1.0, frequency, 0.0), now);
        const double to_kink = drive.time_to_kink(now);
        ASSERT_NEAR(to_kink * frequency, kPi, 1e-12) << frequency << ", kink " << i;
        now = now + to_kink;
        drive.pass_kink();
      }
    }
}

TEST(Drive, a_new_phase_setting_shifts_by_the_difference) {
  Drive drive(excitation_of(Waveform::sine, 1.0, 20.0, 0.4), {});
  const Instant now{3.33, 0.0};
  const double before = drive.phase_at(now);
  drive.change(excitation_of(Waveform::sine, 1.0, 20.0, 1.6), now);
  EXPECT_LT(angle_between(drive.phase_at(now), Float128(before) + Float128(1.2)), 2e-15);
}

TEST(Drive, change_of_waveform_keeps_the_phase_and_finds_the_right_branch) {
  const Waveform all[] = {Waveform::sine, Waveform::square, Waveform::triangle};
  for (const Waveform from : all)
    for (const Waveform to : all)
      for (const double t : {0.02, 0.1, 0.2, 0.28}) {  // theta = 0.4, 2.0, 4.0, 5.6
        Drive drive(excitation_of(from, 1.0, 20.0, 0.0), {});
        const Instant now = go_to(drive, {}, t);
        drive.change(excitation_of(to, 1.0, 20.0, 0.0), now);
        const double theta = 20.0 * t, s = std::sin(theta);
        const double expected = to == Waveform::sine     ? s
                                : to == Waveform::square ? (s > 0.0 ? 1.0 : -1.0)
                                                         : 2.0 / kPi * std::asin(s);
        EXPECT_NEAR(value_of(drive.form_at(now), 0.0), expected, 1e-13);
      }
}

// Turned off and on again by its amplitude, a drive must stand where it would have been.
TEST(Drive, runs_on_while_it_is_off) {
  for (const Waveform waveform : {Waveform::sine, Waveform::square, Waveform::triangle}) {
    Drive drive(excitation_of(waveform, 1.0, 20.0, 0.4), {}), steady = drive;
    Instant now = go_to(drive, {}, 1.0);
    drive.change(excitation_of(waveform, 0.0, 20.0, 0.4), now);
    now = go_to(drive, now, 7.7);
    drive.change(excitation_of(waveform, 1.0, 20.0, 0.4), now);
    const Instant same = go_to(steady, {}, 7.7);
    EXPECT_NEAR(value_of(drive.form_at(now), 0.0), value_of(steady.form_at(same), 0.0), 1e-13);
    if (waveform == Waveform::sine) continue;
    EXPECT_NEAR(drive.time_to_kink(now), steady.time_to_kink(same), 1e-13);
  }
}

TEST(Drive, a_thousand_changes_do_not_lose_the_phase) {
  Drive drive(excitation_of(Waveform::sine, 1.0, 20.0, 0.0), {});
  Instant now;
  Float128 angle = 0;
  double frequency = 20.0;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> next(1.0, 100.0);
  for (int i = 0; i < 1000; ++i) {
    const Instant before = now;
    now = now + 0.7;
    angle += Float128(frequency) * (time_of(now) - time_of(before));
    frequency = next(random);
    drive.change(excitation_of(Waveform::sine, 1.0, frequency, 0.0), now);
  }
  EXPECT_LT(angle_between(drive.phase_at(now), angle), 1000 * 1e-15);
}

}  // namespace
}  // namespace vibratory_alignment
