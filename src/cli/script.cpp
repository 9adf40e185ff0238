#include "cli/script.h"

#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <thread>

extern char** environ;

namespace vibratory_alignment {
namespace {

constexpr std::chrono::milliseconds kTurn(10);

/// In a process group of its own: Ctrl-C on the terminal reaches it once, from here. Returns 0 or an error number.
int spawn(const std::string& script, char* const* words, pid_t& child) {
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  const int error = posix_spawn(&child, script.c_str(), nullptr, &attributes, words, environ);
  posix_spawnattr_destroy(&attributes);
  return error;
}

/// What waitpid() says of the child once it has ended.
int wait_for(pid_t child, const InterruptGuard& interrupt) {
  int status = 0;
  bool told = false;
  for (pid_t ended = 0; ended != child;) {
    ended = waitpid(child, &status, WNOHANG);
    if (ended < 0 && errno != EINTR) throw std::runtime_error(std::string("waitpid: ") + std::strerror(errno));
    if (ended == 0 && interrupt.signal() != 0 && !told) told = kill(child, interrupt.signal()) == 0;
    if (ended == 0) std::this_thread::sleep_for(kTurn);
  }
  return status;
}

}  // namespace

std::string path_word(const std::string& path) { return path.compare(0, 1, "-") == 0 ? "./" + path : path; }

int run_script(const std::string& name, const std::vector<std::string>& arguments, const std::string& purpose,
               const InterruptGuard& interrupt) {
  const std::filesystem::path script = std::filesystem::read_symlink("/proc/self/exe").parent_path() / name;
  if (!std::filesystem::exists(script))
    throw std::runtime_error(purpose + ": " + script.string() + " is missing; is the package installed whole?");
  std::vector<std::string> words = {script.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  pid_t child = 0;
  const int error = spawn(script.string(), pointers.data(), child);
  if (error != 0) throw std::runtime_error(purpose + ": " + script.string() + ": " + std::strerror(error));
  const int status = wait_for(child, interrupt);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

void require_script(const std::string& name, const std::vector<std::string>& arguments, const std::string& purpose,
                    const InterruptGuard& interrupt) {
  const int status = run_script(name, arguments, purpose, interrupt);
  if (status != 0 && interrupt.signal() == 0)
    throw std::runtime_error(purpose + ": " + name + " failed with exit status " + std::to_string(status));
}

}  // namespace vibratory_alignment
