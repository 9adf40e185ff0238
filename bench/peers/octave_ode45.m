% Octave's ode45 with Events, on the compiled right-hand side of the C++ peers.
%
% As its manual has it: an event function gives the guards, all terminal and rising; ode45 ends at one and begins anew
% there in the next mode. Two things of this ode45 to know: it does not stop at an event in its first step (hence the
% small InitialStep), and it locates events by a straight line through the ends of the step, so that the step's length
% bounds the accuracy, not the tolerance. Hence a second series, octave_ode45_maxstep, whose setting is MaxStep, at a
% tolerance of 1e-6.
% Output: see report.h.   Usage: octave octave_ode45.m DIRECTORY_OF_PEER_OCTAVE [PROBLEM ...]
1;

function [values, terminal, direction] = guards (s)
  values = peer_octave ("guards", s);
  terminal = direction = ones (size (values));
endfunction

% outcome: end state, right-hand sides, steps, events
function outcome = integrate (problem, tolerance, max_step)
  first_step = 1e-3;
  if (strcmp (problem, "r1_stiff"))
    first_step = 3e-5;
  endif
  [s, end_time] = peer_octave ("begin", problem);
  options = odeset ("RelTol", tolerance, "AbsTol", tolerance, "InitialStep", min (first_step, max_step), ...
                    "MaxStep", max_step, "Events", @(t, s) guards (s));
  t = steps = events = 0;
  while (t < end_time)
    solution = ode45 (@(t, s) peer_octave ("rate", t, s), [t, end_time], s, options);
    steps += numel (solution.x) - 1;
    t = solution.x(end);
    s = solution.y(:, end);
    if (t >= end_time || isempty (solution.ie))
      break;
    endif
    peer_octave ("pass", solution.ie(end), s);
    events += 1;
    if (events > 2000)
      error ("too many events");
    endif
  endwhile
  if (t < end_time)
    error ("ode45 stopped at t = %g", t);
  endif
  outcome = [s.', peer_octave("evaluations"), steps, events];
endfunction

% Repetitions until 0.3 s are spent and 5 are made; after 3 s: fewer.
function report (peer, problem, setting, run)
  times = [];
  try
    while ((sum (times) < 0.3 || numel (times) < 5) && sum (times) < 3)
      begin_s = cputime ();
      outcome = run ();
      times(end + 1) = cputime () - begin_s;
    endwhile
  catch problem_met
    fprintf (stderr, "%s, %s, setting %g: %s\n", peer, problem, setting, problem_met.message);
    outcome = [NaN(1, 6), 0, 0, 0];
    times = NaN;
  end_try_catch
  printf ("%s,%s,%.6g", peer, problem, setting);
  printf (",%.17g", outcome);
  printf (",%.4g,%.4g\n", min (times), median (times));
  fflush (stdout);
endfunction

warning ("off", "all");
arguments = argv ();
addpath (arguments{1});
for problem = {"r1", "r1_stiff", "lasting", "wedge"}
  name = problem{1};
  if (numel (arguments) > 1 && ! any (strcmp (name, arguments(2:end))))
    continue;
  endif
  for tolerance = 10 .^ (-2:-1:-10)
    report ("octave_ode45", name, tolerance, @() integrate (name, tolerance, Inf));
  endfor
  for max_step = [1e-2, 3e-3, 1e-3, 3e-4]
    report ("octave_ode45_maxstep", name, max_step, @() integrate (name, 1e-6, max_step));
  endfor
endfor
