// The problems as a function of Octave (an oct-file), for octave_ode45.m:
//   [start, end_time] = peer_octave ("begin", problem)      rate = peer_octave ("rate", t, s)
//   values = peer_octave ("guards", s)                      peer_octave ("pass", guard, s), guards count from 1
//   count = peer_octave ("evaluations")
#include <octave/oct.h>

#include <algorithm>

#include "peer_session.h"

namespace {

vibratory_alignment::peers::PeerSession& session() {
  static vibratory_alignment::peers::PeerSession the_session;
  return the_session;
}

octave_value_list begin(const std::string& problem) {
  try {
    session().begin(problem);
  } catch (const std::invalid_argument& wrong) {
    error("%s", wrong.what());
  }
  ColumnVector start(6);
  std::copy_n(session().problem().start.data(), 6, start.fortran_vec());
  return ovl(start, session().problem().end_time);
}

}  // namespace

DEFUN_DLD(peer_octave, args, , "See the head of peer_octave.cpp.") {
  const std::string command = args(0).string_value();
  if (command == "begin") return begin(args(1).string_value());
  auto& progress = session().progress();  // there is one after "begin" only
  if (command == "rate") {
    const ColumnVector s = args(2).column_vector_value();
    ColumnVector rate(6);
    progress.right_hand_side(args(1).double_value(), s.data(), rate.fortran_vec());
    return ovl(rate);
  }
  if (command == "guards") {
    const ColumnVector s = args(1).column_vector_value();
    ColumnVector values(vibratory_alignment::peers::guard_count);
    progress.guards(s.data(), values.fortran_vec());
    return ovl(values);
  }
  if (command == "pass") {
    progress.pass(args(1).int_value() - 1, args(2).column_vector_value().data());
    return ovl();
  }
  return ovl(static_cast<double>(progress.evaluations));
}
