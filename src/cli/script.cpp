#include "cli/script.h"

#include <spawn.h>
#include <sys/wait.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>

extern char** environ;

namespace vibratory_alignment {

int run_script(const std::string& name, const std::vector<std::string>& arguments, const std::string& purpose) {
  const std::filesystem::path script = std::filesystem::read_symlink("/proc/self/exe").parent_path() / name;
  if (!std::filesystem::exists(script))
    throw std::runtime_error(purpose + ": " + script.string() + " is missing; is the package installed whole?");
  std::vector<std::string> words = {script.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  pid_t child = 0;
  const int error = posix_spawn(&child, script.c_str(), nullptr, nullptr, pointers.data(), environ);
  if (error != 0) throw std::runtime_error(purpose + ": " + script.string() + ": " + std::strerror(error));
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

void require_script(const std::string& name, const std::vector<std::string>& arguments, const std::string& purpose) {
  const int status = run_script(name, arguments, purpose);
  if (status != 0)
    throw std::runtime_error(purpose + ": " + name + " failed with exit status " + std::to_string(status));
}

}  // namespace vibratory_alignment
