// The Open Dynamics Engine as a library of the process: open while any of these handles lives.
#pragma once

namespace vibratory_alignment {

class OdeLibrary {
 public:
  OdeLibrary();
  ~OdeLibrary();
  OdeLibrary(const OdeLibrary&) = delete;
  OdeLibrary& operator=(const OdeLibrary&) = delete;

  /// To be called in a thread before it uses ODE, as often as one likes.
  void enter_thread() const;

  /// Throws SolverFailure with what ODE has had to say in this thread since the last call, if anything: its messages
  /// tell of steps that it could not solve.
  static void check_messages();

 private:
  long opening_;  ///< how many times the library had been opened when the handle was made
};

}  // namespace vibratory_alignment
