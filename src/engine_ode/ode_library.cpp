#include "engine_ode/ode_library.h"

#include <ode/ode.h>

#include <cstdarg>
#include <cstdio>
#include <mutex>
#include <string>

#include "solver/solver.h"

namespace vibratory_alignment {
namespace {

std::mutex library_mutex;
long handles = 0, openings = 0;

thread_local long entered_opening = 0;
thread_local std::string last_message;

std::string text_of(int number, const char* format, va_list arguments) {
  char text[256];
  std::vsnprintf(text, sizeof text, format, arguments);
  return "ODE " + std::to_string(number) + ": " + text;
}

/// Kept until the step is done.
void keep_message(int number, const char* format, va_list arguments) {
  last_message = text_of(number, format, arguments);
}

/// ODE would end the process after it.
[[noreturn]] void fail_with_message(int number, const char* format, va_list arguments) {
  throw SolverFailure(text_of(number, format, arguments));
}

}  // namespace

OdeLibrary::OdeLibrary() {
  const std::lock_guard<std::mutex> lock(library_mutex);
  if (handles == 0) {
    if (dInitODE2(0) == 0) throw SolverFailure("the Open Dynamics Engine cannot be initialised");
    ++openings;
    dRandSetSeed(0);  // only ODE's iterative solver, which is not used here, draws random numbers
    dSetMessageHandler(keep_message);
    dSetErrorHandler(fail_with_message);
    dSetDebugHandler(fail_with_message);
  }
  ++handles;
  opening_ = openings;
}

OdeLibrary::~OdeLibrary() {
  const std::lock_guard<std::mutex> lock(library_mutex);
  if (--handles == 0) dCloseODE();
}

void OdeLibrary::enter_thread() const {
  if (entered_opening == opening_) return;
  if (dAllocateODEDataForThread(dAllocateFlagBasicData) == 0)
    throw SolverFailure("the Open Dynamics Engine has no memory for this thread");
  entered_opening = opening_;
  last_message.clear();
}

void OdeLibrary::check_messages() {
  if (last_message.empty()) return;
  const std::string message = last_message;
  last_message.clear();
  throw SolverFailure(message);
}

}  // namespace vibratory_alignment
